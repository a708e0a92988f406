// Trees that a planner has kept go through a snapshot: the next search is that of a twin which never was saved.
#include "cambium/snapshot.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <variant>

#include "../support/error_of.hpp"

#include "cambium/cambium.hpp"
#include "cambium/planner.hpp"
#include "snapshot/fixtures.hpp"
#include "support/maps.hpp"

using namespace cambium;
using namespace fixtures;

namespace {

constexpr AgentId ego{0};

using Vehicles = DynamicSet<SingleTrack, KinematicPoint>;
using Predicted = World<BehaviorSet<MacroActions, MotionPrimitives, ExternalInput, DriverActions<Intersection>,
                                    Intersection, IdmClassic, HumanDriver<IdmClassic>, HeadwayHypotheses<IdmClassic>>,
                        InterpolateExecution, Vehicles>;
using Sim = World<BehaviorSet<IdmClassic, Pedestrian>, InterpolateExecution, Vehicles>;

template <class Actions, class Selection, class Rollout = PolicyRollout, class Others = IdmClassic>
using Search = Mcts<Predicted, Actions, TrafficReward, Others, MctsOptions<Selection, Rollout>>;
using Usual = Search<MacroActions, Puct>;
using Learning = Mcts<Predicted, MacroActions, TrafficReward, HeadwayHypotheses<IdmClassic>>;

/// A planner that keeps its tree.
template <class Planner>
Planner keeping(std::size_t iterations, int threads) {
  Planner planner;
  planner.options.budget.iterations = iterations;
  planner.options.threads = threads;
  planner.options.hold = 1;
  planner.others_keep_speed = false;
  return planner;
}

/// Ego behind a slow vehicle in the right one of two lanes, with `others` on both.
Sim traffic(std::shared_ptr<Map const> const& map, std::uint64_t seed, int others = 5) {
  Sim world(map, {.seed = seed, .time = 3.0});
  auto const left = map->nearest_lane({20, -1.75, 0})->lane;
  world.add({.position = {60, -5.25},
             .speed = 12,
             .behavior = IdmClassic{},
             .goal = LaneLimits{.lane = left, .left = 0.5, .right = 0.5, .heading_error = 0.08}});
  world.add({.position = {95.0, -5.25}, .speed = 9, .behavior = IdmClassic{}});
  for (int i = 1; i < others; ++i)
    world.add(
        {.position = {28.0 * i + 3.0 * static_cast<double>(seed), -1.75}, .speed = 12.5, .behavior = IdmClassic{}});
  return world;
}

template <class Report>
void check_equal(Report const& a, Report const& b) {
  CHECK(a.result.seed == b.result.seed);
  CHECK(a.result.iterations == b.result.iterations);
  CHECK(a.result.nodes == b.result.nodes);
  CHECK(a.result.kept_nodes == b.result.kept_nodes);
  CHECK(a.result.is_full == b.result.is_full);
  CHECK(a.result.first_arm == b.result.first_arm);
  CHECK(a.result.best == b.result.best);
  CHECK(a.result.variation == b.result.variation);
  CHECK(a.result.depths == b.result.depths);
  CHECK(std::ranges::equal(a.result.arms, b.result.arms, [](auto const& p, auto const& q) {
    return p.action == q.action && p.visits == q.visits && p.mean_return == q.mean_return &&
           p.mean_cost == q.mean_cost && p.share == q.share;
  }));
  CHECK(std::ranges::equal(a.candidates, b.candidates, [](auto const& p, auto const& q) {
    return p.name == q.name && p.score == q.score && p.refused == q.refused;
  }));
  CHECK(a.chosen == b.chosen);
  CHECK(a.decidedness == b.decidedness);
  CHECK(a.choosing == b.choosing);
  CHECK(a.agents == b.agents);
  CHECK(a.course == b.course);
  CHECK(a.memory == b.memory);
}

/// A planner with what it needs from one cycle to the next.
template <class Planner>
struct Stack {
  Sim world;
  typename Planner::Memory memory{};
  typename Planner::Workspace workspace{};
  typename Planner::Report report{};

