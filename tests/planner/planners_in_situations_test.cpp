// Laws of all planners where driving is harder: before a bend, behind a standing vehicle, at a merge, behind a slow
// leader.
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <variant>

#include "cambium/behavior/drivers.hpp"
#include "cambium/behavior/actions/driver_actions.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/map/building/road_plan.hpp"
#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/map/road/curve_layout.hpp"
#include "cambium/scenario/highway_site.hpp"
#include "cambium/scenario/junction_site.hpp"
#include "cambium/scenario/merging_site.hpp"
#include "planner/planner_fixtures.hpp"
#include "support/scale.hpp"
#include "support/who_yields.hpp"

using namespace planner_fixtures;

namespace {

using Actions = BasicMacroActions<Idm, Bends>;
using Predicted =
    World<BehaviorSet<Actions, ConstantAcceleration, HeadwayHypotheses<IdmClassic>>, InterpolateExecution, SingleTrack>;
using Search = Mcts<Predicted, Actions, TrafficReward, ConstantAcceleration>;
using Learner = Mcts<Predicted, Actions, TrafficReward, HeadwayHypotheses<IdmClassic>>;
using Tree = PolicyTreePlanner<Predicted, Actions>;
#define ALL_PLANNERS Search, Learner, Proposal, Tree, Frenet
// Those who expect the others to go on as they do. `HeadwayHypotheses<IdmClassic>` expects that a standing vehicle
// drives off.
#define STEADY_PLANNERS Search, Proposal, Tree, Frenet

using Sim = World<BehaviorSet<ALL_PLANNERS, IdmClassic, ConstantAcceleration>, InterpolateExecution, SingleTrack>;

constexpr double highest_lateral = 2.5;  // [m/s^2]

/// A planner with settings for quick tests that limits its lateral acceleration.
template <class Planner>
Planner quick() {
  Planner planner;
  if constexpr (requires { planner.options; }) {
    planner.options.budget.iterations = 100;
    planner.options.step = 0.4;
    planner.options.hold = 2;
    planner.options.search.horizon = 10;
    planner.reward.progress = 1.0;
    planner.belief.interval = planner.options.step;
  }
  if constexpr (requires { planner.limits; }) planner.limits.lateral_acceleration = highest_lateral;
  return planner;
}

/// What a run has shown of ego.
struct Drive {
  double way = 0.0;      ///< [m]
  double lateral = 0.0;  ///< highest lateral acceleration [m/s^2]
};

/// Steps `world` by the planner's own step, for `duration` [s] or until `agent` is at its goal, and checks what holds
/// everywhere: it causes no collision, stays on the road, drives the start of the course that it reports,
/// and, in the first of the runs, moves the same again from the same state.
template <class Planner>
Drive drive(std::uint64_t seed, Sim& world, AgentId agent, Planner const& planner, double duration) {
  double const dt = step_of(planner);
  auto again = world;
  Drive seen;
  for (int i = 0; i * dt < duration && world.status(agent) == AgentStatus::driving && !world.reached_goal(agent); ++i) {
    CAPTURE(world.time());
    auto const before = world.state(agent);
    typename Planner::Workspace workspace;
    std::optional<typename Planner::Report> report;
    if (i % 8 == 0) report = planner.think(world.observe(agent), world.template memory<Planner>(agent), workspace);
    REQUIRE(world.step(dt));
    auto const now = world.state(agent);
    auto const slot = world.slot_of(agent);
    if (report) {
      auto const at = std::ranges::find(report->agents, agent) - report->agents.begin();
      auto planned = report->course[1].agents[static_cast<Slot>(at)].state;
      planned.time = now.time;
      CHECK(now == planned);
      CHECK(world.template memory<Planner>(agent) == report->memory);
    }
    seen.way += 0.5 * (before.speed + now.speed) * dt;
    seen.lateral = std::max(seen.lateral, std::abs(LateralAcceleration::between(before, now)));
    REQUIRE_FALSE(AtFaultCollision{}(world, slot));
    REQUIRE_FALSE(OffRoad{}(world, slot));
  }
  if (seed == 0) {
    (void)drive<Planner>(1, again, agent, planner, duration);
    CHECK(world.frame() == again.frame());
  }
  return seen;
}

}  // namespace

