#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "cambium/core/macros.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/core/stable_sort.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/map/road/detail/quadrature.hpp"
#include "cambium/map/road/parametric_cubic.hpp"

namespace cambium::inline v0_1::map {

/// What a piece of a plan view is.
enum class GeometryKind { line, arc, spiral, cubic };

/// One piece of a plan view, in the map frame: it starts at (x, y, heading). Its curvature runs linearly with the arc
/// length from `curvature_start` to `curvature_end` (line: both 0; arc: both equal), or it is a parametric cubic in the
/// frame of its start, whose arc length is stretched to `length` where the two differ.
struct Geometry {
  double s{};        ///< station of the start on the reference line [m]
  double x{};        ///< [m]
  double y{};        ///< [m]
  double heading{};  ///< counter-clockwise from +x [rad]
  double length{};   ///< [m]
  GeometryKind kind = GeometryKind::line;
  double curvature_start{};                        ///< left positive [1/m]
  double curvature_end{};                          ///< left positive [1/m]
  std::shared_ptr<ParametricCubic const> cubic{};  ///< of the kind of that name; shared by copies

  friend bool operator==(Geometry const& a, Geometry const& b) {
    bool const same_cubic = a.cubic == b.cubic || (a.cubic && b.cubic && *a.cubic == *b.cubic);
    return same_cubic && a.s == b.s && a.x == b.x && a.y == b.y && a.heading == b.heading && a.length == b.length &&
           a.kind == b.kind && a.curvature_start == b.curvature_start && a.curvature_end == b.curvature_end;
  }
};

namespace detail {

/// sin(u) / u, exact to rounding for every u.
[[nodiscard]] inline double sinc(double u) {
  double const u2 = u * u;
  return u2 < 1e-6 ? 1.0 - u2 / 6.0 * (1.0 - u2 / 20.0) : portable::sin(u) / u;
}

/// Integral of (cos, sin)(heading + curvature u + curvature_rate u^2 / 2) for u over [begin, end], by one panel.
template <std::size_t N>
[[nodiscard]] geometry::Point spiral_panel(HalfRule<N> const& rule, double heading, double curvature,
                                           double curvature_rate, double begin, double end) {
  double const middle = 0.5 * (begin + end);
  double const half = 0.5 * (end - begin);
  geometry::Point sum;
  for (std::size_t i = 0; i < N; ++i) {
    for (double const u : {middle - half * rule.node[i], middle + half * rule.node[i]}) {
      auto const [sin, cos] = portable::sin_cos(heading + u * (curvature + 0.5 * curvature_rate * u));
      sum += rule.weight[i] * geometry::Point(cos, sin);
    }
  }
  return half * sum;
}

/// As `spiral_panel`, on panels over which the heading turns by at most 0.7 rad (20 points) or, where the whole
/// interval turns by at most 0.05 rad, on one (6 points): 1e-12 m, with no special case for small curvatures or rates.
/// Beyond 4096 panels (2800 rad) the result is finite but no longer accurate.
[[nodiscard]] inline geometry::Point spiral_displacement(double heading, double curvature, double curvature_rate,
                                                         double begin, double end) {
  double const steepest =
      std::max(std::abs(curvature + curvature_rate * begin), std::abs(curvature + curvature_rate * end));
  double const turn = steepest * std::abs(end - begin);
  if (turn <= 0.05) return spiral_panel(gauss_6, heading, curvature, curvature_rate, begin, end);
  int const panels = static_cast<int>(std::min(4096.0, std::ceil(turn / 0.7)));
  geometry::Point sum;
  for (int i = 0; i < panels; ++i) {
    double const from = begin + (end - begin) * i / panels;
    double const to = begin + (end - begin) * (i + 1) / panels;
    sum += spiral_panel(gauss_20, heading, curvature, curvature_rate, from, to);
  }
  return sum;
}

}  // namespace detail

/// Change of curvature by arc length [1/m^2]; 0 for a geometry without length.
[[nodiscard]] inline double curvature_rate(Geometry const& g) {
  return g.length > 0.0 ? (g.curvature_end - g.curvature_start) / g.length : 0.0;
}

namespace detail {

[[nodiscard]] inline CurvePoint evaluate_cubic(Geometry const& g, double ds) {
  double const stretch = g.cubic->length() / g.length;
  auto const local = g.cubic->at(ds * stretch);
  auto const [sin, cos] = portable::sin_cos(g.heading);
  return {g.x + cos * local.x - sin * local.y, g.y + sin * local.x + cos * local.y,
          g.heading + g.cubic->start_direction() + local.heading, local.curvature, local.curvature_derivative};
}

}  // namespace detail

/// The point `ds` [m] behind the geometry's start; `ds` may lie outside [0, length]: the curve then simply goes on, a
/// cubic along its tangent. Line and arc are closed forms (the arc for any curvature, 0 included), spiral and cubic
/// quadratures; all to 1e-12 m.
[[nodiscard]] inline CurvePoint evaluate(Geometry const& g, double ds) {
  if (g.kind == GeometryKind::cubic) return detail::evaluate_cubic(g, ds);
  double const rate = g.kind == GeometryKind::spiral ? curvature_rate(g) : 0.0;
  CurvePoint p{g.x, g.y, g.heading, g.curvature_start + rate * ds, rate};
  p.heading += ds * (g.curvature_start + 0.5 * rate * ds);
  if (g.kind == GeometryKind::spiral) {
    auto const d = detail::spiral_displacement(g.heading, g.curvature_start, rate, 0.0, ds);
    p.x += d.x();
    p.y += d.y();
    return p;
  }
  double const half_turn = 0.5 * g.curvature_start * ds;
  double const chord = ds * detail::sinc(half_turn);
  auto const [sin, cos] = portable::sin_cos(g.heading + half_turn);
  p.x += chord * cos;
  p.y += chord * sin;
  return p;
}

/// The point at station `s` of geometry `g`, of which `from` is the point at station `from_s` [m]: as `evaluate`, but a
/// spiral is integrated from there only (agrees to 1e-12 m).
[[nodiscard]] inline CurvePoint advance(Geometry const& g, CurvePoint const& from, double from_s, double s) {
  if (g.kind != GeometryKind::spiral) return evaluate(g, s - g.s);
  double const rate = curvature_rate(g), ds = s - g.s;
  auto const d = detail::spiral_displacement(g.heading, g.curvature_start, rate, from_s - g.s, ds);
  return {from.x + d.x(), from.y + d.y(), g.heading + ds * (g.curvature_start + 0.5 * rate * ds),
          g.curvature_start + rate * ds, rate};
}

/// The plan view of a road: lines, arcs, spirals and cubics, evaluated exactly at every station. A geometry holds on
/// the half-open interval from its start to the next one's (the last of equal starts wins); stations before the first
/// and after the last geometry are extrapolated with those.
class ReferenceLine {
 public:
  ReferenceLine() = default;
  /// Takes the geometries in any order and sorts them by `s`; small gaps between them stay as they are.
  explicit ReferenceLine(std::vector<Geometry> geometries) : geometries_(std::move(geometries)) {
    cambium::detail::stable_sort(geometries_, &Geometry::s);
  }

