#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "cambium/behavior/braking.hpp"
#include "cambium/behavior/follow_lane.hpp"
#include "cambium/behavior/idm.hpp"
#include "cambium/core/macros.hpp"
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

/// The speed [m/s] that an IDM driver is to desire at `s` [m], so that it comes to the bends within its way to brake by
/// its comfortable deceleration no faster than `lateral_acceleration` [m/s^2] allows. Out of line: where
/// `max(speed, desired)^2 sharpest_bend` is no more than that, it need not be asked. O(log bends) and those in reach.
template <HasIdmParameters P>
CAMBIUM_NOINLINE [[nodiscard]] double desired_speed_before_bends(P const& p, map::LaneCorridor const& corridor,
                                                                 double s, double speed, double lateral_acceleration) {
  constexpr double comfortable = 0.7;  // of the lateral acceleration: IDM comes down to a desired speed from above
  double const twice_braking = 2.0 * p.comfortable_deceleration, reach = s + speed * (speed / twice_braking + 1.0);
  double const fastest = std::max(speed, p.desired_speed), fastest_square = fastest * fastest;
  double lowest = p.desired_speed * p.desired_speed, way = 0.0;
  auto const& bends = corridor.bends;
  auto bend = std::partition_point(bends.begin(), bends.end(), [s](map::Bend const& b) { return b.end < s; });
  for (; bend != bends.end() && bend->begin <= reach; ++bend) {
    if (fastest_square * bend->curvature <= lateral_acceleration) continue;
    double const ahead = std::max(0.0, bend->begin - s);
    double const square = comfortable * lateral_acceleration / bend->curvature + twice_braking * ahead;
    if (square >= lowest) continue;
    lowest = square;
    way = ahead;
  }
  return std::min(p.desired_speed, std::sqrt(lowest) * idm_lead(p, speed, way));
}

}  // namespace cambium
