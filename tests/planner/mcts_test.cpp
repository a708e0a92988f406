#include "cambium/planner/mcts/mcts.hpp"

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cambium/behavior/drivers.hpp"
#include "cambium/map/building/map_builder.hpp"
#include "cambium/map/building/polyline_roads.hpp"
#include "planner/games.hpp"
#include "planner/planner_fixtures.hpp"
#include "support/allocations.hpp"
#include "support/scale.hpp"

using namespace planner_fixtures;

namespace {

using Search = Mcts<PredictionWorld>;
using Wandering = Mcts<PredictionWorld, MacroActions, TrafficReward, IdmClassic, MctsOptions<Ucb1, RandomRollout>>;
using Sim = World<BehaviorSet<Search, Learning, Wandering, IdmClassic>, InterpolateExecution, SingleTrack>;

/// The planner with few iterations.
template <class Planner>
Planner quick(Planner planner, std::size_t iterations = 300) {
  planner.options.budget.iterations = iterations;
  return planner;
}

/// The same, so that it may keep its tree.
template <class Planner>
Planner keeping(Planner planner, std::size_t iterations) {
  planner.options.hold = 1;
  planner.others_keep_speed = false;
  return quick(planner, iterations);
}

/// Changing lanes where all others drive as a search expects by default.
Sim as_expected() {
  auto world = lane_change<Sim>(0, IdmClassic{});
  for (auto const& agent : world.roster().agents)
    if (agent.id != ego) world.set_behavior(agent.id, IdmClassic{});
  return world;
}

/// Ego behind a driver with a time headway of `headway` [s], who follows a slower one.
Sim behind(double headway) {
  Sim world(support::straight_road(1, 2000.0));
  world.add({.position = {60, -1.75}, .speed = 12, .behavior = IdmClassic{}});
  world.add({.position = {90, -1.75}, .speed = 14, .behavior = IdmClassic{.law = {.time_headway = headway}}});
  world.add({.position = {115, -1.75}, .speed = 10, .behavior = IdmClassic{.law = {.desired_speed = 10}}});
  return world;
}

/// What a search has learnt about that driver by `steps` calls, one each `period` [s], early and late by `jitter` [s].
Belief learnt_about(double headway, int steps, double period, double jitter = 0.0) {
  auto world = behind(headway);
  auto const planner = quick(Learning{}, 20);
  Learning::Workspace workspace;
  Learning::Memory memory;
  for (int step = 0; step < steps; ++step) {
    memory = planner.think(world.observe(ego), memory, workspace).memory;
    REQUIRE(world.step(period + (step % 2 == 0 ? jitter : -jitter)));
  }
  REQUIRE(memory.belief(AgentId{1}) != nullptr);
  return *memory.belief(AgentId{1});
}

/// Two opposite lanes from x = -80 to 80 m that occupy the same place where |x| < 10 m.
std::shared_ptr<Map const> narrowing() {
  map::MapBuilder builder;
  for (double const direction : {1.0, -1.0}) {
    std::vector<std::vector<geometry::Point>> borders;
    for (double const offset : {1.75, -1.75}) {
      borders.emplace_back();
      for (double x = -80.0; x <= 80.0; x += 5.0) {
        double const u = std::clamp((std::abs(x) - 10.0) / 20.0, 0.0, 1.0);
        borders.back().push_back({direction * x, direction * (offset - 2.5 * u * u * (3.0 - 2.0 * u))});
      }
    }
    builder.add_road(map::lanes_between(borders));
  }
  return builder.build();
}

/// Drives on, speeds up or brakes; up to `most_agents` agents choose in the search. To go on as before is no solution
/// here, so courses go on at random.
Wandering through_the_narrowing(int most_agents) {
  Wandering planner;
  planner.options.budget.iterations = 1000;
  planner.most_agents = most_agents;
  planner.actions = MacroActions::of(
      {{MacroAction::Kind::stay, 0.0}, {MacroAction::Kind::stay, 1.5}, {MacroAction::Kind::stay, -3.0}});
  planner.others.law.desired_speed = 9.0;
  planner.reward = TrafficReward::events();
  planner.reward.goal = 0.0;
  planner.reward.collision = planner.reward.off_road = -100.0;
  planner.reward.progress = 1.0;
  planner.options.step = 0.4;
  planner.options.hold = 1;
  planner.options.search = {.horizon = 25, .discount = 0.95, .constraint = {.weight = 0.0}};
  planner.options.rollout.hold = 8;
  return planner;
}

}  // namespace

