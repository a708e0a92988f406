// Rewards composed of evaluators, including a user's own.
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "planner/planner_fixtures.hpp"

using namespace planner_fixtures;

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
using Planner = Mcts<PredictionWorld, MacroActions, Own>;
using Sim = World<BehaviorSet<Planner, IdmClassic>, InterpolateExecution, SingleTrack>;

constexpr Slot slot{};

/// Ego, and a vehicle ahead of it at `x` [m] in its lane.
PredictionWorld two_vehicles(double x) {
  PredictionWorld world(support::straight_road(2, 600.0));
  for (double const at : {60.0, x}) world.add({.position = {at, -5.25}, .speed = 12, .behavior = IdmClassic{}});
  return world;
}

}  // namespace

TEST_CASE("a reward is the sum of its terms, some per second") {
  auto world = two_vehicles(80.0);
  double const gap = 20.0 - geometry::car().front - geometry::car().rear;
  Own reward{.traffic = TrafficReward::events()};
  reward.traffic.progress = 0.5;
  CHECK(reward.judge(world, slot, 0.2).reward == doctest::Approx(0.5 * 12 * 0.2));
  reward.term<TooClose>() = {.weight = -2.0, .per_second = true};
  CHECK(reward.judge(world, slot, 0.2).reward == doctest::Approx(1.2 - 2.0 * (30.0 - gap) * 0.2));
  reward.term<TooClose>().per_second = false;
  CHECK(reward.judge(world, slot, 0.2).reward == doctest::Approx(1.2 - 2.0 * (30.0 - gap)));
  reward.term<OnTheLeft>() = {.weight = 5.0, .ends = true};
  CHECK_FALSE(reward.judge(world, slot, 0.2).ends);
  world.set_state(AgentId{0}, {.x = 60, .y = -1.75, .speed = 12});
  auto const left = reward.judge(world, slot, 0.2);
  CHECK(left.ends);
  CHECK(left.reward == doctest::Approx(1.2 + 5.0));
  world.set_state(AgentId{0}, {.x = 78, .y = -5.25, .speed = 12});  // a collision
  CHECK(reward.judge(world, slot, 0.2).reward ==
        doctest::Approx(reward.traffic.collision - 2.0 * (30.0 - (gap - 18.0))));
}

TEST_CASE("an own evaluator's event counts as a risk") {
  auto world = two_vehicles(300.0);
  Own reward;
  reward.term<OnTheLeft>().cost = 0.7;
  CHECK(reward.judge(world, slot, 0.2).cost == 0.0);
  world.set_state(AgentId{0}, {.x = 60, .y = -1.75, .speed = 12});
  CHECK(reward.judge(world, slot, 0.2).cost == 0.7);
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

#define OTHER_PLANNERS                                                                           \
  ProposalPlanner<PredictionWorld COMMA ConstantAcceleration COMMA NoBudget COMMA Terms<Mixed>>, \
      PolicyTreePlanner<PredictionWorld COMMA MacroActions COMMA NoBudget COMMA Terms<Mixed>>,   \
      FrenetPlanner<PredictionWorld COMMA ConstantAcceleration COMMA NoBudget COMMA Terms<Mixed>>
#define COMMA ,

/// A planner with that term, and its agent at 12 m/s on a straight road.
template <class P>
struct Other {
  P planner;
  World<BehaviorSet<P, IdmClassic>, InterpolateExecution, SingleTrack> world;

  explicit Other(Weighted<Mixed> const& term, int lanes = 3) : world(support::straight_road(lanes, 600.0)) {
    planner.terms.template term<Mixed>() = term;
    world.add({.position = {60, -5.25}, .speed = 12, .behavior = planner});
  }
  auto report() const {
    auto found = report_of(planner, world);
    REQUIRE(found.chosen);
    return found;
  }
};

}  // namespace

TEST_CASE_TEMPLATE("every other planner heeds a user's evaluator, too", P, OTHER_PLANNERS) {
  auto const end = [](double weight) {
    Other<P> other({.weight = weight, .per_second = true});
    auto const report = other.report();
    for (auto const& candidate : report.candidates)
      if (candidate.refused.empty()) CHECK(candidate.score <= report.candidates[*report.chosen].score + 0.01);
    for (int k = 0; k < 20; ++k) REQUIRE(other.world.step(0.2));
    return other.world.state(ego).y;
  };
  double const neutral = end(0.0);
  CHECK(end(20.0) > neutral + 0.5);
  CHECK(end(-20.0) < neutral - 0.5);
}

TEST_CASE_TEMPLATE("a planner without a limit on risk refuses a term with a cost", P, OTHER_PLANNERS) {
  P planner;
  planner.terms.template term<Mixed>().cost = 0.5;
  CHECK_THROWS_WITH_AS(check_parameters(planner, "planner"), doctest::Contains("does not bound"), ParameterError);
}

TEST_CASE_TEMPLATE("a term that ends the course ends it in every planner", P, OTHER_PLANNERS) {
  auto const score = [](bool ends) {
    auto const report = Other<P>({.evaluator = {Mixed::Kind::always}, .weight = 1.0, .ends = ends}).report();
    return report.candidates[*report.chosen].score;
  };
  CHECK(score(true) < score(false) - 20.0);  // 1 instead of 1 a step
}

