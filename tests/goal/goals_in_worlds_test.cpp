#include <doctest/doctest.h>

#include <limits>
#include <string>
#include <vector>

#include "../world/fixtures.hpp"
#include "cambium/core/error.hpp"
#include "cambium/evaluation/driving.hpp"

using namespace fixtures;

namespace {

cb::geometry::Polygon gate(double x) { return cb::geometry::Polygon({{x, -8}, {x + 20, -8}, {x + 20, 1}, {x, 1}}); }

Sim::AgentSpec driver(double x, cb::Goal goal, double speed = 10.0) {
  return {.position = {x, -1.75}, .speed = speed, .behavior = cb::ConstantAcceleration{}, .goal = std::move(goal)};
}

/// Moves an agent sideways, as a planner does.
void put(Sim& world, cb::AgentId id, double x, double y) {
  auto state = world.state(id);
  state.x = x;
  state.y = y;
  world.set_state(id, state);
}

}  // namespace

TEST_CASE("a sequence is reached once its parts have been passed in their order, and stays so") {
  Sim world(straight_road(2, 1000.0));
  cb::Goal const goal = cb::GoalSequence{{cb::ReachPolygon{gate(120)}, cb::ReachPolygon{gate(200)}}};
  auto const id = world.add(driver(100, goal));
  auto const backwards =
      world.add(driver(60, cb::GoalSequence{{cb::ReachPolygon{gate(200)}, cb::ReachPolygon{gate(120)}}}));
  std::vector<int> passed;
  for (int i = 0; i < 30; ++i) {
    CHECK(world.reached_goal(id) == (world.record(id).goals_passed == 2));
    passed.push_back(world.record(id).goals_passed);
    REQUIRE(world.step(0.5));
  }
  CHECK(passed.front() == 0);
  CHECK(passed[10] == 1);
  CHECK(world.reached_goal(id));
  CHECK(world.state(id).x > 240);  // beyond both by now
  CHECK_FALSE(world.reached_goal(backwards));
}

TEST_CASE("copies, frames and predictions each keep how far an agent has got in a sequence") {
  Sim world(straight_road(2, 1000.0));
  cb::Goal const goal = cb::GoalSequence{{cb::ReachPolygon{gate(105)}, cb::ReachPolygon{gate(200)}}};
  auto const id = world.add(driver(100, goal));
  auto const start = world.frame();
  for (int i = 0; i < 4; ++i) REQUIRE(world.step(0.5));
  CHECK(world.record(id).goals_passed == 1);
  Sim copy = world;
  for (int i = 0; i < 20; ++i) REQUIRE(copy.step(0.5));
  CHECK(copy.reached_goal(id));
  CHECK_FALSE(world.reached_goal(id));
  auto future = world.observe(id).predict(cb::predict_all_as<Sim::Behaviors>(cb::ConstantAcceleration{}));
  CHECK(future.record(id).goals_passed == 1);
  for (int i = 0; i < 20; ++i) REQUIRE(future.step(0.5));
  CHECK(future.reached_goal(id));
  copy.restore(start);
  CHECK(copy.record(id).goals_passed == 0);
}

TEST_CASE("parts of a sequence that are reached where the agent enters, or where it is put, count") {
  Sim world(straight_road(2, 1000.0));
  auto const id = world.add(driver(110, cb::GoalSequence{{cb::ReachPolygon{gate(100)}, cb::ReachPolygon{gate(300)}}}));
  CHECK(world.record(id).goals_passed == 1);
  put(world, id, 310, -1.75);
  CHECK(world.reached_goal(id));
}

TEST_CASE("a sequence that is too long, or within another goal, is refused") {
  Sim world(straight_road(2, 1000.0));
  cb::GoalSequence const two{{cb::ReachPolygon{gate(120)}, cb::ReachPolygon{gate(200)}}};
  CHECK_THROWS_AS(world.add(driver(100, cb::AllGoals{{two}})), cb::WorldError);
  CHECK_THROWS_AS(world.add(driver(100, cb::GoalSequence{{two}})), cb::WorldError);
  CHECK_THROWS_AS(world.add(driver(100, cb::GoalSequence{std::vector<cb::Goal>(256, cb::NoGoal{})})), cb::WorldError);
  CHECK(world.size() == 0);
}