  /// The point at station `s` [m], at a joint that of the later geometry. O(log geometries); a spiral costs up to 20
  /// sine-cosine pairs for each 0.7 rad from its start (see `advance` for many stations). Precondition: not empty.
  [[nodiscard]] CurvePoint at(double s) const {
    Geometry const& g = geometries_[locate(s)];
    return evaluate(g, s - g.s);
  }

  /// Index of the geometry in force at `s`. O(log geometries). Precondition: not empty.
  [[nodiscard]] std::size_t locate(double s) const {
    CAMBIUM_ASSERT(!geometries_.empty(), "a reference line needs a geometry before it can be asked for a point");
    auto const next = std::upper_bound(geometries_.begin(), geometries_.end(), s,
                                       [](double v, Geometry const& g) { return v < g.s; });
    return next == geometries_.begin() ? 0 : static_cast<std::size_t>(next - geometries_.begin()) - 1;
  }

  /// Station of the end: the last geometry's start plus its length [m]; 0 when empty.
  [[nodiscard]] double length() const {
    return geometries_.empty() ? 0.0 : geometries_.back().s + geometries_.back().length;
  }

  /// Sorted by `s`; the starts are the places where the curvature may jump.
  [[nodiscard]] std::span<Geometry const> geometries() const { return geometries_; }
  [[nodiscard]] bool empty() const { return geometries_.empty(); }

 private:
  std::vector<Geometry> geometries_;
};

}  // namespace cambium::inline v0_1::map
