#pragma once

#include "cambium/behavior/law/follow_lane.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/angle.hpp"

namespace cambium::inline v0_1 {

namespace detail {

/// Length [m] of the way between two states: of an arc with the same turn, to second order in the turn.
template <MotionState S>
[[nodiscard]] double way_between(S const& a, S const& b) {
  double const turn = geometry::angle_difference(b.heading, a.heading);
  return portable::hypot(b.x - a.x, b.y - a.y) * (1.0 + turn * turn / 24.0);
}

/// Sets position and heading of `state` at share `u` of the `way` [m] from `a` to `b`: on the cubic Hermite curve
/// through both along their headings, and turned evenly. (The curve's tangent would overshoot where the two lie a
/// little beside each other's course, as along a polyline. From step to step such errors would add up.)
template <MotionState S>
void place_between(S const& a, S const& b, double way, double u, S& state) {
  auto const from = portable::sin_cos(a.heading), to = portable::sin_cos(b.heading);
  double const w = u * u * (3.0 - 2.0 * u), p = u * (1.0 - u) * (1.0 - u) * way, q = -u * u * (1.0 - u) * way;
  state.x = a.x + w * (b.x - a.x) + p * from.cos + q * to.cos;
  state.y = a.y + w * (b.y - a.y) + p * from.sin + q * to.sin;
  state.heading = a.heading + u * geometry::angle_difference(b.heading, a.heading);
}

/// Length [m] of the course from `start` through the states of the plan.
template <MotionState S>
[[nodiscard]] double course_length(BasicPlan<S> const& plan, S const& start) {
  double length = 0.0;
  S const* before = &start;
  for (auto const& after : plan.trajectory) {
    length += way_between(*before, after);
    before = &after;
  }
  return length;
}

/// The plan that follows the course of `plan`, but moves by `motion` over `dt` [s]; goes straight on beyond its end.
/// Keeps the plan's steering. The course passes through the plan's states along their headings. O(states).
template <class View>
[[nodiscard]] Plan<View> plan_along_course(View const& view, Plan<View> const& plan,
                                           LongitudinalMotion<double> const& motion, double dt) {
  using S = typename View::State;
  constexpr double shortest = 1e-6;  // [m] a shorter way has no direction
  S const start = view.state();
  S const* before = &start;
  double left = motion.distance;
  S next = *before;
  for (auto const& after : plan.trajectory) {
    double const way = way_between(*before, after);
    next = after;
    if (left < way && way > shortest) place_between(*before, after, way, left / way, next);
    left -= way;
    before = &after;
    if (left < 0.0) break;
  }
  if (left > 0.0) {
    auto const along = portable::sin_cos(next.heading);
    next.x += left * along.cos;
    next.y += left * along.sin;
  }
  next.time = view.time() + dt;
  next.speed = motion.speed;
  Plan<View> result;
  result.trajectory.push_back(next);
  result.action = {(motion.speed - view.state().speed) / dt, plan.action.steering};
  result.is_absolute = plan.is_absolute;
  return result;
}

}  // namespace detail

}  // namespace cambium::inline v0_1