  auto const& think(Planner const& planner) {
    report = planner.think(world.observe(ego), memory, workspace);
    memory = report.memory;
    return report;
  }
  /// As the stack's world goes on: those that choose move as planned, those on foot as predicted.
  void drive(double dt) {
    REQUIRE(world.step(dt));
    for (std::size_t i = 0; i < report.agents.size(); ++i)
      if (std::ranges::count(report.choosing, report.agents[i]) > 0 ||
          std::holds_alternative<Pedestrian>(world.roster().agents[*world.roster().slot_of(report.agents[i])].behavior))
        world.set_state(report.agents[i], report.course[1].agents[static_cast<Slot>(i)].state);
  }
  /// Through a snapshot, into new objects.
  void freeze_and_thaw(Planner const& planner, std::shared_ptr<Map const> const& map, SnapshotFormat format) {
    auto const bytes = to_snapshot({.format = format}, world, planner, memory, workspace);
    Stack other{Sim(map)};
    auto planner_again = Planner{};
    from_snapshot(bytes, "thawed", other.world, planner_again, other.memory, other.workspace);
    CHECK(to_snapshot({.format = format}, other.world, planner_again, other.memory, other.workspace) == bytes);
    CHECK(other.workspace.keep() == (workspace.kept() != nullptr));  // a second call changes nothing
    other.report = std::move(report);
    *this = std::move(other);
  }
};

/// Drives a stack, and a twin that goes through a snapshot in each cycle. Returns how many nodes were kept in all.
template <class Planner>
std::size_t compare(Planner const& planner, Sim const& world, std::shared_ptr<Map const> const& again, int cycles) {
  Stack<Planner> stack{world}, twin{world};
  std::size_t kept = 0;
  for (int i = 0; i < cycles; ++i) {
    CAPTURE(i);
    check_equal(stack.think(planner), twin.think(planner));
    kept += stack.report.result.kept_nodes;
    REQUIRE(stack.workspace.keep() == twin.workspace.keep());
    auto const format = formats[static_cast<std::size_t>(i) % formats.size()];
    if (i % 2 == 0) twin.freeze_and_thaw(planner, again, format);
    for (auto* one : {&stack, &twin}) one->drive(planner.options.step + (i % 2 == 0 ? 1e-3 : -1e-3));  // clocks jitter
    if (i % 2 == 1) twin.freeze_and_thaw(planner, again, format);
  }
  check_equal(stack.think(planner), twin.think(planner));
  return kept + stack.report.result.kept_nodes;
}

constexpr std::size_t golden_nodes = 23;
constexpr std::uint32_t golden_visits = 23;

}  // namespace

#ifdef CAMBIUM_QUICK_TESTS  // each takes 3 s to compile: of each kind of actions one
#define SEARCHES                                                             \
  Search<MacroActions, Exp3>, Search<MotionPrimitives, Ucb1, RandomRollout>, \
      Search<SampledInputs, Puct, RandomRollout>, Search<DriverActions<Intersection>, Puct>
#else
#define SEARCHES                                                                                              \
  Search<MacroActions, Puct>, Search<MotionPrimitives, Ucb1, RandomRollout>, Search<MacroActions, Ucb1Tuned>, \
      Search<MacroActions, Exp3>, Search<MacroActions, RegretMatching, RandomRollout>,                        \
      Search<DriverActions<Intersection>, Puct>, Search<SampledInputs, Ucb1Tuned, RandomRollout>,             \
      Search<SampledInputs, Puct, RandomRollout>, Search<MacroActions, Puct, PolicyRollout, HumanDriver<IdmClassic>>
#endif

TEST_CASE_TEMPLATE("a search goes on in its kept tree after it was saved and restored", Planner, SEARCHES) {
  auto const map = support::straight_road(2, 600.0), again = support::straight_road(2, 600.0);
  for (int const threads : {1, 2}) {
    CAPTURE(threads);
    for (std::uint64_t seed = 0; seed < 2; ++seed)
      CHECK(compare(keeping<Planner>(300, threads), traffic(map, seed), again, 6) > 100);
  }
}

