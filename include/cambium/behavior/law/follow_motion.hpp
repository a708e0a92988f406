#pragma once

#include <algorithm>
#include <cmath>

#include "cambium/behavior/law/constraint.hpp"
#include "cambium/behavior/law/follow_lane.hpp"

namespace cambium::inline v0_1 {

/// Motion over `dt` [s] behind a leader of constant speed, for any law `acceleration(speed, Constraint)`: Heun's scheme
/// of order 2 in equal parts of at most 0.1 s. A vehicle whose speed reaches 0 stops.
template <class Law>
[[nodiscard]] LongitudinalMotion<double> follow_motion(Law const& acceleration, double speed, Constraint leader,
                                                       double dt) {
  int const parts = std::max(1, static_cast<int>(std::ceil(dt / 0.1 - 1e-9)));
  double const h = dt / parts;
  LongitudinalMotion<double> motion{0.0, speed};
  for (int i = 0; i < parts; ++i) {
    double const v = motion.speed, a1 = acceleration(v, leader);
    double const next = std::max(0.0, v + h * a1);
    Constraint ahead = leader;
    ahead.gap += h * (leader.speed - 0.5 * (v + next));
    double const a = 0.5 * (a1 + acceleration(next, ahead));
    double const moving = v + h * a < 0.0 ? v / -a : h;  // until it stops
    double const distance = std::max(0.0, v * moving + a * moving * moving / 2);
    motion.distance += distance;
    motion.speed = moving < h ? 0.0 : v + h * a;
    leader.gap += h * leader.speed - distance;
  }
  return motion;
}

}  // namespace cambium::inline v0_1