TEST_CASE_TEMPLATE("it slows down for a bend and drives through it", Planner, ALL_PLANNERS) {
  for (std::uint64_t seed = 0; seed < support::runs(5); ++seed) {
    CAPTURE(seed);
    RandomStream random(seed, 1, 0);
    auto const planner = quick<Planner>();
    double const curvature = (seed % 2 == 0 ? 1.0 : -1.0) / Uniform{20.0, 60.0}(random);
    auto const line = map::lay_from(
        {}, {{150.0}, {20.0, 0.0, curvature}, {40.0, curvature, curvature}, {20.0, curvature, 0.0}, {200.0}});
    Sim world(support::map_of({.id = "1", .line = line, .sections = {{.right = map::equal_lanes(1)}}}), {.seed = seed});
    world.add({.position = {30.0, -1.75}, .speed = Uniform{8.0, 15.0}(random), .behavior = planner});
    auto const seen = drive<Planner>(seed, world, ego, planner, 40.0);
    CHECK(seen.lateral < 1.05 * highest_lateral);
    CHECK(seen.way > 220.0);
  }
}

TEST_CASE_TEMPLATE("it stops behind a standing vehicle, or passes it in another lane", Planner, STEADY_PLANNERS) {
  for (std::uint64_t seed = 0; seed < support::runs(5); ++seed) {
    CAPTURE(seed);
    RandomStream random(seed, 2, 0);
    int const lanes = seed % 2 == 0 ? 1 : 2;
    double const lane = lanes == 1 ? -1.75 : -5.25, at = Uniform{120.0, 160.0}(random);
    auto const planner = quick<Planner>();
    Sim world(support::straight_road(lanes, 600.0), {.seed = seed});
    world.add({.position = {30.0, lane}, .speed = Uniform{8.0, 15.0}(random), .behavior = planner});
    world.add({.position = {at, lane},
               .shape = seed % 3 == 0 ? geometry::truck() : geometry::car(),
               .behavior = ConstantAcceleration{0.0}});
    auto const seen = drive<Planner>(seed, world, ego, planner, 40.0);
    bool const passes = lanes == 2;
    CHECK(seen.way > (passes ? at : 0.8 * (at - 30.0)));
    if (!passes) CHECK(world.state(ego).speed < 0.5);
  }
}

TEST_CASE_TEMPLATE("it pulls out from close behind a parked vehicle", Planner, STEADY_PLANNERS) {
  for (std::uint64_t seed = 0; seed < support::runs(3); ++seed) {
    CAPTURE(seed);
    double const gap = 4.5 + 2.0 * static_cast<double>(seed), at = 30.0 + 3.6 + gap + 1.3;
    auto const planner = quick<Planner>();
    Sim world(support::straight_road(2, 600.0), {.seed = seed});
    world.add({.position = {30.0, -5.25}, .behavior = planner});
    world.add({.position = {at, -5.25}, .shape = geometry::van(), .behavior = ConstantAcceleration{0.0}});
    auto const seen = drive<Planner>(seed, world, ego, planner, 30.0);
    CHECK(seen.way > gap + 50.0);
  }
}

TEST_CASE_TEMPLATE("it merges into traffic and gets to its goal", Planner, ALL_PLANNERS) {
  MergingSite const sites[] = {find_merging_site(support::own_map("merging.xodr")),
                               find_merging_site(support::own_map("lane_drop.xodr"))};
  for (std::uint64_t seed = 0; seed < support::runs(4); ++seed) {
    CAPTURE(seed);
    auto const planner = quick<Planner>();
    auto scenario = with_behaviors<Sim>(sites[seed % 2].sample(30, static_cast<std::uint32_t>(seed / 2)),
                                        [](auto const& agent) { return std::get<IdmClassic>(agent.behavior); });
    for (auto& agent : scenario.agents)
      if (agent.id.given() == scenario.ego) agent.behavior = planner;
    auto world = scenario.make_world();
    (void)drive<Planner>(seed, world, scenario.ego, planner, 60.0);
    CHECK(world.reached_goal(scenario.ego));
  }
}

