#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "cambium/behavior/law/lane_reach.hpp"
#include "cambium/behavior/view.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/geometry/frenet.hpp"

namespace cambium::inline v0_1 {

namespace detail {

/// A span of time [s from now]; empty where it begins after its end.
struct TimeSpan {
  double begin, end;
};

/// Road users that move more slowly across a lane cross nobody's way [m/s].
inline constexpr double least_crossing_speed = 0.1;

/// When the interval from `low` to `high` [m], which moves at `rate` [m/s], overlaps that from `from` to `to` [m].
[[nodiscard]] inline TimeSpan overlap_time(double low, double high, double rate, double from, double to) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  if (rate == 0.0) return low < to && high > from ? TimeSpan{-infinite, infinite} : TimeSpan{infinite, -infinite};
  double const first = (from - high) / rate, second = (to - low) / rate;
  return {std::min(first, second), std::max(first, second)};
}

/// Position along the lane [m] that the front end of a vehicle must not pass, because a road user from beside crosses
/// its way; infinite if none does. Both keep their velocities: `own` and `other` are their extents along and across the
/// lane, the other moves at `along` and `across` [m/s]. It is in the way if it comes within 0.3 m of the vehicle's
/// course within `horizon` [s], not after the vehicle has passed (plus 0.5 s), and has not left it 1 s before the
/// vehicle arrives. A vehicle slower than 2 m/s counts as that fast, so that a waiting one does not start in front of
/// pedestrians.
[[nodiscard]] inline double stop_before_crossing(LaneReach const& own, double speed, LaneReach const& other,
                                                 double along, double across, double horizon) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  constexpr double slowest = 2.0, side = 0.3, before = 1.0, after = 0.5;  // [m/s], [m], [s], [s]
  if (std::abs(across) < least_crossing_speed) return infinite;
  auto const in_way = overlap_time(other.right, other.left, across, own.right - side, own.left + side);
  if (in_way.end < 0.0 || in_way.begin > horizon) return infinite;
  auto const beside = overlap_time(own.begin, own.end, std::max(speed, slowest) - along, other.begin, other.end);
  if (std::max(0.0, in_way.begin) > beside.end + after || in_way.end + before < beside.begin) return infinite;
  double const shift = std::min(along * std::max(0.0, in_way.begin), along * in_way.end);
  double const place = other.begin + shift;
  return place > own.end ? place : infinite;
}

/// What `stop_before_crossing` needs to know of a road user `at` a place to find that it crosses nobody's way: its
/// speed [m/s], in any direction, and the farthest that its body reaches from its reference point [m].
struct CrossingBound {
  geometry::Projection at;
  double speed, reach;

  /// Whether `stop_before_crossing` is infinite, whatever its heading. Never true where it is not.
  [[nodiscard]] bool stays_away(LaneReach const& own, double horizon) const {
    constexpr double slack = 0.5;  // [m] more than the side distance there, and the rounding
    double const way = reach + speed * horizon;
    return at.s + way + slack < own.end || at.lateral - way - slack > own.left || at.lateral + way + slack < own.right;
  }
};

/// How far [m] the front end of a vehicle of `speed` [m/s] at `s` [m] of its lane may go because of agents on no lane,
/// such as pedestrians, who will step into its way within `horizon` [s]; looks `distance` [m] ahead. Infinite if nobody
/// does. O(agents on no lane).
template <class View>
CAMBIUM_NOINLINE [[nodiscard]] double distance_before_crossing(View const& view, double s, double speed, double horizon,
                                                               double distance) {
  double nearest = std::numeric_limits<double>::infinity();
  auto const& at = view.place();
  auto const& line = view.corridor().center;
  if (!map::is_drivable(view.corridor().pieces[at.piece].type)) return nearest;
  auto const& shape = view.shape();
  LaneReach const own{s - shape.rear, s + shape.front, at.lateral - shape.right, at.lateral + shape.left};
  view.off_lanes(distance + shape.front, [&](RoadUser const& other) {
    auto const& state = view.state(other);
    if (std::abs(state.speed) < least_crossing_speed) return;
    auto const& body = view.shape(other);
    // Most are far from its way, and the directions that the exact answer needs cost more than their place.
    CrossingBound const bound{line.project({state.x, state.y}, at.segment), std::abs(state.speed),
                              std::max(body.front, body.rear) + std::max(body.left, body.right)};
    if (bound.stays_away(own, horizon)) return;
    auto const frenet = geometry::to_frenet(line, state, bound.at);
    auto const reach = lane_reach(line, state, body, bound.at.segment);
    nearest = std::min(
        nearest, stop_before_crossing(own, speed, reach, frenet.longitudinal_speed, frenet.lateral_speed, horizon));
  });
  return nearest - own.end;
}

}  // namespace detail

}  // namespace cambium::inline v0_1