TEST_CASE("a search in traffic changes into a gap in the other lane") {
  auto cooperative = quick(Search{}, 600), careful = quick(Search{});
  cooperative.most_agents = 3;
  cooperative.reward.speed_deviation = -0.1;
  careful.options.search.constraint.limit = 0.1;
  Sim::Behavior const planners[] = {quick(Search{}), cooperative, quick(Learning{}), careful};
  for (auto const& planner : planners) {
    CAPTURE(planner.index());
    int reached = 0, collisions = 0;
    for (std::uint64_t seed = 0; seed < 2; ++seed) {
      auto world = lane_change<Sim>(seed, planner);
      for (int step = 0; step < 100 && !world.reached_goal(ego); ++step) {
        auto const result = world.step(0.2);
        REQUIRE(result.failed == 0);
        collisions += Collision{}(world, world.slot_of(ego)) ? 1 : 0;
      }
      reached += world.reached_goal(ego) ? 1 : 0;
    }
    CHECK(reached == 2);
    CHECK(collisions == 0);
  }
}

TEST_CASE("a narrowing at which each waits for the other is solved by searching for both") {
  auto const map = narrowing();
  auto cooperative = through_the_narrowing(4);
  cooperative.cooperation = 1.0;
  cooperative.range = 100.0;
  auto const solved = [&](Sim::Behavior const& planner, std::uint64_t seed) {
    Sim world(map, {.seed = seed});
    world.add({.position = {-41.0, -2.5}, .speed = 8, .behavior = planner});
    world.add({.position = {45.0, 2.5}, .heading = geometry::pi, .speed = 8, .behavior = planner});
    for (int step = 0; step < 75; ++step) {
      REQUIRE(world.step(0.4).failed == 0);
      REQUIRE_FALSE(Collision{}(world, world.slot_of(ego)));
      if (world.state(ego).x > 20.0 && world.state(AgentId{1}).x < -20.0) return true;
    }
    return false;
  };
  for (std::uint64_t seed = 0; seed < support::runs(2); ++seed) {
    CHECK(solved(cooperative, seed));
    CHECK_FALSE(solved(through_the_narrowing(1), seed));  // it expects the other to drive on
  }
}

TEST_CASE("it stays in its lane in a bend, however long the steps of the search are") {
  for (double const step : {0.1, 0.25, 0.4}) {
    CAPTURE(step);
    auto planner = quick(Search{}, 50);
    planner.actions = MacroActions::of({{MacroAction::Kind::stay, 0.0}});
    planner.options.step = step;
    Sim world(support::straight_road(1, 300.0, 0.05), {.seed = 1});
    auto const& lane = world.map().lanes().front();
    auto const start = lane.path.pose(5.0);
    world.add({.position = {start.x, start.y}, .heading = start.heading, .speed = 8, .behavior = planner});
    for (int k = 0; k < 20; ++k) {
      REQUIRE(world.step(0.2).failed == 0);
      CHECK(std::abs(world.frame().agents[0].lane.lateral) < 0.01);
    }
  }
}

TEST_CASE("a planner reports what it found") {
  auto planner = quick(Search{}, 500);
  planner.others_keep_speed = false;  // the same is expected of all
  auto world = lane_change<Sim>(0, planner);
  Search::Workspace workspace;
  auto const report = planner.think(world.observe(ego), {}, workspace);
  CHECK(report.result.iterations == 500);
  CHECK(report.choosing == std::vector<AgentId>{ego});
  REQUIRE(report.candidates.size() == report.result.of(0).size());
  CHECK(report.chosen == report.result.best[0]);
  for (std::size_t i = 0; i < report.candidates.size(); ++i)
    CHECK(report.candidates[i].score ==
          workspace.search().scales()[0].score(report.result.of(0)[i].mean_return, report.result.of(0)[i].mean_cost));
  CHECK(report.candidates.front().name == "keep_gap");
  REQUIRE(report.course.size() > report.result.variation.size());
  // Played in the predicted world, the variation leads to the states that the report shows.
  auto predicted = world.observe(ego).predict(predict_as<PredictionWorld::Behaviors>(MacroActions{}, IdmClassic{}));
  auto const hold = static_cast<std::size_t>(Search{}.options.hold);
  for (std::size_t i = 0; i < report.result.variation.size() * hold; ++i) {
    if (i % hold == 0) predicted.memory<MacroActions>(ego).choose(report.result.variation[i / hold]);
    REQUIRE(predicted.step(0.2));
    CHECK(predicted.frame().agents == report.course[i + 1].agents);
  }
}

