#pragma once

#include <algorithm>
#include <concepts>
#include <type_traits>

#include "cambium/core/parameters.hpp"
#include "cambium/evaluation/course_end.hpp"
#include "cambium/evaluation/driving.hpp"
#include "cambium/evaluation/evaluator.hpp"
#include "cambium/planner/search/search_domain.hpp"
#include "cambium/world/frame.hpp"

namespace cambium {

/// The outcome of a step for one agent, and whether its course ends there.
struct Judgement {
  AgentOutcome outcome{};
  bool ends = false;
};

/// Judges, for a search, the state of the agent at `slot` of `world` after a step of `dt` [s]. A copyable, described
/// struct (`static constexpr auto parameters()`, see `TrafficReward`) with
///
/// - `template <class World> Judgement judge(World& world, Slot slot, double dt) const`.
///
/// Optional members:
///
/// - `double value(World& world, Slot slot, double dt) const`: the expected further return of a course that is cut off
///   there, for `TruncatedRollout` and `NoRollout`.
/// - `double prior(World& world, Slot slot, MacroAction const& action) const`: a weight of at least 0, the higher the
///   more likely the action is the best, for `Puct`. The action is a `MotionPrimitive` or an `ExternalInput::Memory` if
///   the search uses these.
///
/// A reward is pure: everything that it judges is in the frame. No allocation.
template <class R, class World>
concept RewardModel = std::copyable<R> && requires(R const reward, World& world) {
  { reward.judge(world, Slot{}, double{}) } -> std::same_as<Judgement>;
};

namespace detail {

template <class R, class World>
concept ValuesCourses = requires(R const reward, World& world) {
  { reward.value(world, Slot{}, double{}) } -> std::convertible_to<double>;
};

template <class R, class World, class Set>
concept HasPrior = requires(R const reward, World& world, typename Set::Choice const choice) {
  { reward.prior(world, Slot{}, Set::action({}, choice)) } -> std::convertible_to<double>;
};

}  // namespace detail

/// A weighted sum of evaluators: events that end a course (collision, leaving the road, goal) and terms for driving. A
/// collision also counts as a cost of 1, see `AgentOutcome`.
struct TrafficReward {
  double goal = 100.0;
  double collision = -1000.0;
  double off_road = -1000.0;
  double progress = 0.0;
  double speed_deviation = 0.0;
  double desired_speed = 15.0;
  double acceleration = 0.0;
  double lateral_offset = 0.0;
  double lookahead = 2.0;

  static constexpr char const* name = "traffic_reward";
  static constexpr char const* summary = "goal, collision, leaving the road; progress, speed, comfort, lane centre";
  static constexpr char const* source = "weights as in Bernhard 2020";
  static constexpr auto parameters() {
    using P = TrafficReward;
    return parameter_list(
        parameter("goal", &P::goal, "-", any_finite, "for reaching the goal, which ends the course"),
        parameter("collision", &P::collision, "-", any_finite,
                  "for a collision with an agent or object, which ends the course"),
        parameter("off_road", &P::off_road, "-", any_finite,
                  "for leaving the road or the route, or driving in an oncoming lane, which ends the course; the end "
                  "of the map does not count"),
        parameter("progress", &P::progress, "1/m", any_finite, "per metre along the lane"),
        parameter("speed_deviation", &P::speed_deviation, "1/m", any_finite,
                  "per second, times the deviation from the desired speed"),
        parameter("desired_speed", &P::desired_speed, "m/s", Range{0, 200}, "for speed_deviation"),
        parameter("acceleration", &P::acceleration, "s^3/m^2", any_finite,
                  "per second, times the squared acceleration"),
        parameter("lateral_offset", &P::lateral_offset, "1/(m s)", any_finite,
                  "per second, times the distance from the lane's centre"),
        parameter("lookahead", &P::lookahead, "s", Range{0, 1000},
                  "time for which a course that is cut off counts as unchanged; for TruncatedRollout and NoRollout"));
  }

  template <class World>
  [[nodiscard]] Judgement judge(World const& world, Slot slot, double dt) const {
    switch (course_end(world, slot, Collision{}, off_road != 0.0)) {
      case CourseEnd::none:
        break;
      case CourseEnd::over:
        return {{}, true};
      case CourseEnd::collision:
        return {{collision, 1.0}, true};
      case CourseEnd::off_road:
        return {{off_road, 0.0}, true};
    }
    bool const there = goal != 0.0 && AtGoal{}(world, slot);
    return {{on_the_way(world, slot, dt) + (there ? goal : 0.0), 0.0}, there};
  }

  /// The terms for driving, as if nothing changed during `lookahead`.
  template <class World>
  [[nodiscard]] double value(World const& world, Slot slot, double) const {
    return on_the_way(world, slot, lookahead);
  }

