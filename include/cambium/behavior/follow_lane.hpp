#pragma once

#include <algorithm>

#include "cambium/behavior/view.hpp"

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
  double const s = position.s + motion.distance;
  auto const& segment = view.corridor().center.segment_at(s, cursor);
  double const along = s - segment.s;
  typename View::State next = view.state();
  next.time = view.time() + dt;
  next.x = segment.x + segment.ux * along - segment.uy * position.lateral;
  next.y = segment.y + segment.uy * along + segment.ux * position.lateral;
  next.heading = segment.heading + segment.curvature * std::clamp(along, 0.0, segment.length);
  next.speed = motion.speed;
  return next;
}

/// The plan that leads there.
template <class View>
[[nodiscard]] Plan<View> plan_along_lane(View const& view, LongitudinalMotion<double> const& motion, double dt) {
  Plan<View> plan;
  plan.trajectory.push_back(follow_lane(view, motion, dt));
  plan.action.acceleration = (motion.speed - view.state().speed) / dt;
  return plan;
}

}  // namespace cambium
