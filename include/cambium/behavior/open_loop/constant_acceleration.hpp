#pragma once

#include <algorithm>
#include <cmath>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/law/follow_lane.hpp"

namespace cambium::inline v0_1 {

/// Follows its lane with constant acceleration (0: constant speed) and ignores all others. It first ends the motion
/// across the lane that its heading shows, such as a lane change. It stops rather than reverses.
struct ConstantAcceleration {
  double acceleration = 0.0;
  double highest_speed = 50.0;

  static constexpr char const* name = "constant_acceleration";
  static constexpr char const* summary =
      "keeps its lane, or ends the lane change that its heading shows; v changes by a until the vehicle stands or has "
      "its highest speed";
  static constexpr char const* source = "kinematics";
  static constexpr auto parameters() {
    return parameter_list(parameter("acceleration", &ConstantAcceleration::acceleration, "m/s^2", Range{-50, 50},
                                    "held until the vehicle stands or has its highest speed"),
                          parameter("highest_speed", &ConstantAcceleration::highest_speed, "m/s", Range{0, 200},
                                    "limit when accelerating"));
  }

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, NoMemory&, double dt) const {
    constexpr double aslant = 1e-3;  // [rad]
    bool adrift = std::abs(view.place().heading_error) > aslant;
    return plan_into_lane(view, motion(std::max(0.0, view.state().speed), dt), dt, adrift);
  }

  /// Exact motion over `dt` [s] from `speed` [m/s].
  [[nodiscard]] LongitudinalMotion<double> motion(double speed, double dt) const {
    double const limit = acceleration < 0 ? 0.0 : std::max(highest_speed, speed);
    double const until_limit = acceleration == 0 ? dt : std::clamp((limit - speed) / acceleration, 0.0, dt);
    double const distance = speed * until_limit + acceleration * until_limit * until_limit / 2;
    if (!(until_limit < dt)) return {distance, speed + acceleration * dt};  // or NaN
    return {distance + limit * (dt - until_limit), limit};
  }
};
static_assert(BehaviorModel<ConstantAcceleration>);

}  // namespace cambium::inline v0_1
