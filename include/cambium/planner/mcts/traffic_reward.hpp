#pragma once

#include <concepts>

#include "cambium/core/parameters.hpp"
#include "cambium/evaluation/course_end.hpp"
#include "cambium/evaluation/driving.hpp"
#include "cambium/evaluation/evaluator.hpp"
#include "cambium/planner/search/search_domain.hpp"
#include "cambium/world/frame.hpp"

namespace cambium {

/// What a step brought an agent, and whether its course ends there.
struct Judgement {
  AgentOutcome outcome{};
  bool ends = false;
};

/// Judges, for a search, where a step of `dt` [s] led the agent at `slot` of `world`: a copyable, described struct
/// (`static constexpr auto parameters()`, see `TrafficReward`) with
///   `template <class World> Judgement judge(World& world, Slot slot, double dt) const`
/// and, where it likes,
///   `double value(World& world, Slot slot, double dt) const`: what a course that is cut off there would
///     still bring, for `TruncatedRollout` and `NoRollout`;
///   `double prior(World& world, Slot slot, MacroAction const& action) const`: how likely the action is
///     the best, a weight of at least 0, for `Puct` (a `MotionPrimitive` or an `ExternalInput::Memory` likewise).
/// Pure: what it judges is in the frame; its parts are evaluators. No allocation.
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

/// Evaluators with weights: what ends a course (collision, leaving the road, goal), and what happens on the way. A
/// collision costs 1 in the second channel too.
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
        parameter("collision", &P::collision, "-", any_finite, "for touching somebody or something, likewise"),
        parameter("off_road", &P::off_road, "-", any_finite,
                  "for leaving the road or the route, or driving in an oncoming lane, likewise; the map's end is none"),
        parameter("progress", &P::progress, "1/m", any_finite, "for each metre along the lane"),
        parameter("speed_deviation", &P::speed_deviation, "1/m", any_finite,
                  "for each second, times the deviation from the desired speed"),
        parameter("desired_speed", &P::desired_speed, "m/s", Range{0, 200}, "see there"),
        parameter("acceleration", &P::acceleration, "s^3/m^2", any_finite,
                  "for each second, times the square of the acceleration"),
        parameter("lateral_offset", &P::lateral_offset, "1/(m s)", any_finite,
                  "for each second, times the distance from the lane's centre"),
        parameter("lookahead", &P::lookahead, "s", Range{0, 1000},
                  "for which a course that is cut off counts as going on as it is; of truncated roll-outs, or none"));
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

  /// What is on the way, for `lookahead`.
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

/// A term of a reward: what an evaluator says after a step, times a weight.
template <class E>
struct Weighted {
  static_assert(
      Described<E>,
      "cambium::Reward<Evaluators...>: describe each evaluator's parameters, as cambium::Collision does; where "
      "it has none: `static constexpr auto parameters() { return cambium::parameter_list(); }`");
  E evaluator{};
  double weight = 0.0;
  bool per_second = false;
  bool ends = false;

  static constexpr char const* name = "weighted";
  static constexpr auto parameters() {
    using P = Weighted;
    return parameter_list(
        parameter("evaluator", &P::evaluator, "-", {}, "what judges"),
        parameter("weight", &P::weight, "-", any_finite, "of what it says"),
        parameter("per_second", &P::per_second, "-", Range{0, 1}, "it counts for as long as the step takes"),
        parameter("ends", &P::ends, "-", Range{0, 1}, "a course ends where it says anything but 0"));
  }

  template <class World>
  void judge(World& world, Slot slot, double dt, Judgement& all) const {
    static_assert(
        EvaluatorFor<E, World>,
        "cambium::Reward<Evaluators...>: each must have `template <class World> auto operator()(World&, Slot) "
        "const` that returns a bool or a number (see EvaluatorFor)");
    auto const value = static_cast<double>(evaluator(world, slot));
    all.outcome.reward += weight * value * (per_second ? dt : 1.0);
    all.ends = all.ends || (ends && value != 0.0);
  }
};

/// What `TrafficReward` says, and terms of a user's own: one for each evaluator.
template <class... Evaluators>
struct Reward;

template <>
struct Reward<> : TrafficReward {};

template <class First, class... Rest>
struct Reward<First, Rest...> {
  Weighted<First> first{};
  Reward<Rest...> rest{};

  static constexpr char const* name = "reward";
  static constexpr auto parameters() {
    return parameter_list(parameter("first", &Reward::first, "-", {}, "the first term"),
                          parameter("rest", &Reward::rest, "-", {}, "the further ones, at last those of traffic"));
  }

  /// Those of traffic.
  [[nodiscard]] TrafficReward& traffic() {
    if constexpr (sizeof...(Rest) == 0)
      return rest;
    else
      return rest.traffic();
  }

  template <class World>
  [[nodiscard]] Judgement judge(World& world, Slot slot, double dt) const {
    auto all = rest.judge(world, slot, dt);
    if (!all.ends) first.judge(world, slot, dt, all);
    return all;
  }
  template <class World>
  [[nodiscard]] double value(World& world, Slot slot, double dt) const {
    return rest.value(world, slot, dt);
  }
};

}  // namespace cambium
