// Laws that hold for every planner: the shipped ones and a user's own, written with the public interface only.
#include <optional>
#include <set>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "cambium/observer/parametric.hpp"
#include "planner/planner_fixtures.hpp"
#include "support/allocations.hpp"

using namespace planner_fixtures;

namespace {

/// A deadline that has passed before planning begins.
struct SpentBudget {
  static constexpr char const* name = "spent_budget";
  static constexpr auto parameters() { return parameter_list(); }

  void start() {}
  [[nodiscard]] bool goes_on(std::size_t) const { return false; }
};

/// A user's actions: speeds to reach. A user's behaviour carries them out.
struct ReachSpeed {
  struct Memory {
    float target = 10.0f;
    friend bool operator==(Memory, Memory) = default;
  };
  static constexpr auto parameters() { return parameter_list(); }
  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory& memory, double dt) const {
    double const speed = view.state().speed, target = static_cast<double>(memory.target);
    return plan_along_lane(view, ConstantAcceleration{std::clamp(target - speed, -3.0, 1.5)}.motion(speed, dt), dt);
  }
};

struct Speeds {
  double highest = 12.0;
  static constexpr auto parameters() {
    return parameter_list(parameter("highest", &Speeds::highest, "m/s", Range{0, 50}, "of 4 speeds"));
  }
};

}  // namespace

template <>
struct cambium::ActionSet<Speeds> {
  using Behavior = ReachSpeed;
  using Choice = int;
  static constexpr std::size_t capacity = 4;

  static Behavior behavior(Speeds const&) { return {}; }
  template <class View>
  static std::size_t list(Speeds const&, View const&, Behavior::Memory, std::span<Choice> out) {
    for (int i = 0; i < 4; ++i) out[static_cast<std::size_t>(i)] = i;
    return 4;
  }
  static void set(Behavior::Memory& memory, Choice choice) { memory.target = 4.0f * static_cast<float>(choice); }
  static double action(Speeds const& speeds, Choice choice) { return speeds.highest * choice / 3.0; }
  static Choice usual(Speeds const&) { return 3; }
  static std::string text(Speeds const&, Choice choice) { return "speed " + std::to_string(choice); }
  static bool goes_on_alike(Behavior::Memory, Behavior::Memory) { return true; }
};

namespace {

/// A user's planner: among a few accelerations it picks the one that gets farthest without a collision, or brakes by
/// the first one.
struct Greedy {
  using World = PredictionWorld;
  using Memory = MacroActions::Memory;
  using Workspace = CandidateWorkspace<World, PlannerCandidate>;
  using Report = CandidateReport<World, Memory, PlannerCandidate>;

  double horizon = 3.0;
  double step = 0.2;
  IterationBudget budget{4};

  static constexpr char const* name = "greedy";
  static constexpr auto parameters() {
    return parameter_list(parameter("horizon", &Greedy::horizon, "s", Range{0.2, 60}, "duration of the predictions"),
                          parameter("step", &Greedy::step, "s", Range{0.01, 1}, "time step of the predictions"),
                          parameter("budget", &Greedy::budget, "how many accelerations are tried"));
  }

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory& memory, double dt, Workspace& workspace) const {
    return plan_by_candidates(*this, view, memory, dt, workspace);
  }
  template <class View>
  [[nodiscard]] Report think(View const& view, Memory const& memory, Workspace& workspace) const {
    return think_by_candidates(*this, view, memory, workspace);
  }

  template <class View>
  [[nodiscard]] SearchProblem compare(View const& view, Memory const&, Workspace& workspace,
                                      IterationBudget& clock) const {
    using enum MacroAction::Kind;
    auto const actions = MacroActions::of({{stay, -5.0}, {stay, 0.0}, {stay, -2.0}, {stay, 1.5}});
    if (!workspace.predict(view, actions, IdmClassic{})) return SearchProblem::not_in_world;
    auto& tried = workspace.candidates;
    while (tried.size() < actions.size() && workspace.goes_on(clock, tried.size())) {
      auto const number = tried.size();
      tried.push_back({"accelerate by " + std::to_string(actions.actions[number].acceleration)});
      try_out(workspace, number, nullptr);
      bool const is_best = !workspace.chosen || tried[number].score > tried[*workspace.chosen].score;
      if (tried[number].refused.empty() && is_best) workspace.chosen = number;
    }
    return SearchProblem::none;
  }

