#include "cambium/map/road/road.hpp"

#include <cmath>

#include <doctest/doctest.h>

#include "cambium/geometry/angle.hpp"

namespace {

namespace cb = cambium;
using cb::map::Road;

constexpr auto none = cb::none<cb::LaneId>;

double angle_between(double a, double b) { return std::abs(cb::geometry::angle_difference(a, b)); }

/// The largest differences between what `lane_point` says and numerical derivatives of its positions.
struct Derivatives {
  double heading = 0.0, curvature = 0.0;
};

Derivatives compare_with_differences(Road const& road, double s, int number, double h) {
  auto const at = [&](double station) { return lane_point(road, station, number)->center; };
  auto const before = at(s - h), here = at(s), after = at(s + h);
  double const dx = (after.x - before.x) / (2 * h), dy = (after.y - before.y) / (2 * h);
  double const speed = std::hypot(dx, dy);
  double const turn = std::remainder(after.heading - before.heading, 2 * cb::geometry::pi);
  return {angle_between(std::atan2(dy, dx), here.heading), std::abs(turn / (2 * h * speed) - here.curvature)};
}

}  // namespace

TEST_CASE("a lane's heading and curvature are the derivatives of its centre line") {
  // A clothoid with a lane that swells by a cubic: slope, its change, and the change of curvature all count.
  Road road;
  road.length = 60.0;
  road.reference_line =
      cb::map::ReferenceLine({{0.0, 3.0, -2.0, 0.4, 60.0, cb::map::GeometryKind::spiral, -0.03, 0.05}});
  road.lane_offset = cb::map::CubicProfile({{0.0, 0.5, -0.02, 1e-3, 0.0}});
  road.sections = {{0.0,
                    60.0,
                    {{1, none, none, cb::map::CubicProfile({{0.0, 3.0, 0.05, -2e-3, 3e-5}}), {}, {}},
                     {-1, none, none, cb::map::CubicProfile({{0.0, 2.0, 0.0, 4e-3, -4e-5}}), {}, {}},
                     {-2, none, none, cb::map::CubicProfile({{0.0, 4.0, -0.1, 0.0, 0.0}}), {}, {}}}}};
  for (int const number : {1, -1, -2})
    for (double s = 1.0; s < 59.0; s += 3.7) {
      auto const d = compare_with_differences(road, s, number, 1e-4);
      CAPTURE(number);
      CAPTURE(s);
      CHECK(d.heading < 1e-7);
      CHECK(d.curvature < 1e-7);
    }
}

TEST_CASE("there is no lane 0, none outside of the road, and none that the section does not have") {
  Road road;
  road.length = 10.0;
  road.reference_line = cb::map::ReferenceLine({{0.0, 0.0, 0.0, 0.0, 10.0}});
  cb::map::CubicProfile const three({{0.0, 3.0, 0.0, 0.0, 0.0}}), four({{0.0, 4.0, 0.0, 0.0, 0.0}});
  road.sections = {{2.0, 5.0, {{-1, none, none, three, {}, {}}}}, {5.0, 10.0, {{-1, none, none, four, {}, {}}}}};
  CHECK_FALSE(lane_point(road, 3.0, 0));
  CHECK_FALSE(lane_point(road, 3.0, 1));
  CHECK_FALSE(lane_point(road, 3.0, -2));
  CHECK_FALSE(lane_point(road, 1.0, -1));
  CHECK_FALSE(lane_point(road, -1e-9, -1));
  CHECK_FALSE(lane_point(road, 10.1, -1));
  CHECK_FALSE(lane_point(road, std::nan(""), -1));
  CHECK(lane_point(road, 4.999, -1)->width == 3.0);
  CHECK(lane_point(road, 5.0, -1)->width == 4.0);
  CHECK(lane_point(road, 10.0005, -1)->center.x == 10.0);
}
