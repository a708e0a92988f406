#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "cambium/geometry/oriented_box.hpp"
#include "cambium/geometry/polygon.hpp"
#include "cambium/geometry/pose.hpp"

// All regions are closed: touching regions intersect, and a region may touch the border of one that contains it.
// Results are exact up to rounding, about 1e-15 of the size of the coordinates. Nothing here allocates.

namespace cambium::inline v0_1::geometry {

/// Whether two rectangles share a point. By the separating-axis theorem, they are disjoint if and only if their
/// projections on one of their four side directions are. Takes a few nanoseconds, fewer if they are far apart.
[[nodiscard]] inline bool intersects(OrientedBox const& a, OrientedBox const& b) {
  double const dx = b.x - a.x, dy = b.y - a.y;
  double const reach = a.half_length + a.half_width + b.half_length + b.half_width;
  if (dx * dx + dy * dy > reach * reach) return false;
  double const cos = std::abs(a.cos * b.cos + a.sin * b.sin);
  double const sin = std::abs(a.cos * b.sin - a.sin * b.cos);
  bool const along_a = std::abs(a.cos * dx + a.sin * dy) <= a.half_length + b.half_length * cos + b.half_width * sin;
  bool const across_a = std::abs(a.cos * dy - a.sin * dx) <= a.half_width + b.half_length * sin + b.half_width * cos;
  if (!(along_a & across_a)) return false;
  bool const along_b = std::abs(b.cos * dx + b.sin * dy) <= b.half_length + a.half_length * cos + a.half_width * sin;
  bool const across_b = std::abs(b.cos * dy - b.sin * dx) <= b.half_width + a.half_length * sin + a.half_width * cos;
  return along_b & across_b;
}

/// A lower bound of the distance [m] between two rectangles that is positive if they are disjoint, and else at most 0:
/// the widest gap between their projections on the four side directions.
[[nodiscard]] inline double separation(OrientedBox const& a, OrientedBox const& b) {
  double const dx = b.x - a.x, dy = b.y - a.y;
  double const cos = std::abs(a.cos * b.cos + a.sin * b.sin);
  double const sin = std::abs(a.cos * b.sin - a.sin * b.cos);
  double const along_a = std::abs(a.cos * dx + a.sin * dy) - a.half_length - b.half_length * cos - b.half_width * sin;
  double const across_a = std::abs(a.cos * dy - a.sin * dx) - a.half_width - b.half_length * sin - b.half_width * cos;
  double const along_b = std::abs(b.cos * dx + b.sin * dy) - b.half_length - a.half_length * cos - a.half_width * sin;
  double const across_b = std::abs(b.cos * dy - b.sin * dx) - b.half_width - a.half_length * sin - a.half_width * cos;
  return std::max(std::max(along_a, across_a), std::max(along_b, across_b));
}

namespace detail {

/// Whether the segment a-b shares a point with the rectangle; if `closed` is false, with its interior. Uses separating
/// axes: the two directions of the rectangle and the normal of the segment.
template <bool closed>
[[nodiscard]] inline bool segment_meets_box(Point const& a, Point const& b, OrientedBox const& box) {
  auto const within = [](double value, double bound) { return closed ? value <= bound : value < bound; };
  double const ax = a.x() - box.x, ay = a.y() - box.y, bx = b.x() - box.x, by = b.y() - box.y;
  // Midpoint and half vector of the segment, along and across the rectangle.
  double const mx = 0.5 * (ax + bx), my = 0.5 * (ay + by), hx = 0.5 * (bx - ax), hy = 0.5 * (by - ay);
  double const middle = box.cos * mx + box.sin * my, aside = box.cos * my - box.sin * mx;
  double const half = box.cos * hx + box.sin * hy, half_aside = box.cos * hy - box.sin * hx;
  return within(std::abs(middle), box.half_length + std::abs(half)) &&
         within(std::abs(aside), box.half_width + std::abs(half_aside)) &&
         within(std::abs(middle * half_aside - aside * half),
                box.half_length * std::abs(half_aside) + box.half_width * std::abs(half));
}

template <bool closed>
[[nodiscard]] inline bool border_meets_box(Polygon const& polygon, OrientedBox const& box) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    auto const [a, b] = polygon.edge(i);
    if (segment_meets_box<closed>(a, b, box)) return true;
  }
  return false;
}

}  // namespace detail

/// Whether a rectangle and a polygon share a point. O(corners of the polygon).
[[nodiscard]] inline bool intersects(OrientedBox const& box, Polygon const& polygon) {
  if (!polygon.bounding_box().intersects(box.bounding_box())) return false;
  return detail::border_meets_box<true>(polygon, box) || polygon.contains(box.center());
}