  template <class View>
  [[nodiscard]] Plan<View> drive(View const& view, Memory& memory, double dt, Workspace& workspace) const {
    begin(workspace, workspace.chosen.value_or(0));
    return workspace.drive<MacroActions>(view, dt, step, memory);
  }
  template <class View>
  [[nodiscard]] auto foresee(View const& view, Memory const&, Workspace& workspace,
                             std::optional<std::size_t> candidate) const {
    workspace.check_foreseen(view, candidate);
    std::vector course{workspace.start};
    try_out(workspace, candidate ? *candidate : workspace.chosen.value_or(0), &course);
    return course;
  }
  template <class View>
  [[nodiscard]] PlannerCandidate entry(View const&, Workspace const&, PlannerCandidate const& tried) const {
    return tried;
  }

 private:
  static void begin(Workspace& workspace, std::size_t action) {
    workspace.world->restore(workspace.start);
    workspace.world->memory<MacroActions>(workspace.world->roster().agents[workspace.ego].id).choose(action);
  }
  void try_out(Workspace& workspace, std::size_t action, std::vector<World::FrameType>* course) const {
    begin(workspace, action);
    auto const& agents = workspace.world->frame().agents;
    double const start = agents[workspace.ego].lane.s;
    workspace.simulate(static_cast<int>(std::lround(horizon / step)), step, course, [&](int) {
      auto const end = course_end(*workspace.world, workspace.ego);
      auto& tried = workspace.candidates[action];
      tried.score = agents[workspace.ego].lane.s - start;
      tried.refused = end == CourseEnd::none || end == CourseEnd::over ? "" : "ends badly";
      return end == CourseEnd::none;
    });
  }
};

/// A goal of a user's own.
struct OwnLimits {
  LaneLimits limits;
  [[nodiscard]] std::vector<LaneId> lanes(Map const&) const { return {limits.lane}; }
  [[nodiscard]] bool at_goal(GoalSituation const& at) const { return cambium::at_goal(Goal(limits), at); }
};

using Search = Mcts<PredictionWorld>;
using OwnActions = Mcts<World<BehaviorSet<ReachSpeed, IdmClassic>, InterpolateExecution, SingleTrack>, Speeds>;
#define ALL_PLANNERS Search, Learning, OwnActions, Proposal, PolicyTree, Frenet, Greedy

/// A planner with settings for quick tests.
template <class P>
P quick() {
  P planner;
  if constexpr (requires { planner.options; }) {
    planner.options.budget.iterations = 100;
    planner.reward.progress = 1.0;
  }
  return planner;
}

/// How far it predicts [s].
template <class P>
double horizon_of(P const& planner) {
  if constexpr (requires { planner.options; })
    return planner.options.step * planner.options.hold * planner.options.search.horizon;
  else if constexpr (requires { planner.layers; })
    return planner.layers * planner.layer_duration;
  else
    return planner.horizon;
}

/// One world for all planners, so that it is compiled once, or one of its own.
using Planners = BehaviorSet<ALL_PLANNERS, IdmClassic>;
template <class Planner, class Observer = PerfectObserver>
using Sim = World<
    std::conditional_t<Planners::contains<Planner> && Observer::perfect, Planners, BehaviorSet<Planner, IdmClassic>>,
    InterpolateExecution, SingleTrack, Observer>;

#define COMMA ,

/// Two lanes in a wide bend, with ego on the right one and six other agents around it.
template <class World, class Planner>
World traffic(std::uint64_t seed, Planner const& planner, typename World::Observer const& observer = {}) {
  constexpr double curvature = 0.004, radius = 1.0 / curvature;
  World world(support::straight_road(2, 900.0, curvature), {.seed = seed});
  auto const place = [&](double s, double lateral) {
    double const turn = s * curvature, r = radius - lateral;
    return geometry::Point(r * std::sin(turn), radius - r * std::cos(turn));
  };
  RandomStream random(seed, 0, 0);
  world.add({.position = place(80, -5.25), .speed = 11.0, .behavior = planner, .observer = observer});
  for (int i = 0; i < 6; ++i) {
    double const desired = Uniform{6.0, 15.0}(random), s = 20.0 + 40.0 * (i / 2) + Uniform{0.0, 12.0}(random);
    world.add({.position = place(i % 2 == 0 ? s : s + (s > 70.0 ? 25.0 : 0.0), i % 2 == 0 ? -1.75 : -5.25),
               .speed = 0.8 * desired,
               .behavior = IdmClassic{.law = {.desired_speed = desired}}});
  }
  return world;
}

