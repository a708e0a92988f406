// Worlds that were saved and restored in every step go on as those that were not: all shipped models and planners.
#include "cambium/snapshot.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "cambium/cambium.hpp"
#include "cambium/core/read_file.hpp"
#include "cambium/map/opendrive.hpp"
#include "cambium/planner.hpp"
#include "snapshot/fixtures.hpp"
#include "support/maps.hpp"
#include "support/spoil.hpp"

using namespace cambium;
using namespace fixtures;

namespace {

/// The world after a way through a snapshot, on a map that was read anew.
template <class World>
World thawed(World const& world, std::shared_ptr<Map const> const& map, SnapshotFormat format) {
  World other(map);
  from_snapshot(to_snapshot({.format = format}, world), "thawed", other);
  CHECK(snapshot_hash(other) == snapshot_hash(world));
  return other;
}

/// A memory may hold an empty one.
static_assert(detail::describes_all<MemoryOf<HumanDriver<ConstantAcceleration>>>());

/// Names of the memories' fields, and whether somebody's has ever been other than at first.
using Moved = std::map<std::string, bool>;

void note_moves(Moved& moved, std::string const& name, TypeInfo const& type, void const* value, void const* usual) {
  using Kind = TypeInfo::Kind;
  if (type.kind == Kind::structure) {
    for (auto const& field : type.fields())
      note_moves(moved, std::string(type.name) + "." + field.name, field.type(), field.in(value), field.in(usual));
    return;
  }
  if (type.kind == Kind::one_of) {
    auto const& model = type.alternatives[type.index(value)]();
    return note_moves(moved, name, model, type.held(value), model.usual());
  }
  bool& has_moved = moved[name];
  has_moved = has_moved || !detail::are_equal(type, value, usual, detail::Equality::of_bits);
  if (type.kind == Kind::optional) {
    if (auto const* const held = type.held(value))
      note_moves(moved, name + ".value", type.element(), held, type.element().usual());
  } else if (type.kind == Kind::list) {
    auto const elements = type.elements(value);
    for (std::size_t i = 0; i < elements.count; ++i)
      note_moves(moved, name + ".element", type.element(), elements[i], type.element().usual());
  }
}

template <class Value>
void note_moves(Moved& moved, std::string const& name, Value const& value) {
  note_moves(moved, name, type_info<Value>(), &value, type_info<Value>().usual());
}

/// Draws about half of a model's parameters: numbers near their defaults, those that are 0 between 0 and 1, switches
/// and choices.
template <class Model>
void vary(Model& model, RandomStream& random) {
  Model drawn = model;
  for_each_parameter<Model>([&](auto const& p) {
    auto& field = drawn.*p.field;
    using Field = std::remove_cvref_t<decltype(field)>;
    bool const is_drawn = uniform01(random) < 0.5;
    if constexpr (Described<Field>)
      vary(field, random);
    else if constexpr (std::is_same_v<Field, bool>)
      field = field != is_drawn;
    else if constexpr (std::is_enum_v<Field>)
      field = is_drawn ? static_cast<Field>(Uniform{0.0, p.range.high + 0.999}(random)) : field;
    else if constexpr (std::is_same_v<Field, double>)
      field = !is_drawn      ? field
              : field == 0.0 ? Uniform{0.0, std::min(1.0, p.range.high)}(random)
                             : std::clamp(field * Uniform{0.5, 1.5}(random), p.range.low, p.range.high);
  });
  try {
    check_parameters(drawn);
    model = drawn;
  } catch (ParameterError const&) {  // the drawn ones do not fit together: it keeps its own
  }
}

/// Sets in a memory what a planner or a host chooses for the model.
template <class Memory>
void choose(Memory& memory, RandomStream& random) {
  double const share = uniform01(random);
  if constexpr (requires { memory.choose(1u); }) {
    memory.choose(static_cast<std::size_t>(3.0 * share));
  } else if constexpr (requires { memory.steering; }) {
    memory = {.acceleration = share, .steering = 0.02 * share};
  } else if constexpr (requires { memory.towards; }) {
    memory.speed_share = static_cast<float>(share);
    memory.offset = 0.5f;
    memory.towards = CorridorId{0};
  } else if constexpr (requires { memory.chosen; }) {
    memory.chosen = static_cast<std::uint8_t>(3.0 * share);
  } else if constexpr (requires { memory.time_headway; }) {
    memory.time_headway = static_cast<float>(1.0 + share);
  }
}

/// The project's own map; of "all-way stop", the crossing with stop signs instead of its lights.
std::shared_ptr<Map const> map_named(std::string const& name) {
  if (name != "all-way stop") return support::own_map(name);
  auto text = read_file<MapError>(CAMBIUM_SOURCE_DIR "/maps/intersection_4way.xodr", {});
  std::string const light = "type=\"1000001\"";
  for (auto at = text.find(light); at != text.npos; at = text.find(light))
    text.replace(at, light.size(), "type=\"206\"");
  return parse_opendrive(text, {}, name).map;
}

struct DoNothing {
  void operator()(auto const&) const {}
};

/// Steps `world` and a twin that is saved and restored before each step, and compares them bit by bit. `look` is called
/// with every record of each step.
template <class World, class Look = DoNothing>
void compare(World world, std::shared_ptr<Map const> const& other_map, int steps, double dt, int first_format,
             Look const& look = {}) {
  World twin = world;
  for (int i = 0; i < steps; ++i) {
    CAPTURE(i);
    twin = thawed(twin, other_map, formats[static_cast<std::size_t>(first_format + i) % formats.size()]);
    auto const a = world.step(dt), b = twin.step(dt);
    CHECK(a.failed == b.failed);
    REQUIRE(snapshot_hash(world) == snapshot_hash(twin));
    REQUIRE(world.frame() == twin.frame());
    for (auto const& record : twin.frame().agents) look(record);
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
      if (auto* const idm = std::get_if<IdmClassic>(&behavior)) idm->law.desired_speed = Uniform{5.0, 30.0}(random);
      world.add(
          {.position = {x, i % 2 == 0 ? -1.75 : -5.25}, .speed = Uniform{0.0, 15.0}(random), .behavior = behavior});
    }
    compare(world, again, 12, 0.2, static_cast<int>(seed));
  }
}

