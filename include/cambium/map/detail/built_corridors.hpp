#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/map/corridor.hpp"

namespace cambium::map::detail {

/// Road corridors by their routes: those in use, and others while they are few. Any number of threads may ask.
class BuiltCorridors {
 public:
  using Shared = std::shared_ptr<RoadCorridor const>;

  /// The one along `route`; null if there is none.
  [[nodiscard]] Shared find(std::vector<LaneId> const& route) const {
    std::lock_guard const lock(mutex_);
    auto const at = roads_.find(route);
    return at == roads_.end() ? nullptr : at->second;
  }

  /// Takes `road` in and returns it, or the one that somebody else has built along its route in the meantime.
  Shared add(Shared const& road) {
    std::lock_guard const lock(mutex_);
    Shared const kept = roads_.emplace(road->route, road).first->second;
    if (roads_.size() > most_) {
      std::erase_if(roads_, [](auto const& entry) { return entry.second.use_count() == 1; });
      most_ = std::max(unused, 2 * roads_.size());
    }
    return kept;
  }

 private:
  static constexpr std::size_t unused = 128;  // so many are kept at least before those that nobody uses are forgotten

  mutable std::mutex mutex_;
  std::map<std::vector<LaneId>, Shared> roads_;
  std::size_t most_ = unused;
};

}  // namespace cambium::map::detail
