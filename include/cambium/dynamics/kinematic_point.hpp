#pragma once

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "cambium/core/parameters.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/dynamics/single_track.hpp"

namespace cambium::inline v0_1 {

/// Input of `KinematicPoint`.
template <class Scalar>
struct KinematicPointInput {
  Scalar acceleration{};  ///< along the heading [m/s^2]
  Scalar yaw_rate{};      ///< counter-clockwise [rad/s]
};

/// A point that moves along its heading and can turn on the spot, for pedestrians and simple planners:
/// x' = v cos(heading), y' = v sin(heading), heading' = yaw rate, v' = acceleration. A driver's steering angle gives
/// the yaw rate of a single track with `wheel_base`.
struct KinematicPoint {
  using State = cambium::State;
  using Input = KinematicPointInput<double>;

  double wheel_base = 0.5;
  double yaw_rate_limit = 3.0;
  double lowest_acceleration = -5.0;
  double highest_acceleration = 3.0;
  double lateral_acceleration_limit = 5.0;
  double highest_speed = 3.0;

  static constexpr char const* name = "kinematic_point";
  static constexpr char const* summary =
      "x' = v cos(heading), y' = v sin(heading), heading' = yaw rate, v' = a; turns on the spot";
  static constexpr char const* source = "kinematics";
  static constexpr auto parameters() {
    using Self = KinematicPoint;
    return parameter_list(
        parameter("wheel_base", &Self::wheel_base, "m", Range{0.1, 20},
                  "translates the driver's steering angle to curvature"),
        parameter("yaw_rate_limit", &Self::yaw_rate_limit, "rad/s", Range{0, 100}, "highest yaw rate"),
        parameter("lowest_acceleration", &Self::lowest_acceleration, "m/s^2", Range{-50, 0}, "hardest braking"),
        parameter("highest_acceleration", &Self::highest_acceleration, "m/s^2", Range{0, 50}, "strongest acceleration"),
        parameter("lateral_acceleration_limit", &Self::lateral_acceleration_limit, "m/s^2", Range{0.1, 1000},
                  "limit on speed times yaw rate"),
        parameter("highest_speed", &Self::highest_speed, "m/s", Range{0.1, 200}, "accelerates only up to this speed"));
  }

  template <class Scalar>
  [[nodiscard]] BasicState<Scalar> derivative(BasicState<Scalar> const& x,
                                              KinematicPointInput<std::type_identity_t<Scalar>> const& u) const {
    auto const along = direction_of(x.heading);
    return {Scalar(1), x.speed * along.cos, x.speed * along.sin, u.yaw_rate, u.acceleration};
  }

  [[nodiscard]] Input limited(Input const& u, State const& x) const {
    double const turn = std::min(yaw_rate_limit, lateral_acceleration_limit / std::max(1e-9, std::abs(x.speed)));
    double const most = x.speed >= highest_speed ? 0.0 : highest_acceleration;
    return {std::clamp(u.acceleration, lowest_acceleration, most), std::clamp(u.yaw_rate, -turn, turn)};
  }

  [[nodiscard]] Input input(Action const& action, State const& x) const {
    return limited({action.acceleration, x.speed * portable::tan(std::clamp(action.steering, -1.5, 1.5)) / wheel_base},
                   x);
  }
};
static_assert(DynamicModel<KinematicPoint>);

}  // namespace cambium::inline v0_1
