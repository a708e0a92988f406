#pragma once

#include <algorithm>
#include <cmath>

#include "cambium/core/parameters.hpp"

namespace cambium::inline v0_1::geometry {

/// A rectangle around a road user, given by the distances [m] of its sides from the reference point. The agent's pose
/// is that of the reference point: for vehicles, the centre of the rear axle on the ground.
struct Shape {
  double front = 3.6;
  double rear = 0.9;
  double left = 0.9;
  double right = 0.9;

  static constexpr char const* name = "shape";
  static constexpr Range extent{0.0, 100.0};
  static constexpr auto parameters() {
    return parameter_list(
        parameter("front", &Shape::front, "m", extent, "From the reference point forward to the front end."),
        parameter("rear", &Shape::rear, "m", extent, "From the reference point back to the rear end."),
        parameter("left", &Shape::left, "m", extent, "From the reference point to the left side."),
        parameter("right", &Shape::right, "m", extent, "From the reference point to the right side."));
  }

  [[nodiscard]] constexpr double length() const { return front + rear; }
  [[nodiscard]] constexpr double width() const { return left + right; }
  /// Distance of the rectangle's centre ahead of the reference point [m].
  [[nodiscard]] constexpr double center_offset() const { return 0.5 * (front - rear); }
  /// Distance of the rectangle's centre to the left of the reference point [m]; 0 for symmetric vehicles.
  [[nodiscard]] constexpr double center_offset_left() const { return 0.5 * (left - right); }
  /// Radius [m] of the circumscribed circle.
  [[nodiscard]] double radius() const { return 0.5 * std::sqrt(length() * length() + width() * width()); }

  /// Whether `other` fits inside when the reference points coincide.
  [[nodiscard]] constexpr bool holds(Shape const& other) const {
    return other.front <= front && other.rear <= rear && other.left <= left && other.right <= right;
  }

  friend bool operator==(Shape const&, Shape const&) = default;
};

/// The smallest shape that holds both where the reference points coincide.
[[nodiscard]] constexpr Shape joined(Shape const& a, Shape const& b) {
  return {std::max(a.front, b.front), std::max(a.rear, b.rear), std::max(a.left, b.left), std::max(a.right, b.right)};
}

/// Extent of a shape along an axis [m], measured from the reference point.
struct Extent {
  double positive;  ///< in the direction of the axis
  double negative;  ///< in the opposite direction, also a positive number
};

/// Extent of a shape along an axis. `cos` and `sin` belong to the angle from the axis to the shape's heading.
[[nodiscard]] constexpr Extent extent_along(Shape const& shape, double cos, double sin) {
  auto const reach = [&shape](double c, double s) {
    return (c >= 0.0 ? c * shape.front : -c * shape.rear) + (s <= 0.0 ? -s * shape.left : s * shape.right);
  };
  return {reach(cos, sin), reach(-cos, -sin)};
}

// Presets: outer dimensions without mirrors. The reference point is on the rear axle; midway between twin axles.

/// Compact to medium car, 4.5 m x 1.8 m, wheel base 2.7 m, rear overhang 0.9 m (size of a VW Golf or BMW 3 series,
/// rounded).
[[nodiscard]] constexpr Shape car() { return {3.6, 0.9, 0.9, 0.9}; }

/// Delivery van, 6.0 m x 2.0 m, wheel base 3.7 m, rear overhang 1.3 m (size of a long Mercedes Sprinter, rounded).
[[nodiscard]] constexpr Shape van() { return {4.7, 1.3, 1.0, 1.0}; }

/// Rigid truck, 10.0 m x 2.55 m, wheel base 5.8 m, rear overhang 2.8 m. EU Directive 96/53/EC (annex I) permits at most
/// 2.55 m in width and 12 m in length.
[[nodiscard]] constexpr Shape truck() { return {7.2, 2.8, 1.275, 1.275}; }

/// Articulated truck as one rectangle, 16.5 m x 2.55 m, the longest that EU Directive 96/53/EC (annex I) permits. The
/// reference point is on the middle axle of the trailer, 4.0 m from the rear end.
[[nodiscard]] constexpr Shape articulated_truck() { return {12.5, 4.0, 1.275, 1.275}; }

/// City bus, 12.0 m x 2.55 m, wheel base 5.9 m, rear overhang 3.4 m (size of a Mercedes Citaro, rounded).
[[nodiscard]] constexpr Shape bus() { return {8.6, 3.4, 1.275, 1.275}; }

/// Motorcycle with rider, 2.2 m x 0.8 m, wheel base 1.5 m (size of a BMW R 1250 without cases, rounded).
[[nodiscard]] constexpr Shape motorcycle() { return {1.85, 0.35, 0.4, 0.4}; }

/// Bicycle with rider, 1.8 m x 0.65 m, wheel base 1.1 m (a touring bicycle, with the width of its handlebar).
[[nodiscard]] constexpr Shape bicycle() { return {1.45, 0.35, 0.325, 0.325}; }

/// Pedestrian, a square of 0.6 m about the reference point. The side is the longer axis of Fruin's body ellipse (1971,
/// "Pedestrian planning and design", 0.61 m x 0.46 m), because a pedestrian may turn on the spot.
[[nodiscard]] constexpr Shape pedestrian() { return {0.3, 0.3, 0.3, 0.3}; }

/// Road users up to this length are on foot [m]. Own choice.
inline constexpr double longest_on_foot = 1.0;

}  // namespace cambium::inline v0_1::geometry