TEST_CASE_TEMPLATE("it passes a slower leader, or follows it", Planner, STEADY_PLANNERS) {
  // A search with few iterations finds the change of lanes in some of the runs.
  constexpr bool passes = std::is_same_v<Planner, Tree> || std::is_same_v<Planner, Frenet>;
  std::uint64_t passed = 0;
  for (std::uint64_t seed = 0; seed < support::runs(5); ++seed) {
    CAPTURE(seed);
    RandomStream random(seed, 3, 0);
    auto const planner = quick<Planner>();
    Sim world(support::straight_road(2, 900.0), {.seed = seed});
    double const slow = Uniform{3.0, 7.0}(random);
    auto const begin = Uniform{60.0, 80.0}(random), beside = Uniform{0.0, 20.0}(random);
    world.add({.position = {30.0, -5.25}, .speed = Uniform{8.0, 14.0}(random), .behavior = planner});
    world.add({.position = {begin, -5.25}, .speed = slow, .behavior = IdmClassic{.law = {.desired_speed = slow}}});
    world.add({.position = {beside, -1.75}, .speed = 13.0, .behavior = IdmClassic{.law = {.desired_speed = 13.0}}});
    (void)drive<Planner>(seed, world, ego, planner, 30.0);
    double const ahead = world.state(ego).x - world.state(AgentId{1}).x;
    CHECK(ahead > (passes ? 20.0 : -30.0));
    passed += ahead > 20.0;
  }
  CHECK(passed > 0);
}

namespace {

/// A search that, by default, may drive by the rules at junctions and expects the others to.
using RuledActions = DriverActions<UrbanDriver>;
using Ruled =
    World<BehaviorSet<RuledActions, UrbanDriver, HeadwayHypotheses<UrbanDriver>>, InterpolateExecution, SingleTrack>;
using RuledSearch = Mcts<Ruled>;
using RuledLearning = Mcts<Ruled, RuledActions, TrafficReward, HeadwayHypotheses<UrbanDriver>>;
using RuledTree = PolicyTreePlanner<Ruled>;

template <class Planner = RuledSearch>
Planner ruled_search() {
  Planner planner;
  planner.options.budget.iterations = 200;
  return planner;
}

/// Runs `wanted` of the scenarios `sample(number)` until the ego is at its goal, or without one at the end of its
/// route, and checks that it causes no collision. `make_ego(spec)` sets its behaviour; false: leaves that scenario out.
/// Returns how many egos arrived.
template <class Planner, class Driver, class Sample, class MakeEgo>
int arrivals(int wanted, Sample const& sample, MakeEgo const& make_ego) {
  int arrived = 0;
  for (std::uint32_t number = 0, run = 0; run < static_cast<std::uint32_t>(wanted); ++number) {
    CAPTURE(number);
    auto const drawn = sample(number);
    using Own = World<BehaviorSet<Planner, Driver>, InterpolateExecution, SingleTrack>;
    auto scenario =
        with_behaviors<Own>(drawn, [](auto const& spec) { return std::get<Driver>(spec.behavior.given()); });
    auto const planned = std::ranges::find(scenario.agents, scenario.ego, [](auto const& s) { return *s.id.given(); });
    if (!make_ego(*planned)) continue;
    ++run;
    auto world = scenario.make_world();
    auto const slot = world.slot_of(scenario.ego);
    bool const has_goal = !std::holds_alternative<NoGoal>(world.roster().goals[slot]);
    while (world.time() < 90.0 && world.status(scenario.ego) == AgentStatus::driving && !world.reached_goal(slot)) {
      REQUIRE(world.step(0.2));
      REQUIRE_FALSE(AtFaultCollision{}(world, slot));
    }
    bool const left =
        world.status(scenario.ego) == AgentStatus::arrived || world.status(scenario.ego) == AgentStatus::left_map;
    arrived += has_goal ? world.reached_goal(slot) : left;
  }
  return arrived;
}

}  // namespace

TEST_CASE_TEMPLATE("it gets through traffic to its exit", Planner, RuledSearch, Frenet) {
  auto const site = find_highway_site(support::own_map("highway_exit.xodr"));
  auto const count = static_cast<int>(support::runs(8));
  int const arrived = arrivals<Planner, Mobil>(
      count, [&](std::uint32_t number) { return site.sample(3, number); },
      [](auto& spec) {
        if (std::holds_alternative<NoGoal>(spec.goal.given())) return false;
        double const speed = std::get<Mobil>(spec.behavior.given()).law.desired_speed;
        if constexpr (std::is_same_v<Planner, Frenet>) {
          Planner planner;
          planner.desired_speed = speed;
          spec.behavior = planner;
        } else {
          auto planner = ruled_search();
          planner.reward.desired_speed = planner.actions.driver.law.desired_speed =
              planner.actions.macro.law.desired_speed = speed;
          spec.behavior = planner;
        }
        return true;
      });
  CHECK(arrived >= count - count / 8);
}

