#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "cambium/behavior/braking.hpp"
#include "cambium/behavior/follow_lane.hpp"
#include "cambium/map/corridor.hpp"

namespace cambium {

/// What the bends within reach allow.
struct BendsAhead {
  double highest;                    ///< speed in the sharpest of them [m/s]
  LongitudinalMotion<double> bound;  ///< of a step: it goes no farther
};

/// The bends that a vehicle of `speed` [m/s] at `s` [m] comes to within a step of `dt` [s] and its way to brake with
/// `deceleration` [m/s^2]: so that its `lateral_acceleration` [m/s^2] in them is in bounds. It brakes up to `hardest`
/// where it is too late; `desired_speed` [m/s] where there is none. O(log bends) and those within reach.
[[nodiscard]] inline BendsAhead bends_ahead(map::LaneCorridor const& corridor, double s, double speed,
                                            double desired_speed, double lateral_acceleration, double deceleration,
                                            double hardest, double dt) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  BendsAhead ahead{desired_speed, {infinite, infinite}};
  double const reach = s + speed * (dt + speed / (2.0 * deceleration));
  auto const& bends = corridor.bends;
  auto bend = std::partition_point(bends.begin(), bends.end(), [s](map::Bend const& b) { return b.end < s; });
  for (; bend != bends.end() && bend->begin <= reach; ++bend) {
    double const highest = std::sqrt(lateral_acceleration / bend->curvature);
    auto const motion = motion_before_bend(speed, bend->begin - s, highest, deceleration, hardest, dt);
    ahead.highest = std::min(ahead.highest, highest);
    if (motion.distance < ahead.bound.distance) ahead.bound = motion;
  }
  return ahead;
}

}  // namespace cambium
