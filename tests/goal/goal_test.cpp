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

TEST_CASE("an agent without a goal never arrives") { CHECK_FALSE(cb::at_goal(cb::Goal{}, at(0, 0))); }

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

TEST_CASE("a lane is reached with the reference point between two positions, both included, or without any anywhere") {
  cb::Goal const goal = cb::ReachLane{static_cast<cb::LaneId>(3), 10.0, 20.0};
  CHECK_FALSE(cb::at_goal(goal, at(9.99, 0)));
  CHECK(cb::at_goal(goal, at(10, 0)));
  CHECK(cb::at_goal(goal, at(20, 0)));
  CHECK_FALSE(cb::at_goal(goal, at(20.01, 0)));
  CHECK_FALSE(cb::at_goal(cb::ReachLane{static_cast<cb::LaneId>(4), 10.0, 20.0}, at(15, 0)));
  for (double const x : {0.0, 1e6}) CHECK(cb::at_goal(cb::ReachLane{static_cast<cb::LaneId>(3)}, at(x, 0)));
}

TEST_CASE("limits of the heading wrap, and go counter-clockwise from the first to the second") {
  using cb::geometry::pi;
  auto const heads = [](double from, double to, double heading) {
    return cb::at_goal(cb::StateLimits{.heading_from = from, .heading_to = to}, at(0, 0, heading));
  };
  CHECK(heads(3.0, -3.0, pi));  // over the wrap
  CHECK(heads(3.0, -3.0, -pi));
  CHECK(heads(3.0, -3.0, 3 * pi));
  CHECK(heads(3.0, -3.0, 3.0));
  CHECK(heads(3.0, -3.0, -3.0));
  CHECK_FALSE(heads(3.0, -3.0, 0.0));
  CHECK_FALSE(heads(3.0, -3.0, 2.9));
  CHECK(heads(3.0, 2 * pi - 3.0, pi + 4 * pi));  // the same sector
  CHECK(heads(-0.1, 0.1, 2 * pi));
  CHECK_FALSE(heads(-0.1, 0.1, 2 * pi + 0.11));
  CHECK(heads(0.1, -0.1, 1.0));  // all but a slit
  CHECK_FALSE(heads(0.1, -0.1, 0.0));
  for (double h = -10; h < 10; h += 0.1) CHECK(cb::at_goal(cb::StateLimits{}, at(0, 0, h)));
  auto situation = at(0, 0);
  situation.speed = 10;
  CHECK(cb::at_goal(cb::StateLimits{.lowest_speed = 9, .highest_speed = 10}, situation));
  CHECK_FALSE(cb::at_goal(cb::StateLimits{.lowest_speed = 10.1}, situation));
  CHECK_FALSE(cb::at_goal(cb::StateLimits{.highest_speed = 9.9}, situation));
}

TEST_CASE("limits along a lane: offset to either side, angle and speed") {
  auto situation = at(15, 0);
  situation.lateral = 0.4;
  situation.heading_error = -0.2;
  situation.speed = 8;
  cb::LaneLimits const fits{.lane = static_cast<cb::LaneId>(3),
                            .from = 10,
                            .to = 20,
                            .left = 0.4,
                            .right = 0.1,
                            .heading_error = 0.2,
                            .lowest_speed = 8,
                            .highest_speed = 8};
  CHECK(cb::at_goal(fits, situation));
  auto const fails = [&](auto change) {
    auto goal = fits;
    change(goal);
    return !cb::at_goal(goal, situation);
  };
  CHECK(fails([](auto& g) { g.lane = static_cast<cb::LaneId>(4); }));
  CHECK_FALSE(fails([](auto& g) { g.lane = cb::none<cb::LaneId>; }));
  CHECK(fails([](auto& g) { g.to = 14; }));
  CHECK(fails([](auto& g) { g.from = 16; }));
  CHECK(fails([](auto& g) { g.left = 0.39; }));
  CHECK(fails([](auto& g) { g.right = -0.5; }));
  CHECK(fails([](auto& g) { g.heading_error = 0.19; }));
  CHECK(fails([](auto& g) { g.lowest_speed = 8.1; }));
  CHECK(fails([](auto& g) { g.highest_speed = 7.9; }));
}

TEST_CASE("all of several goals, or any of them, also within each other") {
  cb::Goal const here = cb::ReachLane{static_cast<cb::LaneId>(3)},
                 elsewhere = cb::ReachLane{static_cast<cb::LaneId>(4)};
  CHECK(cb::at_goal(cb::AllGoals{{here, here}}, at(0, 0)));
  CHECK_FALSE(cb::at_goal(cb::AllGoals{{here, elsewhere}}, at(0, 0)));
  CHECK_FALSE(cb::at_goal(cb::AllGoals{}, at(0, 0)));
  CHECK(cb::at_goal(cb::AnyGoal{{elsewhere, here}}, at(0, 0)));
  CHECK_FALSE(cb::at_goal(cb::AnyGoal{{elsewhere}}, at(0, 0)));
  CHECK(cb::at_goal(cb::AllGoals{{here, cb::AnyGoal{{elsewhere, here}}}}, at(0, 0)));
  cb::Goal copy = cb::AllGoals{{here}};
  cb::Goal const original = copy;
  std::get<cb::AllGoals>(copy).parts.push_back(elsewhere);  // a value: the original has its own parts
  CHECK(cb::at_goal(original, at(0, 0)));
  CHECK_FALSE(cb::at_goal(copy, at(0, 0)));
}

TEST_CASE("goals of different lanes are different parameters") {
  auto const differ = [](auto const& one, auto const& other) {
    return !cb::equal_parameters(one, other) && cb::hash_parameters(one) != cb::hash_parameters(other) &&
           cb::to_string(one) != cb::to_string(other);
  };
  CHECK(differ(cb::ReachLane{cb::LaneId{1}}, cb::ReachLane{cb::LaneId{2}}));
  CHECK(differ(cb::LaneLimits{cb::LaneId{1}}, cb::LaneLimits{}));
  CHECK(differ(cb::ReachLaneBeside{.from = cb::LaneId{1}}, cb::ReachLaneBeside{.from = cb::LaneId{2}}));
}
