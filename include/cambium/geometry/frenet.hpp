#pragma once

#include <cstdint>

#include "cambium/core/portable_math.hpp"
#include "cambium/core/state.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/line.hpp"
#include "cambium/geometry/shape.hpp"

namespace cambium::inline v0_1::geometry {

/// A motion state relative to a `Line`. The speeds are the components of the velocity along and across the line's
/// direction at `s`. On a curve of curvature k, s changes at the rate longitudinal_speed / (1 - k lateral).
struct FrenetState {
  double s{};                   ///< arc length of the foot point [m]
  double lateral{};             ///< offset from the line, left positive [m]
  double longitudinal_speed{};  ///< [m/s]
  double lateral_speed{};       ///< left positive [m/s]
  double heading_error{};       ///< heading of the vehicle minus that of the line, in (-pi, pi] [rad]
};

/// Frenet state of `state` at a known projection.
template <MotionState S>
[[nodiscard]] FrenetState to_frenet(Line const& line, S const& state, Projection const& projection) {
  auto cursor = projection.segment;
  double const error = angle_difference(state.heading, line.pose(projection.s, cursor).heading);
  auto const [sin, cos] = portable::sin_cos(error);
  return {projection.s, projection.lateral, state.speed * cos, state.speed * sin, error};
}

/// Frenet state by the exact projection. O(n).
template <MotionState S>
[[nodiscard]] FrenetState to_frenet(Line const& line, S const& state) {
  return to_frenet(line, state, line.project(Point{state.x, state.y}));
}

/// Frenet state by the projection near segment `hint`, which is set to the segment found. O(segments passed).
template <MotionState S>
[[nodiscard]] FrenetState to_frenet(Line const& line, S const& state, std::uint32_t& hint) {
  auto const projection = line.project(Point{state.x, state.y}, hint);
  hint = projection.segment;
  return to_frenet(line, state, projection);
}

/// The state in the map frame at `time` [s]: the inverse of `to_frenet`, except for points whose foot point is a vertex
/// with a kink, which come back on the normal of the segment behind the vertex. The speed is the velocity's component
/// along the heading. O(segments between `cursor` and `s`).
[[nodiscard]] inline State from_frenet(Line const& line, FrenetState const& frenet, double time,
                                       std::uint32_t& cursor) {
  Pose const pose = line.pose(frenet.s, cursor);
  auto const& segment = line.segments()[cursor];
  auto const [sin, cos] = portable::sin_cos(frenet.heading_error);
  return {time, pose.x - segment.uy * frenet.lateral, pose.y + segment.ux * frenet.lateral,
          normalize_angle(pose.heading + frenet.heading_error),
          frenet.longitudinal_speed * cos + frenet.lateral_speed * sin};
}

/// The same by binary search. O(log n).
[[nodiscard]] inline State from_frenet(Line const& line, FrenetState const& frenet, double time = 0.0) {
  auto cursor = line.find(frenet.s);
  return from_frenet(line, frenet, time, cursor);
}

/// Gaps and relative speeds between two vehicles along a common line. Gaps are measured between the shapes.
struct FrenetDifference {
  double longitudinal{};        ///< gap along the line, positive ahead; 0 if the shapes overlap along it [m]
  double lateral{};             ///< gap across the line, positive to the left; 0 if the shapes overlap across it [m]
  bool overlaps_along{};        ///< their ranges of s overlap
  bool overlaps_across{};       ///< their ranges of lateral offset overlap: one is in the other's way
  double longitudinal_speed{};  ///< second minus first [m/s]
  double lateral_speed{};       ///< second minus first, left positive [m/s]
  double heading{};             ///< second minus first, in (-pi, pi] [rad]
};

namespace detail {

/// Signed gap between two intervals around points that are `distance` apart; 0 if they overlap or touch.
[[nodiscard]] constexpr double gap_between(double distance, Extent const& first, Extent const& second) {
  double const ahead = distance - first.positive - second.negative;
  double const behind = distance + first.negative + second.positive;
  return ahead > 0.0 ? ahead : (behind < 0.0 ? behind : 0.0);
}

}  // namespace detail

/// Gaps and relative speeds from `first` to `second`. The line counts as straight: the extents of the shapes, turned by
/// their heading errors, are subtracted from the distances between the reference points.
[[nodiscard]] inline FrenetDifference frenet_difference(FrenetState const& first, Shape const& first_shape,
                                                        FrenetState const& second, Shape const& second_shape) {
  auto const [sin_1, cos_1] = portable::sin_cos(first.heading_error);
  auto const [sin_2, cos_2] = portable::sin_cos(second.heading_error);
  // (sin, -cos) turns the axis a quarter turn to the left: across the line.
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

}  // namespace cambium::inline v0_1::geometry