TEST_CASE("a lane change to the left is reached in the left lane, near its middle; to the right likewise") {
  Sim world(straight_road(3, 1000.0));  // lanes at -1.75, -5.25, -8.75
  using Side = cb::ReachLaneBeside::Side;
  auto const left = world.add({.position = {100, -5.25}, .goal = cb::ReachLaneBeside{}});
  auto const right = world.add({.position = {200, -5.25}, .goal = cb::ReachLaneBeside{.side = Side::right}});
  auto const reach = [&](cb::AgentId id, double y) {
    put(world, id, world.state(id).x, y);
    return world.reached_goal(id);
  };
  for (auto const id : {left, right}) {
    CHECK(reach(id, -1.75) == (id == left));
    CHECK(reach(id, -2.2) == (id == left));
    CHECK_FALSE(reach(id, -2.4));
    CHECK_FALSE(reach(id, -5.25));
    CHECK(reach(id, -8.75) == (id == right));
  }
  auto const two = world.add({.position = {300, -1.75}, .goal = cb::ReachLaneBeside{.side = Side::right}});
  CHECK(reach(two, -5.25));
  CHECK_FALSE(reach(two, -8.75));  // two lanes on
}

TEST_CASE("the end of its lane is reached near the end of the road") {
  Sim world(straight_road(1, 300.0));
  auto const id = world.add(driver(250, cb::ReachLaneEnd{20.0}));
  CHECK_FALSE(world.reached_goal(id));
  for (int i = 0; i < 3; ++i) REQUIRE(world.step(1.0));
  CHECK(world.state(id).x == doctest::Approx(280));
  CHECK(world.reached_goal(id));
}

TEST_CASE("limits along the lane ask for the world's own offsets and speeds") {
  Sim world(straight_road(1, 300.0));
  auto const id = world.add(driver(50, cb::LaneLimits{.from = 60, .left = 0.3, .right = 0.3, .lowest_speed = 9}));
  CHECK_FALSE(world.reached_goal(id));
  REQUIRE(world.step(2.0));
  CHECK(world.reached_goal(id));
  put(world, id, 80, -1.4);
  CHECK_FALSE(world.reached_goal(id));
}

TEST_CASE("routes lead to the places that goals name, a sequence's by way of all of them") {
  auto const map = own_map("intersection_4way.xodr");
  Sim world(map);
  int ways = 0;
  // Some lane that leads into the junction, and where it can go on to.
  for (auto const& start : map->lanes()) {
    if (!start.drivable() || start.length() < 20.0) continue;
    auto const reached = map->reachable({start.id, 5.0}, 400.0);
    for (auto const& end : reached) {
      if (end.lane == start.id || !map->lane(end.lane).drivable()) continue;
      auto const route = map->shortest_route(start.id, end.lane);
      REQUIRE(route);
      auto const pose = start.path.pose(5.0);
      cb::LaneId const middle = route->lanes[route->lanes.size() / 2];
      auto const route_of = [&](cb::Goal const& goal) {
        auto const id = world.add({.position = pose.position(), .heading = pose.heading, .goal = goal});
        auto const lanes = world.roster().agents[world.slot_of(id)].road->route;
        world.remove(id);
        return lanes;
      };
      ++ways;
      cb::Goal const at_end = cb::ReachLane{end.lane};
      auto const lanes = route_of(at_end);
      CHECK(lanes.back() == end.lane);
      CHECK(route_of(cb::AllGoals{{cb::StateLimits{}, at_end}}) == lanes);
      CHECK(route_of(cb::AnyGoal{{at_end}}) == lanes);
      CHECK(route_of(cb::LaneLimits{.lane = end.lane, .left = 1.0}) == lanes);
      CHECK(route_of(cb::GoalSequence{{cb::ReachLane{middle}, cb::StateLimits{}, at_end}}) == lanes);
    }
    if (ways > 12) break;
  }
  CHECK(ways > 5);
}

TEST_CASE("a goal with a number that is none, or out of its range, is refused by name, also within another goal") {
  Sim world(straight_road(2, 1000.0));
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  auto const lane = world.map().find_lane("1", 300.0, -1);
  for (cb::Goal const& goal :
       {cb::Goal{cb::LaneLimits{.left = nan}}, cb::Goal{cb::StateLimits{.heading_to = nan}},
        cb::Goal{cb::ReachLaneEnd{-1.0}}, cb::Goal{cb::ReachLaneBeside{.tolerance = nan}},
        cb::Goal{cb::AllGoals{{cb::ReachLane{lane}, cb::LaneLimits{.lowest_speed = nan}}}},
        cb::Goal{cb::GoalSequence{{cb::ReachLane{lane}, cb::LaneLimits{.heading_error = -0.1}}}}}) {
    CAPTURE(goal.index());
    CHECK_THROWS_AS(world.add(driver(100, goal)), cb::ParameterError);
  }
  CHECK(world.size() == 0);
  CHECK_THROWS_WITH_AS(world.add(driver(100, cb::ReachLaneEnd{-1.0})),
                       doctest::Contains("agent 0: reach_lane_end.distance: is -1 m"), cb::ParameterError);
  CHECK_NOTHROW(world.add(driver(100, cb::LaneLimits{})));  // infinite limits are none
}

