#pragma once

#include <algorithm>
#include <cmath>
#include <deque>

#include "cambium/core/constants.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/evaluation/driving.hpp"
#include "cambium/evaluation/encounter.hpp"
#include "cambium/evaluation/off_road.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/world/frame.hpp"

namespace cambium::inline v0_1 {

/// How well an agent drove, from 0 to 1: the closed-loop score of nuPlan (Karnchanachari et al. 2024, "Towards
/// learning-based planning: the nuPlan benchmark for real-world autonomous driving", with the thresholds of its
/// implementation). The product of four parts for what must not happen, times the weighted mean of four for how it is
/// done:
///
/// | part | | |
/// |---|---|---|
/// | `no_fault` | factor | 0 after a collision at fault, see `AtFaultCollision` |
/// | `on_road` | factor | 0 after leaving the drivable lanes |
/// | `direction` | factor | 1 if it drove less than `way_against` in any second, 0.5 if less than `long_way_against` |
/// | `made_progress` | factor | 0 if the share of the expected progress is below `least_progress` |
/// | `keeps_distance` | 5 | 1 if no time to collision was below `least_time_to_collision` |
/// | `progress` | 5 | share of the expected progress, at most 1 |
/// | `speed_limit` | 4 | 1 less its mean excess over `most_excess` |
/// | `comfort` | 2 | 1 if accelerations, jerks, and the rate and acceleration of yaw stay within the bounds |
///
/// A time to collision counts with those within `bearing_in_lane` of the heading; if the agent is in a junction or not
/// within its lane, with those within `bearing`. While it stands, it has none.
///
/// Departures: `expected_progress` takes the place of a human driver's. Accelerations are differences of states, not
/// filtered, so that what lasts for a step only counts, too. The time to collision follows the lanes, not the headings,
/// and is exact, not on a grid of 0.1 s. Each collision counts as one with a vehicle: nuPlan punishes those with
/// objects less. A collision counts between two frames, too, and the higher of the speeds of that step decides who
/// stood. Progress has no floor of 2 m, and what equals a bound of comfort is comfortable.
struct ClosedLoopScore {
  double expected_progress = 0.0;
  double least_progress = 0.2;
  double least_time_to_collision = 0.95;
  double bearing_in_lane = geometry::pi / 6.0;
  double bearing = detail::behind_bearing;
  double way_against = 2.0;
  double long_way_against = 6.0;
  double most_excess = 2.23;
  double deceleration = comfort_deceleration;
  double acceleration = comfort_acceleration;
  double lateral_acceleration = comfort_lateral_acceleration;
  double jerk = 4.13;
  double size_of_jerk = 8.37;
  double yaw_rate = 0.95;
  double yaw_acceleration = 1.93;

  ClosedLoopScore() = default;
  /// `progress` [m] takes the place of a human driver's.
  explicit ClosedLoopScore(double progress) : expected_progress(progress) {}

  static constexpr char const* name = "closed_loop_score";
  static constexpr char const* summary = "nuPlan's closed-loop score of a run, 0 to 1";
  static constexpr char const* source = "Karnchanachari et al. 2024";
  static constexpr auto parameters() {
    using P = ClosedLoopScore;
    constexpr Range bound{0, 100}, angle{0, 3.2};
    auto const safety = parameter_list(
        parameter("expected_progress", &P::expected_progress, "m", non_negative,
                  "way that a good driver makes in the time of the run; 0: progress is not judged"),
        parameter("least_progress", &P::least_progress, "-", Range{0, 1}, "share of it; with less the score is 0"),
        parameter("least_time_to_collision", &P::least_time_to_collision, "s", Range{0, 60},
                  "a shorter time is dangerous"),
        parameter("bearing_in_lane", &P::bearing_in_lane, "rad", angle,
                  "who is farther off its heading does not count"),
        parameter("bearing", &P::bearing, "rad", angle, "the same in junctions, and where it is not within its lane"),
        parameter("way_against", &P::way_against, "m", non_negative, "against traffic in a second: half the score"),
        parameter("long_way_against", &P::long_way_against, "m", non_negative, "the same: the score is 0"),
        parameter("most_excess", &P::most_excess, "m/s", positive,
                  "mean excess of speed from which on it has no points"));
    auto const comfort = parameter_list(
        parameter("deceleration", &P::deceleration, "m/s^2", bound, "comfortable"),
        parameter("acceleration", &P::acceleration, "m/s^2", bound, "comfortable"),
        parameter("lateral_acceleration", &P::lateral_acceleration, "m/s^2", bound, "comfortable, to either side"),
        parameter("jerk", &P::jerk, "m/s^3", bound, "comfortable, along its heading"),
        parameter("size_of_jerk", &P::size_of_jerk, "m/s^3", bound,
                  "comfortable change of the size of its acceleration"),
        parameter("yaw_rate", &P::yaw_rate, "rad/s", bound, "comfortable"),
        parameter("yaw_acceleration", &P::yaw_acceleration, "rad/s^2", bound, "comfortable"));
    return join_parameters(safety, comfort);
  }

