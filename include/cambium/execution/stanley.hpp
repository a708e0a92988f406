#pragma once

#include "cambium/core/portable_math.hpp"
#include "cambium/execution/steering.hpp"
#include "cambium/execution/tracking.hpp"

namespace cambium::inline v0_1 {

/// Tracks the plan with two controllers: Stanley's law for the steering (Hoffmann et al. 2007), and a PI controller for
/// the speed, whose integral term is the distance that the vehicle lags behind.
struct StanleyExecution {
  double cross_track_gain = 2.0;
  double softening_speed = 1.0;
  double speed_gain = 1.5;
  double lag_gain = 1.0;
  Actuation actuation{};

  static constexpr char const* name = "stanley";
  static constexpr char const* summary =
      "steering = curvature and heading error - atan(k e / (v + v_soft)) at the front axle; acceleration by PI "
      "control of speed and lag";
  static constexpr char const* source = "Hoffmann, Tomlin, Montemerlo, Thrun 2007";
  static constexpr auto parameters() {
    using Self = StanleyExecution;
    return parameter_list(
        parameter("cross_track_gain", &Self::cross_track_gain, "1/s", Range{0, 20},
                  "decay rate of an offset from the plan"),
        parameter("softening_speed", &Self::softening_speed, "m/s", Range{0, 20}, "calms the steering at low speed"),
        parameter("speed_gain", &Self::speed_gain, "1/s", Range{0, 20}, "acceleration per speed error"),
        parameter("lag_gain", &Self::lag_gain, "1/s^2", Range{0, 20}, "acceleration per distance lagged behind"),
        parameter("actuation", &Self::actuation, "delay and noise of the commands"));
  }

  template <MotionState S>
  using Memory = TrackingMemory<S>;

  template <MotionState S, class Dynamics>
  [[nodiscard]] Executed<S> execute(BasicPlan<S> const& plan, S const& now, Dynamics const& dynamics, double time,
                                    TrackingMemory<S>& memory, RandomStream& random) const {
    double const wheel_base = wheel_base_of(dynamics);
    auto const law = [&](Reference const& reference, TrackingError const& error, S const& x, double h) -> Action {
      // The front axle's target is one wheel base straight ahead of the reference, beside a curved path. So a vehicle
      // whose rear axle follows the path has no error.
      double const front = error.left + wheel_base * portable::sin(error.heading);
      double const feedback = stanley_steering(-error.heading, front, x.speed, cross_track_gain, softening_speed);
      return {reference.acceleration - speed_gain * error.speed - lag_gain * error.along,
              portable::atan(reference.curvature * wheel_base) + feedback * held_feedback(x.speed * h, wheel_base)};
    };
    return track(actuation, law, plan, now, dynamics, time, memory, random);
  }
};
static_assert(ExecutionModel<StanleyExecution>);

}  // namespace cambium::inline v0_1
