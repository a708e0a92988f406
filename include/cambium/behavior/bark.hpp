#pragma once

#include <algorithm>
#include <cmath>

#include "cambium/behavior/acc.hpp"
#include "cambium/behavior/follow_lane.hpp"
#include "cambium/core/macros.hpp"

/// The car following of BARK (fortiss, commit bc4d92c2) as its trajectories show it, for comparison with its results:
/// 10 equal sub-steps, each one's acceleration taken at the speed of the step's start, a desired gap that may become
/// negative, speeds from 0 to 50 m/s.
namespace cambium::bark {

inline constexpr int substeps = 10;

/// Acceleration [m/s^2]: IDM whose desired gap is not kept above the minimum gap, blended as by the ACC model.
template <HasIdmParameters P>
[[nodiscard]] double acceleration(P const& p, double coolness, double speed, Leader const& leader) {
  if (leader.gap <= 0) return p.lowest_acceleration;
  double const desired_gap =
      p.minimum_gap + speed * p.time_headway +
      speed * (speed - leader.speed) / (2 * std::sqrt(p.maximum_acceleration * p.comfortable_deceleration));
  double const closeness = desired_gap / leader.gap;
  double const free = 1 - std::pow(speed / p.desired_speed, p.exponent);
  double a = p.maximum_acceleration * (free - closeness * closeness);
  if (coolness > 0.0 && !std::isinf(leader.gap))
    a = acc_blend(a, cah_acceleration(speed, leader, p.maximum_acceleration), p.comfortable_deceleration, coolness);
  return std::clamp(a, p.lowest_acceleration, p.highest_acceleration);
}

/// Moves the leader's gap by a sub-step of `h` [s] of a follower that had `speed` at the step's start.
inline void advance(Leader& leader, double speed, double a, double h) {
  leader.gap += leader.speed * h - (speed * h + a * h * h / 2);
}

/// The plan along the lane over `dt` [s].
template <class View, HasIdmParameters P>
CAMBIUM_NOINLINE [[nodiscard]] Plan<View> plan_along_lane(View const& view, P const& p, double coolness, Leader leader,
                                                          double dt) {
  double const h = dt / substeps, start_speed = std::max(0.0, view.state().speed);
  Plan<View> plan;
  LongitudinalMotion<double> motion{0.0, start_speed};
  for (int i = 0; i < substeps; ++i) {
    double const a = acceleration(p, coolness, start_speed, leader);
    if (i == 0) plan.action.acceleration = a;
    motion.distance += motion.speed * h + a * h * h / 2;
    motion.speed = std::clamp(motion.speed + a * h, 0.0, 50.0);
    advance(leader, start_speed, a, h);
    plan.trajectory.push_back(follow_lane(view, motion, dt * (i + 1) / substeps));
  }
  return plan;
}

}  // namespace cambium::bark