TEST_CASE_TEMPLATE("from a standstill shortly before its exit, it crosses the lanes that it needs", Planner, RuledTree,
                   Proposal, Frenet) {
  auto const map = support::own_map("highway_exit.xodr");
  auto const ramp = map->find_lane("2", 20.0, -1);
  for (double const s : {525.0, 545.0}) {
    CAPTURE(s);
    World<BehaviorSet<Planner>, InterpolateExecution, SingleTrack> world(map);
    auto const lane = map->find_lane("1", s, -2);
    auto const pose = map->lane(lane).path.pose(s - 390.0);
    world.add({.position = pose.position(),
               .heading = pose.heading,
               .behavior = Planner{},
               .goal = ReachLane{.lane = ramp, .from = 20.0}});
    while (world.time() < 40.0 && !world.reached_goal(ego)) {
      REQUIRE(world.step(0.2));
      REQUIRE_FALSE(OffRoad{}(world, Slot{}));
    }
    CHECK(world.time() < 40.0);
  }
}

TEST_CASE_TEMPLATE(
    "a planner that may drive by the rules of junctions gets through them, without a collision of its own", Planner,
    RuledSearch, RuledLearning, RuledTree) {
  for (auto const* const name : {"intersection_4way.xodr", "roundabout.xodr"})
    for (bool const lights : {false, true}) {
      CAPTURE(name);
      CAPTURE(lights);
      auto const site = find_junction_site(support::own_map(name));
      if (lights && site.map->lights().empty()) continue;
      auto const count = static_cast<int>(support::runs(4));
      int const arrived = arrivals<Planner, UrbanDriver>(
          count, [&](std::uint32_t number) { return site.sample(3, number, {.lights = lights}); },
          [](auto& spec) {
            Planner planner;
            if constexpr (requires { planner.reward; }) {
              planner = ruled_search<Planner>();
              planner.reward.desired_speed = 10.0;
            }
            planner.actions.driver.law.desired_speed = planner.actions.macro.law.desired_speed = 10.0;
            spec.behavior = planner;
            return true;
          });
      CHECK(arrived == count);
    }
}

TEST_CASE("a policy tree stops at a red light, and may drive by the rules") {
  auto const map = support::own_map("intersection_4way.xodr");
  World<BehaviorSet<RuledTree>, InterpolateExecution, SingleTrack> world(map);
  for (auto const& light : map->lights())
    world.set_light(light.id, {.cycle = 100.0, .green_begin = 60.0, .green_end = 70.0});
  auto const lane = map->find_lane("1", 50.0, -2);
  auto const pose = map->lane(lane).path.pose(map->lane(lane).length() - 60.0);
  world.add({.position = pose.position(), .heading = pose.heading, .speed = 10.0, .behavior = RuledTree{}});
  auto const report = report_of(RuledTree{}, world, world.memory<RuledTree>(ego));
  CHECK(report.candidates.front().name == "drive");
  for (int i = 0; i < 100; ++i) REQUIRE(world.step(0.2));
  CHECK(world.state(ego).speed < 0.1);
  double const way = std::hypot(world.state(ego).x - pose.x, world.state(ego).y - pose.y);
  CHECK(way > 45.0);
  CHECK(way < 60.0);
}

namespace {

/// Ego comes to a junction, 12 m before its way crosses that of agent 1, who goes first and is 30 m away.
template <class Planner>
auto before_crossing() {
  support::WhoYields const at;
  World<BehaviorSet<Planner, UrbanDriver>, InterpolateExecution, SingleTrack> world(at.map);
  auto const add = [&](std::pair<LaneId, double> const& place, map::Route const& route, double speed,
                       auto const& behavior) {
    auto const pose = at.map->lane(place.first).path.pose(place.second);
    world.add(
        {.position = pose.position(), .heading = pose.heading, .speed = speed, .behavior = behavior, .route = route});
  };
  add(at.own_place(12.0), at.own, 6.0, Planner{});
  add(at.other_place(30.0), at.other, 10.0, UrbanDriver{.law = {.desired_speed = 10.0}});
  return world;
}

}  // namespace

