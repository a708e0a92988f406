#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/geometry/shape.hpp"
#include "cambium/tracking/detail/ways.hpp"
#include "cambium/tracking/tracked_object.hpp"
#include "cambium/tracking/verdict.hpp"

namespace cambium::inline v0_1::detail {

inline constexpr double standing_object = 0.3;  ///< slower counts as standing [m/s]; own choice

/// From `sooner` to `later` [s].
[[nodiscard]] inline double seconds_between(std::int64_t sooner, std::int64_t later) {
  // As unsigned numbers the difference cannot overflow.
  auto const apart = static_cast<std::uint64_t>(later) - static_cast<std::uint64_t>(sooner);
  return later >= sooner ? 1e-9 * static_cast<double>(apart) : -1e-9 * static_cast<double>(~apart + 1);
}

/// The curvature of a way [1/m] with that turn rate [rad/s] and speed [m/s], within what a vehicle can do.
[[nodiscard]] inline double curvature_at(double yaw_rate, double speed) {
  constexpr double tightest = 0.2, slow = 1.0, hardest = 8.0;  // [1/m], [m/s], [m/s^2]
  double const v = std::max(slow, speed), most = std::min(tightest, hardest / (v * v));
  return std::clamp(yaw_rate / v, -most, most);
}

[[nodiscard]] inline geometry::Point direction(double heading) {
  auto const [sin, cos] = portable::sin_cos(heading);
  return {cos, sin};
}

[[nodiscard]] inline bool is_on_foot(TrackedObject const& object) {
  return object.kind == ObjectClass::pedestrian || object.kind == ObjectClass::animal;
}

/// What forbids an object in a list of `stamp`.
[[nodiscard]] inline Refusal fault_of(TrackedObject const& object, std::int64_t stamp, double least_existence) {
  constexpr double farthest = 1e8, highest_speed = 150.0, latest = 1.0;  // [m], [m/s], [s]
  if (!std::isfinite(object.x + object.y + object.vx + object.vy)) return Refusal::not_finite;
  if (std::abs(object.x) > farthest || std::abs(object.y) > farthest ||
      portable::hypot(object.vx, object.vy) > highest_speed)
    return Refusal::out_of_range;
  if (object.stamp != 0 && std::abs(seconds_between(object.stamp, stamp)) > latest) return Refusal::too_old;
  if (!(object.existence >= least_existence)) return Refusal::unlikely;
  return Refusal::none;
}

/// The outline of an object about its reference point, by default that of its class.
[[nodiscard]] inline geometry::Shape shape_of(TrackedObject const& object, bool& is_assumed) {
  struct Size {
    double length, width;
  };
  constexpr Size usual[] = {{4.5, 1.8}, {4.5, 1.8}, {10.0, 2.5}, {12.0, 2.5}, {8.0, 2.5},
                            {2.2, 0.8}, {1.8, 0.6}, {0.5, 0.5},  {0.8, 0.4},  {1.0, 1.0}};
  constexpr double longest = 60.0, widest = 10.0;  // [m]
  auto const place = std::min<std::size_t>(static_cast<std::size_t>(object.kind), std::size(usual) - 1);
  auto const [length, width] = usual[place];
  auto const known = [&](double size, double most) { return size > 0.05 && size <= most; };
  is_assumed = !known(object.length, longest) || !known(object.width, widest);
  double const l = known(object.length, longest) ? object.length : length;
  double const w = known(object.width, widest) ? object.width : width;
  bool const has_axles = object.kind < ObjectClass::motorcycle;
  double const rear = has_axles ? 0.2 * l : 0.5 * l;
  return {l - rear, rear, 0.5 * w, 0.5 * w};
}

/// What a tracker knows of an object.
template <class World>
struct ObjectTrack {
  ObjectKey key;
  AgentId agent = none<AgentId>;
  std::int64_t seen = 0;  ///< when [ns]
  /// Measured, or predicted since: of the reference point, with the heading in which it moves.
  typename World::State state{};
  double acceleration = 0.0;  ///< likewise [m/s^2]
  geometry::Shape shape;      ///< about the reference point, with `front` where it moves to
  bool reverses = false;      ///< its rear goes first
  ObjectPoint point = ObjectPoint::box_center;
  struct {
    double heading = 0.0, speed = 0.0;          ///< as measured last, of its front
    double acceleration = 0.0, yaw_rate = 0.0;  ///< smoothed, where the host does not measure them
  } last{};
  double desired_speed = 0.0;  ///< learnt; 0: not yet [m/s]
  ObjectMotion motion = ObjectMotion::none;
  bool may_drive = true;  ///< it is neither on foot nor known to stay
  std::vector<Way> ways;  ///< the most probable one first; none: it is off the lanes
  typename World::Behaviors::Memory memory;

