#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>

#include "cambium/core/macros.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/map/road/curve_layout.hpp"
#include "cambium/map/road/parametric_cubic.hpp"

namespace cambium::inline v0_1::map {

namespace detail {

[[nodiscard]] inline double round_length(double value) { return std::round(value * 1e10) / 1e10; }
[[nodiscard]] inline double round_angle(double value) { return std::round(value * 1e13) / 1e13; }
/// Each stays exact to 1e-10 m over 100 m.
[[nodiscard]] inline double round_curvature(double value) { return std::round(value * 1e14) / 1e14; }

inline void check_pose(geometry::Pose const& pose) {
  if (!(std::abs(pose.x) <= 1e8 && std::abs(pose.y) <= 1e8 && std::abs(pose.heading) <= 1e4))
    throw MapError("curve", "a pose is not finite, or beyond 100 000 km or 10 000 rad", "give a pose on Earth");
}

inline void check_piece(CurvePiece const& piece) {
  double const steepest = std::max(std::abs(piece.curvature_start), std::abs(piece.curvature_end));
  if (!(piece.length > 0.0 && piece.length <= 1e6) || std::isnan(piece.curvature_start + piece.curvature_end))
    throw MapError("curve", "a piece is " + cambium::detail::rounded_text(piece.length) + " m long",
                   "give a length above 0 and up to 1000 km, and finite curvatures");
  if (!(steepest * piece.length <= 100.0))
    throw MapError("curve", "a piece turns by more than 100 rad", "give a shorter one, or less curvature");
}

[[nodiscard]] inline Geometry make_geometry(CurvePiece const& piece, geometry::Pose const& start) {
  Geometry g;
  g.x = round_length(start.x);
  g.y = round_length(start.y);
  g.heading = round_angle(start.heading);
  g.length = piece.length;
  g.curvature_start = piece.curvature_start;
  g.curvature_end = piece.curvature_end;
  g.kind = piece.curvature_start != piece.curvature_end ? GeometryKind::spiral
           : piece.curvature_start != 0.0               ? GeometryKind::arc
                                                        : GeometryKind::line;
  return g;
}

/// Whether the way from one pose to the other turns by less than a millionth at either end.
[[nodiscard]] inline bool is_straight(geometry::Pose const& from, geometry::Pose const& to) {
  double const direction = portable::atan2(to.y - from.y, to.x - from.x);
  auto const turns = [&](double heading) { return std::abs(geometry::angle_difference(heading, direction)) > 1e-6; };
  return !turns(from.heading) && !turns(to.heading);
}

/// Straight from one place to the other.
[[nodiscard]] inline Geometry make_line(geometry::Pose const& from, geometry::Pose const& to) {
  double const dx = to.x - from.x, dy = to.y - from.y;
  return {.x = round_length(from.x),
          .y = round_length(from.y),
          .heading = round_angle(portable::atan2(dy, dx)),
          .length = round_length(portable::hypot(dx, dy))};
}

/// The cubic from one pose to another that leaves and arrives along tangents of these lengths (a Bezier curve's).
[[nodiscard]] inline Geometry make_cubic(geometry::Pose const& from, geometry::Pose const& to, double leaving,
                                         double arriving, std::string const& where) {
  Geometry g;
  g.x = round_length(from.x);
  g.y = round_length(from.y);
  g.heading = round_angle(from.heading);
  g.kind = GeometryKind::cubic;
  auto const end = geometry::to_local({g.x, g.y, g.heading}, to.position());
  double const turn = to.heading - g.heading;
  auto const coefficients = [](double b, double end_value, double end_slope) {
    return ParametricCubic::Coefficients{0.0, round_length(b), round_length(3 * end_value - 2 * b - end_slope),
                                         round_length(b + end_slope - 2 * end_value)};
  };
  auto const u = coefficients(3 * leaving, end.x(), 3 * arriving * portable::cos(turn));
  auto const v = coefficients(0.0, end.y(), 3 * arriving * portable::sin(turn));
  g.cubic = std::make_shared<ParametricCubic const>(u, v, 1.0);
  if (!g.cubic->is_regular())
    throw MapError(where, "there is no smooth curve from one pose to the next", "move them apart, or turn them");
  g.length = round_length(g.cubic->length());
  return g;
}

/// As `make_cubic`, with tangents that come near a circle's and keep the curvature low (Hobby 1986, velocity function).
[[nodiscard]] inline Geometry make_cubic(geometry::Pose const& from, geometry::Pose const& to,
                                         std::string const& where) {
  double const dx = to.x - from.x, dy = to.y - from.y, chord = portable::hypot(dx, dy),
               direction = portable::atan2(dy, dx);
  if (!(chord > 1e-3))
    throw MapError(where, "its ends are less than a millimetre apart", "move them apart, or join them without it");
  double const a = geometry::angle_difference(direction, from.heading);
  double const b = geometry::angle_difference(to.heading, direction);
  auto const tangent = [chord](double here, double there) {
    double const bend = std::sqrt(2.0) * (portable::sin(here) - portable::sin(there) / 16) *
                        (portable::sin(there) - portable::sin(here) / 16) *
                        (portable::cos(here) - portable::cos(there));
    double const flat =
        1.0 + 0.5 * (std::sqrt(5.0) - 1.0) * portable::cos(here) + 0.5 * (3.0 - std::sqrt(5.0)) * portable::cos(there);
    return chord * std::clamp((2.0 + bend) / (3.0 * std::max(flat, 0.1)), 0.1, 4.0 / 3.0);
  };
  return make_cubic(from, to, tangent(a, b), tangent(b, a), where);
}

inline void number_stations(std::vector<Geometry>& geometries) {
  for (std::size_t i = 1; i < geometries.size(); ++i) geometries[i].s = geometries[i - 1].s + geometries[i - 1].length;
}

}  // namespace detail

CAMBIUM_COLD geometry::Pose end_of(std::span<Geometry const> geometries) {
  auto const p = evaluate(geometries.back(), geometries.back().length);
  return {p.x, p.y, p.heading};
}

CAMBIUM_COLD std::vector<Geometry> lay_from(geometry::Pose start, std::vector<CurvePiece> const& pieces) {
  detail::check_pose(start);
  std::vector<Geometry> geometries;
  for (auto const& piece : pieces) {
    detail::check_piece(piece);
    geometries.push_back(detail::make_geometry(piece, start));
    start = end_of(geometries);
  }
  detail::number_stations(geometries);
  return geometries;
}

CAMBIUM_COLD std::vector<Geometry> lay_to(geometry::Pose end, std::vector<CurvePiece> const& pieces) {
  detail::check_pose(end);
  std::vector<Geometry> geometries(pieces.size());
  for (std::size_t i = pieces.size(); i-- > 0;) {
    detail::check_piece(pieces[i]);
    auto const local = evaluate(detail::make_geometry(pieces[i], {}), pieces[i].length);
    double const heading = end.heading - local.heading, c = portable::cos(heading), s = portable::sin(heading);
    auto& g = geometries[i];
    g = detail::make_geometry(pieces[i],
                              {end.x - c * local.x + s * local.y, end.y - s * local.x - c * local.y, heading});
    end = {g.x, g.y, g.heading};
  }
  detail::number_stations(geometries);
  return geometries;
}

CAMBIUM_COLD std::vector<Geometry> connecting_curve(geometry::Pose const& from, geometry::Pose const& to,
                                                    std::string const& where) {
  detail::check_pose(from);
  detail::check_pose(to);
  constexpr double spiral_share = 0.3;  // of the corner's length, for each of the two
  double const turn = geometry::angle_difference(to.heading, from.heading);
  auto const way = geometry::to_local(from, to.position());
  if (std::abs(turn) < 1e-12 && std::abs(way.y()) < 1e-9 && way.x() > 1e-3)
    return lay_from(from, {{detail::round_length(way.x())}});
  // way = before (1, 0) + after (cos, sin)(turn)
  double const after = way.y() / portable::sin(turn), before = way.x() - after * portable::cos(turn);
  double const nearer = std::min(before, after), farther = std::max(before, after);
  if (!(std::abs(turn) > 0.01 && std::abs(turn) < 2.8 && nearer > 1e-3 && farther < 3.0 * nearer))
    return {detail::make_cubic(from, to, where)};
  auto const corner = [turn](double length) {
    double const curvature = detail::round_curvature(turn / ((1.0 - spiral_share) * length));
    double const spiral = detail::round_length(spiral_share * length);
    double const arc = detail::round_length((1.0 - 2.0 * spiral_share) * length);
    return std::vector<CurvePiece>{{spiral, 0.0, curvature}, {arc, curvature, curvature}, {spiral, curvature, 0.0}};
  };
  constexpr double unit = 100.0;  // [m] long, the corner takes this much of the two straight ways:
  auto const end = end_of(lay_from({}, corner(unit)));
  double const taken = portable::hypot(end.x, end.y) / (2.0 * portable::cos(0.5 * turn));
  auto pieces = corner(unit * nearer / taken);
  double const straight = detail::round_length(farther - nearer);
  if (straight > 1e-9) pieces.insert(before > after ? pieces.begin() : pieces.end(), {straight});
  return lay_from(from, pieces);
}

namespace detail {
/// Throws `MapError` where no curve goes through the points.
inline void check_points(std::span<geometry::Point const> points, std::span<double const> headings,
                         std::string const& where) {
  auto const text = [](double value) { return cambium::detail::rounded_text(value); };
  auto const fail = [&](std::string const& what, char const* remedy) { throw MapError(where, what, remedy); };
  auto const n = points.size();
  if (n < 2) fail(n == 0 ? "it has no points" : "it has one point", "give at least two");
  if (!headings.empty() && headings.size() != n)
    fail("it has " + std::to_string(n) + " points, but " + std::to_string(headings.size()) + " headings",
         "give one heading per point, or none");
  for (std::size_t i = 0; i < n; ++i) {
    auto const point = [i, n] { return "point " + std::to_string(i) + " (of 0 to " + std::to_string(n - 1) + ") "; };
    double const x = points[i].x(), y = points[i].y();
    if (!std::isfinite(x) || !std::isfinite(y))
      fail(point() + "is not a finite number: " + text(x) + ", " + text(y), "give finite coordinates [m]");
    if (std::max(std::abs(x), std::abs(y)) > 1e8)
      fail(point() + "is beyond 100 000 km: " + text(x) + ", " + text(y), "give coordinates in metres");
    if (!headings.empty() && !(std::abs(headings[i]) <= 1e4))
      fail(point() + "has a heading of " + text(headings[i]), "give radians, up to 10 000");
    if (i == 0) continue;
    double const apart = (points[i] - points[i - 1]).norm();
    if (!(apart > 1e-3))
      fail(point() + "is less than a millimetre from the previous one: " + text(apart) + " m",
           "leave one of the two out");
    if (!(apart < 1e6)) fail(point() + "is " + text(apart) + " m from the previous one", "give points within 1000 km");
  }
}
}  // namespace detail

CAMBIUM_COLD std::vector<Geometry> curve_through(std::span<geometry::Point const> points,
                                                 std::span<double const> headings, std::string const& where) {
  detail::check_points(points, headings, where);
  auto const n = points.size();
  std::vector<double> lengths, directions;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    auto const chord = (points[i + 1] - points[i]);
    lengths.push_back(chord.norm());
    directions.push_back(portable::atan2(chord.y(), chord.x()));
  }
  auto const turn = [&](std::size_t i) { return geometry::angle_difference(directions[i + 1], directions[i]); };
  auto const share = [&](std::size_t i, std::size_t of) { return lengths[of] / (lengths[i] + lengths[i + 1]); };
  std::vector<geometry::Pose> poses;
  for (std::size_t i = 0; i < n; ++i) {
    double heading = directions[std::min(i, n - 2)];
    if (!headings.empty())
      heading = headings[i];
    else if (n > 2 && i == 0)
      heading -= turn(0) * share(0, 0);
    else if (n > 2 && i + 1 == n)
      heading += turn(n - 3) * share(n - 3, n - 2);
    else if (n > 2)
      heading = directions[i - 1] + turn(i - 1) * share(i - 1, i - 1);
    poses.push_back({points[i].x(), points[i].y(), detail::round_angle(heading)});
  }
  std::vector<Geometry> geometries;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    try {
      geometries.push_back(detail::make_cubic(poses[i], poses[i + 1], where));
    } catch (MapError const&) {
      throw MapError(where,
                     "there is no smooth curve from point " + std::to_string(i) + " (of 0 to " + std::to_string(n - 1) +
                         ") to the next one",
                     "move them apart, or turn their headings");
    }
  }
  detail::number_stations(geometries);
  return geometries;
}

