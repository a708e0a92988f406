#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/core/stable_sort.hpp"
#include "cambium/map/corridor/corridor.hpp"

namespace cambium::inline v0_1::map::detail {

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

  /// After every `unused_bytes` [B] of new corridors, those not in use are dropped, oldest first, down to that total.
  explicit BuiltCorridors(std::size_t unused_bytes = 8u << 20) : unused_bytes_(unused_bytes) {}

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
    if (is_new) new_bytes_ += bytes;
    if (new_bytes_ > unused_bytes_) forget_oldest();
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
    cambium::detail::stable_sort_by(unused,
                                    [](auto const& l, auto const& r) { return l->second.asked > r->second.asked; });
    std::size_t kept = 0;
    for (auto const& at : unused) {
      kept += at->second.bytes;
      if (kept > unused_bytes_) roads_.erase(at);
    }
    new_bytes_ = 0;
  }

  std::mutex mutex_;
  Roads roads_;
  std::uint64_t asked_ = 0;
  std::size_t unused_bytes_, new_bytes_ = 0;
};

}  // namespace cambium::inline v0_1::map::detail
