#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "cambium/behavior/law/follow_lane.hpp"
#include "cambium/map/corridor/corridor.hpp"

namespace cambium {

/// A vehicle slower than this counts as stopped [m/s].
inline constexpr double standing_speed = 0.1;

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

/// The longest motion over `dt` [s] after which a vehicle of `speed` [m/s] can still stop within `distance` [m] by
/// braking with `deceleration` [m/s^2]; if that no longer suffices, it brakes harder, up to `hardest` [m/s^2]. This is
/// the safe speed of Krauss (1998, eq. 3.6) before a standing obstacle, at the end of a step of constant acceleration.
[[nodiscard]] inline LongitudinalMotion<double> motion_before_stop(double speed, double distance, double deceleration,
                                                                   double hardest, double dt) {
  double const needed = distance > 0.0 ? speed * speed / (2.0 * distance) : std::numeric_limits<double>::infinity();
  double const braking = std::min(std::max(deceleration, needed), hardest), change = braking * dt;
  if (needed > hardest) {
    double const end = std::max(0.0, speed - change);
    return {end > 0.0 ? 0.5 * (speed + end) * dt : speed * speed / (2.0 * braking), end};
  }
  double const root = change * change - 4.0 * braking * (speed * dt - 2.0 * distance);
  double const end = 0.5 * (std::sqrt(std::max(0.0, root)) - change);
  if (end <= 0.0) return {std::min(distance, 0.5 * speed * dt), 0.0};  // it stops before the end of the step
  return {0.5 * (speed + end) * dt, end};
}

/// The longest motion over `dt` [s] after which a vehicle of `speed` [m/s] can still slow down to `highest` [m/s]
/// within `distance` [m] (0 or less: at once) by braking with `deceleration` [m/s^2]; if that no longer suffices, it
/// brakes with `hardest` [m/s^2]. Derived as `motion_before_stop`.
[[nodiscard]] inline LongitudinalMotion<double> motion_before_bend(double speed, double distance, double highest,
                                                                   double deceleration, double hardest, double dt) {
  double end = highest;
  if (distance > 0.0) {
    double const change = deceleration * dt;
    double const root = change * change + 4.0 * (highest * highest + deceleration * (2.0 * distance - speed * dt));
    end = std::max(highest, 0.5 * (std::sqrt(std::max(0.0, root)) - change));
  }
  end = std::max(end, speed - hardest * dt);
  return {0.5 * (speed + end) * dt, end};
}

}  // namespace cambium
