#pragma once

#include <concepts>

#include "cambium/core/parameters.hpp"
#include "cambium/evaluation/course_end.hpp"
#include "cambium/evaluation/driving.hpp"
#include "cambium/evaluation/terms.hpp"
#include "cambium/world/frame.hpp"

namespace cambium::inline v0_1 {

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
/// collision, or leaving the road, is a cost of 1 (see `AgentOutcome`): what must not happen has a channel of its own.
struct TrafficReward {
  double goal = 100.0;
  double collision = 0.0;
  double off_road = 0.0;
  bool heeds_road = true;
  double progress = 0.0;
  double speed_deviation = -1.0;
  double desired_speed = 15.0;
  double acceleration = -0.1;
  double lateral_offset = 0.0;
  double lane_change_urgency = -40.0;
  double others_braking = -10.0;
  double closeness = -20.0;
  double lookahead = 2.0;

  /// Rewards the goal only, not the driving: a base for a reward of your own.
  [[nodiscard]] static constexpr TrafficReward events() {
    return {.speed_deviation = 0.0,
            .acceleration = 0.0,
            .lane_change_urgency = 0.0,
            .others_braking = 0.0,
            .closeness = 0.0};
  }

  static constexpr char const* name = "traffic_reward";
  static constexpr char const* summary =
      "goal, collision, leaving the road; progress, speed, comfort, lane centre, lane changes to the goal";
  static constexpr char const* source = "own; goal as in Bernhard 2020";
  static constexpr auto parameters() {
    using P = TrafficReward;
    return parameter_list(
        parameter("goal", &P::goal, "-", any_finite, "for reaching the goal, which ends the course"),
        parameter("collision", &P::collision, "-", any_finite,
                  "for a collision with an agent or object, which ends the course, besides its cost of 1"),
        parameter("off_road", &P::off_road, "-", any_finite,
                  "for leaving the road or the route, or driving in an oncoming lane, which ends the course, besides "
                  "its cost of 1; the end of the map does not count"),
        parameter("heeds_road", &P::heeds_road,
                  "whether leaving the road, or driving in an oncoming lane, ends the course"),
        parameter("progress", &P::progress, "1/m", any_finite, "per metre along the lane"),
        parameter("speed_deviation", &P::speed_deviation, "1/m", any_finite,
                  "per second, times the deviation from the desired speed"),
        parameter("desired_speed", &P::desired_speed, "m/s", Range{0, 200}, "for speed_deviation"),
        parameter("acceleration", &P::acceleration, "s^3/m^2", any_finite,
                  "per second, times the squared acceleration"),
        parameter("lateral_offset", &P::lateral_offset, "1/(m s)", any_finite,
                  "per second, times the distance from the lane's centre"),
        parameter("lane_change_urgency", &P::lane_change_urgency, "1/s", any_finite,
                  "per second, times the urgency of a lane change, see LaneChangeUrgency"),
        parameter("others_braking", &P::others_braking, "s^3/m^2", any_finite,
                  "per second, times how hard others brake, see OthersBraking"),
        parameter("closeness", &P::closeness, "1/s", any_finite,
                  "per second, times the missing share of the gap ahead, see Closeness"),
        parameter("lookahead", &P::lookahead, "s", Range{0, 1000},
                  "time for which a course that is cut off counts as unchanged; for TruncatedRollout and NoRollout"));
  }

  template <class World>
  [[nodiscard]] Judgement judge(World& world, Slot slot, double dt) const {
    switch (course_end(
        world, slot, [](World const& judged, Slot own) { return Collision{}.in_last_step(judged, own); }, heeds_road)) {
      case CourseEnd::none:
        break;
      case CourseEnd::over:
        return {0.0, 0.0, true};
      case CourseEnd::collision:
        return {collision, 1.0, true};
      case CourseEnd::off_road:
        return {off_road, 1.0, true};
    }
    bool const there = goal != 0.0 && AtGoal{}(world, slot);
    return {on_the_way(world, slot, dt) + (there ? goal : 0.0), 0.0, there};
  }

  /// The terms for driving, as if nothing changed during `lookahead`.
  template <class World>
  [[nodiscard]] double value(World& world, Slot slot, double) const {
    return on_the_way(world, slot, lookahead);
  }

 private:
  template <class World>
  [[nodiscard]] double on_the_way(World& world, Slot slot, double duration) const {
    double const a = Acceleration{}(world, slot);
    double reward = 0.0;
    reward += progress * Progress{}(world, slot) * duration;
    reward += speed_deviation * SpeedDeviation{desired_speed}(world, slot) * duration;
    reward += acceleration * a * a * duration;
    reward += lateral_offset * LaneOffset{}(world, slot) * duration;
    if (closeness != 0.0) reward += closeness * Closeness{}(world, slot) * duration;
    if (others_braking != 0.0) reward += others_braking * OthersBraking{}(world, slot) * duration;
    if (lane_change_urgency != 0.0) reward += lane_change_urgency * LaneChangeUrgency{}(world, slot) * duration;
    return reward;
  }
};

/// `TrafficReward` plus one weighted term for each evaluator: `reward.term<Gap>() = {.weight = 0.1, .per_second =
/// true}`. All terms count in the step that ends the course, too,
/// unless the agent has left.
template <class... Evaluators>
struct Reward {
  TrafficReward traffic{};
  Terms<Evaluators...> terms{};

  static constexpr char const* name = "reward";
  static constexpr auto parameters() {
    return parameter_list(parameter("traffic", &Reward::traffic, "what every search in traffic needs"),
                          parameter("terms", &Reward::terms, "one for each evaluator"));
  }

  /// The term of evaluator `E`.
  template <class E>
  [[nodiscard]] Weighted<E>& term() {
    return terms.template term<E>();
  }

  template <class World>
  [[nodiscard]] Judgement judge(World& world, Slot slot, double dt) const {
    return traffic.judge(world, slot, dt) + terms.judge(world, slot, dt);
  }
  /// That of `TrafficReward`, and the terms per second as if nothing changed during its `lookahead`.
  template <class World>
  [[nodiscard]] double value(World& world, Slot slot, double dt) const {
    return traffic.value(world, slot, dt) + terms.value(world, slot, traffic.lookahead);
  }
};

}  // namespace cambium::inline v0_1