template <class... Planners>
constexpr bool are_planners = (PlannerModel<Planners, typename Sim<Planners>::View> && ...);
static_assert(are_planners<ALL_PLANNERS>);
static_assert(!PlannerModel<IdmClassic, Sim<Search>::View>);

}  // namespace

TEST_CASE_TEMPLATE("in random traffic it makes progress without a collision and on the road, whatever the step",
                   Planner, Proposal, PolicyTree, Frenet) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    CAPTURE(seed);
    double const dt = seed % 3 == 0 ? 0.1 : seed % 3 == 1 ? 0.2 : 0.5;
    auto world = traffic<Sim<Planner>>(seed, Planner{});
    double way = 0.0;
    for (int i = 0; i < std::lround(25.0 / dt); ++i) {
      REQUIRE(world.step(dt));
      REQUIRE_FALSE(AnyCollision{}(world));
      REQUIRE_FALSE(OffRoad{}(world, world.slot_of(ego)));
      way += world.state(ego).speed * dt;
    }
    CHECK(way > 100.0);
  }
}

TEST_CASE_TEMPLATE("a prediction can assume it for ego and for others, and then comes true", Planner, Proposal,
                   PolicyTree, Frenet) {
  auto world = traffic<Sim<Planner>>(1, Planner{});
  using Set = typename Sim<Planner>::Behaviors;
  for (auto const& agent : world.roster().agents) world.set_behavior(agent.id, Planner{});
  auto prediction = world.observe(ego).predict(predict_all_as<Set>(Planner{}));
  for (int i = 0; i < 10; ++i) {
    REQUIRE(world.step(0.2));
    REQUIRE(prediction.step(0.2));
  }
  for (std::size_t i = 0; i < world.size(); ++i)
    CHECK(world.frame().agents[i].state == prediction.frame().agents[i].state);
}

TEST_CASE_TEMPLATE("it plans under noisy observation", Planner, Proposal, PolicyTree, Frenet) {
  ObservationNoise const noise{.along = 0.2, .across = 0.05, .heading = 0.01, .speed = 0.2};
  auto world = traffic<Sim<Planner, ParametricObserver>>(2, Planner{}, {.own = noise, .others = noise});
  for (int i = 0; i < 50; ++i) {
    REQUIRE(world.step(0.2));
    REQUIRE_FALSE(Collision{}(world, world.slot_of(ego)));
  }
  CHECK(world.state(ego).speed > 2.0);
}

TEST_CASE_TEMPLATE("it changes to the lane of its goal in traffic", Planner, PolicyTree, Frenet) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    CAPTURE(seed);
    auto world = lane_change<Sim<Planner>>(seed, Planner{});
    for (int i = 0; i < 120 && !world.reached_goal(ego); ++i) REQUIRE(world.step(0.2));
    CHECK(world.reached_goal(ego));
  }
}

TEST_CASE_TEMPLATE("it plans for a goal of a user's own as for the same shipped one", Planner, ALL_PLANNERS) {
  auto const report = [](auto const& wrapped) {
    auto const map = support::straight_road(2, 600.0);
    LaneLimits const limits{.lane = map->nearest_lane({20, -1.75, 0})->lane, .left = 0.5, .right = 0.5};
    Sim<Planner> world(map, {.seed = 1});
    world.add({.position = {60, -5.25}, .speed = 12, .behavior = quick<Planner>(), .goal = wrapped(limits)});
    for (double const x : {20.0, 48.0, 85.0}) world.add({.position = {x, -1.75}, .speed = 12.5});
    return report_of(quick<Planner>(), world);
  };
  auto const shipped = report([](LaneLimits const& limits) { return Goal(limits); });
  auto const own = report([](LaneLimits const& limits) { return Goal(OwnLimits{limits}); });
  auto const none = report([](LaneLimits const&) { return Goal(); });
  REQUIRE(own.candidates.size() == shipped.candidates.size());
  bool is_other = none.candidates.size() != own.candidates.size();
  for (std::size_t i = 0; i < own.candidates.size(); ++i) {
    CHECK(own.candidates[i].name == shipped.candidates[i].name);
    CHECK(own.candidates[i].score == shipped.candidates[i].score);
    is_other = is_other || none.candidates[i].score != own.candidates[i].score;
  }
  CHECK(own.chosen == shipped.chosen);
  CHECK(own.course.back() == shipped.course.back());
  // The others cannot change lanes, or know nothing of goals.
  if (std::is_same_v<Planner, Search> || std::is_same_v<Planner, Learning> || std::is_same_v<Planner, PolicyTree> ||
      std::is_same_v<Planner, Frenet>)
    CHECK(is_other);
}

