#pragma once

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "cambium/core/parameters.hpp"
#include "cambium/dynamics/single_track.hpp"

namespace cambium::inline v0_1 {

/// A motion state with the steering angle of the front wheels.
template <class Scalar>
struct BasicSteeringState {
  Scalar time{}, x{}, y{}, heading{}, speed{};  ///< as in `BasicState`
  Scalar steering{};                            ///< angle at the front axle, left positive [rad]

  static constexpr char const* name = "steering_state";
  static constexpr auto parameters() {
    using S = BasicSteeringState;
    return parameter_list(
        parameter("time", &S::time, "s", any_finite, "of the state"),
        parameter("x", &S::x, "m", any_finite, "of the reference point, map frame"),
        parameter("y", &S::y, "m", any_finite, "likewise"),
        parameter("heading", &S::heading, "rad", any_finite, "counter-clockwise from +x"),
        parameter("speed", &S::speed, "m/s", any_finite, "along the heading"),
        parameter("steering", &S::steering, "rad", any_finite, "angle at the front axle, left positive"));
  }

  friend bool operator==(BasicSteeringState const&, BasicSteeringState const&) = default;
};

/// Input of `SingleTrackSteering`.
template <class Scalar>
struct SteeringRateInput {
  Scalar acceleration{};   ///< [m/s^2]
  Scalar steering_rate{};  ///< [rad/s]
};

/// Kinematic single-track model with the steering angle as a state: the wheels turn at a limited rate. The steering
/// angle follows the driver's with a first-order lag of `response_time`, at most at the rate limit. Integrate in steps
/// no longer than `response_time`.
struct SingleTrackSteering {
  using State = BasicSteeringState<double>;
  using Input = SteeringRateInput<double>;

  double wheel_base = car_wheel_base;
  double steering_limit = 0.6;
  double steering_rate_limit = 0.8;
  double response_time = 0.1;
  double lowest_acceleration = -8.0;
  double highest_acceleration = 4.0;
  double lateral_acceleration_limit = 8.0;

  static constexpr char const* name = "single_track_steering";
  static constexpr char const* summary = "single track whose steering angle is a state, with a limited rate and a lag";
  static constexpr char const* source = "Rajamani 2012, section 2.2; lag: own";
  static constexpr auto parameters() {
    using Self = SingleTrackSteering;
    return parameter_list(
        parameter("wheel_base", &Self::wheel_base, "m", Range{0.1, 20}, "distance between the axles"),
        parameter("steering_limit", &Self::steering_limit, "rad", Range{0, 1.5},
                  "largest steering angle to either side"),
        parameter("steering_rate_limit", &Self::steering_rate_limit, "rad/s", Range{0.01, 100},
                  "highest rate of the steering angle"),
        parameter("response_time", &Self::response_time, "s", Range{0.01, 10},
                  "time constant of the steering's response to the driver"),
        parameter("lowest_acceleration", &Self::lowest_acceleration, "m/s^2", Range{-50, 0}, "hardest braking"),
        parameter("highest_acceleration", &Self::highest_acceleration, "m/s^2", Range{0, 50}, "fullest throttle"),
        parameter("lateral_acceleration_limit", &Self::lateral_acceleration_limit, "m/s^2", Range{0.1, 1000},
                  "limit on speed^2 times curvature, applied to the driver's action"));
  }

  template <class Scalar>
  [[nodiscard]] BasicSteeringState<Scalar> derivative(BasicSteeringState<Scalar> const& x,
                                                      SteeringRateInput<std::type_identity_t<Scalar>> const& u) const {
    auto const along = direction_of(x.heading);
    return {Scalar(1),           x.speed * along.cos,
            x.speed * along.sin, x.speed * steering_curvature(x.steering, wheel_base),
            u.acceleration,      u.steering_rate};
  }

  /// At the angle limit, the wheels turn no further.
  [[nodiscard]] Input limited(Input const& u, State const& x) const {
    double rate = std::clamp(u.steering_rate, -steering_rate_limit, steering_rate_limit);
    if (std::abs(x.steering) >= steering_limit && rate * x.steering > 0.0) rate = 0.0;
    return {std::clamp(u.acceleration, lowest_acceleration, highest_acceleration), rate};
  }

  [[nodiscard]] Input input(Action const& action, State const& x) const {
    double const largest = steering_within_grip(std::min(std::abs(action.steering), steering_limit),
                                                lateral_acceleration_limit, wheel_base, x.speed);
    double const wanted = std::copysign(largest, action.steering);
    return limited({action.acceleration, (wanted - x.steering) / response_time}, x);
  }
};
static_assert(DynamicModel<SingleTrackSteering>);

}  // namespace cambium::inline v0_1