TEST_CASE("so does a search of several agents that choose, one under a limit on risk, and one that fills its memory") {
  auto const map = support::straight_road(2, 600.0), again = support::straight_road(2, 600.0);
  for (int const threads : {1, 3}) {
    CAPTURE(threads);
    auto planner = keeping<Usual>(300, threads);
    planner.most_agents = 3;
    CHECK(compare(planner, traffic(map, 1), again, 6) > 20);
    planner.most_agents = 1;
    planner.options.search.constraint.limit = 0.1;
    CHECK(compare(planner, traffic(map, 2), again, 6) > 100);
    planner = keeping<Usual>(600, threads);
    planner.options.search.memory = 600'000;
    CHECK(compare(planner, traffic(map, 0), again, 6) > 100);
  }
}

TEST_CASE("so does a search beside people on ways of their own, objects and lights") {
  auto const map = support::own_map("intersection_4way.xodr"), again = support::own_map("intersection_4way.xodr");
  using Planner = Search<DriverActions<Intersection>, Puct, PolicyRollout, Intersection>;
  Sim world(map, {.seed = 5});
  for (auto const& light : map->lights())
    world.set_light(light.id, {.cycle = 20.0, .green_begin = 0.0, .green_end = 8.0});
  world.add({.position = {-40, -1.75}, .speed = 8, .behavior = IdmClassic{}});
  world.add({.position = {-25, -1.75}, .speed = 8, .behavior = IdmClassic{}});
  for (double const x : {-20.0, -22.0})
    world.add({.position = {x, -8},
               .speed = 1.0,
               .shape = geometry::pedestrian(),
               .behavior = Pedestrian{},
               .way = {{x, -8}, {x, 8}},
               .dynamics = KinematicPoint{}});
  world.add_object(geometry::Polygon({{-30, -9}, {-28, -9}, {-28, -6}}));
  CHECK(compare(keeping<Planner>(200, 1), world, again, 6) > 100);
}

TEST_CASE("a workspace without a kept tree takes a flag, and thaws as a new one") {
  auto const map = support::straight_road(2, 600.0);
  auto const planner = keeping<Usual>(100, 1);
  Stack<Usual> stack{traffic(map, 0)};
  stack.think(planner);
  for (auto const format : formats) {
    auto const bytes = to_snapshot({.format = format}, stack.workspace);
    CHECK(snapshot_info(bytes).parts == "workspace");
    CHECK(bytes == to_snapshot({.format = format}, Usual::Workspace{}));
    if (format == SnapshotFormat::binary) CHECK(bytes.size() - bytes.find("\n\n") == 3);
    Usual::Workspace thawed;
    thawed = stack.workspace;
    REQUIRE(thawed.keep());
    from_snapshot(bytes, "x", thawed);
    CHECK(thawed.kept() == nullptr);
    CHECK_THROWS_AS(static_cast<void>(thawed.search()), SearchError);
  }
  // With hypotheses about the others nodes have no states, and there is nothing to keep.
  auto learning = keeping<Learning>(100, 1);
  Stack<Learning> other{traffic(map, 0)}, twin{traffic(map, 0)};
  other.think(learning);
  twin.think(learning);
  CHECK_FALSE(twin.workspace.keep());
  twin.freeze_and_thaw(learning, map, SnapshotFormat::binary);
  for (auto* one : {&other, &twin}) one->drive(0.2);
  check_equal(other.think(learning), twin.think(learning));
}

TEST_CASE("a kept tree needs its world, and nothing changes without it") {
  auto const map = support::straight_road(2, 600.0), longer = support::straight_road(2, 601.0);
  auto const planner = keeping<Usual>(100, 1);
  Stack<Usual> stack{traffic(map, 0)};
  stack.think(planner);
  REQUIRE(stack.workspace.keep());
  auto const sentence = "a kept tree needs its world; restore the world before it";
  Stack<Usual> other{stack};
  auto const before = snapshot_hash(other.workspace);
  says(sentence, [&] { from_snapshot(to_snapshot({}, stack.workspace), "f", other.workspace); });
  says(sentence,
       [&] { from_snapshot(to_snapshot({}, stack.workspace, stack.world), "f", other.workspace, other.world); });
  Sim elsewhere(longer);
  says(sentence, [&] { from_snapshot(to_snapshot({}, elsewhere, stack.workspace), "f", elsewhere, other.workspace); });
  CHECK(snapshot_hash(other.workspace) == before);
  says("no error", [&] {
    from_snapshot(to_snapshot({}, stack.world, elsewhere, stack.workspace), "f", other.world, elsewhere,
                  other.workspace);
  });
  CHECK(snapshot_hash(other.workspace) == before);
}

