#pragma once

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "cambium/core/parameters.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/dynamics/dynamic_model.hpp"

namespace cambium::inline v0_1 {

/// Input of the single-track model: the driver's action, held over a step.
template <class Scalar>
struct SingleTrackInput {
  Scalar acceleration{};  ///< [m/s^2]
  Scalar steering{};      ///< steering angle at the front axle, left positive [rad]
};

/// The largest steering angle [rad], at most `limit`, that keeps the lateral acceleration v^2 tan(steering) / wheel
/// base within its limit [m/s^2].
[[nodiscard]] inline double steering_within_grip(double limit, double lateral_acceleration_limit, double wheel_base,
                                                 double speed) {
  // atan is concave and atan(1) > 0.785, so atan(t) >= 0.785 t on [0, 1]. This bound decides most cases without atan or
  // division.
  double const across = lateral_acceleration_limit * wheel_base, square = speed * speed;
  if (limit <= 0.785 && limit * square <= 0.785 * across) return limit;
  return std::min(limit, portable::atan(across / square));
}

/// Sine and cosine of any scalar type.
template <class Scalar>
struct Direction {
  Scalar sin, cos;
};

/// Sine and cosine of `angle` [rad] for any scalar type; `double` uses `portable::sin_cos`.
template <class Scalar>
[[nodiscard]] Direction<Scalar> direction_of(Scalar const& angle) {
  if constexpr (std::is_same_v<Scalar, double>) {
    auto const [s, c] = portable::sin_cos(angle);
    return {s, c};
  } else {
    using portable::cos;
    using portable::sin;
    return {sin(angle), cos(angle)};
  }
}

/// Curvature [1/m] of the path of the rear axle's centre at a steering angle, |steering| <= 1e5 rad.
template <class Scalar>
[[nodiscard]] Scalar steering_curvature(Scalar const& steering, double wheel_base) {
  if constexpr (std::is_same_v<Scalar, double>) {
    if (std::abs(steering) <= portable::slight_angle) return portable::tan_slight(steering) / wheel_base;
    auto const [s, c] = portable::sin_cos_bounded(steering);
    return s / (c * wheel_base);
  } else {
    using portable::tan;
    return tan(steering) / Scalar(wheel_base);
  }
}

/// Kinematic single-track ("bicycle") model with the reference point at the centre of the rear axle (after Rajamani
/// 2012, Vehicle Dynamics and Control, section 2.2): x' = v cos(heading), y' = v sin(heading),
/// heading' = v tan(steering) / wheel base, v' = acceleration.
struct SingleTrack {
  using State = cambium::State;
  using Input = SingleTrackInput<double>;

  double wheel_base = car_wheel_base;
  double steering_limit = 0.6;
  double lowest_acceleration = -8.0;
  double highest_acceleration = 4.0;
  double lateral_acceleration_limit = 8.0;

  static constexpr char const* name = "single_track";
  static constexpr char const* summary =
      "x' = v cos(heading), y' = v sin(heading), heading' = v tan(steering) / wheel base, v' = a";
  static constexpr char const* source = "Rajamani 2012, section 2.2, about the rear axle";
  static constexpr auto parameters() {
    return parameter_list(
        parameter("wheel_base", &SingleTrack::wheel_base, "m", Range{0.1, 20}, "distance between the axles"),
        parameter("steering_limit", &SingleTrack::steering_limit, "rad", Range{0, 1.5},
                  "largest steering angle to either side"),
        parameter("lowest_acceleration", &SingleTrack::lowest_acceleration, "m/s^2", Range{-50, 0}, "hardest braking"),
        parameter("highest_acceleration", &SingleTrack::highest_acceleration, "m/s^2", Range{0, 50},
                  "fullest throttle"),
        parameter("lateral_acceleration_limit", &SingleTrack::lateral_acceleration_limit, "m/s^2", Range{0.1, 1000},
                  "limit on speed^2 times curvature, which bounds the steering"));
  }

  /// Derivative of the state, for any scalar type: `double`, `float`, automatic differentiation.
  template <class Scalar>
  [[nodiscard]] BasicState<Scalar> derivative(BasicState<Scalar> const& x,
                                              SingleTrackInput<std::type_identity_t<Scalar>> const& u) const {
    auto const along = direction_of(x.heading);
    return {Scalar(1), x.speed * along.cos, x.speed * along.sin, x.speed * steering_curvature(u.steering, wheel_base),
            u.acceleration};
  }

  [[nodiscard]] Input limited(Input const& u, State const& x) const {
    double const largest = steering_within_grip(std::min(std::abs(u.steering), steering_limit),
                                                lateral_acceleration_limit, wheel_base, x.speed);
    return {std::clamp(u.acceleration, lowest_acceleration, highest_acceleration), std::copysign(largest, u.steering)};
  }

  [[nodiscard]] Input input(Action const& action, State const& x) const {
    return limited({action.acceleration, action.steering}, x);
  }
};
static_assert(DynamicModel<SingleTrack>);

/// Runge-Kutta step of the single track: the general result up to rounding, with less work. Under a constant input, the
/// speeds and headings of all stages are known beforehand; the headings are small turns from the first one.
[[nodiscard]] inline State rk4_step(SingleTrack const& model, State const& x, SingleTrackInput<double> const& u,
                                    double dt) {
  double const half = dt / 2, sixth = dt * (1.0 / 6);
  double const middle = x.speed + half * u.acceleration, end = x.speed + dt * u.acceleration;
  double const curvature = steering_curvature(u.steering, model.wheel_base);
  double const turn_2 = half * x.speed * curvature, turn_3 = half * middle * curvature;
  bool const slight = std::max(std::abs(turn_2), std::abs(turn_3)) <= portable::slight_angle;
  auto const first = portable::sin_cos(x.heading);
  auto const second = slight ? portable::sin_cos_slight(turn_2) : portable::sin_cos(turn_2);
  auto const third = slight ? portable::sin_cos_slight(turn_3) : portable::sin_cos(turn_3);
  // The fourth turn is twice the third one: double-angle formulas.
  double const sin_4 = 2.0 * third.sin * third.cos, cos_4 = 1.0 - 2.0 * third.sin * third.sin;
  // Weighted sum of the stage velocities, along and across the first heading.
  double const along = x.speed + 2.0 * middle * (second.cos + third.cos) + end * cos_4;
  double const across = 2.0 * middle * (second.sin + third.sin) + end * sin_4;
  return {x.time + dt, x.x + sixth * (first.cos * along - first.sin * across),
          x.y + sixth * (first.sin * along + first.cos * across),
          x.heading + sixth * curvature * (x.speed + 4.0 * middle + end), end};
}

}  // namespace cambium::inline v0_1
