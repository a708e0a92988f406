#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <variant>

#include "cambium/behavior/lateral/keep_lane.hpp"
#include "cambium/core/described.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/dynamics/integration.hpp"
#include "cambium/execution/steering.hpp"
#include "cambium/geometry/angle.hpp"

namespace cambium::inline v0_1 {

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
  auto const [sin, cos] = portable::sin_cos(state.heading);
  auto const foot = line.project({state.x + wheel_base * cos, state.y + wheel_base * sin}, hint);
  hint = foot.segment;
  auto const& segment = line.segments()[foot.segment];
  double const along = segment.heading + segment.curvature * std::clamp(foot.s - segment.s, 0.0, segment.length);
  return {foot.lateral, geometry::angle_difference(along, state.heading), segment.curvature};
}

/// Keeps its lane as `KeepLane`, but steers its front axle to the corridor's centre line (Stanley controller) through
/// its vehicle model.
struct TrackLine {
  KeepLane keep{};
  double cross_track_gain = 1.0;
  double softening_speed = 1.0;
  double lateral_acceleration_limit = 4.0;
  double longest_substep = 0.2;

  /// How road users count that merge into the lane.
  [[nodiscard]] Merging counted() const { return keep.merging; }

  using Memory = KeepLane::Memory;

  static constexpr char const* name = "track_line";
  static constexpr char const* summary =
      "steers its front axle to the centre line: steering = heading error - atan(k e / (v + v_soft)), through the "
      "vehicle model";
  static constexpr char const* source = "Hoffmann, Tomlin, Montemerlo, Thrun 2007";
  static constexpr auto parameters() {
    using Self = TrackLine;
    return parameter_list(
        parameter("keep", &Self::keep, "how it keeps its lane"),
        parameter("cross_track_gain", &Self::cross_track_gain, "1/s", Range{0, 20},
                  "rate at which an offset from the line decays"),
        parameter("softening_speed", &Self::softening_speed, "m/s", Range{0, 20}, "calms the steering at low speed"),
        parameter("lateral_acceleration_limit", &Self::lateral_acceleration_limit, "m/s^2", Range{0.1, 20},
                  "bound of the steering, besides the vehicle's own limits"),
        parameter("longest_substep", &Self::longest_substep, "s", Range{1e-3, 10},
                  "steering is held over equal parts of a step, each at most this long"));
  }

  template <class View, class Limits>
  std::monostate look(View const& view, Memory& memory, Limits& limits, double dt) const {
    return keep.look(view, memory, limits, dt);
  }

  /// The acceleration of the step's motion is held over the step.
  template <class View, class Limits>
  [[nodiscard]] Plan<View> drive(View const& view, Memory& memory, std::monostate, Limits const& limits,
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
    double const acceleration = (limits.within(limits.motion(dt), dt).speed - x.speed) / dt;
    Plan<View> plan;
    for (int i = 0; i < steps; ++i) {
      auto axle = front_axle(line, x, wheel_base, segment);
      if (memory.aside != 0) axle.offset = std::clamp(axle.offset - memory.offset(), -gentle, gentle);
      Action const action{acceleration, steering(axle, x.speed, wheel_base, h)};
      if (i == 0) plan.action = action_of(model.input(action, x), action);
      x = cambium::drive(model, x, action, h);
    }
    x.time = view.time() + dt;
    plan.trajectory.push_back(x);
    return plan;
  }

  /// Steering angle [rad] for a step of `h` [s].
  [[nodiscard]] double steering(FrontAxle const& at, double speed, double wheel_base, double h) const {
    double const along = at.curvature * wheel_base;  // the steering that follows the line itself
    double const wanted = stanley_steering(at.heading_error, at.offset, speed, cross_track_gain, softening_speed);
    double const angle = along + (wanted - along) * held_feedback(speed * h, wheel_base);
    return std::copysign(steering_within_grip(std::abs(angle), lateral_acceleration_limit, wheel_base, speed), angle);
  }
};

}  // namespace cambium::inline v0_1
