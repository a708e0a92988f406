// Rewards composed of evaluators, including a user's own.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "cambium/execution/interpolate.hpp"
#include "cambium/planner/frenet/frenet_planner.hpp"
#include "cambium/planner/mcts/mcts.hpp"
#include "cambium/planner/policy/policy_tree_planner.hpp"
#include "cambium/planner/policy/proposal_planner.hpp"
#include "cambium/world/world.hpp"
#include "support/maps.hpp"

using namespace cambium;

namespace {

/// A user's evaluator: by how much [m] the gap to the leader falls short of `comfortable`. It uses a view.
struct TooClose {
  double comfortable = 30.0;

  static constexpr auto parameters() {
    return parameter_list(parameter("comfortable", &TooClose::comfortable, "m", Range{0, 1000}, "gap"));
  }
  template <class World>
  [[nodiscard]] double operator()(World& world, Slot slot) const {
    auto const next = world.observe(slot).ahead();
    return next ? std::max(0.0, comfortable - next->gap) : 0.0;
  }
};

/// Whether the agent is in the left lane.
struct OnTheLeft {
  static constexpr auto parameters() { return parameter_list(); }
  template <class World>
  [[nodiscard]] bool operator()(World const& world, Slot slot) const {
    return world.frame().agents[slot].state.y > -3.5;
  }
};

/// One evaluator for several tests, so that each planner is compiled once: how far to the left the agent is on a road
/// along x [m], 1, or from 13 m/s on a `broken` number.
struct Mixed {
  enum class Kind { leftwards, always, broken } kind = Kind::leftwards;
  double broken = 0.0;

  static constexpr auto parameters() { return parameter_list(); }
  template <class World>
  [[nodiscard]] double operator()(World const& world, Slot slot) const {
    auto const& state = world.frame().agents[slot].state;
    return kind == Kind::leftwards ? state.y : kind == Kind::broken && state.speed > 13.0 ? broken : 1.0;
  }
};

using Own = Reward<OnTheLeft, TooClose>;
using Predicted =
    World<BehaviorSet<MacroActions, IdmProposal, IdmClassic, ConstantAcceleration>, InterpolateExecution, SingleTrack>;
using PredictionWorld = World<BehaviorSet<MacroActions, IdmClassic>, InterpolateExecution, SingleTrack>;
using Planner = Mcts<PredictionWorld, MacroActions, Own>;
using Sim = World<BehaviorSet<Planner, IdmClassic>, InterpolateExecution, SingleTrack>;

constexpr Slot ego{};

}  // namespace

TEST_CASE("a reward is the sum of its terms, some per second") {
  PredictionWorld world(support::straight_road(2, 600.0));
  world.add({.position = {60, -5.25}, .speed = 12, .behavior = IdmClassic{}});
  world.add({.position = {80, -5.25}, .speed = 12, .behavior = IdmClassic{}});
  double const gap = 20.0 - geometry::car().front - geometry::car().rear;
  Own reward{.traffic = TrafficReward::events()};
  reward.traffic.progress = 0.5;
  CHECK(reward.judge(world, ego, 0.2).reward == doctest::Approx(0.5 * 12 * 0.2));
  reward.term<TooClose>() = {.weight = -2.0, .per_second = true};
  CHECK(reward.judge(world, ego, 0.2).reward == doctest::Approx(1.2 - 2.0 * (30.0 - gap) * 0.2));
  reward.term<TooClose>().per_second = false;
  CHECK(reward.judge(world, ego, 0.2).reward == doctest::Approx(1.2 - 2.0 * (30.0 - gap)));
  reward.term<OnTheLeft>() = {.weight = 5.0, .ends = true};
  CHECK_FALSE(reward.judge(world, ego, 0.2).ends);
  world.set_state(AgentId{0}, {.x = 60, .y = -1.75, .speed = 12});
  auto const left = reward.judge(world, ego, 0.2);
  CHECK(left.ends);
  CHECK(left.reward == doctest::Approx(1.2 + 5.0));
  world.set_state(AgentId{0}, {.x = 78, .y = -5.25, .speed = 12});  // a collision
  CHECK(reward.judge(world, ego, 0.2).reward ==
        doctest::Approx(reward.traffic.collision - 2.0 * (30.0 - (gap - 18.0))));
}

TEST_CASE("an own evaluator's event counts as a risk") {
  PredictionWorld world(support::straight_road(2, 600.0));
  world.add({.position = {60, -5.25}, .speed = 12, .behavior = IdmClassic{}});
  Own reward;
  reward.term<OnTheLeft>().cost = 0.7;
  CHECK(reward.judge(world, ego, 0.2).cost == 0.0);
  world.set_state(AgentId{0}, {.x = 60, .y = -1.75, .speed = 12});
  CHECK(reward.judge(world, ego, 0.2).cost == 0.7);
}