TEST_CASE("a search continues its tree if the world turns out as predicted") {
  for (int const threads : {1, 2}) {
    CAPTURE(threads);
    auto planner = keeping(Search{}, 600);
    planner.options.threads = threads;
    for (bool const surprised : {false, true}) {
      // The stack's own world: ego moves as planned; the others move as predicted, or one does not.
      auto world = as_expected();
      Search::Workspace workspace;
      CHECK_FALSE(workspace.keep());
      auto report = planner.think(world.observe(ego), {}, workspace);
      for (int step = 0; step < 8; ++step) {
        REQUIRE(workspace.keep());
        CHECK(report.memory == *std::get_if<MacroActions::Memory>(&report.course[1].agents[0].memory));
        REQUIRE(world.step(planner.options.step + (step % 2 == 0 ? 1e-3 : -1e-3)));  // clocks jitter
        world.set_state(ego, report.course[1].agents[0].state);
        if (surprised) put(world, AgentId{3}, [](auto& state) { state.x += 3.0; });
        report = planner.think(world.observe(ego), report.memory, workspace);
        CHECK((report.result.kept_nodes > 0) == !surprised);
        CHECK(report.result.iterations == 600);
        CHECK(report.result.nodes > report.result.kept_nodes);
      }
    }
  }
}

TEST_CASE("nothing is kept if anything has changed, or without a call of keep") {
  using Memory = Search::Memory;
  auto const kept_nodes = [](bool keep, auto const& change) {
    auto world = as_expected();
    auto planner = keeping(Search{}, 600);
    planner.options.search = {.horizon = 30, .discount = 0.98};
    planner.reward = TrafficReward::events();  // only the goal in the other lane counts
    planner.actions = MacroActions::of({{MacroAction::Kind::change_left, 0.0}, {MacroAction::Kind::stay, 0.0}});
    planner.actions.safe_deceleration = 50.0;
    Search::Workspace workspace;
    auto report = planner.think(world.observe(ego), {}, workspace);
    REQUIRE(report.memory.change.active());
    if (keep) CHECK(workspace.keep());
    REQUIRE(world.step(planner.options.step));
    world.set_state(ego, report.course[1].agents[0].state);
    change(world, planner, report.memory);
    return planner.think(world.observe(ego), report.memory, workspace).result.kept_nodes;
  };
  auto const nothing = [](auto&, auto&, auto&) {};
  CHECK(kept_nodes(true, nothing) > 0);
  CHECK(kept_nodes(false, nothing) == 0);
  CHECK(kept_nodes(true, [](auto&, auto&, Memory& memory) { memory = {}; }) == 0);
  CHECK(kept_nodes(true, [](auto&, auto& planner, auto&) { planner.actions.actions[0].acceleration = 1.0; }) == 0);
  CHECK(kept_nodes(true, [](auto&, auto& planner, auto&) { planner.most_agents = 2; }) == 0);
  CHECK(kept_nodes(true, [](auto&, auto& planner, auto&) { planner.options.search.discount = 0.0; }) == 0);
  CHECK(kept_nodes(true, [](auto&, auto& planner, auto&) { planner.reward.progress -= 1.0; }) == 0);
  CHECK(kept_nodes(true, [](auto&, auto& planner, auto&) { planner.others.law.time_headway = 0.5; }) == 0);
  CHECK(kept_nodes(true, [](auto& world, auto&, auto&) {
          auto const& at = world.state(ego);
          geometry::Point const front{at.x + 40.0, at.y};
          world.add_object(geometry::Polygon({front, {front.x() + 1.0, front.y()}, {front.x(), front.y() + 1.0}}));
        }) == 0);
  CHECK(kept_nodes(true,
                   [](auto& world, auto&, auto&) { put(world, ego, [](auto& state) { state.heading += 0.1; }); }) == 0);
  CHECK(kept_nodes(true, [](auto& world, auto&, auto&) {  // another agent in the same place
          auto const state = world.state(AgentId{3});
          auto const shape = world.roster().agents[3].shape;
          world.remove(AgentId{3});
          auto larger = shape;
          larger.rear += 1.0;
          world.add({.position = {state.x, state.y},
                     .heading = state.heading,
                     .speed = state.speed,
                     .shape = larger,
                     .behavior = IdmClassic{},
                     .id = AgentId{3}});
        }) == 0);
}

namespace {

/// A reward that fails at times.
struct Failing : TrafficReward {
  static inline bool fails = false;

  template <class World>
  [[nodiscard]] Judgement judge(World& world, Slot slot, double dt) const {
    if (fails) throw std::runtime_error("failed");
    return TrafficReward::judge(world, slot, dt);
  }
};

}  // namespace

TEST_CASE("a search that fails forgets its tree") {
  auto planner = keeping(Mcts<PredictionWorld, MacroActions, Failing>{}, 100);
  auto world = lane_change<Sim>(0, IdmClassic{});
  decltype(planner)::Workspace workspace;
  auto const report = planner.think(world.observe(ego), {}, workspace);
  REQUIRE(workspace.keep());
  REQUIRE(world.step(planner.options.step));
  world.set_state(ego, report.course[1].agents[0].state);
  Failing::fails = true;
  CHECK_THROWS_AS(static_cast<void>(planner.think(world.observe(ego), report.memory, workspace)), std::runtime_error);
  Failing::fails = false;
  planner.reward.progress -= 1.0;  // another game
  CHECK(planner.think(world.observe(ego), report.memory, workspace).result.kept_nodes == 0);
}

