#pragma once

#include <cmath>
#include <memory>

#include "cambium/geometry/pose.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/routing/route.hpp"

namespace cambium::inline v0_1 {

/// A circular one-lane road, driven counter-clockwise, with a route of several laps. It serves to study traffic without
/// boundary effects.
struct RingRoad {
  std::shared_ptr<Map const> map;
  map::Route route;
  double length{};  ///< of one lap along the middle of the lane [m]

  /// Pose on the middle of the lane, `s` [m] from its start; `s` may exceed a lap.
  [[nodiscard]] geometry::Pose pose(double s) const {
    auto const& first = map->lane(route.lanes[0]);
    s -= length * std::floor(s / length);
    if (s < first.length()) return first.path.pose(s);
    return map->lane(route.lanes[1]).path.pose(s - first.length());
  }
};

/// Makes a ring of `length` [m] with a route of `laps` laps. Throws `MapError` unless the length is between 100 m and
/// 100 km and there are 1 to 1000 laps. O(laps).
[[nodiscard]] RingRoad make_ring_road(double length, int laps);

}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/scenario/ring_road_impl.hpp"
#endif
