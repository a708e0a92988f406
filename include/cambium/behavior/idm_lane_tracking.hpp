#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "cambium/behavior/acc.hpp"
#include "cambium/behavior/bark.hpp"
#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/idm.hpp"
#include "cambium/behavior/leader.hpp"
#include "cambium/dynamics/integration.hpp"
#include "cambium/execution/steering.hpp"
#include "cambium/geometry/angle.hpp"

namespace cambium {

/// How a front axle lies to a line.
struct FrontAxle {
  double offset{};         ///< of the axle to the left of the line [m]
  double heading_error{};  ///< direction of the line over the vehicle's [rad]
  double curvature{};      ///< of the line [1/m]
};

/// The front axle `wheel_base` [m] ahead of `state`, to `line`. `hint`: a segment nearby, becomes the one found.
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

/// Follows the next vehicle in its lane corridor by IDM, or by the ACC model with `coolness` above 0, and steers its
/// front axle to the corridor's centre line (Stanley), through its vehicle model. Slows down for curves, so that its
/// lateral acceleration stays within `lateral_acceleration_limit`.
struct IdmLaneTracking {
  enum class Integration {
    rk4,            ///< steps of at most `longest_substep`, steering held over each: the default
    bark_substeps,  ///< 10 Euler steps as in BARK, for comparison with its results
  };

  IdmParameters idm{};
  double coolness = 0.0;
  RoadRules rules{};
  double cross_track_gain = 1.0;
  double softening_speed = 1.0;
  double lateral_acceleration_limit = 4.0;
  bool slow_for_curves = true;
  Integration integration = Integration::rk4;
  double longest_substep = 0.2;
  double tolerance = 1e-4;

  static constexpr char const* name = "idm_lane_tracking";
  static constexpr char const* summary =
      "along: IDM, or the ACC model where coolness > 0, slower in curves; across: front axle to the centre line, "
      "steering = heading error - atan(k e / (v + v_soft)), through the vehicle model";
  static constexpr char const* source = "Treiber, Hennecke, Helbing 2000; Hoffmann, Tomlin, Montemerlo, Thrun 2007";
  static constexpr auto parameters() {
    using Self = IdmLaneTracking;
    return parameter_list(
        parameter("idm", &Self::idm, "-", {}, "the driver's car following"),
        parameter("coolness", &Self::coolness, "-", Range{0, 1}, "0: IDM; up to 1: the ACC model's"),
        parameter("rules", &Self::rules, "-", {}, "what it heeds beside other road users"),
        parameter("cross_track_gain", &Self::cross_track_gain, "1/s", Range{0, 20},
                  "how fast an offset from the line decays"),
        parameter("softening_speed", &Self::softening_speed, "m/s", Range{0, 20}, "calms the steering at low speed"),
        parameter("lateral_acceleration_limit", &Self::lateral_acceleration_limit, "m/s^2", Range{0.1, 20},
                  "steers no more than this, beside the vehicle's own limits"),
        parameter("slow_for_curves", &Self::slow_for_curves, "-", Range{0, 1},
                  "brakes in time for curves that ask for more"),
        choice("integration", &Self::integration, "rk4|bark_substeps", "of the motion along the lane"),
        parameter("longest_substep", &Self::longest_substep, "s", Range{1e-3, 10},
                  "steering is held over equal parts of a step no longer than this"),
        parameter("tolerance", &Self::tolerance, "m/s^2", Range{1e-12, 1}, "error of the speed, as speed per second"));
  }

  /// How far the road ahead is known to have no curve to slow down for.
  struct Memory {
    std::uint32_t from{}, straight_until{};  ///< segments of the centre line; the second one is not known
    float known_until{};                     ///< where that one begins [m]
    float fastest{};                         ///< the speed at which it is none [m/s]
    CorridorId corridor = none<CorridorId>;

    friend bool operator==(Memory const&, Memory const&) = default;
  };

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory& memory, double dt) const {
    double const speed = std::max(0.0, view.state().speed);
    auto p = within_limits(rules, idm, view, speed);
    if (slow_for_curves && integration == Integration::rk4) slow_down(p, view, speed, memory);
    auto const law = [&](Leader const& l) { return acc_acceleration(p, coolness, speed, l); };
    auto const next = view.ahead();
    auto const leader = coolness > 0.0 ? leader_to_follow<true>(rules, view, next, law)
                                       : leader_to_follow<false>(rules, view, next, law);
    return integration == Integration::rk4 ? drive_along(view, p, leader, dt) : bark_plan(view, p, leader, dt);
  }

  /// The steering angle [rad] that it asks of a vehicle for a step of `h` [s].
  [[nodiscard]] double steering(FrontAxle const& at, double speed, double wheel_base, double h) const {
    double const along = at.curvature * wheel_base;  // the steering that the line itself takes
    double const wanted = stanley_steering(at.heading_error, at.offset, speed, cross_track_gain, softening_speed);
    double const angle = along + (wanted - along) * held_feedback(speed * h, wheel_base);
    return std::copysign(steering_within_grip(std::abs(angle), lateral_acceleration_limit, wheel_base, speed), angle);
  }

