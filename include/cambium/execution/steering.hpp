#pragma once

#include <cmath>

#include "cambium/geometry/angle.hpp"

namespace cambium {

/// Arc tangent, to 1e-15 inline where it is small, as in steering it is.
[[nodiscard]] inline double arc_tangent(double t) {
  if (!(std::abs(t) <= 0.125)) return std::atan(t);
  double const q = t * t;
  return t * (1.0 - q * geometry::detail::polynomial(q, 1.0 / 3, -1.0 / 5, 1.0 / 7, -1.0 / 9, 1.0 / 11, -1.0 / 13));
}

/// The steering angle [rad] by which a vehicle's front axle comes to a line (Hoffmann, Tomlin, Montemerlo, Thrun 2007,
/// "Autonomous automobile trajectory tracking for off-road driving", eq. 5). `heading_error`: of the line over the
/// vehicle [rad]; `offset`: of the front axle to the left of the line [m]; `gain` [1/s]; `softening_speed` [m/s] keeps
/// it calm at low speed.
[[nodiscard]] inline double stanley_steering(double heading_error, double offset, double speed, double gain,
                                             double softening_speed) {
  double const pull = gain * offset, pace = speed + softening_speed;
  return heading_error - (pace > 0.0 ? arc_tangent(pull / pace) : std::atan2(pull, pace));
}

/// How much of a feedback that a step begins with is to be held over it, so that a heading error decays over the step
/// as it would under the same feedback at every moment: (1 - exp(-p)) / p as a fraction, p = `travelled` /
/// `wheel_base`. Without it a long step turns too far. Its error in what is left of the heading error is below 0.001 up
/// to p = 1.5.
[[nodiscard]] inline double held_feedback(double travelled, double wheel_base) {
  double const p = travelled / wheel_base;
  return 1.0 / (1.0 + p * (0.5 + p / 12.0));
}

}  // namespace cambium