TEST_CASE("one that is parked does not choose") {
  auto planner = quick(Search{}, 50);
  planner.most_agents = 4;
  for (double const speed : {0.0, 12.0}) {
    Sim world(support::straight_road(2, 600.0), {.seed = 1});
    world.add({.position = {60, -5.25}, .speed = 12, .behavior = planner});
    world.add({.position = {90, -5.25}, .speed = speed, .behavior = IdmClassic{}});
    CHECK(report_of(planner, world).choosing.size() == (speed > 0.0 ? 2 : 1));
  }
}

TEST_CASE("an agent whose course is over does not choose, and does not prevent ego from planning") {
  auto world = lane_change<Sim>(0, IdmClassic{});
  auto planner = quick(Search{}, 100);
  planner.most_agents = 4;
  auto const before = report_of(planner, world).choosing;
  REQUIRE(before.size() > 1);
  put(world, before[1], [](auto& state) { state.y += 6.0; });
  auto const after = report_of(planner, world).choosing;
  CHECK(after.front() == ego);
  CHECK(std::ranges::count(after, before[1]) == 0);
}

TEST_CASE("with threads a planner repeats its results, also as a behaviour") {
  auto planner = quick(Search{}, 301);
  planner.options.threads = 3;
  auto world = lane_change<Sim>(0, planner), again = lane_change<Sim>(0, planner);
  Search::Workspace workspace, other;
  auto const report = planner.think(world.observe(ego), {}, workspace);
  CHECK(report.result.iterations == 301);
  CHECK(report.result.choice(0).action == report.result.variation[0]);
  auto const same = planner.think(world.observe(ego), {}, other);
  games::check_equal(same.result, report.result);
  // From three threads to one, and back, in the same workspace.
  planner.options.threads = 1;
  CHECK(planner.think(world.observe(ego), {}, other).result.iterations == 301);
  planner.options.threads = 3;
  CHECK(planner.think(world.observe(ego), {}, other).result.variation == report.result.variation);
  REQUIRE(world.step(0.2));
  REQUIRE(again.step(0.2));
  CHECK(world.frame() == again.frame());
  CHECK(world.state(ego) == report.course[1].agents[0].state);
}

TEST_CASE("searches in a warm world do not allocate") {
  using Domain = TrafficDomain<PredictionWorld, MacroActions, TrafficReward>;
  PredictionWorld world(support::straight_road(2, 600.0));
  world.add({.position = {60, -5.25}, .speed = 12, .behavior = MacroActions{}});
  for (int i = 0; i < 4; ++i) world.add({.position = {40.0 + 25.0 * i, -1.75}, .speed = 12, .behavior = IdmClassic{}});
  cambium::Slot const slot{};
  Domain domain(world, {&slot, 1}, MacroActions{}, {}, 0.2);
  auto const root = domain.root();
  TreeSearch<Domain> search(domain, {.horizon = 10}, {}, {}, {300});
  (void)search.run(root, 1);
  auto const before = support::allocations();
  (void)search.run(root, 1);
  CHECK(support::allocations() == before);
  (void)search.run(root, 2);
  CHECK(support::allocations() == before);
  MctsWorkspace<Domain, MctsOptions<>> workspace;
  (void)workspace.run(domain, {.budget = {300}}, 1);
  auto copy = domain;
  auto const copied = support::allocations();
  (void)workspace.run(std::move(copy), {.budget = {300}}, 1);
  CHECK(support::allocations() - copied < 16);  // a root, and the working memory of the new domain's world
}

TEST_CASE("beliefs are learnt from observations that come early or late, and the same") {
  for (double const headway : {0.8, 3.2}) {
    std::size_t const right = headway < 1.0 ? 0 : 3;
    double const interval = BeliefParameters{}.interval,
                 on_time = learnt_about(headway, 8, interval).probability(right);
    for (double const jitter : {0.0, 0.001, 0.05}) {
      CAPTURE(jitter);
      auto const belief = learnt_about(headway, 8, interval, jitter);
      CHECK(belief.most_likely() == right);
      CHECK(belief.probability(right) == doctest::Approx(on_time).epsilon(0.1));
    }
  }
}

TEST_CASE("it learns however often it is called") {
  for (double const period : {1.0 / 30.0, 0.05, 0.1, 0.3, 0.31, 0.5, 1.0}) {
    CAPTURE(period);
    auto const belief = learnt_about(2.5, static_cast<int>(std::ceil(5.0 / period)), period);
    CHECK(belief.most_likely() == 2);
    CHECK(belief.probability(2) > 0.5);
  }
}