TEST_CASE_TEMPLATE("it repeats its motion exactly, also in a copied world", Planner, ALL_PLANNERS) {
  auto world = traffic<Sim<Planner>>(1, quick<Planner>()), again = traffic<Sim<Planner>>(1, quick<Planner>());
  for (int i = 0; i < 6; ++i) REQUIRE(world.step(0.2));
  auto copy = world;
  for (int i = 0; i < 6; ++i) {
    REQUIRE(world.step(0.2));
    REQUIRE(copy.step(0.2));
  }
  for (int i = 0; i < 12; ++i) REQUIRE(again.step(0.2));
  CHECK(world.frame() == copy.frame());
  CHECK(world.frame() == again.frame());
}

TEST_CASE_TEMPLATE("once warm, hardly anything but the prediction allocates", Planner, Proposal, PolicyTree, Frenet) {
  auto world = traffic<Sim<Planner>>(1, Planner{});
  for (int i = 0; i < 8; ++i) REQUIRE(world.step(0.2));
  auto const before = support::allocations();
  REQUIRE(world.step(0.2));
  CHECK(support::allocations() - before < 60);  // for dozens of simulations
}

namespace {

/// Checks that ego is in each frame of a report's course where its state says, as it is in a world: in the lane that
/// holds it, at the place and with the acceleration that belong to the state.
template <class World, class Report>
void check_places(World const& world, Report const& report) {
  auto const slot = world.slot_of(ego);
  auto const& road = *world.roster().agents[slot].road;
  for (std::size_t k = 1; k < report.course.size(); ++k) {
    CAPTURE(k);
    auto const &now = report.course[k].agents[slot], &before = report.course[k - 1].agents[slot];
    if (now.status != AgentStatus::driving) break;
    auto const& corridor = road.corridors[now.lane.corridor];
    auto const at = map::locate(road, now.lane.corridor, {now.state.x, now.state.y, now.state.heading});
    CHECK(now.lane.s == doctest::Approx(at.s).epsilon(1e-6));
    CHECK(std::abs(now.lane.lateral - at.lateral) < 1e-6);
    CHECK(std::abs(now.lane.heading_error - at.heading_error) < 1e-6);
    auto const sides = corridor.widths_at(at.s);
    CHECK(at.lateral < sides.left + 0.01);
    CHECK(-at.lateral < sides.right + 0.01);
    double const dt = now.state.time - before.state.time;
    CHECK(std::abs(now.action.acceleration - (now.state.speed - before.state.speed) / dt) < 0.5);
  }
}

}  // namespace

TEST_CASE_TEMPLATE("its report has a course up to the horizon, and the reasons", Planner, ALL_PLANNERS) {
  auto const planner = quick<Planner>();
  double const step = step_of(planner), horizon = horizon_of(planner);
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    CAPTURE(seed);
    auto world = traffic<Sim<Planner>>(seed, planner);
    auto const report = report_of(planner, world);
    REQUIRE(report.course.size() > 1);
    CHECK(report.course.front().time == world.time());
    CHECK(report.course.back().time == doctest::Approx(world.time() + horizon));
    for (std::size_t k = 1; k < report.course.size(); ++k)
      CHECK(report.course[k].time == doctest::Approx(report.course[k - 1].time + step));
    CHECK(report.agents.size() == world.size());
    for (auto const& frame : report.course) CHECK(frame.agents.size() == report.agents.size());
    CHECK(report.candidates.size() > 1);
    CHECK_FALSE(report.is_cut_short);
    std::set<std::string> names;
    for (auto const& candidate : report.candidates) {
      CHECK(std::isfinite(candidate.score));
      CHECK_FALSE(candidate.name.empty());
      names.insert(candidate.name);
    }
    CHECK(names.size() == report.candidates.size());
    REQUIRE(report.chosen);
    CHECK(report.candidates[*report.chosen].refused.empty());
    CHECK(report.decidedness >= 0.0);
    CHECK(report.decidedness <= 1.0);
    check_places(world, report);
    // It drives the start of that course; afterwards its memory equals that of the report.
    REQUIRE(world.step(step));
    auto const slot = world.slot_of(ego);
    auto planned = report.course[1].agents[slot].state;
    planned.time = world.state(ego).time;
    CHECK(world.state(ego) == planned);
    CHECK(world.template memory<Planner>(ego) == report.memory);
  }
}