TEST_CASE("a goal that can never be reached is refused with the reason, also within another goal") {
  Sim world(straight_road(2, 1000.0));
  auto const lane = world.map().find_lane("1", 300.0, -1);
  auto const refuses = [&](cb::Goal const& goal, char const* what) {
    CAPTURE(what);
    CHECK_THROWS_WITH_AS(world.add(driver(100, goal)), doctest::Contains(what), cb::Error);
    CHECK_THROWS_WITH_AS(world.add(driver(100, cb::AnyGoal{{cb::ReachLane{lane}, goal}})), doctest::Contains(what),
                         cb::Error);
    CHECK_THROWS_WITH_AS(world.add(driver(100, goal)), doctest::Contains("agent 0"), cb::Error);
    auto routed = driver(100, goal);
    routed.route = cb::map::Route{.lanes = {lane}};
    CHECK_THROWS_WITH_AS(world.add(routed), doctest::Contains(what), cb::Error);
  };
  refuses(cb::StateLimits{.lowest_speed = 20, .highest_speed = 10}, "lowest_speed is above highest_speed");
  refuses(cb::LaneLimits{.lowest_speed = 20, .highest_speed = 10}, "lowest_speed is above highest_speed");
  refuses(cb::LaneLimits{.from = 50, .to = 20}, "ends before it begins");
  refuses(cb::LaneLimits{.lane = lane, .from = 50, .to = 20}, "ends before it begins");
  refuses(cb::LaneLimits{.left = -1.0, .right = 0.5}, "left and right leave no room");
  refuses(cb::ReachLane{lane, 50, 20}, "ends before it begins");
  refuses(cb::StateLimits{.heading_from = 0, .heading_to = -7}, "more than a turn below heading_from");
  refuses(cb::ReachLane{lane, 5000, 6000}, "which is 1000 m long");
  refuses(cb::ReachLane{lane, -10, -5}, "which is 1000 m long");
  refuses(cb::LaneLimits{.lane = lane, .from = 5000}, "which is 1000 m long");
  refuses(cb::ReachLane{cb::LaneId{99}}, "which the map does not have");
  refuses(cb::AllGoals{}, "no parts");
  refuses(cb::AnyGoal{}, "no parts");
  CHECK_THROWS_WITH_AS(world.add(driver(100, cb::GoalSequence{})), doctest::Contains("no parts"), cb::WorldError);
  CHECK(world.size() == 0);
  CHECK_NOTHROW(world.add(driver(100, cb::StateLimits{.lowest_speed = 10, .highest_speed = 10})));
  CHECK_NOTHROW(world.add(driver(200, cb::LaneLimits{.from = 20, .to = 20, .left = -0.5, .right = 0.5})));
}

namespace {

/// Reached when driving at some speed beyond a place in one of a few lanes.
struct PassFast {
  std::vector<cb::LaneId> ends{};
  double speed = 12.0, x = 0.0;

  static constexpr char const* name = "pass_fast";
  static constexpr auto parameters() {
    return cb::parameter_list(cb::parameter("speed", &PassFast::speed, "m/s", cb::Range{0, 100}, "at least"),
                              cb::parameter("x", &PassFast::x, "m", cb::any_finite, "from here on"));
  }
  void check(std::string const& where) const {
    if (x > 1000.0) throw cb::ParameterError(where, "x is beyond the road", "give less");
  }
  std::vector<cb::LaneId> lanes(cb::Map const&) const { return ends; }
  bool at_goal(cb::GoalSituation const& at) const { return at.speed >= speed && at.pose.x >= x; }
};

/// The least that a user's own goal needs.
struct NeverAgain {
  bool at_goal(cb::GoalSituation const& at) const { return at.pose.x > 150.0; }
};

/// One that compares itself.
struct Beyond {
  double x = 0.0;
  bool at_goal(cb::GoalSituation const& at) const { return at.pose.x > x; }
  friend bool operator==(Beyond const&, Beyond const&) = default;
};

}  // namespace

