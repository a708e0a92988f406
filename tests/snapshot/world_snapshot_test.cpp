// Worlds that were saved and restored in every step go on as those that were not: all shipped models and planners.
#include "cambium/snapshot.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "cambium/cambium.hpp"
#include "cambium/planner.hpp"
#include "support/maps.hpp"

using namespace cambium;

namespace {

constexpr std::array formats{SnapshotFormat::binary, SnapshotFormat::text, SnapshotFormat::xml};

/// The world after a way through a snapshot, on a map that was read anew.
template <class World>
World thawed(World const& world, std::shared_ptr<Map const> const& map, SnapshotFormat format) {
  World other(map);
  from_snapshot(to_snapshot({.format = format}, world), "thawed", other);
  CHECK(snapshot_hash(other) == snapshot_hash(world));
  return other;
}

/// Steps `world` and a twin that is saved and restored before each step, and compares them bit by bit.
template <class World>
void compare(World world, std::shared_ptr<Map const> const& other_map, int steps, double dt, int first_format) {
  World twin = world;
  for (int i = 0; i < steps; ++i) {
    CAPTURE(i);
    twin = thawed(twin, other_map, formats[static_cast<std::size_t>(first_format + i) % formats.size()]);
    auto const a = world.step(dt), b = twin.step(dt);
    CHECK(a.failed == b.failed);
    REQUIRE(snapshot_hash(world) == snapshot_hash(twin));
    REQUIRE(world.frame() == twin.frame());
  }
  CHECK(world.roster().next_agent_id == twin.roster().next_agent_id);
}

using Everything =
    BehaviorSet<IdmClassic, AdaptiveCruiseControl, IdmLaneTracking, IdmStochastic, HumanDriver<IdmClassic>,
                HeadwayHypotheses<IdmClassic>, Intersection, Mobil, LaneChangeRuleBased, ZipMerge, MacroActions,
                RandomMacroActions, DriverActions<Intersection>, IdmProposal, MotionPrimitives, ExternalInput,
                ConstantAcceleration, Safety, RssConformant<IdmClassic>>;
using Sim = World<Everything, InterpolateExecution, SingleTrack>;

/// The alternative of that number, beginning anew after the last.
template <class Set, class... Models>
Set one_of(OneOf<Models...> const&, std::size_t number) {
  Set const all[] = {Models{}...};
  return all[number % sizeof...(Models)];
}
template <class Set>
Set one_of(std::size_t number) {
  return one_of<Set>(Set{}, number);
}

}  // namespace

TEST_CASE("traffic of all models goes on bit by bit after it was saved and restored, in each format") {
  auto const map = support::own_map("merging.xodr"), again = support::own_map("merging.xodr");
  for (std::uint32_t seed = 0; seed < 150; ++seed) {
    CAPTURE(seed);
    RandomStream random(seed, 0, 0);
    Sim world(map, {.seed = seed, .time = 0.37 * seed});
    for (std::size_t i = 0; i < 14; ++i) {
      double const x = 15.0 + 22.0 * static_cast<double>(i / 2) + Uniform{-4.0, 4.0}(random);
      auto behavior = one_of<Sim::Behavior>(seed + i);
      if (auto* const idm = std::get_if<IdmClassic>(&behavior)) idm->desired_speed = Uniform{5.0, 30.0}(random);
      world.add(
          {.position = {x, i % 2 == 0 ? -1.75 : -5.25}, .speed = Uniform{0.0, 15.0}(random), .behavior = behavior});
    }
    compare(world, again, 12, 0.2, static_cast<int>(seed));
  }
}

TEST_CASE("every execution, vehicle and observer model goes on bit by bit") {
  using Execution = ExecutionSet<InterpolateExecution, StanleyExecution, LqrExecution>;
  using Vehicles = DynamicSet<SingleTrack, KinematicPoint>;
  using Chain = ObserverChain<OccludedObserver, ParametricObserver, DelayedObserver<2>>;
  using Eyes = ObserverSet<PerfectObserver, ParametricObserver, OccludedObserver, DelayedObserver<3>, Chain>;
  using Models = World<BehaviorSet<IdmClassic, Mobil, Intersection>, Execution, Vehicles, Eyes>;
  auto const map = support::own_map("highway.xodr"), again = support::own_map("highway.xodr");
  for (std::uint32_t seed = 0; seed < 80; ++seed) {
    CAPTURE(seed);
    RandomStream random(seed, 0, 1);
    Models world(map, {.seed = seed});
    for (std::uint32_t i = 0; i < 9; ++i)
      world.add({.position = {20.0 + 25.0 * i, -5.25},
                 .speed = Uniform{5.0, 25.0}(random),
                 .behavior = one_of<Models::Behavior>(i + seed),
                 .execution = one_of<Execution>(i),
                 .dynamics = one_of<Vehicles>(i % 5),
                 .observer = one_of<Eyes>(i / 2)});
    compare(world, again, 10, 0.2, static_cast<int>(seed));
  }
  auto const goes_on = [&]<class Vehicle>(Vehicle const& vehicle) {
    using Own = World<BehaviorSet<IdmClassic>, StanleyExecution, Vehicle>;
    Own world(map, {.seed = 3});
    world.add({.position = {20, -5.25}, .speed = 10, .behavior = IdmClassic{}, .dynamics = vehicle});
    compare(world, again, 12, 0.1, 0);
  };
  goes_on(SingleTrackSteering{});
  goes_on(TripleIntegrator{});
}

