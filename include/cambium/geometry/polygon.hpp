#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/box.hpp"
#include "cambium/geometry/oriented_box.hpp"
#include "cambium/geometry/pose.hpp"

namespace cambium::inline v0_1::geometry {

/// Twice the signed area of the triangle a, b, c [m^2]: positive if c lies to the left of the line from a to b.
[[nodiscard]] inline double turn(Point const& a, Point const& b, Point const& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Twice the signed area of the ring of `points` [m^2]: positive if it runs counter-clockwise. Computed relative to the
/// first point, so that rings far from the origin lose no precision.
[[nodiscard]] inline double twice_area(std::span<Point const> points) {
  double twice = 0.0;
  for (std::size_t i = 1; i + 1 < points.size(); ++i) twice += turn(points[0], points[i], points[i + 1]);
  return twice;
}

/// Distance [m] from `p` to the segment from `a` to `b`.
[[nodiscard]] inline double distance_to_segment(Point const& p, Point const& a, Point const& b) {
  double const ex = b.x() - a.x(), ey = b.y() - a.y();
  double const px = p.x() - a.x(), py = p.y() - a.y();
  double const squared = ex * ex + ey * ey;
  double const t = squared > 0.0 ? std::clamp((px * ex + py * ey) / squared, 0.0, 1.0) : 0.0;
  return portable::hypot(px - t * ex, py - t * ey);
}

/// An immutable simple polygon in the map frame [m]: a closed ring of corners, counter-clockwise, not necessarily
/// convex. Its border belongs to it. Precondition: the ring does not cross itself, see `is_simple`.
class Polygon {
 public:
  /// No polygon yet: it has no corners and contains nothing.
  Polygon() = default;

  /// Takes the corners in either direction. Drops repeated points and a last point that closes the ring. Throws `Error`
  /// naming `where` if there are fewer than three distinct points, a number is not finite, or the area is zero. O(n).
  explicit Polygon(std::span<Point const> points, std::string const& where = "polygon") {
    points_.reserve(points.size());
    for (auto const& p : points) {
      if (!std::isfinite(p.x()) || !std::isfinite(p.y()))
        throw Error(where, "a point is not a finite number", "give coordinates in metres");
      if (points_.empty() || p != points_.back()) points_.push_back(p);
    }
    while (points_.size() > 1 && points_.front() == points_.back()) points_.pop_back();
    if (points_.size() < 3) {
      throw Error(where, "has " + std::to_string(points_.size()) + " distinct points", "give at least three corners");
    }
    area_ = 0.5 * twice_area(points_);
    if (area_ == 0.0) throw Error(where, "has no area", "give corners that do not lie on one line");
    if (area_ < 0.0) {
      std::reverse(points_.begin(), points_.end());
      area_ = -area_;
    }
    box_ = box_around(points_);
  }

  /// The same from a list: `Polygon({{0, 0}, {4, 0}, {4, 2}})`.
  explicit Polygon(std::initializer_list<Point> points, std::string const& where = "polygon")
      : Polygon(std::span<Point const>(points.begin(), points.size()), where) {}

  /// The corners, counter-clockwise; the last one is joined to the first.
  [[nodiscard]] std::span<Point const> points() const { return points_; }
  [[nodiscard]] std::size_t size() const { return points_.size(); }
  [[nodiscard]] Point const* data() const { return points_.data(); }
  [[nodiscard]] double area() const { return area_; }  ///< [m^2]
  [[nodiscard]] Box const& bounding_box() const { return box_; }
  /// True if no corner turns right. O(n).
  [[nodiscard]] bool is_convex() const {
    for (std::size_t i = 0; i < points_.size(); ++i)
      if (turn(edge(i).first, edge(i).second, points_[(i + 2) % points_.size()]) < 0.0) return false;
    return !points_.empty();
  }

  /// Edge i, from corner i to the next.
  [[nodiscard]] std::pair<Point const&, Point const&> edge(std::size_t i) const {
    return {points_[i], points_[i + 1 < points_.size() ? i + 1 : 0]};
  }

  /// True inside and on the border (on the border up to rounding). O(n).
  [[nodiscard]] bool contains(Point const& p) const {
    if (!box_.contains(p)) return false;
    bool inside = false;
    for (std::size_t i = points_.size() - 1, j = 0; j < points_.size(); i = j++) {
      auto const& a = points_[i];
      auto const& b = points_[j];
      double const side = turn(a, b, p);
      if (side == 0.0 && between(a, b, p)) return true;
      bool const crosses = (a.y() <= p.y()) != (b.y() <= p.y());
      if (crosses && (side > 0.0) == (b.y() > a.y())) inside = !inside;
    }
    return inside;
  }

  /// Distance [m] to the nearest point of the border, from outside or inside; infinite without corners. O(n).
  [[nodiscard]] double distance_to_border(Point const& p) const {
    if (points_.empty()) return std::numeric_limits<double>::infinity();
    double distance = distance_to_segment(p, points_.back(), points_.front());
    for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
      distance = std::min(distance, distance_to_segment(p, points_[i], points_[i + 1]));
    }
    return distance;
  }

  /// This polygon, taken as local to `frame` (x forward, y left), in the map frame. O(n).
  [[nodiscard]] Polygon transformed(Pose const& frame) const {
    if (points_.empty()) return {};
    auto const [sin, cos] = portable::sin_cos(frame.heading);
    Polygon result = *this;
    for (auto& p : result.points_) {
      p = Point{frame.x + cos * p.x() - sin * p.y(), frame.y + sin * p.x() + cos * p.y()};
    }
    result.box_ = box_around(result.points_);
    return result;
  }

  /// True if no two edges cross or touch, except neighbours in their common corner. O(n^2), meant for checking input.
  [[nodiscard]] bool is_simple() const;

  friend bool operator==(Polygon const& a, Polygon const& b) { return a.points_ == b.points_; }

 private:
  [[nodiscard]] static bool between(Point const& a, Point const& b, Point const& p) {
    return std::min(a.x(), b.x()) <= p.x() && p.x() <= std::max(a.x(), b.x()) && std::min(a.y(), b.y()) <= p.y() &&
           p.y() <= std::max(a.y(), b.y());
  }

  std::vector<Point> points_;
  double area_ = 0.0;
  Box box_{};
};

/// True if the closed segments a-b and c-d share a point.
[[nodiscard]] inline bool segments_intersect(Point const& a, Point const& b, Point const& c, Point const& d) {
  auto const apart = [](double a1, double a2, double b1, double b2) {
    return std::max(a1, a2) < std::min(b1, b2) || std::max(b1, b2) < std::min(a1, a2);
  };
  if (apart(a.x(), b.x(), c.x(), d.x()) || apart(a.y(), b.y(), c.y(), d.y())) return false;
  auto const one_side = [](double first, double second) {
    return (first > 0.0 && second > 0.0) || (first < 0.0 && second < 0.0);
  };
  return !one_side(turn(a, b, c), turn(a, b, d)) && !one_side(turn(c, d, a), turn(c, d, b));
}

inline bool Polygon::is_simple() const {
  std::size_t const n = points_.size();
  for (std::size_t i = 0; i < n; ++i) {
    auto const [a, b] = edge(i);
    auto const next = edge((i + 1) % n);
    // A spike: the next edge runs back over this one.
    if (turn(a, b, next.second) == 0.0 && (b - a).dot(next.second - b) < 0.0) return false;
    for (std::size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j == n - 1) continue;
      auto const [c, d] = edge(j);
      if (segments_intersect(a, b, c, d)) return false;
    }
  }
  return true;
}

/// The rectangle as a polygon. Throws `Error` if its area is zero.
[[nodiscard]] inline Polygon polygon_of(OrientedBox const& box) { return Polygon(box.corners()); }

}  // namespace cambium::inline v0_1::geometry