TEST_CASE_TEMPLATE("its candidates are explained by their paths, and by whom they meet", Planner, ALL_PLANNERS) {
  auto const planner = quick<Planner>();
  Sim<Planner> world(support::straight_road(2, 900.0));
  world.add({.position = {80, -5.25}, .speed = 15.0, .behavior = planner});
  auto const slow =
      world.add({.position = {110, -5.25}, .speed = 5.0, .behavior = IdmClassic{.law = {.desired_speed = 5.0}}});
  auto const beside =
      world.add({.position = {40, -1.75}, .speed = 20.0, .behavior = IdmClassic{.law = {.desired_speed = 20.0}}});
  world.add({.position = {50, -5.25}, .speed = 15.0});  // behind it, in its lane
  world.add({.position = {500, -5.25}, .speed = 15.0});
  typename Planner::Workspace workspace;
  auto report = planner.think(world.observe(ego), {}, workspace);
  explain(planner, world.observe(ego), {}, workspace, report);
  auto const slot = world.slot_of(ego);
  std::size_t behind_slow = 0;
  for (auto const& candidate : report.candidates) {
    CAPTURE(candidate.name);
    REQUIRE(candidate.path.size() == report.course.size());
    CHECK(candidate.path.front() == world.state(ego));
    CHECK(candidate.path.back().time == doctest::Approx(report.course.back().time));
    CHECK((is_valid(candidate.because) ? candidate.time_apart <= 3.0 + same_time : std::isinf(candidate.time_apart)));
    CHECK((candidate.because == none<AgentId> || candidate.because == slow || candidate.because == beside));
    behind_slow += candidate.because == slow;
  }
  CHECK(behind_slow > 0);
  REQUIRE(report.chosen);
  for (std::size_t k = 0; k < report.course.size(); ++k)
    CHECK(report.candidates[*report.chosen].path[k] == report.course[k].agents[slot].state);
  // There is no such candidate, or it has planned for another agent.
  CHECK_THROWS_AS((void)planner.foresee(world.observe(ego), {}, workspace, report.candidates.size()), SearchError);
  CHECK_THROWS_AS((void)planner.foresee(world.observe(beside), {}, workspace, {}), SearchError);
  CHECK_THROWS_AS(explain(planner, world.observe(beside), {}, workspace, report), SearchError);
  // The workspace and the report must belong together.
  typename Planner::Workspace other;
  CHECK_THROWS_AS((void)planner.foresee(world.observe(ego), {}, other, {}), SearchError);
  CHECK_THROWS_AS(explain(planner, world.observe(ego), {}, other, report), SearchError);  // it has not planned yet
  put(world, ego, [](auto& state) { state.speed = 10.0; });
  (void)planner.think(world.observe(ego), {}, workspace);
  CHECK_THROWS_AS(explain(planner, world.observe(ego), {}, workspace, report), SearchError);
  put(world, ego, [](auto& state) { state.speed = 15.0; });
  // Without the slow one it is not in the reasons.
  world.remove(slow);
  report = planner.think(world.observe(ego), {}, other);
  CHECK_THROWS_AS(explain(planner, world.observe(ego), {}, workspace, report), SearchError);
  report = planner.think(world.observe(ego), {}, workspace);
  explain(planner, world.observe(ego), {}, workspace, report);
  for (auto const& candidate : report.candidates) CHECK(candidate.because != slow);
}

TEST_CASE_TEMPLATE("it reports when there is nothing to plan or a parameter is not a number", Planner, ALL_PLANNERS) {
  Sim<Planner> world(support::straight_road(1, 600.0));
  auto planner = quick<Planner>();
  world.add({.position = {590.0, -1.75}, .speed = 12, .behavior = planner});
  for (int i = 0; i < 4; ++i) CHECK(world.step(0.5).failed == 0);
  REQUIRE(world.status(ego) != AgentStatus::driving);
  CHECK_THROWS_AS((void)report_of(planner, world), SearchError);
  Sim<Planner> road(support::straight_road(1, 600.0));
  road.add({.position = {60.0, -1.75}, .speed = 12, .behavior = planner});
  if constexpr (requires { planner.options; })
    planner.options.step = std::nan("");
  else
    planner.step = std::nan("");
  CHECK_THROWS_AS((void)report_of(planner, road), ParameterError);
  CHECK_THROWS_AS(road.add({.position = {90.0, -1.75}, .behavior = planner}), ParameterError);
}