/// As above.
[[nodiscard]] inline bool intersects(Polygon const& polygon, OrientedBox const& box) {
  return intersects(box, polygon);
}

/// Whether two polygons share a point. O(n m) in the worst case; edges away from the other's bounding box cost O(1).
[[nodiscard]] inline bool intersects(Polygon const& a, Polygon const& b) {
  if (!a.bounding_box().intersects(b.bounding_box())) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    auto const [p, q] = a.edge(i);
    Box const around{std::min(p.x(), q.x()), std::min(p.y(), q.y()), std::max(p.x(), q.x()), std::max(p.y(), q.y())};
    if (!around.intersects(b.bounding_box())) continue;
    for (std::size_t j = 0; j < b.size(); ++j) {
      auto const [r, s] = b.edge(j);
      if (segments_intersect(p, q, r, s)) return true;
    }
  }
  // The borders are apart: disjoint, or one inside the other.
  return a.contains(b.points()[0]) || b.contains(a.points()[0]);
}

/// Whether the whole rectangle lies in the polygon. O(corners of the polygon).
[[nodiscard]] inline bool contains(Polygon const& polygon, OrientedBox const& box) {
  // If no border passes through the rectangle's interior, all of it lies on the same side as its centre.
  return polygon.contains(box.center()) && !detail::border_meets_box<false>(polygon, box);
}

/// Distance [m] from `p` to the rectangle, 0 inside.
[[nodiscard]] inline double distance(OrientedBox const& box, Point const& p) {
  double const dx = p.x() - box.x, dy = p.y() - box.y;
  double const along = std::max(std::abs(box.cos * dx + box.sin * dy) - box.half_length, 0.0);
  double const across = std::max(std::abs(box.cos * dy - box.sin * dx) - box.half_width, 0.0);
  return std::sqrt(along * along + across * across);
}

/// The point of the rectangle nearest to `p`; `p` itself if it lies inside.
[[nodiscard]] inline Point nearest_point(OrientedBox const& box, Point const& p) {
  double const dx = p.x() - box.x, dy = p.y() - box.y;
  double const along = std::clamp(box.cos * dx + box.sin * dy, -box.half_length, box.half_length);
  double const across = std::clamp(box.cos * dy - box.sin * dx, -box.half_width, box.half_width);
  return {box.x + box.cos * along - box.sin * across, box.y + box.sin * along + box.cos * across};
}

/// Distance [m] between two rectangles, 0 if they intersect.
[[nodiscard]] inline double distance(OrientedBox const& a, OrientedBox const& b) {
  if (intersects(a, b)) return 0.0;
  // Between disjoint convex polygons, the shortest distance is attained at a corner of one of them.
  double nearest = std::numeric_limits<double>::infinity();
  for (auto const& corner : a.corners()) nearest = std::min(nearest, distance(b, corner));
  for (auto const& corner : b.corners()) nearest = std::min(nearest, distance(a, corner));
  return nearest;
}

/// The point of the polygon's border nearest to `p`, which may lie outside or inside. O(n).
[[nodiscard]] inline Point nearest_border_point(Polygon const& polygon, Point const& p) {
  Point best = polygon.points()[0];
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    auto const [a, b] = polygon.edge(i);
    Point const side = b - a;
    double const squared = side.squaredNorm();
    Point const q = a + (squared > 0.0 ? std::clamp((p - a).dot(side) / squared, 0.0, 1.0) : 0.0) * side;
    if ((q - p).squaredNorm() < (best - p).squaredNorm()) best = q;
  }
  return best;
}

/// The point of the polygon nearest to `p`; `p` itself if it lies inside. O(n).
[[nodiscard]] inline Point nearest_point(Polygon const& polygon, Point const& p) {
  return polygon.contains(p) ? p : nearest_border_point(polygon, p);
}

/// Distance [m] from `p` to the polygon, 0 inside. O(n).
[[nodiscard]] inline double distance(Polygon const& polygon, Point const& p) {
  return polygon.contains(p) ? 0.0 : polygon.distance_to_border(p);
}

/// Distance [m] between a rectangle and a polygon, 0 if they intersect. O(n).
[[nodiscard]] inline double distance(OrientedBox const& box, Polygon const& polygon) {
  if (intersects(box, polygon)) return 0.0;
  double nearest = std::numeric_limits<double>::infinity();  // at a corner of one of them
  for (auto const& corner : box.corners()) nearest = std::min(nearest, polygon.distance_to_border(corner));
  for (auto const& corner : polygon.points()) nearest = std::min(nearest, distance(box, corner));
  return nearest;
}

}  // namespace cambium::inline v0_1::geometry
