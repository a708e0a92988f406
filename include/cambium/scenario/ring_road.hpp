#pragma once

#include <cmath>
#include <memory>

#include "cambium/geometry/pose.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/routing/route.hpp"

namespace cambium {

/// A closed lane, as a circle driven counter-clockwise, with a route that goes round it for some laps: what traffic is
/// studied on that has neither beginning nor end.
struct RingRoad {
  std::shared_ptr<Map const> map;
  map::Route route;
  double length{};  ///< once round, along the middle of the lane [m]

  /// The middle of the lane, `s` [m] from its start; beyond the first lap too.
  [[nodiscard]] geometry::Pose pose(double s) const {
    auto const& first = map->lane(route.lanes[0]);
    s -= length * std::floor(s / length);
    if (s < first.length()) return first.path.pose(s);
    return map->lane(route.lanes[1]).path.pose(s - first.length());
  }
};

/// A ring of `length` [m] whose route is `laps` times round it. Throws `MapError` for a ring of less than 100 m or more
/// than 100 km, or for no lap or more than 1000. O(laps).
[[nodiscard]] RingRoad make_ring_road(double length, int laps);

}  // namespace cambium

#ifndef CAMBIUM_COMPILED
#include "cambium/scenario/ring_road_impl.hpp"
#endif
