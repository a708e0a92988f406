#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "cambium/core/state.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/line.hpp"
#include "cambium/geometry/shape.hpp"

namespace cambium::geometry {

/// A motion state relative to a `Line`. Speeds are the velocity's components along and across the line's direction at
/// `s`; on a curve of curvature k, `s` itself changes by longitudinal_speed / (1 - k lateral).
struct FrenetState {
  double s{};                   ///< arc length of the foot point [m]
  double lateral{};             ///< offset from the line, left positive [m]
  double longitudinal_speed{};  ///< [m/s]
  double lateral_speed{};       ///< left positive [m/s]
  double heading_error{};       ///< heading of the vehicle minus that of the line, in (-pi, pi] [rad]
};

/// Frenet state of `state` at a projection that is known already.
template <MotionState S>
[[nodiscard]] FrenetState to_frenet(Line const& line, S const& state, Projection const& projection) {
  auto cursor = projection.segment;
  double const error = angle_difference(state.heading, line.pose(projection.s, cursor).heading);
  auto const [sin, cos] = sin_cos(error);
  return {projection.s, projection.lateral, state.speed * cos, state.speed * sin, error};
}

/// Frenet state by the exact projection. O(n).
template <MotionState S>
[[nodiscard]] FrenetState to_frenet(Line const& line, S const& state) {
  return to_frenet(line, state, line.project(Point{state.x, state.y}));
}

/// Frenet state by the projection near segment `hint`, which becomes the segment found. O(segments passed).
template <MotionState S>
[[nodiscard]] FrenetState to_frenet(Line const& line, S const& state, std::uint32_t& hint) {
  auto const projection = line.project(Point{state.x, state.y}, hint);
  hint = projection.segment;
  return to_frenet(line, state, projection);
}

/// The state in the map frame, at `time` [s]: the inverse of `to_frenet`, but for points whose foot point is a vertex
/// with a kink; these return on the normal of the segment behind the vertex. The speed is the velocity along the
/// heading. O(segments between `cursor` and `s`).
[[nodiscard]] inline State from_frenet(Line const& line, FrenetState const& frenet, double time,
                                       std::uint32_t& cursor) {
  Pose const pose = line.pose(frenet.s, cursor);
  auto const& segment = line.segments()[cursor];
  auto const [sin, cos] = sin_cos(frenet.heading_error);
  return {time, pose.x - segment.uy * frenet.lateral, pose.y + segment.ux * frenet.lateral,
          normalize_angle(pose.heading + frenet.heading_error),
          frenet.longitudinal_speed * cos + frenet.lateral_speed * sin};
}

/// As above, by binary search. O(log n).
[[nodiscard]] inline State from_frenet(Line const& line, FrenetState const& frenet, double time = 0.0) {
  auto cursor = line.find(frenet.s);
  return from_frenet(line, frenet, time, cursor);
}

/// Where one vehicle is and moves relative to another along a common line, between their shapes: what a driver looks
/// at.
struct FrenetDifference {
  double longitudinal{};        ///< gap along the line, positive ahead; 0 where the shapes overlap along it [m]
  double lateral{};             ///< gap across the line, positive to the left; 0 where the shapes overlap across it [m]
  bool overlaps_along{};        ///< both occupy a common stretch of the line
  bool overlaps_across{};       ///< both occupy a common strip beside the line: one is in the other's way
  double longitudinal_speed{};  ///< of the second minus the first [m/s]
  double lateral_speed{};       ///< of the second minus the first, left positive [m/s]
  double heading{};             ///< of the second minus the first, in (-pi, pi] [rad]
};

namespace detail {

/// The gap between two intervals about points that are `distance` apart; 0 where they overlap or touch.
[[nodiscard]] constexpr double gap_between(double distance, Extent const& first, Extent const& second) {
  double const ahead = distance - first.positive - second.negative;
  double const behind = distance + first.negative + second.positive;
  return ahead > 0.0 ? ahead : (behind < 0.0 ? behind : 0.0);
}

}  // namespace detail

/// From `first` to `second`, each with its shape turned by its heading error, as on a straight line: the reach of the
/// turned shapes is taken off the distances of the reference points.
[[nodiscard]] inline FrenetDifference frenet_difference(FrenetState const& first, Shape const& first_shape,
                                                        FrenetState const& second, Shape const& second_shape) {
  auto const [sin_1, cos_1] = sin_cos(first.heading_error);
  auto const [sin_2, cos_2] = sin_cos(second.heading_error);
  // A quarter turn carries the line's direction into the one across it.
  double const along = detail::gap_between(second.s - first.s, extent_along(first_shape, cos_1, sin_1),
                                           extent_along(second_shape, cos_2, sin_2));
  double const across = detail::gap_between(second.lateral - first.lateral, extent_along(first_shape, sin_1, -cos_1),
                                            extent_along(second_shape, sin_2, -cos_2));
  return {along,
          across,
          along == 0.0,
          across == 0.0,
          second.longitudinal_speed - first.longitudinal_speed,
          second.lateral_speed - first.lateral_speed,
          angle_difference(second.heading_error, first.heading_error)};
}

}  // namespace cambium::geometry
