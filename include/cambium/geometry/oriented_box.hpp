#pragma once

#include <array>
#include <cmath>

#include "cambium/core/portable_math.hpp"
#include "cambium/core/state.hpp"
#include "cambium/geometry/box.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/geometry/shape.hpp"

namespace cambium::inline v0_1::geometry {

/// A rotated rectangle in the map frame: centre, half side lengths [m], and heading. 48 bytes.
struct OrientedBox {
  double x, y;
  double half_length, half_width;
  double cos, sin;  ///< of the heading; the unit vector along the length

  [[nodiscard]] Point center() const { return {x, y}; }

  /// The corners, counter-clockwise: front left, rear left, rear right, front right.
  [[nodiscard]] std::array<Point, 4> corners() const {
    double const lx = half_length * cos, ly = half_length * sin;
    double const wx = -half_width * sin, wy = half_width * cos;
    return {Point{x + lx + wx, y + ly + wy}, Point{x - lx + wx, y - ly + wy}, Point{x - lx - wx, y - ly - wy},
            Point{x + lx - wx, y + ly - wy}};
  }

  /// The smallest axis-aligned rectangle around it.
  [[nodiscard]] Box bounding_box() const {
    double const dx = half_length * std::abs(cos) + half_width * std::abs(sin);
    double const dy = half_length * std::abs(sin) + half_width * std::abs(cos);
    return {x - dx, y - dy, x + dx, y + dy};
  }

  /// True inside and on the border.
  [[nodiscard]] bool contains(Point const& p) const {
    double const dx = p.x() - x, dy = p.y() - y;
    return std::abs(cos * dx + sin * dy) <= half_length && std::abs(cos * dy - sin * dx) <= half_width;
  }
};

/// The rectangle of `shape` with its reference point at (x, y) and the cosine and sine of its heading.
[[nodiscard]] inline OrientedBox box_of(Shape const& shape, double x, double y, double cos, double sin) {
  double const ahead = shape.center_offset(), aside = shape.center_offset_left();
  return {x + cos * ahead - sin * aside,
          y + sin * ahead + cos * aside,
          0.5 * shape.length(),
          0.5 * shape.width(),
          cos,
          sin};
}

/// The rectangle of `shape` with its reference point at `pose`.
[[nodiscard]] inline OrientedBox box_of(Shape const& shape, Pose const& pose) {
  auto const [sin, cos] = portable::sin_cos(pose.heading);
  return box_of(shape, pose.x, pose.y, cos, sin);
}

/// The rectangle of `shape` with its reference point in `state`.
template <MotionState S>
[[nodiscard]] OrientedBox box_of(Shape const& shape, S const& state) {
  return box_of(shape, Pose{state.x, state.y, state.heading});
}

}  // namespace cambium::inline v0_1::geometry
