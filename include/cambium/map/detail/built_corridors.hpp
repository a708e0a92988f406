#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/map/corridor.hpp"

namespace cambium::map::detail {

/// About how much memory a road corridor takes [B]: its lines, and what it has of lanes that cross it.
[[nodiscard]] inline std::size_t bytes_of(RoadCorridor const& road) {
  std::size_t bytes = sizeof(RoadCorridor);
  for (auto const& corridor : road.corridors) {
    bytes += sizeof(LaneCorridor) + corridor.widths.size() * sizeof(SideWidths) +
             corridor.conflicts.size() * sizeof(Conflict) + corridor.feeders.size() * sizeof(Feeder);
    for (auto const* line : {&corridor.center, &corridor.left, &corridor.right}) bytes += line->segments().size_bytes();
    for (auto const& conflict : corridor.conflicts) bytes += conflict.ways.size() * sizeof(ConflictWay);
  }
  return bytes;
}

/// Road corridors by their routes: those in use, and those that were asked for last. Any number of threads may ask.
class BuiltCorridors {
 public:
  using Shared = std::shared_ptr<RoadCorridor const>;

  /// Those that are not in use may take `unused_bytes`, and as much again until it is time to forget some [B].
  explicit BuiltCorridors(std::size_t unused_bytes = 8u << 20) : unused_bytes_(unused_bytes), most_(2 * unused_bytes) {}

  /// The one along `route`; null if there is none.
  [[nodiscard]] Shared find(std::vector<LaneId> const& route) {
    std::lock_guard const lock(mutex_);
    auto const at = roads_.find(route);
    if (at == roads_.end()) return nullptr;
    at->second.asked = ++asked_;
    return at->second.road;
  }

  /// Takes `road` in and returns it, or the one that somebody else has built along its route in the meantime.
  Shared add(Shared const& road) {
    auto const bytes = bytes_of(*road);
    std::lock_guard const lock(mutex_);
    auto const [at, is_new] = roads_.try_emplace(road->route, Entry{road, bytes, ++asked_});
    Shared const kept = at->second.road;
    if (is_new) bytes_ += bytes;
    if (bytes_ > most_) forget_oldest();
    return kept;
  }

 private:
  struct Entry {
    Shared road;
    std::size_t bytes;
    std::uint64_t asked;  ///< when it was asked for last
  };
  using Roads = std::map<std::vector<LaneId>, Entry>;

  /// Forgets those not in use but for the ones that were asked for last.
  void forget_oldest() {
    std::vector<Roads::iterator> unused;
    for (auto at = roads_.begin(); at != roads_.end(); ++at)
      if (at->second.road.use_count() == 1) unused.push_back(at);
    std::ranges::sort(unused, std::greater{}, [](auto const& at) { return at->second.asked; });
    std::size_t kept = 0;
    for (auto const& at : unused) {
      kept += at->second.bytes;
      if (kept <= unused_bytes_) continue;
      bytes_ -= at->second.bytes;
      roads_.erase(at);
    }
    most_ = bytes_ + unused_bytes_;
  }

  std::mutex mutex_;
  Roads roads_;
  std::uint64_t asked_ = 0;
  std::size_t unused_bytes_, bytes_ = 0;
  std::size_t most_;  ///< with more bytes it is time to forget some
};

}  // namespace cambium::map::detail