 private:
  /// Desires no more speed than what lets it take the curves within its way to brake. O(curved segments within it),
  /// beside those that are new.
  template <class View>
  void slow_down(IdmParameters& p, View const& view, double speed, Memory& memory) const {
    auto const& at = view.place();
    auto const segments = view.corridor().center.segments();
    double const fastest = std::max(speed, idm.desired_speed), square = fastest * fastest;
    auto const faster = static_cast<float>(fastest);
    // Whose speed rises beyond the desired one does not look anew in every step.
    float const room_to_rise = speed > idm.desired_speed ? 1.1f : 1.0f;
    if (memory.corridor != at.corridor || at.segment < memory.from || faster > memory.fastest)
      memory = {at.segment, 0, 0.0f, room_to_rise * faster, at.corridor};
    memory.from = at.segment;
    double const twice_braking = 2.0 * p.comfortable_deceleration;
    if (speed * (speed + twice_braking) < twice_braking * (static_cast<double>(memory.known_until) - at.s)) return;
    double const reach = at.s + speed * (speed / twice_braking + 1.0);
    double const comfortable = 0.85 * lateral_acceleration_limit;  // the rest is for corrections
    auto i = static_cast<std::size_t>(std::max(at.segment, memory.straight_until));
    double const straight = comfortable / (static_cast<double>(memory.fastest) * static_cast<double>(memory.fastest));
    while (i < segments.size() && segments[i].s < reach + 50.0 && std::abs(segments[i].curvature) <= straight) ++i;
    memory.straight_until = static_cast<std::uint32_t>(i);
    memory.known_until = i < segments.size() ? static_cast<float>(segments[i].s) : std::numeric_limits<float>::max();
    double lowest = square, way = 0.0;
    for (; i < segments.size() && segments[i].s < reach; ++i) {
      double const ahead = std::max(0.0, segments[i].s - at.s), room = twice_braking * ahead,
                   bend = std::abs(segments[i].curvature);
      if (!(bend * (lowest - room) > comfortable)) continue;
      lowest = room + comfortable / bend;
      way = ahead;
    }
    if (lowest >= square) return;
    p.desired_speed = std::clamp(std::sqrt(lowest) * idm_lead(p, speed, way), 0.1, p.desired_speed);
  }

  template <class View>
  [[nodiscard]] Plan<View> drive_along(View const& view, IdmParameters const& p, Leader leader, double dt) const {
    auto const& model = view.dynamics();
    auto const& line = view.corridor().center;
    double const wheel_base = wheel_base_of(model);
    int const steps = dt <= longest_substep ? 1 : static_cast<int>(std::ceil(dt / longest_substep - 1e-9));
    double const h = steps == 1 ? dt : dt / steps;
    auto segment = view.place().segment;
    auto x = view.state();
    x.speed = std::max(0.0, x.speed);
    Plan<View> plan;
    for (int i = 0; i < steps; ++i) {
      auto const motion = longitudinal(p, x.speed, leader, h);
      double const angle = steering(front_axle(line, x, wheel_base, segment), x.speed, wheel_base, h);
      Action const action{(motion.speed - x.speed) / h, angle};
      if (i == 0) plan.action = action_of(model.input(action, x), action);
      leader.gap += h * leader.speed - motion.distance;
      x = drive(model, x, action, h);
    }
    x.time = view.time() + dt;
    plan.trajectory.push_back(x);
    return plan;
  }

  [[nodiscard]] LongitudinalMotion<double> longitudinal(IdmParameters const& p, double speed, Leader const& leader,
                                                        double h) const {
    if (coolness == 0.0) return idm_motion(p, speed, leader.gap, leader.speed, h, tolerance);
    return follow_motion([&](double v, Leader const& l) { return acc_acceleration(p, coolness, v, l); }, speed, leader,
                         h);
  }

  /// Out of line, with arguments by value: what others use is not kept in memory for it.
  template <class View>
  [[nodiscard]] CAMBIUM_NOINLINE Plan<View> bark_plan(View view, IdmParameters p, Leader leader, double dt) const {
    auto const& model = view.dynamics();
    double const wheel_base = wheel_base_of(model), h = dt / bark::substeps;
    auto segment = view.place().segment;
    auto x = view.state();
    double const start_speed = std::max(0.0, x.speed);
    Plan<View> plan;
    for (int i = 0; i < bark::substeps; ++i) {
      double const a = bark::acceleration(p, coolness, start_speed, leader);
      auto const at = front_axle(view.corridor().center, x, wheel_base, segment);
      double const grip = std::atan2(lateral_acceleration_limit * wheel_base, x.speed * x.speed);
      double const angle = at.heading_error + std::atan2(-cross_track_gain * at.offset, x.speed);
      auto const u = model.input({a, std::clamp(angle, -grip, grip)}, x);
      if (i == 0) plan.action = action_of(u, {a, angle});
      bark::advance(leader, start_speed, a, h);
      x = euler_step(model, x, u, h);
      x.speed = std::max(0.0, x.speed);
      x.time = view.time() + dt * (i + 1) / bark::substeps;
      plan.trajectory.push_back(x);
    }
    return plan;
  }
};
static_assert(BehaviorModel<IdmLaneTracking>);

}  // namespace cambium
