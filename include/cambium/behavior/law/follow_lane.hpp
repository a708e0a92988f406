#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "cambium/behavior/view.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/portable_math.hpp"

namespace cambium::inline v0_1 {

/// Lateral position of a vehicle that converges to a line, as a function of the distance along the line.
template <class Scalar>
struct LateralCourse {
  Scalar offset{};  ///< left positive [m]
  Scalar slope{};   ///< derivative of the offset [-]
  Scalar bend{};    ///< derivative of the slope [1/m]
};

/// Distance covered and final speed of a vehicle after some time on its lane.
template <class Scalar>
struct LongitudinalMotion {
  Scalar distance{};  ///< [m]
  Scalar speed{};     ///< [m/s]
};

/// Places `state` at position `s` [m] of a lane corridor, `lateral` [m] to the left of its centre line, with heading
/// `turn` [rad] relative to the lane. `hint`: a nearby segment of the centre line.
template <MotionState State>
void place_on_lane(map::LaneCorridor const& corridor, double s, double lateral, double turn, std::uint32_t hint,
                   State& state) {
  auto const& segment = corridor.center.segment_at(s, hint);
  double const along = s - segment.s;
  state.x = segment.x + segment.ux * along - segment.uy * lateral;
  state.y = segment.y + segment.uy * along + segment.ux * lateral;
  state.heading = segment.heading + segment.curvature * std::clamp(along, 0.0, segment.length) + turn;
}

/// The state after `motion` along the lane corridor over `dt` [s]: keeps its lateral offset and takes the lane's
/// heading.
template <class View>
[[nodiscard]] typename View::State follow_lane(View const& view, LongitudinalMotion<double> const& motion, double dt) {
  auto const& position = view.place();
  typename View::State next = view.state();
  next.time = view.time() + dt;
  place_on_lane(view.corridor(), position.s + motion.distance, position.lateral, 0.0, position.segment, next);
  next.speed = motion.speed;
  return next;
}

namespace detail {
/// How long the way of a vehicle beside the centre line of `corridor` is, over `distance` [m] from `at`, for each metre
/// along that line [-]: 1 less the curvature times the offset. Where a bend ends in this step, or within a metre, the
/// mean curvature counts.
[[nodiscard]] inline double stretch_beside(map::LaneCorridor const& corridor, map::LanePlace const& at,
                                           double distance) {
  auto const& segment = corridor.center.segments()[at.segment];
  double const inside = at.s - segment.s, ahead = std::max(1.0, distance);
  double curvature = segment.curvature;
  if (inside + ahead > segment.length) {
    auto hint = at.segment;
    double const heading = segment.heading + curvature * std::clamp(inside, 0.0, segment.length);
    curvature = (corridor.center.pose(at.s + ahead, hint).heading - heading) / ahead;
  }
  return std::max(0.1, 1.0 - curvature * at.lateral);
}

/// The plan that reaches `next` after `dt` [s].
template <class View>
[[nodiscard]] Plan<View> plan_to(View const& view, typename View::State const& next, double dt) {
  Plan<View> plan;
  plan.trajectory.push_back(next);
  plan.action.acceleration = (next.speed - view.state().speed) / dt;
  return plan;
}
}  // namespace detail

/// The plan that leads to `follow_lane`.
template <class View>
[[nodiscard]] Plan<View> plan_along_lane(View const& view, LongitudinalMotion<double> const& motion, double dt) {
  return detail::plan_to(view, follow_lane(view, motion, dt), dt);
}

namespace detail {

/// Largest heading error [rad] for which a course exists; beyond it the vehicle is turned along its lane.
inline constexpr double most_aslant = 1.0;

/// Lateral speed that reveals the intention to change lanes [m/s].
inline constexpr double least_drift = 0.12;

/// Where the present motion of a vehicle across its lane leads.
struct Drift {
  CorridorId target = none<CorridorId>;  ///< lane corridor in which it ends: the own one or the one beside
  double rest{};                         ///< its end, from the own centre line, left positive [m]
};

/// A driver levels out no harder than this, and no tighter.
inline constexpr double comfortable_levelling = 1.0, hardest_levelling = 3.0, tightest_levelling = 0.1;  // [m/s^2, 1/m]

/// Curvature [1/m] at `speed` [m/s] that takes `acceleration` [m/s^2] sideways.
[[nodiscard]] inline double levelling_curvature(double speed, double acceleration) {
  return speed * speed * tightest_levelling > acceleration ? acceleration / (speed * speed) : tightest_levelling;
}

/// The drift of a vehicle that moves `slope` [-] to the left for each metre along its lane. Towards the centre line it
/// ends there. Away from it, it ends on the centre line of the lane beside if it crosses the border within a second,
/// else within the own lane.
template <class View>
CAMBIUM_NOINLINE [[nodiscard]] Drift drift_of(View const& view, double slope) {
  auto const& at = view.place();
  if (slope * at.lateral < 0.0) return {at.corridor, 0.0};
  double const side = slope > 0.0 ? 1.0 : -1.0, speed = std::max(0.0, view.state().speed);
  auto const& piece = view.corridor().pieces[at.piece];
  auto const widths = view.corridor().widths_at(at.s, at.segment);
  double const border = slope > 0.0 ? widths.left : widths.right;
  bool const leaves = side * (at.lateral + slope * speed) > border;
  auto const beside = piece.beside(slope > 0.0);
  if (leaves && beside != none<CorridorId>) return {beside, at.lateral - view.place(beside).lateral};
  double const stop = slope * slope / (2.0 * levelling_curvature(speed, comfortable_levelling));
  double const body = slope > 0.0 ? view.shape().left : view.shape().right;
  double const room = std::max(0.0, border - body - side * at.lateral);
  return {at.corridor, at.lateral + side * (leaves ? std::min(stop, room) : stop)};
}

/// The state of a vehicle adrift after the motion that follows the lane to `next`, see `plan_into_lane`.
template <class View>
CAMBIUM_NOINLINE [[nodiscard]] typename View::State drift_on(View const& view, LongitudinalMotion<double> const& motion,
                                                             typename View::State next, bool& adrift) {
  constexpr double aligned = 1e-6;  // [-]
  auto const& at = view.place();
  auto const& corridor = view.corridor();
  double const speed = std::max(view.state().speed, motion.speed);
  double const stretch = stretch_beside(corridor, at, motion.distance);
  auto const [sin, cos] = portable::sin_cos(at.heading_error);
  double const along = motion.distance * cos / stretch, slope = stretch * (sin / cos);
  bool const turns_at_once =
      std::abs(slope) <= std::max(levelling_curvature(speed, comfortable_levelling) * along, aligned);
  if (std::abs(at.heading_error) > most_aslant || (turns_at_once && std::abs(slope) * speed < least_drift)) {
    adrift = false;
    return next;
  }
  double const way = std::abs(drift_of(view, slope).rest - at.lateral), side = slope > 0.0 ? 1.0 : -1.0;
  double const hardest = levelling_curvature(speed, hardest_levelling);
  double const curvature = slope * slope < 2.0 * way * hardest ? slope * slope / (2.0 * way) : hardest;
  double const turning = std::min(along, std::abs(slope) / curvature);
  place_on_lane(corridor, at.s + along, at.lateral + turning * (slope - side * curvature * turning / 2.0),
                portable::atan((slope - side * curvature * turning) / stretch), at.segment, next);
  return next;
}

}  // namespace detail

/// As `plan_along_lane`, but a vehicle that may be `adrift`, because it has just entered or was set, first ends its
/// motion across the lane. It drives the circle that touches the centre line to which it drifts, in the lane beside if
/// it is about to cross the border. `adrift` becomes false once the vehicle drives along its lane.
template <class View>
[[nodiscard]] Plan<View> plan_into_lane(View const& view, LongitudinalMotion<double> const& motion, double dt,
                                        bool& adrift) {
  auto next = follow_lane(view, motion, dt);
  if (adrift) [[unlikely]] {
    bool still = true;  // a call that is not inlined gets copies, so that the originals can stay in registers
    next = detail::drift_on(View(view), LongitudinalMotion<double>(motion), next, still);
    adrift = still;
  }
  return detail::plan_to(view, next, dt);
}

}  // namespace cambium::inline v0_1
