// Rewards composed of evaluators, including a user's own.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

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

/// How far to the left the agent is on a road along x [m].
struct Leftwards {
  static constexpr auto parameters() { return parameter_list(); }
  template <class World>
  [[nodiscard]] double operator()(World const& world, Slot slot) const {
    return world.frame().agents[slot].state.y;
  }
};

using Own = Reward<OnTheLeft, TooClose>;
using Predicted =
    World<BehaviorSet<MacroActions, IdmProposal, IdmClassic, ConstantAcceleration>, InterpolateExecution, SingleTrack>;
using PredictionWorld = World<BehaviorSet<MacroActions, IdmClassic>, InterpolateExecution, SingleTrack>;
using Planner = Mcts<PredictionWorld, MacroActions, Own>;
using Sim = World<BehaviorSet<Planner, IdmClassic>, InterpolateExecution, SingleTrack>;

constexpr Slot ego{};
#define COMMA ,

}  // namespace

TEST_CASE("a reward is the sum of its terms, some per second") {
  PredictionWorld world(support::straight_road(2, 600.0));
  world.add({.position = {60, -5.25}, .speed = 12, .behavior = IdmClassic{}});
  world.add({.position = {80, -5.25}, .speed = 12, .behavior = IdmClassic{}});
  double const gap = 20.0 - geometry::car().front - geometry::car().rear;
  Own reward;
  reward.traffic = {.progress = 0.5};
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

TEST_CASE_TEMPLATE("every other planner heeds a user's evaluator, too", Heeding,
                   ProposalPlanner<Predicted COMMA ConstantAcceleration COMMA NoBudget COMMA Terms<Leftwards>>,
                   PolicyTreePlanner<Predicted COMMA NoBudget COMMA Terms<Leftwards>>,
                   FrenetPlanner<Predicted COMMA ConstantAcceleration COMMA NoBudget COMMA Terms<Leftwards>>) {
  auto const drive = [](double weight) {
    World<BehaviorSet<Heeding, IdmClassic>, InterpolateExecution, SingleTrack> world(support::straight_road(3, 600.0));
    Heeding planner;
    planner.terms.template term<Leftwards>() = {.weight = weight, .per_second = true};
    auto const id = world.add({.position = {60, -5.25}, .speed = 12, .behavior = planner});
    typename Heeding::Workspace workspace;
    auto const report = planner.think(world.observe(id), {}, workspace);
    REQUIRE(report.chosen);
    for (auto const& candidate : report.candidates)
      if (candidate.refused.empty()) CHECK(candidate.score <= report.candidates[*report.chosen].score + 0.01);
    for (int k = 0; k < 20; ++k) REQUIRE(world.step(0.2));
    return world.state(id).y;
  };
  double const left = drive(20.0), middle = drive(0.0), right = drive(-20.0);
  CHECK(left > middle + 0.5);
  CHECK(right < middle - 0.5);
}

namespace {

/// Not a number, or infinite, where the speed is above 13 m/s.
template <int sign>
struct Broken {
  static constexpr auto parameters() { return parameter_list(); }
  template <class World>
  [[nodiscard]] double operator()(World const& world, Slot slot) const {
    if (world.frame().agents[slot].state.speed < 13.0) return 1.0;
    double const infinite = std::numeric_limits<double>::infinity();
    return sign == 0 ? infinite - infinite : sign * infinite;
  }
};

}  // namespace

TEST_CASE_TEMPLATE("no planner drives a course whose terms are not finite", Term, Broken<0>, Broken<1>, Broken<-1>) {
  World<BehaviorSet<IdmClassic>, InterpolateExecution, SingleTrack> world(support::straight_road(2, 600.0));
  auto const id = world.add({.position = {60, -5.25}, .speed = 12});
  auto const check = [&]<class P>(P planner) {
    planner.terms.template term<Term>().weight = 1.0;
    typename P::Workspace workspace;
    try {
      auto const report = planner.think(world.observe(id), {}, workspace);
      REQUIRE(report.chosen);
      CHECK(std::isfinite(report.candidates[*report.chosen].score));
      for (auto const& candidate : report.candidates)
        if (candidate.refused.empty()) CHECK(std::isfinite(candidate.score));
    } catch (SearchError const& error) {
      CHECK(std::string(error.what()).find("finite") != std::string::npos);
    }
  };
  check(ProposalPlanner<Predicted, ConstantAcceleration, NoBudget, Terms<Term>>{});
  check(PolicyTreePlanner<Predicted, NoBudget, Terms<Term>>{});
  check(FrenetPlanner<Predicted, ConstantAcceleration, NoBudget, Terms<Term>>{});
}

TEST_CASE("evaluators see Frenet's courses as they see a world") {
  // A lane change: its lane offset is that from the lane that holds the vehicle, the gap is to whoever is ahead there.
  World<BehaviorSet<IdmClassic>, InterpolateExecution, SingleTrack> world(support::straight_road(2, 600.0));
  auto const id = world.add({.position = {60, -5.25}, .speed = 12});
  world.add({.position = {110, -5.25}, .speed = 4, .behavior = IdmClassic{.desired_speed = 4}});
  FrenetPlanner<Predicted, ConstantAcceleration, NoBudget, Terms<LaneOffset>> planner;
  planner.terms.term<LaneOffset>() = {.weight = -1e-9, .per_second = true};
  decltype(planner)::Workspace workspace;
  auto const report = planner.think(world.observe(id), {}, workspace);
  REQUIRE(report.chosen);
  Predicted seen = world.observe(id).predict(
      predict_all_as<BehaviorSet<MacroActions, IdmProposal, IdmClassic, ConstantAcceleration>>(ConstantAcceleration{}));
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

TEST_CASE("a term that ends the course ends it in every planner") {
  World<BehaviorSet<IdmClassic>, InterpolateExecution, SingleTrack> world(support::straight_road(2, 600.0));
  auto const id = world.add({.position = {60, -5.25}, .speed = 12});
  auto const score = [&]<class P>(P planner, bool ends) {
    planner.terms.template term<Progress>() = {.weight = 1.0, .ends = ends};
    typename P::Workspace workspace;
    auto const report = planner.think(world.observe(id), {}, workspace);
    return report.candidates[*report.chosen].score;
  };
  auto const shortens = [&](auto const& planner) { return score(planner, true) < score(planner, false) - 50.0; };
  CHECK(shortens(ProposalPlanner<Predicted, ConstantAcceleration, NoBudget, Terms<Progress>>{}));
  CHECK(shortens(PolicyTreePlanner<Predicted, NoBudget, Terms<Progress>>{}));
  CHECK(shortens(FrenetPlanner<Predicted, ConstantAcceleration, NoBudget, Terms<Progress>>{}));
}

TEST_CASE_TEMPLATE("every shipped evaluator can be a term of a reward that a search plans by", Evaluator, Collision,
                   AtFaultCollision, AnyCollision, OffRoad, OncomingLane, AtGoal, PastJunctions, Progress,
                   SpeedDeviation, SpeedLimitExcess, LaneOffset, Acceleration, HardBraking, Gap, TimeToCollision) {
  using Term = Reward<Evaluator>;
  using TermPlanner = Mcts<PredictionWorld, MacroActions, Term>;
  World<BehaviorSet<TermPlanner, IdmClassic>, InterpolateExecution, SingleTrack> world(
      support::straight_road(2, 600.0));
  TermPlanner planner;
  planner.options.budget.iterations = 50;
  planner.reward.template term<Evaluator>() = {.weight = 1.0, .per_second = true};
  auto const id = world.add({.position = {60, -5.25}, .speed = 12, .behavior = planner});
  typename TermPlanner::Workspace workspace;
  for (auto const& candidate : planner.think(world.observe(id), {}, workspace).candidates)
    CHECK(std::isfinite(candidate.score));
  REQUIRE(world.step(0.2));
}

TEST_CASE_TEMPLATE("an event that ends the course counts as a term of its own, too", Event, Collision, AtFaultCollision,
                   AnyCollision, OffRoad) {
  PredictionWorld world(support::straight_road(2, 600.0));
  world.add({.position = {60, -5.25}, .speed = 12, .behavior = IdmClassic{}});
  world.add({.position = {90, -5.25}, .speed = 12, .behavior = IdmClassic{}});
  Reward<Event> reward;
  reward.template term<Event>().weight = -7.0;
  CHECK(reward.judge(world, ego, 0.2).reward == 0.0);
  double const y = std::is_same_v<Event, OffRoad> ? 5.0 : -5.25;
  world.set_state(AgentId{0}, {.x = 88, .y = y, .speed = 12});
  auto const judged = reward.judge(world, ego, 0.2);
  CHECK(judged.ends);
  CHECK(judged.reward == doctest::Approx(-1007.0));
}

TEST_CASE("a course that is cut off counts the terms per second for the lookahead, the user's too") {
  PredictionWorld world(support::straight_road(2, 600.0));
  world.add({.position = {60, -5.25}, .speed = 12, .behavior = IdmClassic{}});
  Reward<SpeedDeviation> reward;
  reward.term<SpeedDeviation>() = {.evaluator = {.desired_speed = 15.0}, .weight = -2.0, .per_second = true};
  reward.traffic = {.progress = 0.5, .lookahead = 4.0};
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