TEST_CASE_TEMPLATE("whoever goes first is expected to drive on whatever ego does, if others insist", Planner,
                   RuledSearch, RuledTree) {
  auto world = before_crossing<Planner>();
  auto const slowest = [&](bool insist) {  // of agent 1, whatever ego does
    Planner planner{.others_insist = insist};
    typename Planner::Workspace workspace;
    auto const report = planner.think(world.observe(ego), {}, workspace);
    auto const slot = workspace.predicted().slot_of(AgentId{1});
    double lowest = 1e9;
    for (std::size_t number = 0; number < report.candidates.size(); ++number)
      for (auto const& frame : planner.foresee(world.observe(ego), {}, workspace, number))
        if (frame.time < 3.0) lowest = std::min(lowest, frame.agents[slot].state.speed);
    return lowest;
  };
  CHECK(slowest(true) > 9.0);
  CHECK(slowest(false) < 8.0);
}

TEST_CASE_TEMPLATE("the ways in which it thinks that others may go on have probabilities, and one time", Planner,
                   RuledLearning, RuledTree) {
  Planner planner;
  World<BehaviorSet<Planner, UrbanDriver>, InterpolateExecution, SingleTrack> world(support::straight_road(2, 900.0));
  world.add({.position = {80, -5.25}, .speed = 14.0, .behavior = planner});
  for (int i = 0; i < 4; ++i) world.add({.position = {60.0 + 20.0 * i, -1.75}, .speed = 12.0});
  world.add({.position = {100, -5.25}, .speed = 12.0});
  auto const far = world.add({.position = {500, -5.25}, .speed = 12.0});
  typename Planner::Workspace workspace;
  (void)planner.think(world.observe(ego), {}, workspace);
  std::map<AgentId, double> sums;
  for (auto const& way : planner.alternatives(world.observe(ego), {}, workspace, 3.0)) {
    CHECK(way.probability >= 0.0);
    CHECK(way.after.time == doctest::Approx(world.time() + 3.0));
    CHECK(way.after.x > world.state(way.agent).x);
    sums[way.agent] += way.probability;
  }
  CHECK(sums.size() > 1);
  for (auto const& [agent, sum] : sums) {
    CHECK(sum == doctest::Approx(1.0));
    CHECK(agent != far);
    CHECK(agent != ego);
  }
}

TEST_CASE("whoever drives on a through lane is expected to open no gap, unless it brakes or goodwill is expected") {
  using Predicting = World<BehaviorSet<UrbanDriver, ConstantAcceleration>, InterpolateExecution, SingleTrack>;
  auto const site = find_merging_site(support::own_map("merging.xodr"));
  auto const& through =
      *std::ranges::find_if(site.entrances, [](auto const& e) { return e.merges() && !e.gives_up_lane; });
  auto const acceleration = [&](bool insists, double before) {
    Predicting world(site.map);
    auto const add = [&](MergingSite::Entrance const& from, double way, Predicting::Behavior const& behavior) {
      auto const road = map::build_road_corridor(*site.map, from.route);
      auto const pose = road->corridors[road->main].center.pose(from.merge_at - way);
      return world.add({.position = pose.position(),
                        .heading = pose.heading,
                        .speed = 12.0,
                        .behavior = behavior,
                        .route = from.route});
    };
    auto const other = add(through, 60.0, UrbanDriver{}),
               own = add(site.entrances[site.ramp], 36.0, ConstantAcceleration{});
    world.set_state(other, world.state(other), Reroute::no, before);
    detail::expect(world, *world.roster().slot_of(own), UrbanDriver{}, {.keeps_speed = false, .insists = insists});
    for (int i = 0; i < 5; ++i) REQUIRE(world.step(0.2));
    return world.record(other).action.acceleration;
  };
  double const polite = acceleration(false, 0.0);
  CHECK(acceleration(true, 0.0) > polite + 0.3);
  CHECK(acceleration(true, -2.0) == doctest::Approx(acceleration(false, -2.0)));
}
