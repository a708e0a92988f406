#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "cambium/behavior/law/follow_lane.hpp"
#include "cambium/behavior/law/slowing.hpp"
#include "cambium/core/constants.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/map/corridor/corridor.hpp"

namespace cambium::inline v0_1 {

/// Whether a vehicle of `speed` [m/s] can stop within `distance` [m] by braking with `deceleration` [m/s^2]. A stopped
/// vehicle always can.
[[nodiscard]] inline bool can_stop(double speed, double distance, double deceleration) {
  return speed * speed <= 2.0 * deceleration * std::max(0.0, distance) || speed < standing_speed;
}

/// Time [s] in which a vehicle of `speed` [m/s] that accelerates by `acceleration` [m/s^2] up to `highest` [m/s] covers
/// `distance` [m]; 0 for a distance ≤ 0, infinite if the vehicle never gets there.
[[nodiscard]] inline double time_to_cover(double distance, double speed, double acceleration, double highest) {
  if (distance <= 0.0) return 0.0;
  if (acceleration <= 0.0 || speed >= highest)
    return speed > 0.0 ? distance / speed : std::numeric_limits<double>::infinity();
  double const until_highest = (highest - speed) / acceleration;
  double const there = until_highest * 0.5 * (speed + highest);
  if (distance >= there) return until_highest + (distance - there) / highest;
  return (std::sqrt(speed * speed + 2.0 * acceleration * distance) - speed) / acceleration;
}

/// Distance [m] that a vehicle of `speed` and `acceleration` [m/s, m/s^2] needs to stop if it brakes with up to
/// `deceleration` [m/s^2], which it builds up and takes back as `bound` permits.
[[nodiscard]] inline double stopping_distance(double speed, double acceleration, double deceleration,
                                              JerkBound const& bound) {
  if (!bound.matters()) return speed * speed / (2.0 * deceleration);
  return slowing_distance(speed, acceleration, 0.0, deceleration, bound.planned()).distance;
}

/// The longest motion over `dt` [s] after which a vehicle of `speed` [m/s] can still stop within `distance` [m] by
/// braking with `deceleration` [m/s^2]; if that no longer suffices, it brakes harder, up to `hardest` [m/s^2]. This is
/// the safe speed of Krauss (1998, eq. 3.6) before a standing obstacle, at the end of a step of constant acceleration.
/// With a bounded jerk the vehicle begins early enough to build up the braking, and stops softly.
[[nodiscard]] inline LongitudinalMotion<double> motion_before_stop(double speed, double distance, double deceleration,
                                                                   double hardest, double dt,
                                                                   JerkBound const& bound = {}) {
  double const needed = distance > 0.0 ? speed * speed / (2.0 * distance) : std::numeric_limits<double>::infinity();
  double const braking = std::min(std::max(deceleration, needed), hardest), change = braking * dt;
  if (needed > hardest) {
    double const end = std::max(0.0, speed - change);
    return {end > 0.0 ? 0.5 * (speed + end) * dt : speed * speed / (2.0 * braking), end};
  }
  double end = 0.0;
  if (!bound.matters()) {
    double const root = change * change - 4.0 * braking * (speed * dt - 2.0 * distance);
    end = 0.5 * (std::sqrt(std::max(0.0, root)) - change);
  } else if (0.5 * speed * dt < distance) {
    end = speed + dt * detail::highest_acceleration(speed, distance, 0.0, deceleration, -hardest, bound, dt);
  }
  if (end <= 0.0) return {std::min(distance, 0.5 * speed * dt), 0.0};  // it stops before the end of the step
  return {0.5 * (speed + end) * dt, end};
}

/// The longest motion over `dt` [s] after which a vehicle of `speed` [m/s] can still slow down to `highest` [m/s]
/// within `distance` [m] (0 or less: at once) by braking with `deceleration` [m/s^2]; if that no longer suffices, it
/// brakes harder, up to `hardest` [m/s^2]. Derived as `motion_before_stop`; a bounded jerk counts likewise.
[[nodiscard]] inline LongitudinalMotion<double> motion_before_bend(double speed, double distance, double highest,
                                                                   double deceleration, double hardest, double dt,
                                                                   JerkBound const& bound = {}) {
  double const at_once = detail::approach(speed, highest, bound, dt);
  double a = at_once, lowest = -hardest;
  if (distance > 0.0) {
    lowest = -std::min(hardest, std::max(deceleration, (speed * speed - highest * highest) / (2.0 * distance)));
    if (bound.matters()) {
      a = std::max(at_once, detail::highest_acceleration(speed, distance, highest, deceleration, lowest, bound, dt));
    } else {
      double const change = deceleration * dt;
      double const root = change * change + 4.0 * (highest * highest + deceleration * (2.0 * distance - speed * dt));
      a = std::max(at_once, (0.5 * (std::sqrt(std::max(0.0, root)) - change) - speed) / dt);
    }
  }
  double const end = speed + dt * std::max(a, lowest);
  return {0.5 * (speed + end) * dt, end};
}

namespace detail {

/// A vehicle slower than this at a junction or a merge has hardly begun to move, or is about to stop [m/s]. Own
/// choice.
inline constexpr double starting_speed = 3.5;
/// Acceleration of a vehicle that leaves a junction or merges [m/s^2]. Own choice.
inline constexpr double pull_away = 1.0;

/// Highest speed [m/s] at position `s` [m] of a corridor from which a driver who brakes by `deceleration` [m/s^2]
/// reaches every lower speed limit ahead 3 s early, because car following approaches a desired speed slowly; infinite
/// without limits. O(limits within the braking distance).
CAMBIUM_NOINLINE [[nodiscard]] inline double permitted_speed(map::LaneCorridor const& corridor, double s, double speed,
                                                             double deceleration) {
  double permitted = corridor.speed_limit_at(s);
  double const early = s + 3.0 * speed, reach = early + speed * speed / (2.0 * deceleration);
  for (auto const& step : corridor.speed_limits) {
    if (step.begin <= s) continue;
    if (step.begin > reach) break;
    double const room = std::max(0.0, step.begin - early);
    permitted = std::min(permitted, std::sqrt(step.limit * step.limit + 2.0 * deceleration * room));
  }
  return permitted;
}

/// What the bends within reach permit.
struct BendsAhead {
  double highest;                    ///< speed in the sharpest of them [m/s]
  LongitudinalMotion<double> bound;  ///< longest motion of a step
};

/// What the bends within the step of `dt` [s] and the braking distance at `deceleration` [m/s^2] permit a vehicle of
/// `speed` [m/s] at `s` [m], so that it takes each of them with at most `lateral_acceleration` [m/s^2]. It brakes up to
/// `hardest` [m/s^2] if the bend is too close for that, see `motion_before_bend`. Without bends `highest` is
/// `desired_speed` [m/s]. O(log bends + bends within reach).
[[nodiscard]] inline BendsAhead bends_ahead(map::LaneCorridor const& corridor, double s, double speed,
                                            double desired_speed, double lateral_acceleration, double deceleration,
                                            double hardest, double dt, JerkBound const& bound = {}) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  BendsAhead ahead{desired_speed, {infinite, infinite}};
  double const reach =
      s + speed * dt + stopping_distance(speed, std::max(0.0, bound.acceleration), deceleration, bound);
  auto const& bends = corridor.bends;
  if (bends.empty() || bends.front().begin > reach || bends.back().end < s) return ahead;
  auto bend = std::partition_point(bends.begin(), bends.end(), [s](map::Bend const& b) { return b.end < s; });
  for (; bend != bends.end() && bend->begin <= reach; ++bend) {
    double const highest = std::sqrt(lateral_acceleration / bend->curvature);
    auto const motion = motion_before_bend(speed, bend->begin - s, highest, deceleration, hardest, dt, bound);
    ahead.highest = std::min(ahead.highest, highest);
    if (motion.distance < ahead.bound.distance) ahead.bound = motion;
  }
  return ahead;
}

}  // namespace detail

}  // namespace cambium::inline v0_1
