#pragma once

#include <algorithm>
#include <cmath>

#include "cambium/execution/lqr_gain.hpp"
#include "cambium/execution/tracking.hpp"

namespace cambium {

/// Follows the plan by the linear-quadratic regulators of its errors, across (offset and heading, by the steering) and
/// along (lag and speed, by the acceleration), discrete in time, the one across for the speed that the step begins
/// with, or 1 m/s where that is less: slower than that it comes to the path slowly. The weights are relative to those
/// of the inputs.
struct LqrExecution {
  double offset_weight = 1.0;
  double heading_weight = 1.0;
  double steering_weight = 40.0;
  double lag_weight = 1.0;
  double speed_weight = 1.0;
  double acceleration_weight = 1.0;
  Actuation actuation{};

  static constexpr char const* name = "lqr";
  static constexpr char const* summary =
      "u = -K x with K from the discrete Riccati equation, across for (offset, heading error), along for (lag, speed "
      "error)";
  static constexpr char const* source = "linear-quadratic regulator; solver: Chu, Fan, Lin, Wang 2004";
  static constexpr auto parameters() {
    using Self = LqrExecution;
    constexpr Range weight{0, 1e6}, of_input{1e-6, 1e6};
    return parameter_list(
        parameter("offset_weight", &Self::offset_weight, "1/m^2", weight, "of the offset from the plan, squared"),
        parameter("heading_weight", &Self::heading_weight, "1/rad^2", weight, "of the heading's error, squared"),
        parameter("steering_weight", &Self::steering_weight, "1/rad^2", of_input, "of the steering, squared"),
        parameter("lag_weight", &Self::lag_weight, "1/m^2", weight, "of the way that it lags behind, squared"),
        parameter("speed_weight", &Self::speed_weight, "s^2/m^2", weight, "of the speed's error, squared"),
        parameter("acceleration_weight", &Self::acceleration_weight, "s^4/m^2", of_input,
                  "of the acceleration, squared"),
        parameter("actuation", &Self::actuation, "-", {}, "how commands are carried out"));
  }

  template <MotionState S>
  using Memory = TrackingMemory<S>;

  /// Gain of the steering on (offset, heading error) at `speed` [m/s], commands being held for `h` [s].
  [[nodiscard]] LqrGain lateral_gain(double speed, double wheel_base, double h) const {
    double const v = std::max(1.0, speed), turn = v * h / wheel_base;
    return lqr_gain({1.0, v * h, 0.0, 1.0}, 0.5 * v * h * turn, turn, offset_weight, heading_weight, steering_weight);
  }

  /// Gain of the acceleration on (lag, speed error).
  [[nodiscard]] LqrGain longitudinal_gain(double h) const {
    return lqr_gain({1.0, h, 0.0, 1.0}, 0.5 * h * h, h, lag_weight, speed_weight, acceleration_weight);
  }

  template <MotionState S, class Dynamics>
  [[nodiscard]] Executed<S> execute(BasicPlan<S> const& plan, S const& now, Dynamics const& dynamics, double time,
                                    TrackingMemory<S>& memory, RandomStream& random) const {
    double const wheel_base = wheel_base_of(dynamics);
    double const h = actuation.interval(std::max(1e-3, time - now.time));
    auto const across = lateral_gain(now.speed, wheel_base, h), along = longitudinal_gain(h);
    auto const law = [&](Reference const& reference, TrackingError const& error, S const&, double) -> Action {
      return {reference.acceleration - along.first * error.along - along.second * error.speed,
              std::atan(reference.curvature * wheel_base) - across.first * error.left - across.second * error.heading};
    };
    return track(actuation, law, plan, now, dynamics, time, memory, random);
  }
};
static_assert(ExecutionModel<LqrExecution>);

}  // namespace cambium
