#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "cambium/core/portable_math.hpp"
#include "cambium/map/road/detail/quadrature.hpp"

namespace cambium::inline v0_1::map {

/// A point of a curve with its tangent, and derivatives by arc length.
struct CurvePoint {
  double x{};                     ///< [m]
  double y{};                     ///< [m]
  double heading{};               ///< not wrapped: start heading plus the curvature's integral [rad]
  double curvature{};             ///< left positive [1/m]
  double curvature_derivative{};  ///< [1/m^2]
};

/// A planar curve u(p) = a + b p + c p^2 + d p^3, v(p) likewise, p from 0 to `end()`, in a frame of its own (u forward,
/// v to the left), that can be asked by arc length: OpenDRIVE's paramPoly3, and poly3 with u = p. The parameter of an
/// arc length is found by Newton's method on a quadrature, to 1e-12 of the curve's length.
class ParametricCubic {
 public:
  using Coefficients = std::array<double, 4>;  ///< a, b, c, d

  /// O(1), some microseconds.
  ParametricCubic(Coefficients const& u, Coefficients const& v, double end) : u_(u), v_(v), end_(end) {
    for (std::size_t i = 0; i < panels; ++i) arc_[i + 1] = arc_[i] + arc_between(parameter(i), parameter(i + 1));
  }

  /// The poly3 v(u) with `v` as its coefficients, from u = 0 on, that is `length` [m] long.
  [[nodiscard]] static ParametricCubic along_u(Coefficients const& v, double length) {
    double low = 0.0, high = length;  // it is at least as long as u is
    for (int i = 0; i < 100 && high - low > 1e-15 * high; ++i) {
      double const middle = 0.5 * (low + high);
      (ParametricCubic({0, 1, 0, 0}, v, middle).length() < length ? low : high) = middle;
    }
    return ParametricCubic({0, 1, 0, 0}, v, high);
  }

  [[nodiscard]] double end() const { return end_; }
  [[nodiscard]] double length() const { return arc_.back(); }  ///< [m]
  [[nodiscard]] Coefficients const& u() const { return u_; }
  [[nodiscard]] Coefficients const& v() const { return v_; }

  /// True when the curve has a length, is finite, and nowhere stops or turns back (where its direction would jump).
  [[nodiscard]] bool is_regular() const {
    if (!(length() > 0.0) || !std::isfinite(length())) return false;
    double const mean = length() / end_;
    for (std::size_t i = 0; i <= 16 * panels; ++i)
      if (!(speed(end_ * static_cast<double>(i) / (16 * panels)) > 1e-3 * mean)) return false;
    return true;
  }

  /// The point at arc length `arc` [m], in the frame of u and v, but with the heading counted from the direction at the
  /// start; outside [0, length] straight on along the tangent of that end.
  [[nodiscard]] CurvePoint at(double arc) const {
    double const inside = std::fmin(std::fmax(arc, 0.0), length());
    double const p = parameter_at(inside), beyond = arc - inside;
    double const du = slope(u_, p), dv = slope(v_, p), w = std::sqrt(du * du + dv * dv);
    double const start_u = u_[1], start_v = v_[1];
    CurvePoint point{value(u_, p) + beyond * du / w, value(v_, p) + beyond * dv / w,
                     portable::atan2(start_u * dv - start_v * du, start_u * du + start_v * dv), 0.0, 0.0};
    if (beyond != 0.0) return point;
    double const ddu = 2 * u_[2] + 6 * u_[3] * p, ddv = 2 * v_[2] + 6 * v_[3] * p;
    point.curvature = (du * ddv - dv * ddu) / (w * w * w);
    double const by_p =
        (du * 6 * v_[3] - dv * 6 * u_[3]) / (w * w * w) - 3 * point.curvature * (du * ddu + dv * ddv) / (w * w);
    point.curvature_derivative = by_p / w;
    return point;
  }

  /// The direction at the start, from the u axis [rad].
  [[nodiscard]] double start_direction() const { return portable::atan2(v_[1], u_[1]); }

  friend bool operator==(ParametricCubic const&, ParametricCubic const&) = default;

 private:
  static constexpr std::size_t panels = 8;

  [[nodiscard]] static double value(Coefficients const& k, double p) {
    return k[0] + p * (k[1] + p * (k[2] + p * k[3]));
  }
  [[nodiscard]] static double slope(Coefficients const& k, double p) { return k[1] + p * (2 * k[2] + p * 3 * k[3]); }
  [[nodiscard]] double speed(double p) const {
    double const du = slope(u_, p), dv = slope(v_, p);
    return std::sqrt(du * du + dv * dv);
  }
  [[nodiscard]] double parameter(std::size_t panel) const { return end_ * static_cast<double>(panel) / panels; }
  [[nodiscard]] double arc_between(double from, double to) const {
    return detail::integrate(detail::gauss_20, from, to, [this](double p) { return speed(p); });
  }

  [[nodiscard]] double parameter_at(double arc) const {
    std::size_t panel = 0;
    while (panel + 1 < panels && arc > arc_[panel + 1]) ++panel;
    double const begin = parameter(panel), whole = arc_[panel + 1] - arc_[panel];
    double low = begin, high = parameter(panel + 1);
    double p = whole > 0.0 ? low + (high - low) * (arc - arc_[panel]) / whole : low;
    for (int i = 0; i < 50; ++i) {
      double const error = arc_[panel] + arc_between(begin, p) - arc;
      (error > 0.0 ? high : low) = p;
      double const newton = p - error / speed(p);
      double const next = newton >= low && newton <= high ? newton : 0.5 * (low + high);
      if (std::abs(next - p) <= 4 * std::numeric_limits<double>::epsilon() * end_) return next;
      p = next;
    }
    return p;
  }

  Coefficients u_, v_;
  double end_;
  std::array<double, panels + 1> arc_{};
};

}  // namespace cambium::inline v0_1::map