TEST_CASE_TEMPLATE("no planner drives a course whose terms are not finite", P, OTHER_PLANNERS) {
  double const infinite = std::numeric_limits<double>::infinity();
  for (double const broken : {infinite - infinite, infinite, -infinite}) {
    CAPTURE(broken);
    try {
      auto const report = Other<P>({.evaluator = {Mixed::Kind::broken, broken}, .weight = 1.0}).report();
      for (auto const& candidate : report.candidates)
        if (candidate.refused.empty()) CHECK(std::isfinite(candidate.score));
      CHECK(report.candidates[*report.chosen].refused.empty());
    } catch (SearchError const& error) {
      CHECK(std::string(error.what()).find("finite") != std::string::npos);
    }
  }
}

TEST_CASE("evaluators see Frenet's courses as they see a world") {
  // A lane change: its lane offset is that from the lane that holds the vehicle, the gap is to whoever is ahead there.
  auto world = road(2, 12.0, Frenet{});
  world.add({.position = {90, -5.25}, .speed = 4, .behavior = ConstantAcceleration{}});
  auto const report = report_of(Frenet{}, world);
  REQUIRE(report.chosen);
  auto seen = world.observe(ego).predict(predict_all_as<PredictionWorld::Behaviors>(ConstantAcceleration{}));
  double largest = 0.0, least_gap = 400.0;
  for (auto const& frame : report.course) {
    seen.restore(frame);
    largest = std::max(largest, LaneOffset{}(seen, slot));
    if (frame.agents[slot].state.y < -4.5) least_gap = std::min(least_gap, Gap{}(seen, slot));
  }
  CHECK(report.course.back().agents[slot].state.y > -3.0);  // it changes lanes
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
  world.add({.position = {60, -5.25}, .speed = 12, .behavior = planner});
  for (auto const& candidate : report_of(planner, world).candidates) CHECK(std::isfinite(candidate.score));
  REQUIRE(world.step(0.2));
}

TEST_CASE_TEMPLATE("an event that ends the course counts as a term of its own, too", Event, Collision, AtFaultCollision,
                   AnyCollision, OffRoad) {
  auto world = two_vehicles(90.0);
  Reward<Event> reward{.traffic = TrafficReward::events()};
  reward.template term<Event>().weight = -7.0;
  CHECK(reward.judge(world, slot, 0.2).reward == 0.0);
  double const y = std::is_same_v<Event, OffRoad> ? 5.0 : -5.25;
  world.set_state(AgentId{0}, {.x = 88, .y = y, .speed = 12});
  auto const judged = reward.judge(world, slot, 0.2);
  CHECK(judged.ends);
  CHECK(judged.reward == -7.0);
  CHECK(judged.cost == 1.0);
}

TEST_CASE("each term of the reward for driving is its weight times what its evaluator measures, per second") {
  auto world = two_vehicles(70.0);
  world.add({.position = {52, -5.0}, .speed = 12, .behavior = IdmClassic{}});  // brakes behind
  world.set_state(AgentId{0}, {.x = 60, .y = -5.0, .speed = 12});
  REQUIRE(world.step(0.2));
  double const a = Acceleration{}(world, slot);
  struct Term {
    double TrafficReward::*weight;
    double measured;
  };
  for (auto const& term :
       {Term{&TrafficReward::progress, Progress{}(world, slot)},
        Term{&TrafficReward::speed_deviation, SpeedDeviation{20.0}(world, slot)},
        Term{&TrafficReward::acceleration, a * a}, Term{&TrafficReward::lateral_offset, LaneOffset{}(world, slot)},
        Term{&TrafficReward::closeness, Closeness{}(world, slot)},
        Term{&TrafficReward::others_braking, OthersBraking{}(world, slot)}}) {
    auto reward = TrafficReward::events();
    reward.desired_speed = 20.0;
    reward.lookahead = 3.0;
    reward.*term.weight = -2.0;
    CHECK(std::abs(term.measured) > 0.01);
    CHECK(reward.value(world, slot, 0.2) == doctest::Approx(-2.0 * 3.0 * term.measured));
    CHECK(reward.judge(world, slot, 0.2).reward == doctest::Approx(-2.0 * 0.2 * term.measured));
  }
}

TEST_CASE("a course that is cut off counts the terms per second for the lookahead, the user's too") {
  auto world = two_vehicles(300.0);
  Reward<SpeedDeviation> reward{.traffic = TrafficReward::events()};
  reward.term<SpeedDeviation>() = {.evaluator = {.desired_speed = 15.0}, .weight = -2.0, .per_second = true};
  reward.traffic.progress = 0.5;
  reward.traffic.lookahead = 4.0;
  CHECK(reward.value(world, slot, 0.2) == doctest::Approx(4.0 * (0.5 * 12.0 - 2.0 * 3.0)));
  reward.term<SpeedDeviation>().per_second = false;
  CHECK(reward.value(world, slot, 0.2) == doctest::Approx(4.0 * 0.5 * 12.0));
}

TEST_CASE("the parameters of a reward's terms are checked and compared like all others") {
  Own a, b;
  CHECK(equal_parameters(a, b));
  b.term<TooClose>().evaluator.comfortable = 20.0;
  CHECK_FALSE(equal_parameters(a, b));
  b.term<TooClose>().evaluator.comfortable = -1.0;
  CHECK_THROWS_WITH_AS(check_parameters(b, "reward"), doctest::Contains("comfortable"), ParameterError);
}
