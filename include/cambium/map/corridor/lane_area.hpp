#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/line.hpp"
#include "cambium/geometry/polygon.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/lanes/lane.hpp"

namespace cambium::inline v0_1::map {

namespace detail {

/// The two border points of a cross-section of a strip, and the direction there.
struct StripSection {
  geometry::Point left, right;
  double heading{};
};

/// Builds simple polygons from the cross-sections of a strip, in order: a new one begins where the strip would run over
/// what the last one holds. Where a side does not advance (the inner side of a curve tighter than the strip is wide) it
/// stands still until it does.
class StripPolygons {
 public:
  void add(StripSection const& section) {
    if (left_.empty()) return begin(section);
    if (append(section)) return;
    StripSection const last{left_.back(), right_.back(), section.heading};
    close();
    begin(last);
    append(section);
  }

  [[nodiscard]] std::vector<geometry::Polygon> finish() {
    close();
    return std::move(polygons_);
  }

 private:
  using Point = geometry::Point;

  void begin(StripSection const& section) {
    left_ = {section.left};
    right_ = {section.right};
  }

  /// Grows the ring by a cross-section where it stays simple; true also where there is nothing to add.
  bool append(StripSection const& section) {
    constexpr double shortest = 1e-4;  // [m] between a side's vertices
    auto const direction = portable::sin_cos(section.heading);
    double const sin = direction.sin, cos = direction.cos;
    auto const advances = [&](Point const& from, Point const& to) {
      return (to.x() - from.x()) * cos + (to.y() - from.y()) * sin > shortest;
    };
    auto const &l = left_.back(), &r = right_.back();
    bool const left_moves = advances(l, section.left), right_moves = advances(r, section.right);
    if (!left_moves && !right_moves) return true;
    Point const left = left_moves ? section.left : l, right = right_moves ? section.right : r;
    if (!is_apart(l, left, r, right)) return false;
    if (left_moves) left_.push_back(left);
    if (right_moves) right_.push_back(right);
    return true;
  }

  /// Whether the ring stays simple with the sides going on from l to `left` and r to `right`.
  [[nodiscard]] bool is_apart(Point const& l, Point const& left, Point const& r, Point const& right) const {
    bool const left_moves = left != l, right_moves = right != r;
    if (left_moves && right_moves && geometry::segments_intersect(l, left, r, right)) return false;
    // The corners of the new part run counter-clockwise.
    if (left_moves && !(geometry::turn(r, left, l) > 0.0)) return false;
    if (right_moves && !(geometry::turn(r, right, left_moves ? left : l) > 0.0)) return false;
    auto const hits = [&](Point const& a, Point const& b, bool ends_left, bool ends_right) {
      if (left_moves && !ends_left && meet(l, left, a, b)) return true;
      if (right_moves && !ends_right && meet(r, right, a, b)) return true;
      bool const touches_end = (ends_left && !left_moves) || (ends_right && !right_moves);
      return !touches_end && meet(left, right, a, b);
    };
    for (std::size_t i = 0; i + 1 < left_.size(); ++i)
      if (hits(left_[i], left_[i + 1], i + 2 == left_.size(), false)) return false;
    for (std::size_t i = 0; i + 1 < right_.size(); ++i)
      if (hits(right_[i], right_[i + 1], false, i + 2 == right_.size())) return false;
    return !hits(left_.front(), right_.front(), left_.size() == 1, right_.size() == 1);
  }

  /// Whether two segments touch, up to rounding: a ring road's end and its begin do.
  [[nodiscard]] static bool meet(Point const& a, Point const& b, Point const& c, Point const& d) {
    constexpr double tolerance = 1e-6;  // [m]
    auto const apart = [](double a1, double a2, double b1, double b2) {
      return std::max(a1, a2) < std::min(b1, b2) - tolerance || std::max(b1, b2) < std::min(a1, a2) - tolerance;
    };
    if (apart(a.x(), b.x(), c.x(), d.x()) || apart(a.y(), b.y(), c.y(), d.y())) return false;
    if (geometry::segments_intersect(a, b, c, d)) return true;
    return geometry::distance_to_segment(a, c, d) < tolerance || geometry::distance_to_segment(b, c, d) < tolerance ||
           geometry::distance_to_segment(c, a, b) < tolerance || geometry::distance_to_segment(d, a, b) < tolerance;
  }

