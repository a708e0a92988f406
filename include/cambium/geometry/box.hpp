#pragma once

#include <algorithm>
#include <limits>
#include <span>

#include "cambium/geometry/pose.hpp"

namespace cambium::inline v0_1::geometry {

/// An axis-aligned rectangle in the map frame [m], borders included. A default one is empty.
struct Box {
  double min_x = std::numeric_limits<double>::infinity(), min_y = std::numeric_limits<double>::infinity();
  double max_x = -std::numeric_limits<double>::infinity(), max_y = -std::numeric_limits<double>::infinity();

  /// Grows to include the point.
  void add(double x, double y) {
    min_x = std::min(min_x, x);
    min_y = std::min(min_y, y);
    max_x = std::max(max_x, x);
    max_y = std::max(max_y, y);
  }

  [[nodiscard]] Point center() const { return {0.5 * (min_x + max_x), 0.5 * (min_y + max_y)}; }
  /// Larger by `by` [m] on each side; smaller where it is negative.
  [[nodiscard]] Box grown(double by) const { return {min_x - by, min_y - by, max_x + by, max_y + by}; }

  /// Whether `p` lies inside or on the border.
  [[nodiscard]] bool contains(Point const& p) const {
    return p.x() >= min_x && p.x() <= max_x && p.y() >= min_y && p.y() <= max_y;
  }
  /// Whether all of `other` does.
  [[nodiscard]] bool contains(Box const& other) const {
    return other.min_x >= min_x && other.max_x <= max_x && other.min_y >= min_y && other.max_y <= max_y;
  }
  /// Whether the two share a point.
  [[nodiscard]] bool intersects(Box const& other) const {
    return min_x <= other.max_x && other.min_x <= max_x && min_y <= other.max_y && other.min_y <= max_y;
  }

  friend bool operator==(Box const&, Box const&) = default;
};

/// The smallest box around `points`.
[[nodiscard]] inline Box box_around(std::span<Point const> points) {
  Box box;
  for (auto const& p : points) box.add(p.x(), p.y());
  return box;
}

}  // namespace cambium::inline v0_1::geometry
