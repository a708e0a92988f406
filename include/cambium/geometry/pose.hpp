#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>

#include "cambium/core/described.hpp"
#include "cambium/core/portable_math.hpp"

namespace cambium::inline v0_1::geometry {

/// A vector of two doubles from another library, such as Eigen: it has `x()`, `y()` and a constant size.
template <class V>
concept ForeignVector = requires(V const& v) {
  requires static_cast<int>(V::SizeAtCompileTime) == 2;
  { v.x() + v.y() } -> std::same_as<double>;
};

struct Pose;

/// A point, or the vector between two points, in the map frame [m]. Converts from and to `Eigen::Vector2d` (and similar
/// types) and uses the same member names, so that most headers need not include Eigen.
class Point {
 public:
  constexpr Point() = default;
  /// Of its coordinates, or of what converts to it.
  constexpr Point(double x, double y) : x_(x), y_(y) {}
  template <ForeignVector V>
  constexpr Point(V const& v) : x_(v.x()), y_(v.y()) {}
  /// Catches a pose, whose heading would be lost.
  template <std::same_as<Pose> P>
  constexpr Point(P const&) {
    static_assert(!std::same_as<P, Pose>,
                  "cambium::geometry::Point: a pose is no point; write pose.position(), and give its heading where one "
                  "is asked for");
  }
  template <ForeignVector V>
  constexpr operator V() const {
    return V(x_, y_);
  }

  static constexpr char const* name = "point";
  static constexpr auto parameters() {
    return parameter_list(parameter("x", &Point::x_, "m", any_finite, "map frame"),
                          parameter("y", &Point::y_, "m", any_finite, "map frame"));
  }

  [[nodiscard]] constexpr double x() const { return x_; }
  [[nodiscard]] constexpr double y() const { return y_; }
  [[nodiscard]] constexpr double& x() { return x_; }
  [[nodiscard]] constexpr double& y() { return y_; }

  /// As `Eigen::Vector2d` has them; a vector of length 0 stays so when normalised.
  [[nodiscard]] constexpr double dot(Point const& b) const { return x_ * b.x_ + y_ * b.y_; }
  [[nodiscard]] constexpr double squaredNorm() const { return dot(*this); }
  [[nodiscard]] double norm() const { return std::sqrt(squaredNorm()); }
  [[nodiscard]] Point normalized() const {
    double const length = norm();
    return length > 0.0 ? *this / length : *this;
  }
  [[nodiscard]] constexpr Point cwiseMin(Point const& b) const { return {std::min(x_, b.x_), std::min(y_, b.y_)}; }
  [[nodiscard]] constexpr Point cwiseMax(Point const& b) const { return {std::max(x_, b.x_), std::max(y_, b.y_)}; }
  [[nodiscard]] bool allFinite() const { return std::isfinite(x_) && std::isfinite(y_); }

  constexpr Point& operator+=(Point const& b) { return *this = *this + b; }
  constexpr Point& operator-=(Point const& b) { return *this = *this - b; }

  friend constexpr Point operator+(Point const& a, Point const& b) { return {a.x_ + b.x_, a.y_ + b.y_}; }
  friend constexpr Point operator-(Point const& a, Point const& b) { return {a.x_ - b.x_, a.y_ - b.y_}; }
  friend constexpr Point operator-(Point const& a) { return {-a.x_, -a.y_}; }
  friend constexpr Point operator*(double k, Point const& a) { return {k * a.x_, k * a.y_}; }
  friend constexpr Point operator*(Point const& a, double k) { return k * a; }
  friend constexpr Point operator/(Point const& a, double k) { return {a.x_ / k, a.y_ / k}; }
  friend constexpr bool operator==(Point const&, Point const&) = default;

 private:
  double x_{}, y_{};
};

/// Position [m] and heading [rad, counter-clockwise from +x] in the map frame.
struct Pose {
  double x{}, y{}, heading{};

  Pose() = default;
  /// Requires all three: two numbers are a point, not a pose with heading 0.
  constexpr Pose(double x_, double y_, double heading_) : x(x_), y(y_), heading(heading_) {}

  [[nodiscard]] Point position() const { return {x, y}; }

  friend bool operator==(Pose const&, Pose const&) = default;
};

/// Transforms `local` (x forward, y left, relative to `frame`) to the map frame.
[[nodiscard]] inline Point to_map(Pose const& frame, Point const& local) {
  auto const [s, c] = portable::sin_cos(frame.heading);
  return {frame.x + c * local.x() - s * local.y(), frame.y + s * local.x() + c * local.y()};
}

/// Transforms the map point `p` to coordinates relative to `frame` (x forward, y left). Inverse of `to_map`.
[[nodiscard]] inline Point to_local(Pose const& frame, Point const& p) {
  auto const [s, c] = portable::sin_cos(frame.heading);
  double const dx = p.x() - frame.x, dy = p.y() - frame.y;
  return {c * dx + s * dy, -s * dx + c * dy};
}

}  // namespace cambium::inline v0_1::geometry