  [[nodiscard]] Moving moving() const { return {{state.x, state.y, state.heading}, state.speed, last.yaw_rate}; }

  /// From its reference point to the point that the host gives, along its motion [m].
  [[nodiscard]] double to_point() const { return point == ObjectPoint::box_center ? shape.center_offset() : 0.0; }

  /// The curvature of its way [1/m].
  [[nodiscard]] double curvature() const { return curvature_at(last.yaw_rate, state.speed); }

  /// Takes what was measured, `since` [s] the last time, as the state at `stamp` [ns], which is the world's `time` [s].
  void measure(TrackedObject const& object, std::int64_t stamp, double time, double since, Verdict& verdict) {
    constexpr double moves = 0.5, hardest = 10.0, tightest = 1.5, smoothing = 0.3;  // [m/s], [m/s^2], [rad/s], [-]
    shape = shape_of(object, verdict.assumed_size);
    point = object.point;
    double const over_ground = portable::hypot(object.vx, object.vy);
    double const before = since > 0.0 ? last.heading : std::isfinite(object.heading) ? object.heading : 0.0;
    double const towards = over_ground > moves ? portable::atan2(object.vy, object.vx) : before;
    double heading = object.heading;
    verdict.assumed_heading = object.heading_known == HeadingKnown::no || !std::isfinite(heading);
    if (verdict.assumed_heading || is_on_foot(object))
      heading = towards;
    else if (object.heading_known == HeadingKnown::up_to_sign &&
             std::abs(geometry::angle_difference(heading, towards)) > 0.5 * geometry::pi)
      heading += geometry::pi;
    heading = geometry::normalize_angle(heading);
    double const along = object.vx * portable::cos(heading) + object.vy * portable::sin(heading);
    auto const smooth = [&](double from, double measured, double by_difference, double most) {
      double const value = std::isfinite(measured) ? measured
                           : since > 0.0           ? from + smoothing * (by_difference - from)
                                                   : 0.0;
      return std::clamp(value, -most, most);
    };
    double const per = since > 0.0 ? 1.0 / since : 0.0;
    last.yaw_rate =
        smooth(last.yaw_rate, object.yaw_rate, geometry::angle_difference(heading, last.heading) * per, tightest);
    last.acceleration = smooth(last.acceleration, object.acceleration, (along - last.speed) * per, hardest);
    last.heading = heading;
    last.speed = along;

    double const late = object.stamp == 0 ? 0.0 : seconds_between(object.stamp, stamp), turn = last.yaw_rate * late;
    geometry::Point at{object.x, object.y};
    if (point == ObjectPoint::box_center) at = at - shape.center_offset() * direction(heading);
    at = at + along * late * direction(heading + 0.5 * turn);
    double speed = along + last.acceleration * late;
    heading += turn;
    acceleration = last.acceleration;
    reverses = along < -standing_object;
    if (reverses) {
      heading += geometry::pi;
      std::swap(shape.front, shape.rear);
      speed = -speed;
      acceleration = -acceleration;
    }
    state.time = time;
    state.x = at.x();
    state.y = at.y();
    state.heading = geometry::normalize_angle(heading);
    state.speed = std::max(0.0, speed);
  }
};

}  // namespace cambium::inline v0_1::detail
