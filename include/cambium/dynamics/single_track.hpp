#pragma once

#include <algorithm>
#include <cmath>
#include <tuple>

#include "cambium/core/parameters.hpp"
#include "cambium/dynamics/dynamic_model.hpp"

namespace cambium {

/// Kinematic single-track ("bicycle") model about the centre of the rear axle (Rajamani 2012, Vehicle Dynamics and
/// Control, section 2.2, with the reference point at the rear): x' = v cos(heading), y' = v sin(heading), heading' = v
/// tan(steering) / wheel base.
struct SingleTrack {
  using State = cambium::State;
  struct Input {
    double acceleration{};  ///< [m/s^2]
    double steering{};      ///< steering angle of the front axle, left positive [rad]
  };

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

  [[nodiscard]] State derivative(State const& x, Input const& u) const {
    return {1.0, x.speed * std::cos(x.heading), x.speed * std::sin(x.heading),
            x.speed * std::tan(u.steering) / wheel_base, u.acceleration};
  }

  [[nodiscard]] Input limited(Input const& u, State const&) const {
    return {std::clamp(u.acceleration, lowest_acceleration, highest_acceleration),
            std::clamp(u.steering, -steering_limit, steering_limit)};
  }
};
static_assert(DynamicModel<SingleTrack>);

}  // namespace cambium
