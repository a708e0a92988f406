#include "cambium/planner/policy/proposal_planner.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "cambium/execution/interpolate.hpp"
#include "cambium/map/building/road_plan.hpp"
#include "cambium/map/road/curve_layout.hpp"
#include "cambium/world/world.hpp"
#include "support/allocations.hpp"
#include "support/maps.hpp"

using namespace cambium;

namespace {

using PredictionWorld =
    World<BehaviorSet<IdmProposal, ConstantAcceleration, IdmClassic>, InterpolateExecution, SingleTrack>;
using Planner = ProposalPlanner<PredictionWorld>;
using Sim = World<BehaviorSet<Planner, IdmClassic, ConstantAcceleration>, InterpolateExecution, SingleTrack>;
static_assert(BehaviorModel<Planner>);

constexpr AgentId ego{0};

/// Two lanes with ego, agent 0, in the right one.
Sim two_lanes(std::uint64_t seed, double speed = 12.0, Planner const& planner = {}) {
  Sim world(support::straight_road(2, 600.0), {.seed = seed});
  world.add({.position = {40, -5.25}, .speed = speed, .behavior = planner});
  return world;
}

/// A rectangle in the right lane from `right` to `left`, relative to the lane's middle.
geometry::Polygon obstacle(double x, double right, double left) {
  return geometry::Polygon({{x, -5.25 + right}, {x + 4, -5.25 + right}, {x + 4, -5.25 + left}, {x, -5.25 + left}});
}

/// Steps the world for a while and checks that no agent fails and ego touches nothing.
void drive(Sim& world, int steps, double dt = 0.2) {
  for (int i = 0; i < steps; ++i) {
    auto const result = world.step(dt);
    CHECK(result.failed == 0);
    REQUIRE_FALSE(Collision{}(world, world.slot_of(ego)));
  }
}

}  // namespace

TEST_CASE("it follows a slower leader and stops behind a standing one") {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    CAPTURE(seed);
    double const slow = 2.0 * static_cast<double>(seed);
    Planner planner;
    planner.lane_changes = false;
    auto world = two_lanes(seed, 10.0 + static_cast<double>(seed), planner);
    world.add({.position = {100, -5.25}, .speed = slow, .behavior = ConstantAcceleration{}});
    drive(world, 150);
    CHECK(world.state(ego).speed == doctest::Approx(slow).epsilon(0.05).scale(1.0));
    CHECK(world.state(AgentId{1}).x - world.state(ego).x < 60.0);
    CHECK(std::abs(world.state(ego).y + 5.25) < 0.1);
  }
}

TEST_CASE("it brakes in time for a bend, whatever the score") {
  auto const map = support::map_of({.id = "1",
                                    .line = map::lay_from({}, {{150.0}, {30.0, 0.05, 0.05}, {150.0}}),
                                    .sections = {{.right = map::equal_lanes(1)}}});
  for (double const comfortable : {2.5, 50.0}) {
    Planner planner;
    planner.driver.driver.rules.lateral_acceleration = comfortable;
    planner.scoring.comfort = 0.0;
    Sim world(map);
    world.add({.position = {20, -1.75}, .speed = 14, .behavior = planner});
    double across = 0.0, hardest = 0.0;
    for (int i = 0; i < 120; ++i) {
      auto const before = world.state(ego);
      drive(world, 1);
      auto const& now = world.state(ego);
      across = std::max(across, std::abs(geometry::angle_difference(now.heading, before.heading)) / 0.2 * now.speed);
      hardest = std::max(hardest, (before.speed - now.speed) / 0.2);
    }
    CAPTURE(comfortable);
    CHECK((across < 3.0) == (comfortable == 2.5));
    CHECK(hardest < 3.0);
    CHECK(world.state(ego).y > 20.0);
  }
}

TEST_CASE("it stops once at a stop sign, and remembers that it did") {
  Planner planner;
  planner.driver.driver.rules.obey_signals = true;
  Sim world(support::road_with_signal("206"));
  world.add({.position = {100, -1.75}, .speed = 12, .behavior = planner});
  int stops = 0;
  for (int i = 0; i < 500 && world.state(ego).x < 300.0; ++i) {
    bool const stood = world.state(ego).speed < standing_speed;
    drive(world, 1, planner.step);
    stops += !stood && world.state(ego).speed < standing_speed;
  }
  CHECK(stops == 1);
  CHECK(world.state(ego).x >= 300.0);
}

