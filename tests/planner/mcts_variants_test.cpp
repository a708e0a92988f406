// Selections, roll-outs, budgets, final moves and actions of searches in traffic.
#include "cambium/planner/search/puct.hpp"
#include "planner/planner_fixtures.hpp"
#include "support/scale.hpp"

using namespace planner_fixtures;

namespace {

/// A user's reward: as `TrafficReward`, with a prior that favours braking.
struct Expecting : TrafficReward {
  double braking = 3.0;

  template <class World>
  [[nodiscard]] double prior(World const&, cambium::Slot, MacroAction const& action) const {
    return action.kind == MacroAction::Kind::stay && action.acceleration < -1.0 ? braking : 1.0;
  }
};

template <class Options, class Reward = TrafficReward, class Actions = MacroActions>
using Single = Mcts<PredictionWorld, Actions, Reward, IdmClassic, Options>;

using Plain = Single<MctsOptions<>>;
using Truncated = Single<MctsOptions<Ucb1, TruncatedRollout<RandomRollout>>>;
using Policy = Single<MctsOptions<Ucb1, PolicyRollout>>;
using Timed = Single<MctsOptions<Ucb1, RandomRollout, TimeBudget>>;
using Expected = Single<MctsOptions<Puct>, Expecting>;
using Sampled = Mcts<World<BehaviorSet<ExternalInput, IdmClassic>, InterpolateExecution, SingleTrack>, SampledInputs>;
using Sim = World<BehaviorSet<IdmClassic, Plain, Truncated, Policy, Timed, Expected, Sampled>, InterpolateExecution,
                  SingleTrack>;

template <class Planner>
Planner careful() {
  Planner planner;
  planner.others.law.desired_speed = 0.1;  // like the vehicle that stands there
  planner.reward.goal = 0.0;
  planner.reward.progress = 1.0;
  planner.options.budget.iterations = 300;
  if constexpr (requires { planner.actions.actions; })
    planner.actions = MacroActions::of({{MacroAction::Kind::keep_gap},
                                        {MacroAction::Kind::stay, 0.0},
                                        {MacroAction::Kind::stay, 1.5},
                                        {MacroAction::Kind::stay, -2.0},
                                        {MacroAction::Kind::stay, -5.0}});
  return planner;
}

}  // namespace

TEST_CASE("every variant of the search stops behind a standing vehicle") {
  auto lower_bound = careful<Plain>();
  lower_bound.options.search.final_move = FinalMove::lower_bound;
  auto truncated = careful<Truncated>();
  truncated.options.rollout.base = {.steps = 3};
  auto timed = careful<Timed>();
  timed.options.budget.duration = 60.0;  // so large that the iterations end it
  auto sampled = careful<Sampled>();
  sampled.actions.largest_steering = 0.0;
  Sim::Behavior const planners[] = {lower_bound, truncated, careful<Policy>(), timed, careful<Expected>(), sampled};
  for (auto const& planner : planners) {
    CAPTURE(planner.index());
    for (std::uint64_t seed = 0; seed < support::runs(2); ++seed) {
      Sim world(support::straight_road(1, 300.0), {.seed = seed});
      world.add({.position = {30, -1.75}, .speed = 12, .behavior = planner});
      world.add({.position = {90, -1.75}, .speed = 0, .behavior = IdmClassic{.law = {.desired_speed = 0.1}}});
      for (int step = 0; step < 50; ++step) {
        REQUIRE(world.step(0.2));
        REQUIRE_FALSE(Collision{}(world, world.slot_of(ego)));
      }
      CHECK(world.state(ego).speed < 3.0);
      CHECK(world.state(ego).x > 55.0);
    }
  }
}

TEST_CASE("a course that is cut off has the reward's value, with the others' weighted by the cooperation") {
  Sim world(support::straight_road(1, 300.0));
  world.add({.position = {30, -1.75}, .speed = 12, .behavior = IdmClassic{}});
  world.add({.position = {60, -1.75}, .speed = 11, .behavior = IdmClassic{}});
  auto only_progress = TrafficReward::events();
  only_progress.progress = 1.0;
  for (double const lookahead : {2.0, 0.0}) {
    using Cooperative = Mcts<PredictionWorld, MacroActions, TrafficReward, IdmClassic, MctsOptions<Ucb1, NoRollout>>;
    Cooperative planner{.most_agents = 4};
    planner.actions = MacroActions::of({{MacroAction::Kind::stay, 0.0}});
    planner.reward = only_progress;
    planner.reward.lookahead = lookahead;
    planner.options.hold = 1;
    planner.options.search = {.horizon = 1, .discount = 0.9};
    auto const report = report_of(planner, world);
    double const own = 12.0 * (0.2 + 0.9 * lookahead), other = 11.0 * (0.2 + 0.9 * lookahead);
    CHECK(report.result.choice(0).mean_return == doctest::Approx(own + 0.5 * other));
    CHECK(report.result.choice(1).mean_return == doctest::Approx(other + 0.5 * own));
  }
  // Likewise after a roll-out: one step in the tree, 4 beyond it, then 2 s.
  auto planner = careful<Truncated>();
  planner.reward = only_progress;
  planner.options.hold = 1;
  planner.actions = MacroActions::of({{MacroAction::Kind::stay, 0.0}});
  planner.options.search = {.horizon = 20, .discount = 1.0};
  planner.options.budget.iterations = 1;
  planner.options.rollout.base.steps = 4;
  auto const report = report_of(planner, world);
  CHECK(report.result.choice(0).mean_return == doctest::Approx(12.0 * (5 * 0.2 + 2.0)));
}

TEST_CASE("a user's prior guides a search in traffic and is checked") {
  Sim world(support::straight_road(1, 300.0));
  world.add({.position = {30, -1.75}, .speed = 12, .behavior = IdmClassic{}});
  auto planner = careful<Expected>();
  planner.reward = {TrafficReward::events()};  // all is worth as much
  planner.reward.braking = 50.0;
  planner.options.budget.iterations = 200;
  auto const report = report_of(planner, world);
  CHECK(report.result.choice(0).share > 0.3);
  CHECK(report.candidates[*report.chosen].name.starts_with("stay -"));
  planner.reward.braking = -1.0;
  CHECK_THROWS_AS((void)report_of(planner, world), SearchError);
}
