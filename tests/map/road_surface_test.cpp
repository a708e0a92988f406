#include "cambium/map/road/road_surface.hpp"

#include <cmath>

#include <doctest/doctest.h>

namespace {

namespace cb = cambium;
using cb::map::CubicProfile;
using cb::map::Road;
using Eigen::Vector3d;

/// A straight road along x, 100 m long, with a lane of 4 m on each side.
Road straight_road() {
  Road road;
  road.length = 100.0;
  road.reference_line = cb::map::ReferenceLine({{0.0, 0.0, 0.0, 0.0, 100.0}});
  CubicProfile const wide({{0.0, 4.0, 0.0, 0.0, 0.0}});
  auto const none = cb::none<cb::LaneId>;
  road.sections = {{0.0, 100.0, {{1, none, none, wide, {}, {}}, {-1, none, none, wide, {}, {}}}}};
  return road;
}

CubicProfile constant(double value) { return CubicProfile({{0.0, value, 0.0, 0.0, 0.0}}); }

void check_near(Vector3d const& a, Vector3d const& b) { CHECK((a - b).norm() < 1e-12); }

}  // namespace

TEST_CASE("superelevation lifts the left side about the reference line") {
  Road road = straight_road();
  road.superelevation = constant(0.1);
  auto const left = surface_at(road, 20.0, 3.0), right = surface_at(road, 20.0, -3.0);
  check_near(left.position, {20.0, 3.0 * std::cos(0.1), 3.0 * std::sin(0.1)});
  check_near(right.position, {20.0, -3.0 * std::cos(0.1), -3.0 * std::sin(0.1)});
  check_near(left.axes.col(2), {0.0, -std::sin(0.1), std::cos(0.1)});
}

TEST_CASE("a road uphill points upwards, and the map's offset lifts all of it") {
  Road road = straight_road();
  road.elevation = CubicProfile({{10.0, 1.0, 0.1, 0.0, 0.0}});
  road.elevation_offset = 100.0;
  auto const p = surface_at(road, 30.0, 2.0);
  check_near(p.position, {30.0, 2.0, 103.0});
  check_near(p.axes.col(0), Vector3d(1.0, 0.0, 0.1).normalized());
  check_near(surface_at(road, 5.0, 0.0).position, {5.0, 0.0, 100.0});
}

TEST_CASE("crossfall lets each side fall outwards") {
  Road road = straight_road();
  road.crossfall_left = constant(0.02);
  road.crossfall_right = constant(0.05);
  check_near(surface_at(road, 1.0, 2.0).position, {1.0, 2.0, -2.0 * std::tan(0.02)});
  check_near(surface_at(road, 1.0, -2.0).position, {1.0, -2.0, -2.0 * std::tan(0.05)});
  CHECK(surface_at(road, 1.0, -2.0).axes(1, 2) < 0.0);  // the surface leans to the right there
  CHECK(surface_at(road, 1.0, 2.0).axes(1, 2) > 0.0);
}

TEST_CASE("between two shapes the height runs linearly along the road") {
  Road road = straight_road();
  road.shape = {{10.0, CubicProfile({{-4.0, 0.4, -0.1, 0.0, 0.0}, {0.0, 0.0, 0.1, 0.0, 0.0}})},
                {30.0, CubicProfile({{-4.0, 0.0, 0.0, 0.0, 0.0}})}};
  CHECK(surface_at(road, 5.0, 2.0).position.z() == 0.0);
  CHECK(surface_at(road, 10.0, 2.0).position.z() == doctest::Approx(0.2));
  CHECK(surface_at(road, 10.0, -2.0).position.z() == doctest::Approx(0.2));
  CHECK(surface_at(road, 20.0, 2.0).position.z() == doctest::Approx(0.1));
  CHECK(surface_at(road, 90.0, 2.0).position.z() == 0.0);
}

TEST_CASE("a lane's height counts across that lane only") {
  Road road = straight_road();
  road.sections[0].lanes[1].heights = {{20.0, 0.1, 0.3}, {50.0, 0.5, 0.5}};
  CHECK(surface_at(road, 10.0, -2.0).position.z() == 0.0);
  CHECK(surface_at(road, 30.0, -1.0).position.z() == doctest::Approx(0.15));
  CHECK(surface_at(road, 30.0, 1.0).position.z() == 0.0);
  CHECK(surface_at(road, 60.0, -3.9).position.z() == doctest::Approx(0.5));
}