namespace {

/// A user's hypotheses: the driver keeps its speed, or brakes.
struct MayBrake {
  struct Memory {
    bool brakes = false;
    friend bool operator==(Memory, Memory) = default;
  };
  std::size_t count = 2;

  static constexpr auto parameters() { return parameter_list(); }
  [[nodiscard]] std::size_t hypotheses() const { return count; }
  void assume(Memory& memory, std::size_t number, double) const { memory.brakes = number == 1; }
  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory const& memory, double dt) const {
    return plan_along_lane(view, ConstantAcceleration{memory.brakes ? -1.0 : 0.0}.motion(view.state().speed, dt), dt);
  }
};

}  // namespace

TEST_CASE("a planner learns which of a user's own hypotheses holds") {
  using Predicted = World<BehaviorSet<MacroActions, MayBrake>, InterpolateExecution, SingleTrack>;
  using Curious = Mcts<Predicted, MacroActions, TrafficReward, MayBrake>;
  for (bool const brakes : {false, true}) {
    Predicted::WithBehaviors<BehaviorSet<Curious, ConstantAcceleration>> world(support::straight_road(1, 2000.0));
    world.add({.position = {60, -1.75}, .speed = 12, .behavior = quick(Curious{}, 50)});
    world.add({.position = {110, -1.75}, .speed = 14, .behavior = ConstantAcceleration{brakes ? -1.0 : 0.0}});
    for (int step = 0; step < 6; ++step) REQUIRE(world.step(0.2));
    auto const* belief = world.memory<Curious>(ego).belief(AgentId{1});
    REQUIRE(belief != nullptr);
    CHECK(belief->size() == 2);
    CHECK(belief->probability(brakes ? 1 : 0) > 0.95);
  }
  for (std::size_t const count : {0u, 9u})
    CHECK_THROWS_WITH_AS(check_parameters(Curious{.others = {count}}, "planner"), doctest::Contains("give 1 to 8"),
                         ParameterError);
}

TEST_CASE("an observed speed changes a belief by its normal distribution about what each headway predicts") {
  auto planner = quick(Learning{}, 20);
  double const interval = BeliefParameters{}.interval;
  planner.belief = {.forgetting = 0.0, .floor = 0.0, .speed_deviation = 0.08};
  for (double const late : {0.0, 0.05, -0.05}) {
    CAPTURE(late);
    Sim world(support::straight_road(1, 2000.0));
    world.add({.position = {60, -1.75}, .speed = 12, .behavior = IdmClassic{}});
    auto const other =
        world.add({.position = {90, -1.75}, .speed = 14, .behavior = IdmClassic{.law = {.time_headway = 1.7}}});
    world.add({.position = {125, -1.75}, .speed = 12, .behavior = IdmClassic{.law = {.desired_speed = 12}}});
    std::vector<double> predicted;  // by each region's headway, carried on to when it observes
    for (std::size_t r = 0; r < static_cast<std::size_t>(planner.others.regions); ++r) {
      Sim trial = world;
      auto driver = planner.others.driver;
      driver.law.time_headway = planner.others.headway(r, 0.5);
      trial.set_behavior(other, driver);
      REQUIRE(trial.step(interval));
      double const speed = trial.state(other).speed;
      predicted.push_back(speed + late / interval * (speed - 14.0));
    }
    Learning::Workspace workspace;
    auto memory = planner.think(world.observe(ego), {}, workspace).memory;
    REQUIRE(world.step(interval + late));
    memory = planner.think(world.observe(ego), memory, workspace).memory;
    auto const* belief = memory.belief(other);
    REQUIRE(belief != nullptr);
    REQUIRE(belief->size() == predicted.size());
    std::vector<double> likelihoods;
    double sum = 0.0;
    for (double const speed : predicted) {
      double const off = (world.state(other).speed - speed) / planner.belief.speed_deviation;
      sum += likelihoods.emplace_back(std::exp(-0.5 * off * off));
    }
    for (std::size_t r = 0; r < predicted.size(); ++r)
      CHECK(belief->probability(r) == doctest::Approx(likelihoods[r] / sum).epsilon(1e-3));
    CHECK(belief->probability(belief->most_likely()) > 1.5 / static_cast<double>(predicted.size()));
    CHECK(belief->probability(belief->most_likely()) < 0.995);  // all of them count
  }
}

