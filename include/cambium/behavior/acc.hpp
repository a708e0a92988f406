#pragma once

#include <algorithm>
#include <cmath>

#include "cambium/behavior/idm.hpp"
#include "cambium/behavior/leader.hpp"

namespace cambium {

/// The acceleration [m/s^2] that avoids a collision if the leader keeps its own (constant-acceleration heuristic;
/// Kesting, Treiber, Helbing 2010, eq. 2.3); the leader is not taken to accelerate more than `most` [m/s^2].
[[nodiscard]] inline double cah_acceleration(double speed, Leader const& leader, double most) {
  double const a = std::min(leader.acceleration, most), gap = std::max(leader.gap, 1e-9);
  double const closing = speed - leader.speed;
  double const denominator = leader.speed * leader.speed - 2.0 * gap * a;
  // The leader stands before the two would be at the closest; one that stands already is left to the other case.
  if (leader.speed * closing <= -2.0 * gap * a && denominator > 0.0) return speed * speed * a / denominator;
  return a - (closing > 0.0 ? closing * closing / (2.0 * gap) : 0.0);
}

/// The blend of IDM's acceleration with that of the heuristic: where IDM brakes harder than needed, `coolness` 0 to 1
/// says how far the driver trusts the heuristic (eq. 2.6).
[[nodiscard]] inline double acc_blend(double idm, double cah, double comfortable_deceleration, double coolness) {
  if (idm >= cah) return idm;
  double const b = comfortable_deceleration;
  return (1.0 - coolness) * idm + coolness * (cah + b * std::tanh((idm - cah) / b));
}

/// Acceleration [m/s^2] of the ACC model (Kesting, Treiber, Helbing 2010, "Enhanced intelligent driver model to access
/// the impact of driving strategies on traffic capacity"), within the parameters' bounds; IDM's where `coolness` is 0.
template <HasIdmParameters P>
[[nodiscard]] double acc_acceleration(P const& p, double coolness, double speed, Leader const& leader) {
  if (coolness == 0.0 || !(leader.gap > 0.0) || std::isinf(leader.gap))
    return idm_acceleration(p, speed, leader.gap, leader.speed);
  // The blend is one of unbounded accelerations.
  double const closeness = idm_desired_gap(p, speed, leader.speed) / leader.gap;
  double const free = idm_power(speed / p.desired_speed, p.exponent);
  double const idm = p.maximum_acceleration * (1.0 - free - closeness * closeness);
  double const cah = cah_acceleration(speed, leader, p.maximum_acceleration);
  return std::clamp(acc_blend(idm, cah, p.comfortable_deceleration, coolness), p.lowest_acceleration,
                    p.highest_acceleration);
}

/// Motion over `dt` [s] of a follower with any law `acceleration(speed, Leader)` behind a leader that keeps its speed:
/// Heun's scheme of order 2 in equal parts of at most 0.1 s. Where the speed reaches 0 the vehicle stops.
template <class Law>
[[nodiscard]] LongitudinalMotion<double> follow_motion(Law const& acceleration, double speed, Leader leader,
                                                       double dt) {
  int const parts = std::max(1, static_cast<int>(std::ceil(dt / 0.1 - 1e-9)));
  double const h = dt / parts;
  LongitudinalMotion<double> motion{0.0, speed};
  for (int i = 0; i < parts; ++i) {
    double const v = motion.speed, a1 = acceleration(v, leader);
    double const next = std::max(0.0, v + h * a1);
    Leader ahead = leader;
    ahead.gap += h * (leader.speed - 0.5 * (v + next));
    double const a = 0.5 * (a1 + acceleration(next, ahead));
    double const moving = v + h * a < 0.0 ? v / -a : h;  // until it stands
    double const distance = std::max(0.0, v * moving + a * moving * moving / 2);
    motion.distance += distance;
    motion.speed = moving < h ? 0.0 : v + h * a;
    leader.gap += h * leader.speed - distance;
  }
  return motion;
}

}  // namespace cambium
