#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/following/adaptive_cruise_control.hpp"
#include "cambium/behavior/law/idm.hpp"
#include "cambium/behavior/law/road_rules.hpp"
#include "cambium/dynamics/integration.hpp"
#include "cambium/execution/steering.hpp"
#include "cambium/geometry/angle.hpp"

namespace cambium {

/// Pose of a front axle relative to a line.
struct FrontAxle {
  double offset{};         ///< of the axle to the left of the line [m]
  double heading_error{};  ///< direction of the line minus that of the vehicle [rad]
  double curvature{};      ///< of the line [1/m]
};

/// Pose of the front axle, `wheel_base` [m] ahead of `state`, relative to `line`. `hint`: a nearby segment; becomes the
/// one found.
template <MotionState State>
[[nodiscard]] FrontAxle front_axle(geometry::Line const& line, State const& state, double wheel_base,
                                   std::uint32_t& hint) {
  auto const [sin, cos] = geometry::sin_cos(state.heading);
  auto const foot = line.project({state.x + wheel_base * cos, state.y + wheel_base * sin}, hint);
  hint = foot.segment;
  auto const& segment = line.segments()[foot.segment];
  double const along = segment.heading + segment.curvature * std::clamp(foot.s - segment.s, 0.0, segment.length);
  return {foot.lateral, geometry::angle_difference(along, state.heading), segment.curvature};
}

/// Follows the next vehicle in its lane corridor by IDM (by the ACC model with `coolness` above 0) and steers its front
/// axle to the corridor's centre line (Stanley controller) through its vehicle model. It slows down for bends so that
/// its lateral acceleration stays within `lateral_acceleration_limit`.
struct IdmLaneTracking {
  IdmParameters idm{};
  double coolness = 0.0;
  RoadRules rules{.slow_for_bends = true, .lateral_acceleration = 3.4};
  double cross_track_gain = 1.0;
  double softening_speed = 1.0;
  double lateral_acceleration_limit = 4.0;
  double longest_substep = 0.2;
  double tolerance = 1e-4;

  using Memory = RoadRules::Memory;

  static constexpr char const* name = "idm_lane_tracking";
  static constexpr char const* summary =
      "along: IDM, or the ACC model if coolness > 0, slower in bends; across: front axle to the centre line, steering "
      "= heading error - atan(k e / (v + v_soft)), through the vehicle model";
  static constexpr char const* source = "Treiber, Hennecke, Helbing 2000; Hoffmann, Tomlin, Montemerlo, Thrun 2007";
  static constexpr auto parameters() {
    using Self = IdmLaneTracking;
    return parameter_list(
        parameter("idm", &Self::idm, "the driver's car following"),
        parameter("coolness", &Self::coolness, "-", Range{0, 1}, "0: IDM; up to 1: as in the ACC model"),
        parameter("rules", &Self::rules, "what it heeds besides other road users"),
        parameter("cross_track_gain", &Self::cross_track_gain, "1/s", Range{0, 20},
                  "rate at which an offset from the line decays"),
        parameter("softening_speed", &Self::softening_speed, "m/s", Range{0, 20}, "calms the steering at low speed"),
        parameter("lateral_acceleration_limit", &Self::lateral_acceleration_limit, "m/s^2", Range{0.1, 20},
                  "bound of the steering, besides the vehicle's own limits"),
        parameter("longest_substep", &Self::longest_substep, "s", Range{1e-3, 10},
                  "steering is held over equal parts of a step, each at most this long"),
        parameter("tolerance", &Self::tolerance, "m/s^2", Range{1e-12, 1}, "integration error in speed, per second"));
  }

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory& memory, double dt) const {
    double const speed = std::max(0.0, view.state().speed);
    auto p = idm;
    p.desired_speed = rules.desired_speed(idm, view, speed);
    AccLaw const law(p, coolness, speed);
    Strictest ahead(law);
    rules.heed(view, ahead, memory);
    return drive_along(view, p, ahead.constraint(), memory, dt);
  }

  /// Steering angle [rad] for a step of `h` [s].
  [[nodiscard]] double steering(FrontAxle const& at, double speed, double wheel_base, double h) const {
    double const along = at.curvature * wheel_base;  // the steering that follows the line itself
    double const wanted = stanley_steering(at.heading_error, at.offset, speed, cross_track_gain, softening_speed);
    double const angle = along + (wanted - along) * held_feedback(speed * h, wheel_base);
    return std::copysign(steering_within_grip(std::abs(angle), lateral_acceleration_limit, wheel_base, speed), angle);
  }

 private:
  template <class View>
  [[nodiscard]] Plan<View> drive_along(View const& view, IdmParameters const& p, Constraint leader, Memory& memory,
                                       double dt) const {
    constexpr double gentle = 0.3;  // [m] the largest offset by which it steers when it moves aside
    auto const& model = view.dynamics();
    auto const& line = view.corridor().center;
    double const wheel_base = wheel_base_of(model);
    int const steps = dt <= longest_substep ? 1 : static_cast<int>(std::ceil(dt / longest_substep - 1e-9));
    double const h = steps == 1 ? dt : dt / steps;
    auto segment = view.place().segment;
    auto x = view.state();
    x.speed = std::max(0.0, x.speed);
    double s = view.place().s;
    Plan<View> plan;
    for (int i = 0; i < steps; ++i) {
      auto const motion =
          rules.bound(view, p, s, x.speed, AccLaw(p, coolness, x.speed).motion(leader, h, tolerance), h, memory);
      auto axle = front_axle(line, x, wheel_base, segment);
      if (memory.aside != 0) axle.offset = std::clamp(axle.offset - memory.offset(), -gentle, gentle);
      double const angle = steering(axle, x.speed, wheel_base, h);
      Action const action{(motion.speed - x.speed) / h, angle};
      if (i == 0) plan.action = action_of(model.input(action, x), action);
      leader.gap += h * leader.speed - motion.distance;
      s += motion.distance;
      x = drive(model, x, action, h);
    }
    x.time = view.time() + dt;
    plan.trajectory.push_back(x);
    return plan;
  }
};
static_assert(BehaviorModel<IdmLaneTracking>);

}  // namespace cambium
