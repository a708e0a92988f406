#pragma once

#include <algorithm>
#include <cmath>

#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/box.hpp"
#include "cambium/geometry/collision.hpp"
#include "cambium/geometry/oriented_box.hpp"
#include "cambium/geometry/polygon.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/geometry/shape.hpp"

namespace cambium::inline v0_1::geometry {

/// A rectangle that moves from one state to another with constant acceleration and, to second order in the change of
/// its heading, along an arc. Times `t` are shares of the whole motion, from 0 to 1.
class MovingBox {
 public:
  /// Of a rectangle that rests at `to`.
  MovingBox(Shape const& shape, Pose const& to) : shape_(shape), to_(to) {}

  template <MotionState S>
  MovingBox(Shape const& shape, S const& from, S const& to)
      : shape_(shape), to_(to.x, to.y, to.heading), way_(to.x - from.x, to.y - from.y), turn_(turn(from, to)) {
    double const length = way_.norm();
    if (length > 0.0) lead_ = std::clamp(0.5 * (from.speed - to.speed) * (to.time - from.time) / length, -1.0, 1.0);
  }

  /// Where it is at `t`.
  [[nodiscard]] OrientedBox at(double t) const {
    double const done = t * (1.0 + lead_ * (1.0 - t)), left = 1.0 - done, bulge = 0.5 * turn_ * done * left;
    return box_of(shape_, {to_.x - left * way_.x() + bulge * way_.y(), to_.y - left * way_.y() - bulge * way_.x(),
                           to_.heading - left * turn_});
  }

  /// An axis-aligned rectangle that it does not leave.
  [[nodiscard]] Box bounding_box() const {
    auto const end = at(1.0).bounding_box();
    double const most = longest_way(*this);
    return {end.min_x - most, end.min_y - most, end.max_x + most, end.max_y + most};
  }

  /// Bound on the distance [m] between any point of a moving rectangle and its place on an even motion along the chord
  /// with the last heading. `reach` [m] bounds its distance from the reference point. Takes a few nanoseconds.
  template <MotionState S>
  [[nodiscard]] static double deviation(double reach, S const& from, S const& to) {
    double const way = std::abs(to.x - from.x) + std::abs(to.y - from.y);
    return 0.125 * std::abs((from.speed - to.speed) * (to.time - from.time)) +
           (0.125 * way + reach) * std::abs(turn(from, to));
  }

  /// Bound on the way [m] that any point of one makes relative to any of the other.
  [[nodiscard]] friend double longest_way(MovingBox const& a, MovingBox const& b) {
    // Both accelerate evenly: the relative velocity along the chords is greatest at the beginning or the end.
    Point const chord = b.way_ - a.way_, lead = b.lead_ * b.way_ - a.lead_ * a.way_;
    return std::sqrt(std::max((chord + lead).squaredNorm(), (chord - lead).squaredNorm())) + a.turning() + b.turning();
  }

  /// Bound on the way [m] of any of its points.
  [[nodiscard]] friend double longest_way(MovingBox const& box) {
    return (1.0 + std::abs(box.lead_)) * box.way_.norm() + box.turning();
  }

 private:
  /// Change of the heading [rad].
  template <MotionState S>
  [[nodiscard]] static double turn(S const& from, S const& to) {
    return normalize_angle(to.heading - from.heading);
  }

  /// Bound on the part of the way that comes from turning [m].
  [[nodiscard]] double turning() const {
    if (turn_ == 0.0) return 0.0;
    double const reach = std::max(shape_.front, shape_.rear) + std::max(shape_.left, shape_.right);
    return (1.0 + std::abs(lead_)) * std::abs(turn_) * (0.5 * way_.norm() + reach);
  }

  Shape shape_;
  Pose to_;
  Point way_{};        ///< from the beginning to the end [m]
  double turn_ = 0.0;  ///< [rad]
  double lead_ = 0.0;  ///< by how much its speed at the beginning exceeds its mean speed, as a share of that
};

namespace detail {

/// Whether `gap(t)`, a lower bound of a distance [m] that changes by at most `way` [m] per unit of `t`, falls to 0 for
/// a `t` from 0 to 1. Conservative advancement (Mirtich 1996), backwards: from the end, it advances by the gap. Where
/// that is not settled in 10 000 steps, for motions of kilometres, it counts as contact.
template <class Gap>
[[nodiscard]] bool closes(double way, Gap const& gap) {
  constexpr double overlap = 0.02;  // advances so much further: what it misses is half as deep
  double t = 1.0;
  for (int step = 0; step < 10'000; ++step) {
    double const here = gap(t);
    if (here <= 0.0) return true;
    if (!(here <= t * way)) return false;
    t = std::max(0.0, t - (here + overlap) / way);
  }
  return true;
}

}  // namespace detail

/// Whether two moving rectangles share a point at the same time. Misses contacts less than 1 cm deep between beginning
/// and end. O(1 + longest way / distance).
[[nodiscard]] inline bool intersects(MovingBox const& a, MovingBox const& b) {
  return detail::closes(longest_way(a, b), [&](double t) { return separation(a.at(t), b.at(t)); });
}

/// As above, with a polygon that rests. Each of its steps is O(corners of the polygon).
[[nodiscard]] inline bool intersects(MovingBox const& box, Polygon const& polygon) {
  return detail::closes(longest_way(box), [&](double t) { return distance(box.at(t), polygon); });
}

}  // namespace cambium::inline v0_1::geometry