TEST_CASE("a junction goes on with its lights, goals, objects, and people on ways of their own") {
  using Street = World<BehaviorSet<Intersection, Pedestrian, IdmClassic, StaticTrajectory>, InterpolateExecution,
                       DynamicSet<SingleTrack, KinematicPoint>>;
  auto const map = support::own_map("intersection_4way.xodr"), again = support::own_map("intersection_4way.xodr");
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    CAPTURE(seed);
    Street world(map, {.seed = seed});
    auto const shift = static_cast<double>(seed);
    for (auto const& light : map->lights())
      world.set_light(light.id, {.cycle = 20.0, .green_begin = shift, .green_end = shift + 8.0});
    auto const first = world.add({.position = {-40 - shift, -1.75}, .speed = 8, .behavior = Intersection{}});
    world.add({.position = {-60 - shift, -1.75},
               .speed = 8,
               .behavior = Intersection{},
               .goal = GoalSequence{{StateLimits{}, AnyGoal{{AllGoals{{StateLimits{}, NoGoal{}}}, NoGoal{}}}}}});
    world.add(
        {.position = {50, 1.75}, .heading = M_PI, .speed = 7, .shape = geometry::truck(), .behavior = IdmClassic{}});
    std::vector<State> recorded;
    for (int k = 0; k < 30; ++k)
      recorded.push_back({.time = 0.5 + 0.2 * k, .x = 1.75, .y = -50.0 + k, .heading = M_PI / 2, .speed = 5.0});
    world.add({.position = {1.75, -50}, .heading = M_PI / 2, .speed = 5, .behavior = StaticTrajectory(recorded)});
    auto const walker = [&](std::vector<geometry::Point> way) {
      world.add({.position = way.front(),
                 .speed = 1.0,
                 .shape = geometry::pedestrian(),
                 .behavior = Pedestrian{},
                 .way = std::move(way),
                 .dynamics = KinematicPoint{}});
    };
    walker({{-20, -8}, {-20, 8}});
    walker({{-20, -8}, {-20, 8}});
    walker({{22, 9}, {22, -9}, {30, -9}});
    auto const object = world.add_object(geometry::Polygon({{-30, -9}, {-28, -9}, {-28, -4}}));
    world.add_object(geometry::Polygon({{60, 1}, {62, 1}, {62, 3}, {60, 3}}));
    if (seed % 2 == 0) world.remove_object(object);
    if (seed % 3 == 0) world.remove(first);
    compare(world, again, 15, 0.2, static_cast<int>(seed));
    // Who enters after the thaw gets the ids, roads and neighbours that it would have got without.
    auto twin = thawed(world, again, SnapshotFormat::binary);
    for (auto* one : {&world, &twin}) {
      one->add({.position = {-20, -6},
                .speed = 1.0,
                .shape = geometry::pedestrian(),
                .behavior = Pedestrian{},
                .way = {{-20, -8}, {-20, 8}},
                .dynamics = KinematicPoint{}});
      one->add_object(geometry::Polygon({{-60, -9}, {-58, -9}, {-58, -4}}));
      CHECK(one->roster().free_roads.size() == 2);
      for (int i = 0; i < 5; ++i) REQUIRE(one->step(0.2));
    }
    CHECK(snapshot_hash(world) == snapshot_hash(twin));
  }
}

namespace {

using Predicted = World<BehaviorSet<MacroActions, DriverActions<Intersection>, IdmProposal, Intersection, IdmClassic,
                                    HeadwayHypotheses<Intersection>, ConstantAcceleration>,
                        InterpolateExecution, SingleTrack>;
using Search = Mcts<Predicted, DriverActions<Intersection>, TrafficReward, Intersection>;
using Learning = Mcts<Predicted, DriverActions<Intersection>, TrafficReward, HeadwayHypotheses<Intersection>>;

}  // namespace

TEST_CASE_TEMPLATE("a planner in traffic plans on bit by bit", Planner, Search, Learning, PolicyTreePlanner<Predicted>,
                   ProposalPlanner<Predicted>, FrenetPlanner<Predicted>) {
  using Road = World<BehaviorSet<Planner, IdmClassic, Mobil>, InterpolateExecution, SingleTrack>;
  auto const map = support::own_map("merging.xodr"), again = support::own_map("merging.xodr");
  for (std::uint32_t seed = 0; seed < 30; ++seed) {
    CAPTURE(seed);
    RandomStream random(seed, 0, 2);
    Road world(map, {.seed = seed});
    Planner planner;
    if constexpr (requires { planner.options; }) {
      planner.options.budget.iterations = 25;
      planner.most_agents = seed % 3 == 0 ? 3 : 1;
    }
    world.add({.position = {60, -5.25}, .speed = Uniform{5.0, 15.0}(random), .behavior = planner});
    for (int i = 0; i < 6; ++i) {
      typename Road::Behavior driver = IdmClassic{};
      if (i % 2 == 0) driver = Mobil{};
      world.add({.position = {20.0 + 30.0 * i, -1.75}, .speed = Uniform{5.0, 15.0}(random), .behavior = driver});
    }
    compare(world, again, 5, 0.2, static_cast<int>(seed));
  }
}