TEST_CASE("it learns about agents that do not choose while others choose with it, under a limit on risk") {
  auto planner = quick(Learning{}, 200);
  planner.most_agents = 3;
  planner.options.search.constraint.limit = 0.2;
  auto world = lane_change<Sim>(0, IdmClassic{});
  auto const report = report_of(planner, world);
  REQUIRE(report.choosing.size() == 3);
  CHECK(report.result.agents == 3);
  for (auto const& agent : world.roster().agents) {
    bool const chooses = std::ranges::count(report.choosing, agent.id) > 0;
    CHECK((report.memory.belief(agent.id) != nullptr) == !chooses);
  }
}

TEST_CASE(
    "slow drivers on a free road, and those that change lanes, do not choose; the slow ones are expected to stay "
    "slow") {
  auto const with_other = [](double speed, double heading, std::optional<double> leader = {}) {
    Sim world(support::straight_road(2, 2000.0));
    world.add({.position = {60, -5.25}, .speed = 12, .behavior = IdmClassic{}});
    world.add({.position = {95, -5.25}, .heading = heading, .speed = speed, .behavior = IdmClassic{}});
    if (leader) world.add({.position = {110, -5.25}, .speed = *leader, .behavior = IdmClassic{}});
    return world;
  };
  auto cooperative = quick(Search{}, 50);
  cooperative.most_agents = 2;
  auto const chooses = [&](Sim world) { return report_of(cooperative, world).choosing.size() == 2; };
  CHECK(chooses(with_other(12.0, 0.0)));
  CHECK_FALSE(chooses(with_other(5.0, 0.0)));
  CHECK(chooses(with_other(5.0, 0.0, 5.0)));
  CHECK_FALSE(chooses(with_other(12.0, 0.1)));

  Learning::Workspace learning;
  auto const speed_later = [&](std::optional<double> leader) {
    auto world = with_other(5.0, 0.0, leader);
    auto const course = quick(Learning{}, 50).think(world.observe(ego), {}, learning).course;
    return course.back().agents[Slot{1}].state.speed;
  };
  CHECK(speed_later({}) == doctest::Approx(5.0).epsilon(0.05));
  CHECK(speed_later(12.0) > 7.0);  // its leader may have slowed it down
}

TEST_CASE("who is on foot is expected to go on at a walk, and does not choose") {
  Sim world(support::straight_road(2, 400.0));
  world.add({.position = {60, -5.25}, .speed = 10, .behavior = IdmClassic{}});
  auto const walker = world.add({.position = {95, -12},
                                 .heading = M_PI / 2,
                                 .speed = 1.4,
                                 .behavior = IdmClassic{},
                                 .way = {{95, -12}, {95, 12}}});
  auto planner = quick(Search{}, 50);
  planner.most_agents = 2;
  auto const report = report_of(planner, world);
  CHECK(report.choosing == std::vector{ego});
  auto const slot = world.slot_of(walker);
  for (auto const& frame : report.course) CHECK(frame.agents[slot].state.speed <= 1.41);
  world.set_state(walker, {.x = 95, .y = -12, .heading = M_PI / 2, .speed = 0.0});
  auto const waiting = report_of(planner, world);
  for (auto const& frame : waiting.course) CHECK(frame.agents[slot].state.speed <= 0.11);
}

TEST_CASE("it plans among vehicles that are too large for the conflicts that its others heed") {
  Sim world(support::own_map("intersection_4way.xodr"));
  world.add({.position = {-60, -1.75}, .speed = 8, .behavior = IdmClassic{}});
  geometry::Shape const convoy{.front = 16.0, .rear = 8.0, .left = 1.4, .right = 1.4};
  world.add({.position = {60, 1.75}, .heading = M_PI, .speed = 8, .shape = convoy, .behavior = IdmClassic{}});
  using Ruled = Mcts<World<BehaviorSet<MacroActions, Intersection>, InterpolateExecution, SingleTrack>, MacroActions,
                     TrafficReward, Intersection>;
  CHECK(report_of(quick(Ruled{}, 20), world).chosen);
}

TEST_CASE("beliefs start anew if the number of headway regions changes") {
  auto world = lane_change<Sim>(0, IdmClassic{});
  auto planner = quick(Learning{}, 20);
  planner.others.regions = 8;
  auto memory = report_of(planner, world).memory;
  REQUIRE(world.step(0.2));
  planner.others.regions = 2;
  memory = report_of(planner, world, memory).memory;
  for (std::uint32_t id = 1; id < 6; ++id) {
    auto const* belief = memory.belief(AgentId{id});
    REQUIRE(belief != nullptr);
    CHECK(belief->size() == 2);
  }
}

TEST_CASE("a search does not brake for the end of the map") {
  auto const speed_before_end = [](double x) {
    Sim world(support::straight_road(1, 600.0));
    auto planner = quick(Search{});
    planner.reward = TrafficReward{.progress = 1.0};
    world.add({.position = {x, -1.75}, .speed = 15, .behavior = planner});
    for (int i = 0; i < 5; ++i) REQUIRE(world.step(0.2));
    return world.state(ego).speed;
  };
  CHECK(speed_before_end(540.0) > 14.0);
  CHECK(speed_before_end(540.0) == doctest::Approx(speed_before_end(100.0)).epsilon(0.3));
}