TEST_CASE("a user's own goal is reached as its function says, alone and as a part of others") {
  Sim world(straight_road(2, 1000.0));
  auto const fast = world.add(driver(100, PassFast{.x = 130.0}, 15.0));
  auto const slow = world.add(driver(60, PassFast{.x = 70.0}, 10.0));
  auto const bare = world.add(driver(20, NeverAgain{}, 10.0));
  auto const both = world.add(driver(140, cb::AllGoals{{NeverAgain{}, cb::StateLimits{.lowest_speed = 5.0}}}));
  auto const first = world.add(driver(180, cb::GoalSequence{{PassFast{.speed = 5.0, .x = 190.0}, NeverAgain{}}}));
  for (auto const id : {fast, slow, bare, both, first}) CHECK_FALSE(world.reached_goal(id));
  auto copy = world;
  for (int i = 0; i < 6; ++i) REQUIRE(copy.step(0.5));
  CHECK(copy.reached_goal(fast));
  CHECK(cb::AtGoal{}(copy, copy.slot_of(fast)));
  CHECK_FALSE(cb::AtGoal{}(copy, copy.slot_of(slow)));
  CHECK_FALSE(copy.reached_goal(slow));
  CHECK_FALSE(copy.reached_goal(bare));
  CHECK(copy.reached_goal(both));
  CHECK(copy.reached_goal(first));
  CHECK(copy.record(first).goals_passed == 2);
  CHECK_FALSE(world.reached_goal(fast));
  auto future = world.observe(fast).predict(cb::predict_all_as<cb::BehaviorSet<cb::IdmClassic>>(cb::IdmClassic{}));
  for (int i = 0; i < 8; ++i) REQUIRE(future.step(0.5));
  CHECK(future.reached_goal(fast));
}

TEST_CASE("the route of an agent leads to the lanes that a user's own goal names") {
  Sim world(support::own_map("intersection_4way.xodr"));
  auto const& map = world.map();
  int routes = 0;
  for (auto const& lane : map.lanes()) {
    if (!lane.drivable() || !lane.predecessors.empty() || lane.successors.size() < 2) continue;
    auto const at = lane.path.pose(5.0);
    for (auto const inside : lane.successors) {
      auto const end = map.lane(inside).successors.front();
      auto const id = world.add({.position = at.position(), .heading = at.heading, .goal = PassFast{.ends = {end}}});
      CHECK(world.roster().agents[world.slot_of(id)].road->route.back() == end);
      world.remove(id);
      ++routes;
    }
  }
  CHECK(routes > 5);
  auto const anywhere = map.lanes().front().path.pose(1.0);
  CHECK_THROWS_WITH_AS(world.add({.position = anywhere.position(), .goal = PassFast{.ends = {cb::LaneId{9999}}}}),
                       doctest::Contains("which the map does not have"), cb::WorldError);
}

TEST_CASE("a user's own goal is checked by its description and its own check, compared, and given back") {
  Sim world(straight_road(2, 1000.0));
  CHECK_THROWS_WITH_AS(world.add(driver(100, PassFast{.speed = -1.0})), doctest::Contains("pass_fast.speed: is -1 m/s"),
                       cb::ParameterError);
  CHECK_THROWS_WITH_AS(world.add(driver(100, cb::AnyGoal{{PassFast{.x = 2000.0}}})),
                       doctest::Contains("x is beyond the road"), cb::ParameterError);
  CHECK(world.size() == 0);
  cb::OwnGoal const goal = PassFast{.x = 5.0}, same = PassFast{.x = 5.0}, other = PassFast{.x = 6.0},
                    bare = NeverAgain{};
  CHECK(goal == same);
  CHECK_FALSE(goal == other);
  CHECK_FALSE(goal == bare);
  CHECK(bare == cb::OwnGoal(NeverAgain{}));
  CHECK(cb::OwnGoal(Beyond{5.0}) == cb::OwnGoal(Beyond{5.0}));
  CHECK_FALSE(cb::OwnGoal(Beyond{5.0}) == cb::OwnGoal(Beyond{6.0}));
  REQUIRE(goal.get<PassFast>() != nullptr);
  CHECK(goal.get<PassFast>()->x == 5.0);
  CHECK(goal.get<NeverAgain>() == nullptr);
  cb::Goal from = goal;
  cb::Goal const to = std::move(from);
  CHECK(std::get<cb::OwnGoal>(to) == std::get<cb::OwnGoal>(from));  // what was moved from is still a goal
}
