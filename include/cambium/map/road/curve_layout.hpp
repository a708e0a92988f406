#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/map/road/reference_line.hpp"

/// Lays out the plan view of roads: pieces in sequence, curves between two poses, curves through points. All
/// of it meets to 1e-9 m and 1e-9 rad. Poses are rounded to 1e-10 m and 1e-13 rad before the next piece is laid out
/// from them: so errors do not add up along a road, and every compiler's sine gives the same numbers. All functions
/// throw `MapError` for numbers that are not finite, poses beyond 1e8 m or 1e4 rad, and pieces that are not longer
/// than 0, longer than 1000 km, or turn by more than 100 rad.
namespace cambium::inline v0_1::map {

/// A piece of a plan view: a line, an arc where the curvatures are equal, else a spiral.
struct CurvePiece {
  double length{};           ///< [m], positive
  double curvature_start{};  ///< left positive [1/m]
  double curvature_end{};
};

/// Where the last of the geometries ends. Precondition: there is one.
[[nodiscard]] geometry::Pose end_of(std::span<Geometry const> geometries);

/// The pieces in sequence, the first one beginning at `start`.
[[nodiscard]] std::vector<Geometry> lay_from(geometry::Pose start, std::vector<CurvePiece> const& pieces);

/// The pieces in sequence, the last one ending at `end`.
[[nodiscard]] std::vector<Geometry> lay_to(geometry::Pose end, std::vector<CurvePiece> const& pieces);

/// A smooth curve from one pose to another: straight on where `to` lies ahead; a corner (spiral, arc, spiral and at
/// most one line, so that the curvature has no jumps) where the way ahead from `from` crosses the way back from `to`
/// not three times as far from the one as from the other; else one cubic without a kink (but whose curvature may jump
/// at its ends). Throws `MapError` where there is none: the poses are less than a millimetre apart, or it would have
/// a kink; `where` names the curve there.
[[nodiscard]] std::vector<Geometry> connecting_curve(geometry::Pose const& from, geometry::Pose const& to,
                                                     std::string const& where = "curve");

/// A curve through `points` without kinks: a cubic from each to the next. Its direction at a point is `headings` [rad],
/// one a point, or without these that of the circle through the point and its neighbours. On a circle of 20 m with a
/// point every metre it stays within 0.1 mm; a corner in the points comes out rounded, and swings a little to the
/// outside of the corner before and behind it: give points close together where the way turns. Throws `MapError` with
/// fewer than two points, ones that are not finite, consecutive ones less than a millimetre or more than 1000 km apart,
/// or headings that are not one a point; `where` names the line there, and points are counted from 0.
[[nodiscard]] std::vector<Geometry> curve_through(std::span<geometry::Point const> points,
                                                  std::span<double const> headings = {},
                                                  std::string const& where = "polyline");

/// A curve from `points` to `points`, each left towards the corner behind it and reached from there: parabolas, which
/// turn no more than the polyline through points and corners; without a kink where each point lies between its corners.
/// `begin` and `end`: other directions at the curve's ends [rad]. Throws `MapError` as `curve_through`, and where there
/// is not one corner less than points, or one lies within a micrometre of its points; `where` names the line there.
[[nodiscard]] std::vector<Geometry> curve_around(std::span<geometry::Point const> points,
                                                 std::span<geometry::Point const> corners, std::optional<double> begin,
                                                 std::optional<double> end, std::string const& where = "polyline");

}  // namespace cambium::inline v0_1::map

#ifndef CAMBIUM_COMPILED
#include "cambium/map/road/curve_layout_impl.hpp"
#endif
