#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/map/road/cubic.hpp"
#include "cambium/map/road/reference_line.hpp"

namespace cambium::inline v0_1::map {

/// Height of a lane's borders above the road's surface [m], as at a kerb, from `s` after the section's start on.
struct LaneHeight {
  double s{}, inner{}, outer{};
};

/// Height of the surface across the road at station `s` [m], as a profile over t.
struct ShapeProfile {
  double s{};
  CubicProfile height;
};

/// A lane of the road cross-section: exact width as a function of the distance from the section's start, or where the
/// file gives borders instead, the t of its outer border.
struct RoadLane {
  int number{};
  LaneId id = none<LaneId>;  ///< as driven in the direction that traffic rule, side and the file's `direction` say
  LaneId opposite = none<LaneId>;  ///< the same strip driven the other way; only where traffic runs in both directions
  CubicProfile width;
  CubicProfile border;              ///< in force where it has records
  std::vector<LaneHeight> heights;  ///< above the road's surface, sorted
};

/// A stretch of a road along which its lanes stay the same.
struct RoadSection {
  double begin{}, end{};        ///< road s [m]
  std::vector<RoadLane> lanes;  ///< from left (largest number) to right; without lane 0
};

/// A road as in the file: exact geometry. Sampled lanes are in `Map::lanes`.
struct Road {
  RoadId id = none<RoadId>;
  std::string name;  ///< the file's id
  JunctionId junction = none<JunctionId>;
  bool left_hand_traffic = false;
  ReferenceLine reference_line;
  CubicProfile lane_offset;
  CubicProfile elevation;                        ///< of the reference line, without `elevation_offset` [m]
  double elevation_offset{};                     ///< of the whole map [m]
  CubicProfile superelevation;                   ///< [rad], positive where the left side is the higher one
  CubicProfile crossfall_left, crossfall_right;  ///< [rad], positive where the side falls outwards
  std::vector<ShapeProfile> shape;               ///< sorted
  std::vector<RoadSection> sections;
  double length{};

  /// The section that holds the station `s` [m], the later one where two meet; the road's end (to a millimetre, for
  /// lengths are often written rounded) belongs to the last one. Null outside of the road or before its first section.
  /// O(log sections).
  [[nodiscard]] RoadSection const* section_at(double s) const {
    if (!(s <= length + 1e-3)) return nullptr;
    auto const next = std::upper_bound(sections.begin(), sections.end(), s,
                                       [](double v, RoadSection const& section) { return v < section.begin; });
    return next == sections.begin() ? nullptr : &*(next - 1);
  }
};

/// A lateral coordinate of a road and its derivatives by the station.
struct Lateral {
  double t{};          ///< [m], left positive
  double slope{};      ///< dt/ds
  double curvature{};  ///< d^2t/ds^2 [1/m]