 private:
  template <class World>
  [[nodiscard]] double on_the_way(World const& world, Slot slot, double duration) const {
    double const a = Acceleration{}(world, slot);
    double reward = 0.0;
    reward += progress * Progress{}(world, slot) * duration;
    reward += speed_deviation * SpeedDeviation{desired_speed}(world, slot) * duration;
    reward += acceleration * a * a * duration;
    reward += lateral_offset * LaneOffset{}(world, slot) * duration;
    return reward;
  }
};

/// A term of a reward: an evaluator's value after a step, times a weight.
template <class E>
struct Weighted {
  static_assert(
      Described<E>,
      "cambium::Reward<Evaluators...>: describe each evaluator's parameters, as cambium::Collision does; where "
      "it has none: `static constexpr auto parameters() { return cambium::parameter_list(); }`");
  static_assert(
      !requires { E::needs_history; },
      "cambium::Reward<Evaluators...>: this evaluator needs a history, and predictions keep none: it would "
      "always be 0; judge by cambium::Acceleration or the state instead");
  E evaluator{};
  double weight = 0.0;
  double cost = 0.0;
  bool per_second = false;
  bool ends = false;

  static constexpr char const* name = "weighted";
  static constexpr auto parameters() {
    using P = Weighted;
    return parameter_list(
        parameter("evaluator", &P::evaluator, "-", {}, "returns a bool or a number"),
        parameter("weight", &P::weight, "-", any_finite, "factor on its value"),
        parameter("cost", &P::cost, "-", Range{0, 1},
                  "of a value other than 0: the probability of the event that a limit on risk bounds"),
        parameter("per_second", &P::per_second, "-", Range{0, 1},
                  "whether the term is multiplied by the duration of the step"),
        parameter("ends", &P::ends, "-", Range{0, 1}, "whether a value other than 0 ends the course"));
  }

  template <class World>
  void judge(World& world, Slot slot, double dt, Judgement& all) const {
    static_assert(
        EvaluatorFor<E, World>,
        "cambium::Reward<Evaluators...>: each must have `template <class World> auto operator()(World&, Slot) "
        "const` that returns a bool or a number (see EvaluatorFor)");
    if (weight == 0.0 && cost == 0.0 && !ends) return;
    auto const value = static_cast<double>(evaluator(world, slot));
    all.outcome.reward += weight * value * (per_second ? dt : 1.0);
    if (value != 0.0) all.outcome.cost = std::max(all.outcome.cost, cost);
    all.ends = all.ends || (ends && value != 0.0);
  }
};

/// `TrafficReward` plus one weighted term for each evaluator: `reward.term<Gap>() = {.weight = 0.1, .per_second =
/// true}`. All terms count in the step that ends the course, too.
template <class... Evaluators>
struct Reward;

template <>
struct Reward<> : TrafficReward {
  [[nodiscard]] TrafficReward& traffic() { return *this; }
  [[nodiscard]] TrafficReward const& traffic() const { return *this; }

  template <class E>
  TrafficReward& term() {
    static_assert(std::is_void_v<E>, "cambium::Reward<Evaluators...>::term<E>: E is not one of Evaluators");
    return *this;
  }
};

template <class First, class... Rest>
struct Reward<First, Rest...> {
  static_assert(!(std::is_same_v<First, Rest> || ...),
                "cambium::Reward<Evaluators...>: an evaluator is there twice; each has one term");
  Weighted<First> first{};
  Reward<Rest...> rest{};

  static constexpr char const* name = "reward";
  static constexpr auto parameters() {
    return parameter_list(
        parameter("first", &Reward::first, "-", {}, "the first term"),
        parameter("rest", &Reward::rest, "-", {}, "the other terms; the last of them are those of TrafficReward"));
  }

  /// The `TrafficReward` at the end of the list.
  [[nodiscard]] TrafficReward& traffic() { return rest.traffic(); }
  [[nodiscard]] TrafficReward const& traffic() const { return rest.traffic(); }

  /// The term of evaluator `E`.
  template <class E>
  [[nodiscard]] auto& term() {
    if constexpr (std::is_same_v<E, First>)
      return first;
    else
      return rest.template term<E>();
  }

  template <class World>
  [[nodiscard]] Judgement judge(World& world, Slot slot, double dt) const {
    auto all = rest.judge(world, slot, dt);
    if (world.frame().agents[slot].status == AgentStatus::driving) first.judge(world, slot, dt, all);
    return all;
  }
  /// That of `TrafficReward`, and the terms per second as if nothing changed during its `lookahead`.
  template <class World>
  [[nodiscard]] double value(World& world, Slot slot, double dt) const {
    Judgement own;
    if (first.per_second) first.judge(world, slot, traffic().lookahead, own);
    return rest.value(world, slot, dt) + own.outcome.reward;
  }
};

}  // namespace cambium
