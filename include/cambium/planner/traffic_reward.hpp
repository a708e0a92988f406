#pragma once

#include <cmath>
#include <cstdint>

#include "cambium/core/parameters.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/evaluation/drivable_area.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/planner/detail/predicted.hpp"
#include "cambium/planner/search_domain.hpp"
#include "cambium/world/frame.hpp"

namespace cambium {

/// What a step brought an agent, and whether its course ends there.
struct Judgement {
  AgentOutcome outcome{};
  bool ends = false;
};

/// Judges, for a search, where a step of `dt` [s] led the agent at `slot` of `world`: a copyable, described struct
/// (`static constexpr auto parameters()`, see `TrafficReward`) with
///   `template <class World> Judgement judge(World const& world, Slot slot, double dt) const`
/// and, where it likes,
///   `double value(World const& world, Slot slot, double dt) const`: what a course that is cut off there would
///     still bring, for `TruncatedRollout` and `NoRollout`;
///   `double prior(World const& world, Slot slot, MacroAction const& action) const`: how likely the action is
///     the best, a weight of at least 0, for `Puct` (a `MotionPrimitive` or an `ExternalInput::Memory` likewise).
/// Pure: what it judges is in the frame; neighbours are not (the traffic index is that of another frame). No
/// allocation.
template <class R, class World>
concept RewardModel = std::copyable<R> && requires(R const reward, World const world) {
  { reward.judge(world, Slot{}, double{}) } -> std::same_as<Judgement>;
};

namespace detail {

template <class R, class World>
concept ValuesCourses = requires(R const reward, World const world) {
  { reward.value(world, Slot{}, double{}) } -> std::convertible_to<double>;
};

template <class R, class World, class Set>
concept HasPrior = requires(R const reward, World const world, typename Set::Choice const choice) {
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
    auto const& record = world.frame().agents[slot];
    switch (record.status) {
      case AgentStatus::driving:
        break;
      case AgentStatus::off_route:
      case AgentStatus::failed:
        return {{off_road, 0.0}, true};
      default:
        return {{}, true};
    }
    if (CollisionEgo::at_slot(world, slot).ego_collision) return {{collision, 1.0}, true};
    if (off_road != 0.0 && (DrivableArea::off_road(world, slot) || detail::drives_against_traffic(world, slot)))
      return {{off_road, 0.0}, true};
    bool const there = goal != 0.0 && world.reached_goal(world.roster().agents[slot].id);
    return {{on_the_way(record, dt) + (there ? goal : 0.0), 0.0}, there};
  }

  /// What is on the way, for `lookahead`.
  template <class World>
  [[nodiscard]] double value(World const& world, Slot slot, double) const {
    return on_the_way(world.frame().agents[slot], lookahead);
  }

 private:
  template <class Record>
  [[nodiscard]] double on_the_way(Record const& record, double duration) const {
    double const speed = record.state.speed;
    double reward = 0.0;
    reward += progress * speed * geometry::sin_cos(record.lane.heading_error).cos * duration;
    reward += speed_deviation * std::abs(speed - desired_speed) * duration;
    reward += acceleration * record.action.acceleration * record.action.acceleration * duration;
    reward += lateral_offset * std::abs(record.lane.lateral) * duration;
    return reward;
  }
};

}  // namespace cambium