TEST_CASE("a planner heeds a user's evaluator") {
  for (double const weight : {20.0, -20.0}) {
    Sim world(support::straight_road(2, 600.0), {.seed = 3});
    Planner planner;
    planner.options.budget.iterations = 600;
    planner.reward.term<OnTheLeft>() = {.weight = weight, .per_second = true};
    planner.reward.traffic.goal = 0.0;
    auto const id = world.add({.position = {60, weight > 0 ? -5.25 : -1.75}, .speed = 12, .behavior = planner});
    for (int k = 0; k < 40; ++k) REQUIRE(world.step(0.2));
    CAPTURE(world.state(id).y);
    CHECK((world.state(id).y > -3.5) == (weight > 0));
  }
}

namespace {

using OtherPlanners = BehaviorSet<ProposalPlanner<Predicted, ConstantAcceleration, NoBudget, Terms<Mixed>>,
                                  PolicyTreePlanner<Predicted, MacroActions, NoBudget, Terms<Mixed>>,
                                  FrenetPlanner<Predicted, ConstantAcceleration, NoBudget, Terms<Mixed>>>;
using OtherSim = World<OtherPlanners, InterpolateExecution, SingleTrack>;

/// Calls `f(planner)` for each of them, with that term.
template <class F>
void for_each_other(Weighted<Mixed> const& term, F const& f) {
  auto const call = [&]<class P>(std::type_identity<P>) {
    P planner;
    planner.terms.template term<Mixed>() = term;
    CAPTURE(P::name);
    f(planner);
  };
  [&]<class... P>(std::type_identity<BehaviorSet<P...>>) {
    (call(std::type_identity<P>{}), ...);
  }(std::type_identity<OtherPlanners>{});
}

/// A world with a planner's agent at 12 m/s on a straight road.
template <class P>
OtherSim with(P const& planner, int lanes = 3) {
  OtherSim world(support::straight_road(lanes, 600.0));
  world.add({.position = {60, -5.25}, .speed = 12, .behavior = planner});
  return world;
}

template <class P>
auto report_of(P const& planner, OtherSim& world) {
  typename P::Workspace workspace;
  auto report = planner.think(world.observe(ego), {}, workspace);
  REQUIRE(report.chosen);
  return report;
}

}  // namespace

TEST_CASE("every other planner heeds a user's evaluator, too") {
  std::vector<double> ends;
  for (double const weight : {20.0, 0.0, -20.0})
    for_each_other({.weight = weight, .per_second = true}, [&](auto const& planner) {
      auto world = with(planner);
      auto const report = report_of(planner, world);
      for (auto const& candidate : report.candidates)
        if (candidate.refused.empty()) CHECK(candidate.score <= report.candidates[*report.chosen].score + 0.01);
      for (int k = 0; k < 20; ++k) REQUIRE(world.step(0.2));
      ends.push_back(world.state(AgentId{0}).y);
    });
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(ends[i] > ends[3 + i] + 0.5);
    CHECK(ends[6 + i] < ends[3 + i] - 0.5);
  }
}

TEST_CASE("planners without a limit on risk refuse a term with a cost") {
  for_each_other({.cost = 0.5}, [](auto const& planner) {
    CHECK_THROWS_WITH_AS(check_parameters(planner, "planner"), doctest::Contains("does not bound"), ParameterError);
  });
}

TEST_CASE("a term that ends the course ends it in every planner") {
  std::vector<double> scores;
  for (bool const ends : {false, true})
    for_each_other({.evaluator = {Mixed::Kind::always}, .weight = 1.0, .ends = ends}, [&](auto const& planner) {
      auto world = with(planner);
      auto const report = report_of(planner, world);
      scores.push_back(report.candidates[*report.chosen].score);
    });
  for (std::size_t i = 0; i < 3; ++i) CHECK(scores[3 + i] < scores[i] - 20.0);  // 1 instead of 1 a step
}

TEST_CASE("no planner drives a course whose terms are not finite") {
  double const infinite = std::numeric_limits<double>::infinity();
  for (double const broken : {infinite - infinite, infinite, -infinite})
    for_each_other({.evaluator = {Mixed::Kind::broken, broken}, .weight = 1.0}, [&](auto const& planner) {
      auto world = with(planner);
      try {
        auto const report = report_of(planner, world);
        for (auto const& candidate : report.candidates)
          if (candidate.refused.empty()) CHECK(std::isfinite(candidate.score));
        CHECK(report.candidates[*report.chosen].refused.empty());
      } catch (SearchError const& error) {
        CHECK(std::string(error.what()).find("finite") != std::string::npos);
      }
    });
}