TEST_CASE("in a roundabout it does not wait for those who wait for it") {
  Sim world(support::own_map("roundabout.xodr"));
  ReachLane const west{world.map().nearest_lane({-60.0, 2.0, 3.14})->lane};
  world.add({.position = {60.0, 1.75}, .heading = 3.14, .speed = 7.0, .behavior = Planner{}, .goal = west});
  world.add({.position = {-2.8, 35.0}, .heading = -1.57, .behavior = ConstantAcceleration{}});
  drive(world, 100);
  CHECK(world.state(ego).x < -10.0);
}

TEST_CASE("it stops at an object that blocks its lane and passes one that leaves room") {
  auto blocked = two_lanes(0);
  blocked.add_object(obstacle(120, -1.75, 1.75));
  drive(blocked, 150);
  CHECK(blocked.state(ego).speed < 0.05);
  CHECK(blocked.state(ego).x > 100.0);
  Planner planner;
  planner.offsets = {0.0, -0.8, 0.8};  // farther to the right it would leave the road
  for (double const side : {-1.0, 1.0}) {
    CAPTURE(side);
    auto world = two_lanes(0, 12.0, planner);
    world.add_object(side < 0.0 ? obstacle(140, -1.75, -0.6) : obstacle(140, 0.6, 1.75));
    double farthest = 0.0;
    for (int i = 0; i < 12; ++i) {
      drive(world, 10);
      farthest = std::max(farthest, -side * (world.state(ego).y + 5.25));
    }
    CHECK(world.state(ego).x > 200.0);
    CHECK(farthest > 0.3);
    CHECK(std::abs(world.state(ego).y + 5.25) < 0.2);  // and returns to the middle
  }
}

TEST_CASE("it passes a standing vehicle in the lane beside, and waits with room for a gap there") {
  for (double const spacing : {1e3, 24.0}) {
    CAPTURE(spacing);
    auto world = two_lanes(0);
    world.add({.position = {200, -5.25}, .speed = 0, .behavior = ConstantAcceleration{}});
    double const first = spacing < 100.0 ? 140.0 : -1e3;
    for (double x = first; x > 0.0; x -= spacing)
      world.add(
          {.position = {x, -1.75}, .speed = 15, .behavior = IdmClassic{.desired_speed = 15, .time_headway = 1.0}});
    double slowest = 1e9, closest = 1e9, hardest = 0.0;
    for (int i = 0; i < 250 && world.state(ego).x < 260.0; ++i) {
      drive(world, 1);
      slowest = std::min(slowest, world.state(ego).speed);
      for (auto const& agent : world.frame().agents) hardest = std::max(hardest, -agent.action.acceleration);
      if (world.state(ego).y < -4.25) closest = std::min(closest, 200.0 - world.state(ego).x);
    }
    CHECK(world.state(ego).x >= 260.0);
    CHECK(closest > 12.0);
    CHECK(hardest < 4.5);
    if (spacing > 100.0) CHECK(slowest > 9.0);
  }
}

TEST_CASE("it changes into the lane of its goal, for which nobody has to brake hard") {
  for (double const gap : {200.0, 60.0, 40.0}) {
    CAPTURE(gap);
    auto const map = support::straight_road(2, 600.0);
    Sim world(map);
    auto const left = map->find_lane("1", 500.0, -1);
    world.add({.position = {40, -5.25}, .speed = 12.0, .behavior = Planner{}, .goal = ReachLane{left, 500.0}});
    for (double x = 190.0; x > 0.0; x -= gap)
      world.add(
          {.position = {x, -1.75}, .speed = 15, .behavior = IdmClassic{.desired_speed = 16, .time_headway = 1.0}});
    double hardest = 0.0;
    for (int i = 0; i < 200 && !world.reached_goal(world.slot_of(ego)); ++i) {
      drive(world, 1);
      for (auto const& agent : world.frame().agents) hardest = std::max(hardest, -agent.action.acceleration);
    }
    CHECK(world.reached_goal(world.slot_of(ego)));
    CHECK(hardest < 4.5);
  }
}

