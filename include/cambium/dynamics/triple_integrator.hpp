#pragma once

#include <algorithm>
#include <cmath>
#include <tuple>
#include <type_traits>

#include "cambium/core/parameters.hpp"
#include "cambium/dynamics/single_track.hpp"

namespace cambium {

/// A motion state with its acceleration.
template <class Scalar>
struct BasicAcceleratedState {
  Scalar time{}, x{}, y{}, heading{}, speed{};  ///< as of `BasicState`
  Scalar acceleration{};                        ///< along the heading [m/s^2]
  Scalar lateral_acceleration{};                ///< to the left of it [m/s^2]

  friend bool operator==(BasicAcceleratedState const&, BasicAcceleratedState const&) = default;
};

template <class Scalar>
[[nodiscard]] BasicAcceleratedState<Scalar> add_scaled(BasicAcceleratedState<Scalar> const& a,
                                                       BasicAcceleratedState<Scalar> const& derivative, double h) {
  auto const s = Scalar(h);
  return {a.time + s * derivative.time,
          a.x + s * derivative.x,
          a.y + s * derivative.y,
          a.heading + s * derivative.heading,
          a.speed + s * derivative.speed,
          a.acceleration + s * derivative.acceleration,
          a.lateral_acceleration + s * derivative.lateral_acceleration};
}

/// Change of the acceleration's vector in the map frame.
template <class Scalar>
struct JerkInput {
  Scalar x{}, y{};  ///< [m/s^3]
};

/// Jerk in the plane: x''' and y''' are the input, the state is kept as heading, speed and the acceleration along and
/// across it (the same motion, in the coordinates of the path). Below `lowest_turning_speed` the heading stays, and
/// with it the lateral acceleration has no effect.
struct TripleIntegrator {
  using State = BasicAcceleratedState<double>;
  using Input = JerkInput<double>;

  double jerk_limit = 10.0;
  double response_time = 0.2;
  double wheel_base = 2.7;
  double lowest_acceleration = -8.0;
  double highest_acceleration = 4.0;
  double lateral_acceleration_limit = 8.0;
  double lowest_turning_speed = 0.05;

  static constexpr char const* name = "triple_integrator";
  static constexpr char const* summary = "x''' = j_x, y''' = j_y, in the coordinates of the path";
  static constexpr char const* source = "kinematics; after BARK";
  static constexpr auto parameters() {
    using Self = TripleIntegrator;
    return std::make_tuple(
        parameter("jerk_limit", &Self::jerk_limit, "m/s^3", Range{0.01, 1000}, "length of the jerk at most"),
        parameter("response_time", &Self::response_time, "s", Range{0.01, 10},
                  "of the acceleration to what the driver asks for"),
        parameter("wheel_base", &Self::wheel_base, "m", Range{0.1, 20}, "of the vehicle that a driver steers"),
        parameter("lowest_acceleration", &Self::lowest_acceleration, "m/s^2", Range{-50, 0},
                  "hardest braking that a driver's action is kept within"),
        parameter("highest_acceleration", &Self::highest_acceleration, "m/s^2", Range{0, 50},
                  "fullest throttle that a driver's action is kept within"),
        parameter("lateral_acceleration_limit", &Self::lateral_acceleration_limit, "m/s^2", Range{0.1, 1000},
                  "that a driver's action is kept within"),
        parameter("lowest_turning_speed", &Self::lowest_turning_speed, "m/s", Range{1e-6, 10},
                  "the heading changes above it"));
  }

  template <class Scalar>
  [[nodiscard]] BasicAcceleratedState<Scalar> derivative(BasicAcceleratedState<Scalar> const& x,
                                                         JerkInput<std::type_identity_t<Scalar>> const& u) const {
    auto const along = direction_of(x.heading);
    Scalar const yaw_rate = x.speed > Scalar(lowest_turning_speed) ? x.lateral_acceleration / x.speed : Scalar(0);
    return {Scalar(1),
            x.speed * along.cos,
            x.speed * along.sin,
            yaw_rate,
            x.acceleration,
            u.x * along.cos + u.y * along.sin + x.lateral_acceleration * yaw_rate,
            u.y * along.cos - u.x * along.sin - x.acceleration * yaw_rate};
  }

  [[nodiscard]] Input limited(Input const& u, State const&) const {
    double const length = std::hypot(u.x, u.y);
    if (!(length > jerk_limit)) return u;
    return {u.x * (jerk_limit / length), u.y * (jerk_limit / length)};
  }

  [[nodiscard]] Input input(Action const& action, State const& x) const {
    double const tangent = std::tan(std::clamp(action.steering, -1.5, 1.5));
    double const across =
        std::clamp(x.speed * x.speed * tangent / wheel_base, -lateral_acceleration_limit, lateral_acceleration_limit);
    double const forward =
                     (std::clamp(action.acceleration, lowest_acceleration, highest_acceleration) - x.acceleration) /
                     response_time,
                 left = (across - x.lateral_acceleration) / response_time;
    // The acceleration turns with the vehicle.
    double const yaw_rate = x.speed > lowest_turning_speed ? x.lateral_acceleration / x.speed : 0.0;
    double const along_jerk = forward - x.lateral_acceleration * yaw_rate,
                 across_jerk = left + x.acceleration * yaw_rate;
    auto const [sin, cos] = geometry::sin_cos(x.heading);
    return limited({along_jerk * cos - across_jerk * sin, along_jerk * sin + across_jerk * cos}, x);
  }

  /// One that stands is not accelerated any more.
  [[nodiscard]] State stopped(State x) const {
    x.acceleration = x.lateral_acceleration = 0.0;
    return x;
  }
};
static_assert(DynamicModel<TripleIntegrator>);

}  // namespace cambium