  static constexpr bool needs_history = true;

  /// The parts of a score, from 0 to 1 each.
  struct Parts {
    double no_fault = 1.0, on_road = 1.0, direction = 1.0, made_progress = 1.0;
    double keeps_distance = 1.0, progress = 1.0, speed_limit = 1.0, comfort = 1.0;
  };

  /// Precondition: the world keeps a history of one frame.
  template <class World>
  void observe(World& world, Slot slot, double dt) {
    auto const& record = world.frame().agents[slot];
    if (AtFaultCollision{}.in_last_step(world, slot)) parts_.no_fault = 0.0;
    if (record.status != AgentStatus::driving) return;
    bool const leaves = OffRoad{}(world, slot);
    if (leaves) parts_.on_road = 0.0;
    if (parts_.keeps_distance > 0.0 && is_close(world, slot, leaves)) parts_.keeps_distance = 0.0;
    if (dt <= 0.0) return;
    duration_ += dt;
    progress_ += Progress{}(world, slot) * dt;
    excess_ += SpeedLimitExcess{}(world, slot) * dt;
    against_.push_back({world.time(), OncomingLane{}(world, slot) ? record.state.speed * dt : 0.0});
    while (world.time() - against_.front().time >= 1.0 - same_time) against_.pop_front();
    double in_a_second = 0.0;
    for (auto const& step : against_) in_a_second += step.way;
    most_against_ = std::max(most_against_, in_a_second);
    if (!is_comfortable(world, slot, dt)) parts_.comfort = 0.0;
  }

  [[nodiscard]] Parts parts() const {
    auto parts = parts_;
    parts.direction = most_against_ < way_against ? 1.0 : most_against_ < long_way_against ? 0.5 : 0.0;
    if (expected_progress > 0.0) parts.progress = std::clamp(progress_ / expected_progress, 0.0, 1.0);
    parts.made_progress = parts.progress < least_progress ? 0.0 : 1.0;
    if (duration_ > 0.0) parts.speed_limit = std::max(0.0, 1.0 - excess_ / (most_excess * duration_));
    return parts;
  }

  [[nodiscard]] double value() const {
    auto const p = parts();
    return p.no_fault * p.on_road * p.direction * p.made_progress *
           (5.0 * p.keeps_distance + 5.0 * p.progress + 4.0 * p.speed_limit + 2.0 * p.comfort) / 16.0;
  }

 private:
  template <class World>
  [[nodiscard]] bool is_close(World const& world, Slot slot, bool leaves_road) const {
    constexpr double stands = 0.005;  // [m/s]
    auto const& record = world.frame().agents[slot];
    if (record.state.speed <= stands) return false;
    auto const lane = world.roster().agents[slot].road->corridors[record.lane.corridor].pieces[record.lane.piece].lane;
    bool const is_wide =
        leaves_road || (is_valid(lane) && world.map().in_junction(lane)) || !detail::within_lane(world, slot);
    TimeToCollision const time{.longest = least_time_to_collision, .bearing = is_wide ? bearing : bearing_in_lane};
    return time(world, slot) < least_time_to_collision;
  }

  /// Bounds of nuPlan, taken from human drivers.
  template <class World>
  [[nodiscard]] bool is_comfortable(World& world, Slot slot, double dt) {
    if (world.history_size() == 0 || world.history(1).agents[slot].status != AgentStatus::driving) return true;
    auto const &now = world.frame().agents[slot].state, &before = world.history(1).agents[slot].state;
    double const along = Acceleration{}(world, slot), across = LateralAcceleration::between(before, now);
    double const size = portable::hypot(along, across);
    double const turn = geometry::angle_difference(now.heading, before.heading) / dt;
    bool comfortable = along >= -deceleration && along <= acceleration && std::abs(across) <= lateral_acceleration &&
                       std::abs(turn) <= yaw_rate;
    if (has_turn_)
      comfortable = comfortable && std::abs(turn - turn_) / dt <= yaw_acceleration &&
                    std::abs(Jerk{}(world, slot)) <= jerk && std::abs(size - size_) / dt <= size_of_jerk;
    turn_ = turn;
    size_ = size;
    has_turn_ = true;
    return comfortable;
  }

  struct Against {
    double time, way;
  };

  Parts parts_{};  ///< those that are known step by step
  bool has_turn_ = false;
  double duration_ = 0.0, progress_ = 0.0, excess_ = 0.0, most_against_ = 0.0;
  double turn_ = 0.0, size_ = 0.0;  ///< yaw rate [rad/s] and size of the acceleration [m/s^2], of the last step
  std::deque<Against> against_;     ///< of the last second
};

}  // namespace cambium::inline v0_1
