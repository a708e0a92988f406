#include "cambium/behavior/road_rules.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "../world/fixtures.hpp"
#include "cambium/behavior/adaptive_cruise_control.hpp"
#include "cambium/behavior/idm_lane_tracking.hpp"
#include "cambium/behavior/idm_stochastic.hpp"

using namespace fixtures;

namespace {

using Set = cb::BehaviorSet<cb::IdmClassic, cb::AdaptiveCruiseControl, cb::IdmLaneTracking, cb::IdmStochastic>;
using World = cb::World<Set, cb::InterpolateExecution, cb::SingleTrack>;

cb::map::LaneCorridor with_limits() {
  cb::map::LaneCorridor corridor;
  corridor.speed_limits = {{0.0, 30.0}, {200.0, 10.0}, {400.0, 20.0}};
  return corridor;
}

/// How it goes on a straight road of 300 m: the end's place and speed.
template <class Behavior>
cb::AgentId enter(World& world, Behavior behavior, cb::RoadRules const& rules, double x = 100, double speed = 14) {
  behavior.rules = rules;
  return world.add({.position = {x, -1.75}, .speed = speed, .behavior = behavior});
}

}  // namespace

TEST_CASE_TEMPLATE("every car-following model stops before its lane's end where it is told to", Behavior,
                   cb::IdmClassic, cb::AdaptiveCruiseControl, cb::IdmLaneTracking, cb::IdmStochastic) {
  World world(straight_road(1, 300));
  auto const id = enter(world, Behavior{}, {.lane_end = cb::RoadRules::LaneEnd::always});
  for (int i = 0; i < 300; ++i) REQUIRE(world.step(0.2));
  CHECK(world.status(id) == cb::AgentStatus::driving);
  CHECK(world.state(id).speed < 0.05);
  double const front = world.state(id).x + 3.6;
  CHECK(front < 285.0);
  CHECK(front > 280.0);
  // Not where the end is its destination, unless BARK's way is asked for.
  World other(straight_road(1, 300));
  auto const through = enter(other, Behavior{}, {.lane_end = cb::RoadRules::LaneEnd::before_destination});
  for (int i = 0; i < 300; ++i) REQUIRE(other.step(0.2));
  CHECK(other.status(through) != cb::AgentStatus::driving);
}

TEST_CASE("of a leader and the lane's end that counts which asks for more braking") {
  World world(straight_road(1, 300));
  cb::RoadRules const rules{.lane_end = cb::RoadRules::LaneEnd::always};
  auto const ahead = enter(world, cb::IdmClassic{}, rules, 290, 0), id = enter(world, cb::IdmClassic{}, rules, 250, 10);
  cb::IdmLaw const law(cb::IdmParameters{}, 10.0);
  auto const strictest = [&](auto const& view) {
    cb::Strictest of_all(law);
    rules.heed(view, of_all);
    return of_all.constraint();
  };
  auto const view = world.observe(id);
  auto const leader = strictest(view);
  REQUIRE(view.ahead().has_value());
  CHECK(view.ahead()->agent == ahead);
  CHECK(leader.gap < view.ahead()->gap);
  CHECK(leader.gap == doctest::Approx(300 - 250 - 3.6 - 15));
  world.set_state(ahead, {.x = 265, .y = -1.75});
  auto const near = world.observe(id);
  CHECK(strictest(near).gap == near.ahead()->gap);
}

TEST_CASE("the permitted speed is the limit, and what lets it be lower in time") {
  auto const corridor = with_limits();
  CHECK(cb::permitted_speed(corridor, 10.0, 20.0, 2.0) == 30.0);
  CHECK(cb::permitted_speed(corridor, 150.0, 30.0, 2.0) == doctest::Approx(10.0));
  CHECK(cb::permitted_speed(corridor, 60.0, 30.0, 2.0) == doctest::Approx(std::sqrt(100.0 + 4.0 * 50.0)));
  CHECK(cb::permitted_speed(corridor, 250.0, 10.0, 2.0) == 10.0);
  CHECK(cb::permitted_speed(corridor, 401.0, 10.0, 2.0) == 20.0);
  CHECK(std::isinf(cb::permitted_speed(cb::map::LaneCorridor{}, 10.0, 20.0, 2.0)));
}

TEST_CASE("one who obeys speed limits keeps them, along a town's roads") {
  auto const map = corpus_map("Town04.xodr");
  if (!map) return;
  int limited = 0;
  for (std::size_t i = 0; i < map->lanes().size() && limited < 12; ++i) {
    auto const& lane = map->lanes()[i];
    if (!lane.drivable() || lane.length() < 60 || lane.speed_limits.empty()) continue;
    double const limit = cb::map::speed_limit_at(lane.speed_limits, 5.0);
    if (!std::isfinite(limit)) continue;
    World world(map);
    cb::IdmClassic driver{.desired_speed = 50.0};
    driver.rules.obey_speed_limits = true;
    auto const pose = lane.path.pose(5.0);
    auto const id =
        world.add({.position = pose.position(), .heading = pose.heading, .speed = 0.9 * limit, .behavior = driver});
    for (int k = 0; k < 100 && world.status(id) == cb::AgentStatus::driving; ++k) {
      auto const& record = world.record(id);
      auto const& corridor = world.roster().agents[0].road->corridors[record.lane.corridor];
      CHECK(record.state.speed <= corridor.speed_limit_at(record.lane.s) * 1.05 + 0.3);
      REQUIRE(world.step(0.2));
    }
    ++limited;
  }
  MESSAGE(limited << " lanes");
  CHECK(limited > 0);
}