TEST_CASE("at its goal ego drives on without a manoeuvre, whatever its first action is") {
  auto const map = support::straight_road(2, 600.0);
  constexpr MacroAction left{MacroAction::Kind::change_left, 0.0}, right{MacroAction::Kind::change_right, 0.0},
      on{MacroAction::Kind::stay, 0.0}, brake{MacroAction::Kind::stay, -5.0};
  for (auto const& [first, second] : {std::pair{left, on}, {brake, on}, {left, brake}, {left, right}}) {
    Sim world(map);
    auto planner = quick(Search{});
    planner.actions = MacroActions::of({first, second});
    world.add({.position = {60, -5.25},
               .speed = 12,
               .behavior = planner,
               .goal = LaneLimits{.lane = map->nearest_lane({20, -5.25, 0})->lane}});
    REQUIRE(world.reached_goal(ego));
    for (int i = 0; i < 10; ++i) REQUIRE(world.step(0.2).failed == 0);
    CHECK(world.state(ego).speed == doctest::Approx(12.0));
    CHECK(world.state(ego).y == doctest::Approx(-5.25));
  }
}

TEST_CASE("headways of unknown agents are drawn uniformly") {
  Sim world(support::straight_road(1, 2000.0));
  world.add({.position = {60, -1.75}, .speed = 12, .behavior = IdmClassic{}});
  for (int i = 1; i <= 9; ++i)  // six near, three far away
    world.add({.position = {60.0 + (i > 6 ? 100.0 : 9.0) * i, -1.75}, .speed = 12, .behavior = IdmClassic{}});
  auto const planner = quick(Learning{}, 20);
  Learning::Workspace workspace;
  auto const memory = planner.think(world.observe(ego), {}, workspace).memory;
  CHECK(memory.belief(AgentId{6}) != nullptr);
  CHECK(memory.belief(AgentId{7}) == nullptr);
  RandomStream random(1, 0, 0);
  int const draws = 4000;
  std::vector<double> sums(10), squares(10);
  for (int i = 0; i < draws; ++i) {
    auto state = workspace.domain().root();
    workspace.domain().sample_root(state, random);
    for (std::size_t k = 1; k < 10; ++k) {
      double const headway =
          std::get_if<HeadwayHypotheses<IdmClassic>::Memory>(&state.frame.agents[k].memory)->time_headway;
      sums[k] += headway;
      squares[k] += headway * headway;
    }
  }
  for (std::size_t k = 1; k < 10; ++k) {
    double const mean = sums[k] / draws;
    CHECK(mean == doctest::Approx(2.0).epsilon(0.05));
    CHECK(squares[k] / draws - mean * mean == doctest::Approx(9.0 / 12).epsilon(0.1));  // uniform over 3 s
  }
}

namespace {

/// Rewards every metre; each step faster than 13 m/s carries a risk.
struct Hurry {
  template <class World>
  [[nodiscard]] Judgement judge(World const& world, Slot slot, double dt) const {
    double const speed = world.frame().agents[slot].state.speed;
    return {.reward = 0.1 * speed * dt, .cost = speed > 13.0 ? 0.1 : 0.0};
  }
  static constexpr auto parameters() { return parameter_list(); }
};

}  // namespace

TEST_CASE("a constraint on risk overrules the reward") {
  using Hurried = Mcts<PredictionWorld, MacroActions, Hurry>;
  using HurriedSim = World<BehaviorSet<Hurried>, InterpolateExecution, SingleTrack>;
  auto const driven = [](double risk) {
    auto planner = quick(Hurried{}, 500);
    planner.options.search.constraint = {.weight = 0.0, .limit = risk};
    planner.options.hold = 1;
    planner.options.search.horizon = 15;
    HurriedSim world(support::straight_road(1, 900.0));
    world.add({.position = {60, -1.75}, .speed = 12, .behavior = planner});
    double fastest = 0.0;
    for (int step = 0; step < 30; ++step) {
      REQUIRE(world.step(0.2));
      fastest = std::max(fastest, world.state(ego).speed);
    }
    return fastest;
  };
  CHECK(driven(1.0) > 16.0);
  double const careful = driven(0.05);
  CHECK(careful < 13.6);
  CHECK(careful > 10.0);
}

