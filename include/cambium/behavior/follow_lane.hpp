#pragma once

#include "cambium/behavior/view.hpp"
#include "cambium/geometry/angle.hpp"

namespace cambium {

/// How far and how fast a vehicle is after some time on its lane.
template <class Scalar>
struct LongitudinalMotion {
  Scalar distance{};  ///< [m]
  Scalar speed{};     ///< [m/s]
};

/// The state `motion` further along the lane corridor after `dt` [s]: keeps its lateral offset, heads along the lane.
template <class View>
[[nodiscard]] typename View::State follow_lane(View const& view, LongitudinalMotion<double> const& motion, double dt) {
  auto const& position = view.lane_position();
  auto cursor = position.segment;
  auto const on_line = view.corridor().center.pose(position.s + motion.distance, cursor);
  typename View::State next = view.state();
  next.time = view.time() + dt;
  next.x = on_line.x;
  next.y = on_line.y;
  next.heading = on_line.heading;
  next.speed = motion.speed;
  if (position.lateral != 0.0) {
    auto const [sin, cos] = geometry::sin_cos(on_line.heading);
    next.x -= sin * position.lateral;
    next.y += cos * position.lateral;
  }
  return next;
}

/// The plan that leads there in one straight piece.
template <class View>
[[nodiscard]] Plan<View> plan_along_lane(View const& view, LongitudinalMotion<double> const& motion, double dt) {
  Plan<View> plan;
  plan.trajectory.push_back(view.state());
  plan.trajectory.push_back(follow_lane(view, motion, dt));
  plan.action.acceleration = (motion.speed - view.state().speed) / dt;
  return plan;
}

}  // namespace cambium