TEST_CASE("what drivers remember goes on when they queue, stop, turn and react late") {
  Moved moved;
  for (std::string const name : {"all-way stop", "intersection_4way.xodr", "lane_drop.xodr", "roundabout.xodr"}) {
    CAPTURE(name);
    auto const map = map_named(name), again = map_named(name);
    for (std::uint32_t seed = 0; seed < 40; ++seed) {
      CAPTURE(seed);
      RandomStream random(seed, 0, 3);
      Sim world(map, {.seed = seed});
      for (auto const& light : map->lights())
        world.set_light(light.id, {.cycle = 20.0, .green_begin = 5.0, .green_end = Uniform{6.0, 20.0}(random)});
      if (name == "all-way stop") {  // two that come to the crossing at once
        world.add({.position = {-40, -1.75}, .speed = 8, .behavior = Intersection{}});
        world.add({.position = {1.75, -40}, .heading = M_PI / 2, .speed = 8, .behavior = Intersection{}});
      }
      for (std::size_t i = 0; world.size() < 12 && i < 100; ++i) {
        auto const& lane = map->lanes()[static_cast<std::size_t>(
            Uniform{0.0, static_cast<double>(map->lanes().size()) - 1e-9}(random))];
        if (lane.type != map::LaneType::driving || lane.path.length() < 20.0) continue;
        auto const pose = lane.path.pose(Uniform{5.0, lane.path.length() - 10.0}(random));
        auto behavior = one_of<Sim::Behavior>(seed + i);
        std::visit([&](auto& model) { vary(model, random); }, static_cast<Sim::Behavior::variant&>(behavior));
        world.add({.position = pose.position(),
                   .heading = pose.heading,
                   .speed = Uniform{0.0, 10.0}(random),
                   .behavior = behavior});
        if (cambium::Collision{.margin = 2.0}(world, Slot{static_cast<std::uint32_t>(world.size() - 1)}))
          world.remove(world.roster().agents[Slot{static_cast<std::uint32_t>(world.size() - 1)}].id);
      }
      auto frame = world.frame();
      for (auto& record : frame.agents) std::visit([&](auto& memory) { choose(memory, random); }, record.memory);
      world.restore(frame);
      compare(world, again, 50, seed % 4 == 0 ? 0.02 : 0.25, static_cast<int>(seed), [&](auto const& record) {
        note_moves(moved, "memory", record.memory);
        note_moves(moved, "lane", record.lane);
      });
    }
  }
  for (auto const& [field, has_moved] : moved) {
    CAPTURE(field);
    CHECK(has_moved);
  }
}

