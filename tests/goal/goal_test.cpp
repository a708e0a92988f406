#include "cambium/goal/goal.hpp"

#include <doctest/doctest.h>

#include <vector>

namespace cb = cambium;

namespace {

cb::GoalSituation at(double x, double y, double heading = 0.0) {
  return {{x, y, heading}, cb::geometry::car(), static_cast<cb::LaneId>(3), x};
}

cb::Goal area(std::vector<cb::geometry::Point> const& points) {
  return cb::ReachPolygon{cb::geometry::Polygon(points)};
}

}  // namespace

TEST_CASE("without a goal nobody arrives") { CHECK_FALSE(cb::at_goal(cb::Goal{}, at(0, 0))); }

TEST_CASE("a polygon is reached with the whole vehicle, from its rear to its front end") {
  // The car reaches from 0.9 m behind its reference point to 3.6 m ahead of it, and 0.9 m to either side.
  auto const goal = area({{10, -2}, {20, -2}, {20, 2}, {10, 2}});
  CHECK_FALSE(cb::at_goal(goal, at(10.8, 0)));
  CHECK(cb::at_goal(goal, at(11.0, 0)));
  CHECK(cb::at_goal(goal, at(16.3, 0)));
  CHECK_FALSE(cb::at_goal(goal, at(16.5, 0)));
  CHECK(cb::at_goal(goal, at(13, 1.0)));
  CHECK_FALSE(cb::at_goal(goal, at(13, 1.2)));
  CHECK_FALSE(cb::at_goal(goal, at(13, 0, 1.5)));  // across
  CHECK_FALSE(cb::at_goal(goal, at(100, 0)));
}

TEST_CASE("a polygon with a notch is not reached by a vehicle over the notch") {
  auto const goal = area({{0, -5}, {20, -5}, {20, 5}, {11, 5}, {10, 0}, {9, 5}, {0, 5}});
  CHECK(cb::at_goal(goal, at(8, -3)));
  CHECK_FALSE(cb::at_goal(goal, at(8, 1)));  // all four corners are inside
}

TEST_CASE("a lane is reached with the reference point between two positions, both included") {
  cb::Goal const goal = cb::ReachLane{static_cast<cb::LaneId>(3), 10.0, 20.0};
  CHECK_FALSE(cb::at_goal(goal, at(9.99, 0)));
  CHECK(cb::at_goal(goal, at(10, 0)));
  CHECK(cb::at_goal(goal, at(20, 0)));
  CHECK_FALSE(cb::at_goal(goal, at(20.01, 0)));
  CHECK_FALSE(cb::at_goal(cb::ReachLane{static_cast<cb::LaneId>(4), 10.0, 20.0}, at(15, 0)));
}

TEST_CASE("a lane without positions is reached anywhere in it") {
  cb::Goal const goal = cb::ReachLane{static_cast<cb::LaneId>(3)};
  CHECK(cb::at_goal(goal, at(0, 0)));
  CHECK(cb::at_goal(goal, at(1e6, 0)));
}