CAMBIUM_COLD std::vector<Geometry> curve_around(std::span<geometry::Point const> points,
                                                std::span<geometry::Point const> corners, std::optional<double> begin,
                                                std::optional<double> end, std::string const& where) {
  detail::check_points(points, {}, where);
  if (corners.size() + 1 != points.size())
    throw MapError(
        where,
        "it has " + std::to_string(points.size()) + " points, but " + std::to_string(corners.size()) + " corners",
        "give a corner between each two points");
  auto const pose = [](geometry::Point const& at, geometry::Point const& way, std::optional<double> heading) {
    return geometry::Pose{at.x(), at.y(), detail::round_angle(heading.value_or(portable::atan2(way.y(), way.x())))};
  };
  std::vector<Geometry> geometries;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    auto const leaving = corners[i] - points[i], arriving = points[i + 1] - corners[i];
    if (!(leaving.norm() > 1e-6 && arriving.norm() > 1e-6))
      throw MapError(where, "corner " + std::to_string(i) + " is no corner between its points",
                     "move it away from them");
    auto const from = pose(points[i], leaving, i == 0 ? begin : std::nullopt),
               to = pose(points[i + 1], arriving, i + 1 == corners.size() ? end : std::nullopt);
    geometries.push_back(detail::is_straight(from, to) ? detail::make_line(from, to)
                                                       : detail::make_cubic(from, to, 2.0 / 3.0 * leaving.norm(),
                                                                            2.0 / 3.0 * arriving.norm(), where));
  }
  detail::number_stations(geometries);
  return geometries;
}

}  // namespace cambium::inline v0_1::map
