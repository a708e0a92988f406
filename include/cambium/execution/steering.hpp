#pragma once

#include <cmath>

#include "cambium/geometry/angle.hpp"

namespace cambium {

/// The steering angle [rad] by which a vehicle's front axle comes to a line (Hoffmann, Tomlin, Montemerlo, Thrun 2007,
/// "Autonomous automobile trajectory tracking for off-road driving", eq. 5). `heading_error`: of the line over the
/// vehicle [rad]; `offset`: of the front axle to the left of the line [m]; `gain` [1/s]; `softening_speed` [m/s] keeps
/// it calm at low speed.
[[nodiscard]] inline double stanley_steering(double heading_error, double offset, double speed, double gain,
                                             double softening_speed) {
  double const pull = gain * offset, pace = speed + softening_speed;
  return heading_error - (pace > 0.0 ? geometry::arc_tangent(pull / pace) : std::atan2(pull, pace));
}

/// How much of a feedback that a step begins with is to be held over it, so that a heading error decays over the step
/// as it would under the same feedback at every moment: (1 - exp(-p)) / p as a fraction, p = `travelled` /
/// `wheel_base`. Without it a long step turns too far. Its error in what is left of the heading error is below 0.001 up
/// to p = 1.5.
[[nodiscard]] inline double held_feedback(double travelled, double wheel_base) {
  // 1 / (1 + p / 2 + p^2 / 12)
  double const square = wheel_base * wheel_base;
  return square / (square + travelled * (0.5 * wheel_base + travelled * (1.0 / 12)));
}

}  // namespace cambium
