#pragma once

#include <algorithm>
#include <cmath>
#include <tuple>
#include <type_traits>

#include "cambium/core/parameters.hpp"
#include "cambium/dynamics/dynamic_model.hpp"

namespace cambium {

/// What a driver does over a step.
template <class Scalar>
struct SingleTrackInput {
  Scalar acceleration{};  ///< [m/s^2]
  Scalar steering{};      ///< steering angle of the front axle, left positive [rad]
};

/// Kinematic single-track ("bicycle") model about the centre of the rear axle (Rajamani 2012, Vehicle Dynamics and
/// Control, section 2.2, with the reference point at the rear): x' = v cos(heading), y' = v sin(heading), heading' = v
/// tan(steering) / wheel base.
struct SingleTrack {
  using State = cambium::State;
  using Input = SingleTrackInput<double>;

  double wheel_base = 2.7;
  double steering_limit = 0.6;
  double lowest_acceleration = -8.0;
  double highest_acceleration = 4.0;

  static constexpr char const* name = "single_track";
  static constexpr auto parameters() {
    return std::make_tuple(
        parameter("wheel_base", &SingleTrack::wheel_base, "m", Range{0.1, 20}, "distance between the axles"),
        parameter("steering_limit", &SingleTrack::steering_limit, "rad", Range{0, 1.5},
                  "largest steering angle to either side"),
        parameter("lowest_acceleration", &SingleTrack::lowest_acceleration, "m/s^2", Range{-50, 0}, "hardest braking"),
        parameter("highest_acceleration", &SingleTrack::highest_acceleration, "m/s^2", Range{0, 50},
                  "fullest throttle"));
  }

  /// Change per second, in any scalar: `double`, `float`, one that differentiates.
  template <class Scalar>
  [[nodiscard]] BasicState<Scalar> derivative(BasicState<Scalar> const& x,
                                              SingleTrackInput<std::type_identity_t<Scalar>> const& u) const {
    using std::cos;
    using std::sin;
    using std::tan;
    return {Scalar(1), x.speed * cos(x.heading), x.speed * sin(x.heading),
            x.speed * tan(u.steering) / Scalar(wheel_base), u.acceleration};
  }

  [[nodiscard]] Input limited(Input const& u, State const&) const {
    return {std::clamp(u.acceleration, lowest_acceleration, highest_acceleration),
            std::clamp(u.steering, -steering_limit, steering_limit)};
  }
};
static_assert(DynamicModel<SingleTrack>);

}  // namespace cambium
