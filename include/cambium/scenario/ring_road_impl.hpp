#pragma once

#include "cambium/core/error.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/map/building/map_builder.hpp"
#include "cambium/scenario/ring_road.hpp"

namespace cambium::inline v0_1 {

CAMBIUM_COLD RingRoad make_ring_road(double length, int laps) {
  if (!(length >= 100.0 && length <= 1e5))
    throw MapError("ring", "its length is not between 100 and 100 000 m", "choose a length in this range");
  if (!(laps >= 1 && laps <= 1000))
    throw MapError("ring", "its number of laps is not between 1 and 1000", "choose a number in this range");
  constexpr double lane_width = 3.5;
  double const radius = length / (2 * geometry::pi) - lane_width / 2;  // of the reference line, left of the lane
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

}  // namespace cambium::inline v0_1
