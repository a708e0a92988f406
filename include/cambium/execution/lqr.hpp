#pragma once

#include <algorithm>

#include "cambium/core/portable_math.hpp"
#include "cambium/execution/lqr_gain.hpp"
#include "cambium/execution/tracking.hpp"

namespace cambium::inline v0_1 {

/// Tracks the plan with two discrete-time linear-quadratic regulators. The lateral one corrects offset and heading by
/// steering, the longitudinal one lag and speed by acceleration. The lateral gain belongs to the speed at the beginning
/// of the step, but at least 1 m/s; a slower vehicle therefore converges slowly. Only the ratios of the error weights
/// to the input weight matter.
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
      "u = -K x, K from the discrete Riccati equation; lateral: x = (offset, heading error), longitudinal: x = (lag, "
      "speed error)";
  static constexpr char const* source = "linear-quadratic regulator; solver: Chu, Fan, Lin, Wang 2004";
  static constexpr auto parameters() {
    using Self = LqrExecution;
    constexpr Range weight{0, 1e6}, of_input{1e-6, 1e6};
    return parameter_list(
        parameter("offset_weight", &Self::offset_weight, "1/m^2", weight, "of the squared offset from the plan"),
        parameter("heading_weight", &Self::heading_weight, "1/rad^2", weight, "of the squared heading error"),
        parameter("steering_weight", &Self::steering_weight, "1/rad^2", of_input, "of the squared steering angle"),
        parameter("lag_weight", &Self::lag_weight, "1/m^2", weight, "of the squared lag behind the plan"),
        parameter("speed_weight", &Self::speed_weight, "s^2/m^2", weight, "of the squared speed error"),
        parameter("acceleration_weight", &Self::acceleration_weight, "s^4/m^2", of_input,
                  "of the squared acceleration"),
        parameter("actuation", &Self::actuation, "delay and noise of the commands"));
  }

  template <MotionState S>
  using Memory = TrackingMemory<S>;

  /// Gain from (offset, heading error) to steering at `speed` [m/s]; commands are held for `h` [s].
  [[nodiscard]] LqrGain lateral_gain(double speed, double wheel_base, double h) const {
    double const v = std::max(1.0, speed), turn = v * h / wheel_base;
    return lqr_gain({1.0, v * h, 0.0, 1.0}, 0.5 * v * h * turn, turn, offset_weight, heading_weight, steering_weight);
  }

  /// Gain from (lag, speed error) to acceleration; commands are held for `h` [s].
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
      return {
          reference.acceleration - along.first * error.along - along.second * error.speed,
          portable::atan(reference.curvature * wheel_base) - across.first * error.left - across.second * error.heading};
    };
    return track(actuation, law, plan, now, dynamics, time, memory, random);
  }
};
static_assert(ExecutionModel<LqrExecution>);

}  // namespace cambium::inline v0_1