TEST_CASE("a tree that contradicts itself, its map or its world is refused by a sentence") {
  auto const map = support::straight_road(2, 600.0);
  auto const planner = keeping<Usual>(200, 2);
  Stack<Usual> stack{traffic(map, 0)};
  stack.think(planner);
  REQUIRE(stack.workspace.keep());
  auto const good = detail::archived_trees(*stack.workspace.kept());
  detail::ArchivedScenes const scenes{{{map, {}}}};
  auto const says_after = [&](char const* sentence, auto const& damage) {
    auto parts = good;
    damage(parts);
    says(sentence, [&] { static_cast<void>(detail::restored_trees(std::move(parts), scenes)); });
  };
  says_after("no error", [](auto&) {});
  auto& nodes = good.trees[0].nodes;
  REQUIRE(nodes.size() > 10);
  auto const inner = static_cast<std::size_t>(
      std::ranges::find_if(nodes, [](auto const& node) { return !node.agents[0].arms.empty(); }, {}) - nodes.begin());
  REQUIRE(inner < nodes.size());

  auto const says_of_nodes = [&](char const* sentence, auto const& damage) {
    says_after(sentence, [&](auto& parts) { damage(parts.trees[0].nodes); });
  };
  says_of_nodes("comes before its parent", [](auto& list) { list[5].parent = 5; });
  says_of_nodes("comes before its parent", [](auto& list) { list[5].parent = 4'000'000'000u; });
  says_of_nodes("comes before its parent", [](auto& list) { list[0].parent = 0; });
  says_of_nodes("comes by no arm", [](auto& list) { list[1].agents[0].came_by = 60'000; });
  says_of_nodes("other agents that choose", [](auto& list) { list[1].agents.clear(); });
  says_of_nodes("other agents that choose", [](auto& list) { list[1].agents.push_back(list[1].agents[0]); });
  says_of_nodes("no valid outcome", [](auto& list) { list[1].agents[0].outcome.cost = 2.0; });
  says_of_nodes("no valid outcome", [](auto& list) { list[1].agents[0].outcome.reward = 1.0 / 0.0; });
  says_of_nodes("other actions", [&](auto& list) { list[inner].agents[0].arms[0].action = 200; });
  says_of_nodes("other actions", [&](auto& list) { list[inner].agents[0].arms.pop_back(); });
  says_of_nodes("more nodes than states", [](auto& list) { list.push_back(list.back()); });
  says_after("there twice", [](auto& parts) {
    auto& tree = parts.trees[0];
    tree.nodes.push_back(tree.nodes.back());
    tree.states.push_back(tree.states.back());
  });
  says_after("after the end", [](auto& parts) { parts.trees[0].states[0].over = true; });
  says_after("other agents that choose", [](auto& parts) { parts.trees[0].scales.clear(); });

  auto const says_of_state = [&](char const* sentence, auto const& damage) {
    says_after(sentence, [&](auto& parts) { damage(parts.trees[1].states[3].frame); });
  };
  says_of_state("other agents than its world", [](auto& frame) { frame.agents.pop_back(); });
  says_of_state("other agents than its world", [](auto& frame) { ++frame.roster_revision; });
  says_of_state("on no lane", [](auto& frame) { frame.agents[Slot{1}].lane.corridor = CorridorId{9}; });
  says_of_state("another model's memory", [](auto& frame) { frame.agents[Slot{1}].memory = MacroActions::Memory{}; });
  says_of_state("remembers a lane that its road lacks", [](auto& frame) {
    std::get<MacroActions::Memory>(frame.agents[Slot{0}].memory).change.target = CorridorId{9};
  });

  says_after("no agents that choose", [](auto& parts) { parts.slots.clear(); });
  says_after("another model", [](auto& parts) { parts.slots = {Slot{77}}; });
  says_after("another model", [](auto& parts) { parts.slots = {Slot{1}}; });
  says_after("other agents that choose", [](auto& parts) { parts.slots = {Slot{0}, Slot{0}}; });
  says_after("no time step", [](auto& parts) { parts.dt = std::nan(""); });
  says_after("has no trees", [](auto& parts) { parts.trees.clear(); });
  says_after("has no trees", [](auto& parts) { parts.trees.resize(1025); });
  says_after("a kept tree needs its world", [](auto& parts) { parts.world.map_hash += 1; });
  says_after("horizon", [](auto& parts) { parts.parameters_of_search.horizon = 0; });
}

TEST_CASE("a kept tree that was changed and sealed again is an error or a tree, never a crash") {
  auto const map = support::straight_road(2, 600.0);
  auto const planner = keeping<Usual>(40, 2);
  Stack<Usual> stack{traffic(map, 0, 3)};
  stack.think(planner);
  REQUIRE(stack.workspace.keep());
  auto const world = stack.world;
  stack.drive(0.2);
  int refused = 0;
  for (auto const format : formats) {
    auto const bytes = to_snapshot({.format = format}, world, stack.workspace);
    auto const begin = to_snapshot({.format = format}, world, Usual::Workspace{}).size();
    RandomStream random(static_cast<std::uint64_t>(format), 2, 0);
    for (int i = 0; i < 1500; ++i) {
      auto const damaged = changed_archive(bytes, begin, random);
      Sim other(map);
      Usual::Workspace workspace;
      if (support::error_of<cambium::SnapshotError>([&] { from_snapshot(damaged, "f", other, workspace); }) !=
          "no error") {
        ++refused;
        continue;
      }
      if (workspace.kept() == nullptr) continue;
      try {
        static_cast<void>(planner.think(stack.world.observe(ego), stack.memory, workspace));
      } catch (SearchError const&) {  // sums that are not finite
      }
    }
  }
  CHECK(refused > 1000);
}

TEST_CASE("a kept tree takes a few hundred bytes a node") {
  auto const map = support::straight_road(2, 1200.0);
  auto const planner = keeping<Search<MacroActions, Ucb1Tuned>>(500, 1);
  Stack<Search<MacroActions, Ucb1Tuned>> stack{traffic(map, 0, 20)};
  auto const without = to_snapshot({}, stack.world, stack.workspace).size();
  stack.think(planner);
  REQUIRE(stack.workspace.keep());
  auto const with = to_snapshot({}, stack.world, stack.workspace).size();
  auto const nodes = detail::archived_trees(*stack.workspace.kept()).trees[0].nodes.size();
  REQUIRE(nodes > 50);
  CHECK(with - without < 300 * nodes + 5'000);
}

// As with worlds, in snapshot_test.cpp: files of each version of the format stay here for good.
TEST_CASE("kept trees of earlier versions load") {
  using Tree = detail::ArchivedSearch<Usual::Workspace::Search>;
  auto const map = support::straight_road(2, 600.0);
  write_golden("tree_2", 2, [&] {
    Stack<Usual> stack{traffic(map, 0, 2)};
    stack.think(keeping<Usual>(60, 1));
    REQUIRE(stack.workspace.keep());
    return detail::archived_trees(*stack.workspace.kept());
  });
  int const files = for_each_golden("tree_2", [&](std::string const& path) {
    Tree parts;
    load_snapshot(path, parts);
    REQUIRE(parts.trees.size() == 1);
    CHECK(parts.trees[0].nodes.size() == golden_nodes);
    CHECK(parts.trees[0].nodes[0].visits == golden_visits);
    CHECK(parts.dt == 0.2);
    parts.world.map_hash = detail::hash_of_map(*map);
    detail::ArchivedScenes scenes;
    scenes.scenes.push_back({map, {}});
    auto const trees = detail::restored_trees(std::move(parts), scenes);
    CHECK(trees.searches()[0].tree().size() == golden_nodes);
  });
  CHECK(files >= 2);
  CHECK(for_each_golden("tree_1", [&](std::string const& path) {
          Tree parts;
          says("its struct 'macro_actions' was saved with other fields", [&] { load_snapshot(path, parts); });
        }) == 2);
}
