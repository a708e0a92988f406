#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "cambium/geometry/polygon.hpp"
#include "cambium/viewer/recording.hpp"

namespace cambium::inline v0_1::detail {

using PointList = std::vector<geometry::Point>;

using geometry::distance_to_segment;

/// Distance [m] of `p` from a polyline of at least one point. O(points).
inline double distance_to_line(geometry::Point const& p, PointList const& line) {
  double best = (line.front() - p).norm();
  for (std::size_t i = 1; i < line.size(); ++i) best = std::min(best, distance_to_segment(p, line[i - 1], line[i]));
  return best;
}

/// The polyline simplified to `tolerance` [m] (Douglas, Peucker 1973). Points that are not finite or beyond 1e8 m are
/// dropped.
inline PointList simplified(PointList const& line, double tolerance) {
  PointList points;
  for (geometry::Point const& p : line)
    if (std::max(std::abs(p.x()), std::abs(p.y())) < 1e8 && p.allFinite()) points.push_back(p);
  if (points.size() < 3) return points;
  std::vector<bool> keep(points.size(), false);
  keep.front() = keep.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, points.size() - 1}};
  while (!open.empty()) {
    auto const [first, last] = open.back();
    open.pop_back();
    std::size_t farthest = first;
    double most = tolerance;
    for (std::size_t i = first + 1; i < last; ++i) {
      double const distance = distance_to_segment(points[i], points[first], points[last]);
      if (distance > most) most = distance, farthest = i;
    }
    if (farthest == first) continue;
    keep[farthest] = true;
    open.emplace_back(first, farthest);
    open.emplace_back(farthest, last);
  }
  PointList result;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (keep[i]) result.push_back(points[i]);
  return result;
}

/// The point at a fraction [0, 1] of the length of a polyline of at least one point. O(points).
inline geometry::Point point_at(PointList const& line, double fraction) {
  double length = 0.0;
  for (std::size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
  double left = fraction * length;
  for (std::size_t i = 1; i < line.size(); ++i) {
    double const step = (line[i] - line[i - 1]).norm();
    if (left <= step && step > 0.0) return line[i - 1] + (line[i] - line[i - 1]) * (left / step);
    left -= step;
  }
  return line.back();
}

/// A lane prepared for drawing: borders simplified to 1 cm, outline and bounding box.
struct LaneArea {
  PointList left;
  PointList right;
  PointList outline;  ///< the left border, then the right one backwards
  geometry::Point low{0.0, 0.0};
  geometry::Point high{0.0, 0.0};

  explicit LaneArea(RecordedLane const& lane) : left(simplified(lane.left, 0.01)), right(simplified(lane.right, 0.01)) {
    if (left.size() < 2 || right.size() < 2) left.clear(), right.clear();
    if (left.empty()) return;
    outline = left;
    outline.insert(outline.end(), right.rbegin(), right.rend());
    low = high = left.front();
    for (geometry::Point const& p : outline) low = low.cwiseMin(p), high = high.cwiseMax(p);
    for (std::size_t first = 0; first < outline.size(); first += run_) {
      Range range{before(first).y(), before(first).y()};
      for (std::size_t i = first; i < std::min(first + run_, outline.size()); ++i)
        range = {std::min(range.low, outline[i].y()), std::max(range.high, outline[i].y())};
      heights_.push_back(range);
    }
  }

  [[nodiscard]] bool empty() const { return left.empty(); }

  /// Whether `p` lies inside the outline (even-odd rule). O(1) outside the bounding box, else O(points); most points
  /// are skipped in runs of 16.
  [[nodiscard]] bool contains(geometry::Point const& p) const {
    if (empty() || p.x() < low.x() || p.y() < low.y() || p.x() > high.x() || p.y() > high.y()) return false;
    bool inside = false;
    for (std::size_t k = 0; k < heights_.size(); ++k) {
      if (p.y() < heights_[k].low || p.y() > heights_[k].high) continue;
      for (std::size_t i = k * run_; i < std::min((k + 1) * run_, outline.size()); ++i) {
        geometry::Point const &a = outline[i], &b = before(i);
        if ((a.y() > p.y()) != (b.y() > p.y()) && p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x())
          inside = !inside;
      }
    }
    return inside;
  }

  /// Middle of the lane at a fraction of its length.
  [[nodiscard]] geometry::Point middle(double fraction) const {
    return 0.5 * (point_at(left, fraction) + point_at(right, fraction));
  }

 private:
  struct Range {
    double low, high;
  };
  static constexpr std::size_t run_ = 16;

  [[nodiscard]] geometry::Point const& before(std::size_t i) const { return i > 0 ? outline[i - 1] : outline.back(); }

  std::vector<Range> heights_;  ///< range of y of each run of edges [m]; edge i ends at point i
};

/// A direction arrow on a lane.
struct LaneArrow {
  geometry::Point at{0.0, 0.0};
  double heading = 0.0;  ///< [rad]
};

/// Arrows in the direction of traffic, about one every `spacing` [m], on driving lanes that are long and wide enough.
inline std::vector<LaneArrow> lane_arrows(std::vector<RecordedLane> const& lanes, std::vector<LaneArea> const& areas,
                                          double spacing) {
  std::vector<LaneArrow> arrows;
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    LaneArea const& area = areas[i];
    if (area.empty() || lanes[i].kind != RecordedLaneKind::driving) continue;
    double length = 0.0;
    for (std::size_t k = 1; k < area.left.size(); ++k) length += (area.left[k] - area.left[k - 1]).norm();
    if (length < 12.0) continue;
    auto const count = std::max(1L, std::lround(length / spacing));
    for (long k = 0; k < count; ++k) {
      double const fraction = (static_cast<double>(k) + 0.5) / static_cast<double>(count);
      if ((point_at(area.left, fraction) - point_at(area.right, fraction)).norm() < 2.0) continue;
      geometry::Point along = area.middle(fraction + 1.0 / length) - area.middle(fraction - 1.0 / length);
      if (!lanes[i].forward) along = -along;
      arrows.push_back({area.middle(fraction), std::atan2(along.y(), along.x())});
    }
  }
  return arrows;
}

}  // namespace cambium::inline v0_1::detail