TEST_CASE("evaluators see Frenet's courses as they see a world") {
  // A lane change: its lane offset is that from the lane that holds the vehicle, the gap is to whoever is ahead there.
  using Frenet = FrenetPlanner<Predicted, ConstantAcceleration, NoBudget, Terms<Mixed>>;
  Frenet const planner;
  auto world = with(planner, 2);
  OtherSim::Behavior const slow = planner;
  world.add({.position = {110, -5.25}, .speed = 4, .behavior = slow});
  auto const report = report_of(planner, world);
  auto seen = world.observe(ego).predict(predict_all_as<Predicted::Behaviors>(ConstantAcceleration{}));
  double largest = 0.0, least_gap = 400.0;
  for (auto const& frame : report.course) {
    seen.restore(frame);
    largest = std::max(largest, LaneOffset{}(seen, ego));
    if (frame.agents[ego].state.y < -4.5) least_gap = std::min(least_gap, Gap{}(seen, ego));
  }
  CHECK(report.course.back().agents[ego].state.y > -3.0);  // it changes lanes
  CHECK(largest > 1.0);
  CHECK(largest < 1.8);
  CHECK(least_gap < 46.0);
}

#define EVALUATORS                                                                                                   \
  Collision, AtFaultCollision, AnyCollision, OffRoad, OncomingLane, AtGoal, PastJunctions, Progress, SpeedDeviation, \
      SpeedLimitExcess, LaneOffset, Acceleration, HardBraking, Gap, TimeToCollision, RequiredDeceleration,           \
      LaneChangeUrgency, OthersBraking, Closeness

TEST_CASE_TEMPLATE("every shipped evaluator can be a term of a reward that a search plans by", Evaluator, EVALUATORS) {
  using TermPlanner = Mcts<PredictionWorld, MacroActions, Reward<EVALUATORS>>;  // one search: each takes 2 s to compile
  World<BehaviorSet<TermPlanner, IdmClassic>, InterpolateExecution, SingleTrack> world(
      support::straight_road(2, 600.0));
  TermPlanner planner;
  planner.options.budget.iterations = 50;
  planner.reward.template term<Evaluator>() = {.weight = 1.0, .per_second = true};
  auto const id = world.add({.position = {60, -5.25}, .speed = 12, .behavior = planner});
  TermPlanner::Workspace workspace;
  for (auto const& candidate : planner.think(world.observe(id), {}, workspace).candidates)
    CHECK(std::isfinite(candidate.score));
  REQUIRE(world.step(0.2));
}

TEST_CASE_TEMPLATE("an event that ends the course counts as a term of its own, too", Event, Collision, AtFaultCollision,
                   AnyCollision, OffRoad) {
  PredictionWorld world(support::straight_road(2, 600.0));
  world.add({.position = {60, -5.25}, .speed = 12, .behavior = IdmClassic{}});
  world.add({.position = {90, -5.25}, .speed = 12, .behavior = IdmClassic{}});
  Reward<Event> reward{.traffic = TrafficReward::events()};
  reward.template term<Event>().weight = -7.0;
  CHECK(reward.judge(world, ego, 0.2).reward == 0.0);
  double const y = std::is_same_v<Event, OffRoad> ? 5.0 : -5.25;
  world.set_state(AgentId{0}, {.x = 88, .y = y, .speed = 12});
  auto const judged = reward.judge(world, ego, 0.2);
  CHECK(judged.ends);
  CHECK(judged.reward == -7.0);
  CHECK(judged.cost == 1.0);
}

TEST_CASE("a course that is cut off counts the terms per second for the lookahead, the user's too") {
  PredictionWorld world(support::straight_road(2, 600.0));
  world.add({.position = {60, -5.25}, .speed = 12, .behavior = IdmClassic{}});
  Reward<SpeedDeviation> reward{.traffic = TrafficReward::events()};
  reward.term<SpeedDeviation>() = {.evaluator = {.desired_speed = 15.0}, .weight = -2.0, .per_second = true};
  reward.traffic.progress = 0.5;
  reward.traffic.lookahead = 4.0;
  CHECK(reward.value(world, ego, 0.2) == doctest::Approx(4.0 * (0.5 * 12.0 - 2.0 * 3.0)));
  reward.term<SpeedDeviation>().per_second = false;
  CHECK(reward.value(world, ego, 0.2) == doctest::Approx(4.0 * 0.5 * 12.0));
}

TEST_CASE("the parameters of a reward's terms are checked and compared like all others") {
  Own a, b;
  CHECK(equal_parameters(a, b));
  b.term<TooClose>().evaluator.comfortable = 20.0;
  CHECK_FALSE(equal_parameters(a, b));
  b.term<TooClose>().evaluator.comfortable = -1.0;
  CHECK_THROWS_WITH_AS(check_parameters(b, "reward"), doctest::Contains("comfortable"), ParameterError);
}