  friend Lateral operator+(Lateral const& a, Lateral const& b) {
    return {a.t + b.t, a.slope + b.slope, a.curvature + b.curvature};
  }
  friend Lateral operator*(double k, Lateral const& a) { return {k * a.t, k * a.slope, k * a.curvature}; }
};

/// A point of a curve along a road, with its direction for increasing s (whatever way the lane is driven).
struct RoadPoint {
  double x{}, y{};     ///< [m]
  double heading{};    ///< of the curve, not wrapped [rad]
  double curvature{};  ///< of the curve, left positive [1/m]
};

/// The curve at lateral coordinate `lateral` of a reference line, where that passes `reference`: with the curve's slope
/// and the factor 1 - curvature t. Planar: superelevation is left out. On the inner side of a bend, beyond its centre,
/// the curve runs backwards, and so does its heading.
[[nodiscard]] inline RoadPoint offset_point(CurvePoint const& reference, Lateral const& lateral) {
  auto const [sin, cos] = portable::sin_cos(reference.heading);
  // With the Frenet frame T, N of the reference line: P = r + t N, P' = along T + slope N, P'' = ddt T + ddn N.
  double const along = 1.0 - reference.curvature * lateral.t;
  double const ddt = -reference.curvature_derivative * lateral.t - 2.0 * reference.curvature * lateral.slope;
  double const ddn = reference.curvature * along + lateral.curvature;
  double const squared = along * along + lateral.slope * lateral.slope;
  double const curvature = squared > 0.0 ? (along * ddn - lateral.slope * ddt) / (squared * std::sqrt(squared)) : 0.0;
  double const turn = lateral.slope == 0.0 && along > 0.0 ? 0.0 : portable::atan2(lateral.slope, along);  // mostly 0
  return {reference.x - sin * lateral.t, reference.y + cos * lateral.t, reference.heading + turn, curvature};
}

/// A lane at a station of its road, exactly as the records say.
struct LanePoint {
  RoadPoint center;      ///< the middle between the borders
  CurvePoint reference;  ///< the road's reference line (t = 0, without lane offset)
  double t{};            ///< of the centre [m]
  double inner_t{};      ///< of the border towards lane 0 [m]
  double outer_t{};      ///< of the other border [m]
  double width{};        ///< as written: below 0 where the records fall below 0 (sampled lanes take 0 there) [m]
};

/// Point and direction at station `s` and lateral offset `t` [m] of `road`, along the line that keeps this offset.
/// Stations outside of the road are extrapolated. O(log geometries); a spiral costs up to 20 sine-cosine pairs for each
/// 0.7 rad from its start.
[[nodiscard]] inline RoadPoint point_at(Road const& road, double s, double t) {
  return offset_point(road.reference_line.at(s), {t, 0.0, 0.0});
}

namespace detail {

/// Value and derivatives at `s` by the record in force at `inside`.
[[nodiscard]] inline Lateral lateral_at(CubicProfile const& profile, double s, double inside) {
  if (auto const* record = profile.find(inside))
    return {record->value(s), record->derivative(s), record->second_derivative(s)};
  return {profile.value(s), 0.0, 0.0};
}

/// The outer border of `lane` as written, `ds` behind its section's start, by the records in force at `inside` (from
/// there too): some files write the magnitude of a right border.
[[nodiscard]] inline Lateral outer_border(RoadLane const& lane, Lateral const& inner, double ds, double inside) {
  double const sign = lane.number > 0 ? 1.0 : -1.0;
  if (lane.border.empty()) return inner + sign * lateral_at(lane.width, ds, inside);
  Lateral const border = lateral_at(lane.border, ds, inside);
  return border.t * sign < 0.0 ? -1.0 * border : border;
}

/// As above, but not on the inner side of `inner`: a width below 0 counts as 0.
[[nodiscard]] inline Lateral clamped_outer_border(RoadLane const& lane, Lateral const& inner, double ds,
                                                  double inside) {
  constexpr double rounding = 1e-9;  // [m]
  Lateral const outer = outer_border(lane, inner, ds, inside);
  double const width = lane.number > 0 ? outer.t - inner.t : inner.t - outer.t;
  if (width > rounding) return outer;
  // At the place where the lane comes up from nothing, its slope counts.
  bool const rises = width > -rounding && lane.border.empty() && lateral_at(lane.width, inside, inside).t > 0.0;
  return rises ? outer : inner;
}

}  // namespace detail

/// Lane `number` (not 0) at station `s` [m] of `road`. Where two sections, records or geometries meet, the later one
/// counts. Nothing where the road has no such lane there. O(lanes between it and lane 0), each a binary search, and the
/// cost of `point_at`.
[[nodiscard]] inline std::optional<LanePoint> lane_point(Road const& road, double s, int number) {
  auto const* section = road.section_at(s);
  if (section == nullptr || number == 0) return std::nullopt;
  s = std::min(s, road.length);
  auto const& lanes = section->lanes;
  bool const is_left = number > 0;
  auto const middle = std::partition_point(lanes.begin(), lanes.end(), [](RoadLane const& l) { return l.number > 0; });
  Lateral inner = detail::lateral_at(road.lane_offset, s, s);
  double const ds = s - section->begin;
  auto const place = [&](RoadLane const& lane) -> std::optional<LanePoint> {
    Lateral const outer = detail::outer_border(lane, inner, ds, ds);
    if (lane.number == number) {
      Lateral const center = 0.5 * (inner + outer);
      auto const reference = road.reference_line.at(s);
      return LanePoint{offset_point(reference, center),
                       reference,
                       center.t,
                       inner.t,
                       outer.t,
                       is_left ? outer.t - inner.t : inner.t - outer.t};
    }
    inner = outer;
    return std::nullopt;
  };
  if (is_left) {
    for (auto lane = middle; lane != lanes.begin();)
      if (auto const found = place(*--lane)) return found;
  } else {
    for (auto lane = middle; lane != lanes.end(); ++lane)
      if (auto const found = place(*lane)) return found;
  }
  return std::nullopt;
}

}  // namespace cambium::inline v0_1::map