  void close() {
    if (left_.size() + right_.size() < 3) return;
    auto ring = right_;
    ring.insert(ring.end(), left_.rbegin(), left_.rend());
    polygons_.emplace_back(ring, "lane area");
  }

  std::vector<Point> left_, right_;  ///< the ring so far
  std::vector<geometry::Polygon> polygons_;
};

/// The cross-section of a strip at a vertex of its line. Widths of 0 or less count as 2 mm.
[[nodiscard]] inline StripSection strip_section(geometry::Pose const& on_line, SideWidths sides, double growth) {
  constexpr double least = 1e-3;
  double const middle = 0.5 * (sides.left - sides.right);
  double const half = std::max(0.5 * (sides.left + sides.right) + growth, least);
  auto const direction = portable::sin_cos(on_line.heading);
  double const sin = direction.sin, cos = direction.cos;
  auto const at = [&](double t) { return geometry::Point(on_line.x - t * sin, on_line.y + t * cos); };
  return {at(middle + half), at(middle - half), on_line.heading};
}

/// The ground of a strip along `line` with `widths` at its vertices, from `begin` to `end`.
[[nodiscard]] inline std::vector<StripSection> strip_sections(geometry::Line const& line,
                                                              std::span<SideWidths const> widths,
                                                              PathStretch const& stretch, double growth) {
  if (std::isnan(stretch.begin) || std::isnan(stretch.end))
    throw MapError("lane area", "its begin or end is not a number", "give metres along it");
  if (!std::isfinite(growth)) throw MapError("lane area", "its growth is no finite number", "give metres");
  double const begin = std::clamp(stretch.begin, 0.0, line.length()),
               end = std::clamp(stretch.end, begin, line.length());
  std::vector<StripSection> sections;
  if (!(end > begin)) return sections;
  sections.push_back(strip_section(line.pose(begin), interpolated(widths, line, begin, line.find(begin)), growth));
  auto const segments = line.segments();
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (!(segments[i].s > begin && segments[i].s < end)) continue;
    sections.push_back(strip_section({segments[i].x, segments[i].y, segments[i].heading}, widths[i], growth));
  }
  sections.push_back(strip_section(line.pose(end), interpolated(widths, line, end, line.find(end)), growth));
  return sections;
}

[[nodiscard]] inline std::vector<geometry::Polygon> strip_polygons(std::span<StripSection const> sections) {
  StripPolygons polygons;
  for (auto const& section : sections) polygons.add(section);
  return polygons.finish();
}

inline constexpr PathStretch whole_path{0.0, std::numeric_limits<double>::infinity()};

}  // namespace detail

/// The ground of `lane` on a stretch of its path, widened by `growth` [m] to either side: simple polygons one behind
/// the other that share an edge each. It is one polygon, but where the lane runs over itself. Where the inner border of
/// a tight curve folds, the fold is left out. Empty for a stretch without a length. Throws `MapError` for a stretch
/// that is not a number and a growth that is not finite. O(n^2) for n vertices, a few ns a pair.
[[nodiscard]] inline std::vector<geometry::Polygon> area_of(Lane const& lane, PathStretch stretch = detail::whole_path,
                                                            double growth = 0.0) {
  return detail::strip_polygons(detail::strip_sections(lane.path, lane.widths, stretch, growth));
}

/// As above, of a lane corridor: its lanes' ground merged.
[[nodiscard]] inline std::vector<geometry::Polygon> area_of(LaneCorridor const& corridor,
                                                            PathStretch stretch = detail::whole_path,
                                                            double growth = 0.0) {
  return detail::strip_polygons(detail::strip_sections(corridor.center, corridor.widths, stretch, growth));
}

}  // namespace cambium::inline v0_1::map
