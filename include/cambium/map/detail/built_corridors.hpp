#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/map/corridor.hpp"

namespace cambium::map::detail {

/// Road corridors by their routes: those in use, and those that were asked for last. Any number of threads may ask.
class BuiltCorridors {
 public:
  using Shared = std::shared_ptr<RoadCorridor const>;

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
    std::lock_guard const lock(mutex_);
    Shared const kept = roads_.try_emplace(road->route, Entry{road, ++asked_}).first->second.road;
    if (roads_.size() > most_) forget_oldest();
    return kept;
  }

 private:
  struct Entry {
    Shared road;
    std::uint64_t asked;  ///< when it was asked for last
  };

  static constexpr std::size_t unused_kept = 16;

  /// Forgets those not in use but for the ones that were asked for last.
  void forget_oldest() {
    std::vector<std::uint64_t> unused;
    for (auto const& [route, entry] : roads_)
      if (entry.road.use_count() == 1) unused.push_back(entry.asked);
    if (unused.size() > unused_kept) {
      auto const oldest_kept = unused.end() - unused_kept;
      std::nth_element(unused.begin(), oldest_kept, unused.end());
      std::erase_if(roads_, [since = *oldest_kept](auto const& road) {
        return road.second.road.use_count() == 1 && road.second.asked < since;
      });
    }
    most_ = roads_.size() + unused_kept;
  }

  std::mutex mutex_;
  std::map<std::vector<LaneId>, Entry> roads_;
  std::uint64_t asked_ = 0;
  std::size_t most_ = 2 * unused_kept;  ///< with more it is time to forget some
};

}  // namespace cambium::map::detail
