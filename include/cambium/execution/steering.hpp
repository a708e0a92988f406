#pragma once

#include "cambium/core/portable_math.hpp"

namespace cambium::inline v0_1 {

/// Stanley's steering law: the steering angle [rad] that brings a vehicle's front axle to a line (Hoffmann, Tomlin,
/// Montemerlo, Thrun 2007, "Autonomous automobile trajectory tracking for off-road driving", eq. 5). `heading_error`:
/// heading of the line minus that of the vehicle [rad]; `offset`: of the front axle to the left of the line [m]; `gain`
/// [1/s]; `softening_speed` [m/s] calms the steering at low speed.
[[nodiscard]] inline double stanley_steering(double heading_error, double offset, double speed, double gain,
                                             double softening_speed) {
  double const pull = gain * offset, pace = speed + softening_speed;
  return heading_error - (pace > 0.0 ? portable::atan(pull / pace) : portable::atan2(pull, pace));
}

/// Factor on a steering feedback that is held over a step, so that the heading error decays as much as under continuous
/// feedback: (1 - exp(-p)) / p with p = `travelled` / `wheel_base`. Without it, the vehicle turns too far in a long
/// step. The factor is a rational approximation; up to p = 1.5, it changes the remaining fraction of the heading error
/// by less than 0.001.
[[nodiscard]] inline double held_feedback(double travelled, double wheel_base) {
  // 1 / (1 + p / 2 + p^2 / 12)
  double const square = wheel_base * wheel_base;
  return square / (square + travelled * (0.5 * wheel_base + travelled * (1.0 / 12)));
}

}  // namespace cambium::inline v0_1