TEST_CASE_TEMPLATE("a budget cuts it short, and it plans with what it has found", Planner,
                   ProposalPlanner<PredictionWorld COMMA ConstantAcceleration COMMA IterationBudget>,
                   PolicyTreePlanner<PredictionWorld COMMA MacroActions COMMA IterationBudget>,
                   FrenetPlanner<PredictionWorld COMMA ConstantAcceleration COMMA IterationBudget>, Greedy) {
  Planner planner;
  auto world = traffic<Sim<Planner>>(1, planner);
  auto const weighed = [&](std::size_t most) {
    planner.budget.iterations = most;
    auto const report = report_of(planner, world);
    CHECK(report.is_cut_short == (most < 1000 && !std::is_same_v<Planner, Greedy> ? true : most < 4));
    CHECK(report.course.size() > 1);
    return std::ranges::count_if(report.candidates, [](auto const& c) { return c.refused != "unchecked"; });
  };
  CHECK(weighed(1) == 1);
  CHECK(weighed(3) == 3);
  CHECK(weighed(1'000'000) > 3);
  planner.budget.iterations = 2;
  for (auto const& agent : world.roster().agents) world.set_behavior(agent.id, planner);
  for (int i = 0; i < 5; ++i) REQUIRE(world.step(0.2));
}

TEST_CASE_TEMPLATE("with hardly any time it scores one candidate and plans", Planner,
                   Mcts<PredictionWorld COMMA MacroActions COMMA TrafficReward COMMA IdmClassic COMMA
                            MctsOptions<Ucb1 COMMA RandomRollout COMMA TimeBudget>>,
                   ProposalPlanner<PredictionWorld COMMA ConstantAcceleration COMMA SpentBudget>,
                   PolicyTreePlanner<PredictionWorld COMMA MacroActions COMMA TimeBudget>,
                   FrenetPlanner<PredictionWorld COMMA ConstantAcceleration COMMA SpentBudget>) {
  Planner planner;
  if constexpr (requires { planner.options; })
    planner.options.budget.duration = 1e-6;
  else if constexpr (requires { planner.budget.duration; })
    planner.budget.duration = 1e-6;
  auto world = traffic<Sim<Planner>>(1, planner);
  auto const report = report_of(planner, world);
  if constexpr (requires { report.result; })
    CHECK(report.result.iterations == 1);
  else
    CHECK(report.is_cut_short);
  CHECK(report.course.back().time > world.time() + 1.0);
  for (int i = 0; i < 5; ++i) REQUIRE(world.step(0.2));
}

TEST_CASE_TEMPLATE("it is less decided where two lanes are as good as each other", Planner, Proposal, PolicyTree,
                   Frenet) {
  auto const decided = [](bool is_left_free) {
    Planner planner;
    Sim<Planner> world(support::straight_road(3, 900.0));
    world.add({.position = {80, -5.25}, .speed = 15.0, .behavior = planner});
    world.add({.position = {125, -5.25}, .speed = 4.0, .behavior = IdmClassic{.law = {.desired_speed = 4.0}}});
    if (!is_left_free) world.add({.position = {80, -1.75}, .speed = 15.0});
    return report_of(planner, world).decidedness;
  };
  CHECK(decided(true) < 0.5 * decided(false));
}

TEST_CASE("decidedness is the lead over the next best score as a share of their range") {
  std::vector<PlannerCandidate> candidates{{"a", 1.0}, {"b", 4.0}, {"c", 5.0}, {"d", 9.0, "collision"}};
  auto const any = [](std::size_t) { return true; };
  CHECK(decidedness(candidates, 2, any) == doctest::Approx(0.25));
  CHECK(decidedness(candidates, 1, any) == 0.0);
  CHECK(decidedness(candidates, std::nullopt, any) == 0.0);
  CHECK(decidedness(candidates, 2, [](std::size_t i) { return i == 0; }) == 1.0);  // "b" begins like "c"
  candidates[1].score = 5.0;
  CHECK(decidedness(candidates, 2, any) == 0.0);
  std::vector<PlannerCandidate> const as_bad{{"a", -41.0}, {"b", -41.01}};
  CHECK(decidedness(as_bad, 0, any) < 0.01);
  candidates[0].refused = candidates[1].refused = "off road";
  CHECK(decidedness(candidates, 2, any) == 1.0);
}