TEST_CASE("a report says which actions are too risky") {
  constexpr double limit = 0.02;
  auto planner = quick(Search{}, 400);
  planner.options.search.constraint.limit = limit;
  auto world = lane_change<Sim>(0, IdmClassic{});
  auto const report = report_of(planner, world);
  auto const arms = report.result.of(0);
  int risky = 0;
  for (std::size_t i = 0; i < arms.size(); ++i) {
    double const risk = (arms[i].mean_cost * arms[i].visits + 1.0) / (arms[i].visits + 2.0);
    bool const is_refused = report.candidates[i].refused.starts_with("risk 0.");
    CHECK(is_refused == (risk > limit && i != report.chosen));
    risky += is_refused;
  }
  CHECK(risky > 0);
}

TEST_CASE("think says why there is nothing to plan") {
  auto const says = [](auto const& planner, auto const& change, char const* why) {
    auto world = lane_change<Sim>(0, IdmClassic{});
    put(world, ego, change);
    while (world.state(ego).x > 590.0 && world.status(ego) == AgentStatus::driving) REQUIRE(world.step(0.2));
    CHECK_THROWS_WITH_AS((void)report_of(planner, world), doctest::Contains(why), SearchError);
  };
  auto const planner = quick(Search{});
  says(
      planner, [](auto& at) { at.x = 595.0; },
      "agent 0: it is not in the predicted world, or not in traffic; plan for agents that drive");
  says(
      planner, [](auto& at) { at.y = -1.75; },
      "agent 0: the course is over already (agent 0 is at its goal); ask the evaluators before you plan");
  says(
      planner, [](auto& at) { at.x = 95.0; }, "agent 0 touches agent 5");
  says(
      planner, [](auto& at) { at.y = -9.5; }, "agent 0 is off the road");
  auto changing = planner;  // there is no lane to the left of the left one
  changing.actions = MacroActions::of({{MacroAction::Kind::change_left}});
  changing.reward.goal = 0.0;
  says(
      changing, [](auto& at) { at.y = -1.75; }, "agent 0: none of its actions is available");
  auto const refuses = [](auto const& change) {
    auto faulty = quick(Search{});
    change(faulty);
    CHECK_THROWS_AS((void)report_of(faulty, lane_change<Sim>(0, IdmClassic{})), ParameterError);
  };
  refuses([](auto& faulty) { faulty.options.budget.iterations = 0; });
  refuses([](auto& faulty) { faulty.options.threads = 65; });
  refuses([](auto& faulty) { faulty.most_agents = 0; });
}

TEST_CASE("a planner does not fail if it leaves the map within a step or steps for an instant") {
  for (double const dt : {20.0, 1e-6, 1e-9}) {
    Sim world(support::straight_road(1, 200.0));
    auto planner = quick(Search{}, 20);
    planner.reward = {.progress = 1.0};
    auto const id = world.add({.position = {60, -1.75}, .speed = 12, .behavior = planner});
    CHECK(world.step(dt).failed == 0);
    CHECK((world.record(id).status == AgentStatus::left_map) == (dt == 20.0));
    if (dt == 20.0) CHECK(std::string(to_string(world.record(id).status)) == "left the map");
  }
}

TEST_CASE("an agent in an oncoming lane has left the road") {
  PredictionWorld world(support::two_way_road(300.0));
  TrafficReward const reward{.off_road = -10.0, .progress = 0.1, .speed_deviation = 0.0};
  world.add({.position = {60, -1.75}, .heading = 0.0, .speed = 10});
  CHECK(reward.judge(world, cambium::Slot{}, 0.2).reward == doctest::Approx(0.2));
  world.set_state(ego, {.x = 60, .y = 1.75, .heading = 0.0, .speed = 10});
  CHECK(reward.judge(world, cambium::Slot{}, 0.2).reward == doctest::Approx(-10.0));
  CHECK(reward.judge(world, cambium::Slot{}, 0.2).ends);
}

TEST_CASE("a lane change continues from search to search, and ego keeps its lane past the goal") {
  auto const map = support::straight_road(2, 600.0);
  auto planner = quick(Search{});
  planner.actions.course = {.duration = 2.0, .shortest_duration = 1.5};
  Sim world(map, {.seed = 3});
  world.add({.position = {60, -5.25},
             .speed = 12,
             .behavior = planner,
             .goal = LaneLimits{.lane = map->nearest_lane({20, -1.75, 0})->lane, .left = 0.5, .right = 0.5}});
  double first = 0.0, farthest = -5.25;
  for (int step = 1; step <= 40; ++step) {
    REQUIRE(world.step(0.2).failed == 0);
    if (first == 0.0 && world.reached_goal(ego)) first = 0.2 * step;
    farthest = std::max(farthest, world.state(ego).y);
  }
  CHECK(first > 0.0);
  CHECK(first < 3.0);
  CHECK(farthest < -1.75 + 0.1);
  CHECK(std::abs(world.state(ego).y + 1.75) < 0.1);
}