TEST_CASE("it expects those who brake in its direction to go on, and the others to keep their speed") {
  for (bool const oncoming : {false, true}) {
    CAPTURE(oncoming);
    Sim world(support::two_way_road(600.0));
    world.add({.position = {40, -1.75}, .speed = 12, .behavior = Planner{}});
    auto const other = world.add({.position = {oncoming ? 400.0 : 140.0, oncoming ? 1.75 : -1.75},
                                  .heading = oncoming ? M_PI : 0.0,
                                  .speed = 12,
                                  .behavior = ConstantAcceleration{.acceleration = -3.0}});
    REQUIRE(world.step(0.2));
    Planner::Workspace workspace;
    auto const report = Planner{}.think(world.observe(ego), {}, workspace);
    auto const slot = static_cast<Slot>(std::ranges::find(report.agents, other) - report.agents.begin());
    CHECK(report.course.back().agents[slot].state.speed == doctest::Approx(oncoming ? 11.4 : 0.0));
  }
}

TEST_CASE("a braking that was measured from outside counts as one that was driven") {
  for (bool const is_set : {false, true}) {
    CAPTURE(is_set);
    Sim world(support::two_way_road(600.0));
    world.add({.position = {40, -1.75}, .speed = 12, .behavior = Planner{}});
    auto const other = world.add({.position = {140, -1.75},
                                  .speed = 12,
                                  .acceleration = is_set ? 0.0 : -3.0,
                                  .behavior = ConstantAcceleration{}});
    if (is_set) world.set_state(other, {.x = 140, .y = -1.75, .speed = 12}, Reroute::no, -3.0);
    CHECK(world.record(other).action.acceleration == -3.0);
    Planner::Workspace workspace;
    auto const report = Planner{}.think(world.observe(ego), {}, workspace);
    auto const slot = static_cast<Slot>(std::ranges::find(report.agents, other) - report.agents.begin());
    CHECK(report.course.back().agents[slot].state.speed == 0.0);
  }
}

TEST_CASE("a change under way is the first proposal, and goes on if nothing is better") {
  auto world = two_lanes(0);
  Planner::Workspace workspace;
  auto memory = Planner::Memory{};
  world.set_state(ego, {.x = 100, .y = -4.5, .heading = 0.08, .speed = 12.0});
  auto const at = world.record(ego).lane;
  memory.lane.change = {world.observe(ego).corridor().pieces[at.piece].left, 30.0f, 0.0f};
  auto const report = Planner{}.think(world.observe(ego), memory, workspace);
  CHECK(report.proposals[0].towards == memory.lane.change.target);
  CHECK(report.proposals[0].left);
  CHECK(report.proposals[0].changes);
  CHECK(report.best == 0);
}

TEST_CASE("a scored proposal reports its outcome, and the best is driven") {
  auto world = two_lanes(3);
  world.add({.position = {75, -5.25}, .speed = 4, .behavior = ConstantAcceleration{}});
  world.add_object(obstacle(90, -3.5, -1.0));
  Planner::Workspace workspace;
  auto const report = Planner{}.think(world.observe(ego), {}, workspace);
  REQUIRE(report.proposals.size() == 20);  // 5 speeds at 3 offsets, and into the left lane
  auto const& best = report.proposals[report.best];
  for (auto const& p : report.proposals) {
    CHECK(p.score <= best.score + Planner{}.scoring.indifference);
    CHECK((p.score == 0.0) == (p.collides || p.leaves_road));
    CHECK(std::isfinite(p.time_to_infraction) == (p.collides || p.leaves_road));
    CHECK(p.score <= 1.0);
  }
  CHECK(best.score > 0.0);
  CHECK(report.chosen == report.best);
  CHECK_FALSE(report.is_emergency(ego));
}

TEST_CASE("an offset towards a vehicle alongside is a collision at fault; a hit from behind is not") {
  auto world = two_lanes(0);
  world.add({.position = {41, -3.4}, .speed = 12, .behavior = ConstantAcceleration{}});
  Planner::Workspace workspace;
  for (auto const& p : Planner{}.think(world.observe(ego), {}, workspace).proposals)
    if (p.speed_share == 1.0) CHECK(p.collides == (p.offset > 0.0));
  auto pushed = two_lanes(0, 5.0);
  pushed.add({.position = {25, -5.25}, .speed = 20, .behavior = ConstantAcceleration{}});
  for (auto const& p : Planner{}.think(pushed.observe(ego), {}, workspace).proposals) CHECK_FALSE(p.collides);
}

