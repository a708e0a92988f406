#pragma once

#include <cmath>

#include <Eigen/Core>

namespace cambium::geometry {

/// A point in the map frame [m].
using Point = Eigen::Vector2d;

/// Position [m] and heading [rad, counter-clockwise from +x] in the map frame.
struct Pose {
  double x{}, y{}, heading{};

  Pose() = default;
  /// All three: two numbers are a point, not a pose of heading 0.
  constexpr Pose(double x_, double y_, double heading_) : x(x_), y(y_), heading(heading_) {}

  [[nodiscard]] Point position() const { return {x, y}; }

  friend bool operator==(Pose const&, Pose const&) = default;
};

/// The map point that lies at `local` (x forward, y left) as seen from `frame`.
[[nodiscard]] inline Point to_map(Pose const& frame, Point const& local) {
  double const c = std::cos(frame.heading), s = std::sin(frame.heading);
  return {frame.x + c * local.x() - s * local.y(), frame.y + s * local.x() + c * local.y()};
}

/// Where the map point `p` lies as seen from `frame` (x forward, y left). Inverse of `to_map`.
[[nodiscard]] inline Point to_local(Pose const& frame, Point const& p) {
  double const c = std::cos(frame.heading), s = std::sin(frame.heading);
  double const dx = p.x() - frame.x, dy = p.y() - frame.y;
  return {c * dx + s * dy, -s * dx + c * dy};
}

}  // namespace cambium::geometry
