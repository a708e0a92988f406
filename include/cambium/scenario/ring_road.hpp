#pragma once

#include <cmath>
#include <memory>

#include "cambium/core/error.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/map/map_builder.hpp"
#include "cambium/map/route.hpp"

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
[[nodiscard]] inline RingRoad make_ring_road(double length, int laps) {
  if (!(length >= 100.0 && length <= 1e5)) throw MapError("ring", "its length is not a number from 100 to 100 000 m");
  if (!(laps >= 1 && laps <= 1000)) throw MapError("ring", "its laps are not a number from 1 to 1000");
  constexpr double lane_width = 3.5;
  double const radius = length / (2 * geometry::pi) - lane_width / 2;  // of the line left of the lane
  double const curvature = 1.0 / radius, half = geometry::pi * radius;
  map::MapBuilder builder("ring");
  map::RoadEnd const end_1{"1", map::opendrive::ContactPoint::end}, start_1{"1", map::opendrive::ContactPoint::start},
      end_2{"2", map::opendrive::ContactPoint::end}, start_2{"2", map::opendrive::ContactPoint::start};
  auto const add_half = [&](char const* id, geometry::Pose const& from) {
    builder.add_road({.id = id,
                      .line = map::lay_from(from, {{half, curvature, curvature}}),
                      .sections = {{.right = map::equal_lanes(1, lane_width)}}});
  };
  add_half("1", {});
  add_half("2", builder.end_pose(end_1));
  builder.connect(end_1, start_2);
  builder.connect(end_2, start_1);
  RingRoad ring{builder.build(), {}, 0.0};
  auto const lane_1 = ring.map->find_lane("1", 0.0, -1), lane_2 = ring.map->find_lane("2", 0.0, -1);
  ring.length = ring.map->lane(lane_1).length() + ring.map->lane(lane_2).length();
  for (int i = 0; i < laps; ++i) ring.route.lanes.insert(ring.route.lanes.end(), {lane_1, lane_2});
  ring.route.length = laps * ring.length;
  return ring;
}

}  // namespace cambium