TEST_CASE("every execution, vehicle and observer model goes on bit by bit") {
  using Execution = ExecutionSet<InterpolateExecution, StanleyExecution, LqrExecution>;
  using Vehicles = DynamicSet<SingleTrack, KinematicPoint>;
  using Chain = ObserverChain<OccludedObserver, ParametricObserver, DelayedObserver<2>>;
  using Eyes = ObserverSet<PerfectObserver, ParametricObserver, OccludedObserver, DelayedObserver<3>, Chain>;
  using Models = World<BehaviorSet<IdmClassic, Mobil, Intersection>, Execution, Vehicles, Eyes>;
  auto const map = support::own_map("highway.xodr"), again = support::own_map("highway.xodr");
  auto const varied = [](auto models, RandomStream& random) {
    std::visit([&](auto& model) { vary(model, random); }, models);
    return models;
  };
  Moved moved;
  for (std::uint32_t seed = 0; seed < 80; ++seed) {
    CAPTURE(seed);
    RandomStream random(seed, 0, 1);
    Models world(map, {.seed = seed});
    for (std::uint32_t i = 0; i < 9; ++i)
      world.add({.position = {20.0 + 25.0 * i, -5.25},
                 .speed = Uniform{5.0, 25.0}(random),
                 .behavior = one_of<Models::Behavior>(i + seed),
                 .execution = varied(one_of<Execution>(i), random),
                 .dynamics = varied(one_of<Vehicles>(i % 5), random),
                 .observer = varied(one_of<Eyes>(i / 2), random)});
    compare(world, again, 15, 0.2, static_cast<int>(seed), [&](auto const& record) {
      note_moves(moved, "execution", record.execution);
      note_moves(moved, "past", record.past);
    });
  }
  for (auto const& [field, has_moved] : moved) {
    CAPTURE(field);
    CHECK(has_moved);
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

TEST_CASE("numbers that no world has are refused, others can be driven on with") {
  auto const map = support::own_map("merging.xodr");
  Sim world(map, {.seed = 3});
  for (std::size_t i = 0; i < 19; ++i)
    world.add({.position = {20.0 + 10.0 * static_cast<double>(i), i % 2 == 0 ? -1.75 : -5.25},
               .speed = 8.0,
               .behavior = one_of<Sim::Behavior>(i),
               .goal = AllGoals{{StateLimits{}, ReachLaneEnd{}}}});
  world.add_object(geometry::Polygon({{150, -9}, {152, -9}, {152, -4}}));
  for (int i = 0; i < 3; ++i) REQUIRE(world.step(0.2));
  auto const spoilt = support::spoil_numbers(world, 1500, 2, [](std::string const& what) { FAIL_CHECK(what); });
  CHECK(spoilt.refused > 300);
  CHECK(spoilt.worlds > 300);
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

#define PLANNERS Search, Learning, PolicyTreePlanner<Predicted>, ProposalPlanner<Predicted>, FrenetPlanner<Predicted>
using Road = World<BehaviorSet<PLANNERS, IdmClassic, Mobil>, InterpolateExecution, SingleTrack>;

}  // namespace

TEST_CASE_TEMPLATE("a planner in traffic plans on bit by bit", Planner, PLANNERS) {
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
      Road::Behavior driver = IdmClassic{};
      if (i % 2 == 0) driver = Mobil{};
      world.add({.position = {20.0 + 30.0 * i, -1.75}, .speed = Uniform{5.0, 15.0}(random), .behavior = driver});
    }
    compare(world, again, 5, 0.2, static_cast<int>(seed));
  }
}
