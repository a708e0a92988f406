#pragma once

#include <algorithm>
#include <cstdint>

#include "cambium/behavior/view.hpp"

namespace cambium {

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

/// The plan that leads to `follow_lane`.
template <class View>
[[nodiscard]] Plan<View> plan_along_lane(View const& view, LongitudinalMotion<double> const& motion, double dt) {
  Plan<View> plan;
  plan.trajectory.push_back(follow_lane(view, motion, dt));
  plan.action.acceleration = (motion.speed - view.state().speed) / dt;
  return plan;
}

}  // namespace cambium