TEST_CASE("whatever its indifference, it avoids a collision that it can avoid") {
  auto world = two_lanes(0);
  world.add({.position = {41, -3.4}, .speed = 12, .behavior = ConstantAcceleration{}});
  Planner planner;
  planner.scoring.indifference = 1.0;
  planner.offsets = {1.0, 0.0};  // towards the other vehicle first
  Planner::Workspace workspace;
  auto const report = planner.think(world.observe(ego), {}, workspace);
  CHECK(report.proposals[0].collides);
  CHECK_FALSE(report.proposals[report.best].collides);
  CHECK(report.proposals[report.best].offset == 0.0);
}

TEST_CASE("a proposal that leads off the road scores 0") {
  auto world = two_lanes(0);
  Planner planner;
  planner.offsets = {0.0, -2.0};
  Planner::Workspace workspace;
  for (auto const& p : planner.think(world.observe(ego), {}, workspace).proposals) {
    CHECK(p.leaves_road == (p.offset < 0.0));
    CHECK_FALSE(p.collides);
  }
}

TEST_CASE("a proposal that leads into an oncoming lane scores 0") {
  Sim world(support::two_way_road(600.0));
  world.add({.position = {40, -1.75}, .speed = 12, .behavior = IdmClassic{}});
  Planner planner;
  planner.offsets = {0.0, 3.5};
  Planner::Workspace workspace;
  for (auto const& p : planner.think(world.observe(ego), {}, workspace).proposals)
    if (p.speed_share == 1.0) CHECK((p.score == 0.0) == (p.offset > 0.0));
}

TEST_CASE("it brakes as hard as it may if all proposals soon collide") {
  auto world = two_lanes(0, 20.0);
  world.add_object(obstacle(65, -1.75, 5.25));
  Planner::Workspace workspace;
  auto const report = Planner{}.think(world.observe(ego), {}, workspace);
  CHECK_FALSE(report.chosen);
  CHECK(report.is_emergency(ego));
  CHECK(report.course.back().agents[0].state.speed == 0.0);
  for (auto const& frame : report.course) {  // it is where its state says
    auto const &now = frame.agents[0], &start = report.course[0].agents[0];
    CHECK(now.lane.s - start.lane.s == doctest::Approx(now.state.x - start.state.x));
    CHECK(now.action.acceleration <= 0.0);
  }
  REQUIRE(world.step(0.2));
  CHECK(world.record(ego).action.acceleration == doctest::Approx(-6.0));
  for (auto const& candidate : report.candidates) CHECK(candidate.refused == "collision");
}

TEST_CASE("an emergency stop is reported as it is driven") {
  auto world = two_lanes(0, 20.0);
  world.set_state(ego, {.x = 40, .y = -4.9, .heading = 0.02, .speed = 20.0});
  world.add_object(obstacle(65, -1.75, 5.25));
  Planner::Workspace workspace;
  auto const report = Planner{}.think(world.observe(ego), {}, workspace);
  REQUIRE_FALSE(report.chosen);
  REQUIRE(world.step(Planner{}.step));
  auto const planned = report.course[1].agents[0].state;
  CHECK(world.state(ego).x == doctest::Approx(planned.x));
  CHECK(world.state(ego).y == doctest::Approx(planned.y));
  CHECK(world.state(ego).heading == doctest::Approx(planned.heading));
  CHECK(world.memory<Planner>(ego) == report.memory);
}

TEST_CASE("faulty parameters are reported") {
  auto world = two_lanes(0);
  Planner planner;
  planner.offsets.clear();
  CHECK_THROWS_AS(world.add({.position = {300, -1.75}, .behavior = planner}), ParameterError);
  planner = {};
  planner.scoring.progress = std::nan("");
  Planner::Workspace workspace;
  CHECK_THROWS_AS((void)planner.think(world.observe(ego), {}, workspace), ParameterError);
}
