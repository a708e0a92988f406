#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/pose.hpp"

namespace cambium::inline v0_1::geometry {

/// A sample of a curve: position [m] and direction [rad].
using LineSample = Pose;

/// Whether `next` continues a drivable line from `last`. False if it is the same place or less than 1 m away and not
/// ahead: offset lines fold back like that beside a kink, and no vehicle gets past such a fold.
[[nodiscard]] inline bool goes_on(LineSample const& last, LineSample const& next) {
  constexpr double fold = 1.0;  // [m]
  double const dx = next.x - last.x, dy = next.y - last.y, distance = portable::hypot(dx, dy);
  return distance >= fold ||
         (distance >= 1e-6 && dx * portable::cos(last.heading) + dy * portable::sin(last.heading) > 0.0);
}

/// Position of a point relative to a `Line`.
struct Projection {
  double s{};        ///< arc length of the foot point [m]; below 0 or beyond the length on the extended end segments
  double lateral{};  ///< signed offset from the line, left positive [m]
  std::uint32_t segment{};  ///< segment of the foot point; the hint for the next query nearby
};

/// An immutable polyline, parametrised by arc length, with a heading.
///
/// Positions are interpolated linearly. The heading is either that of the chords, constant on each segment
/// (`from_points`), or interpolated between the headings of the samples (`from_samples`). The first and the last
/// segment extend to infinity, so a vehicle that has passed the end still has a position.
///
/// Queries take a `cursor`, the segment of the previous query. They cost O(number of segments between the two): O(1)
/// for a vehicle that moves along the line. One segment is one cache line (64 B).
///
/// Projecting a point with a hint walks from segment to segment until the point lies between the bisectors at the
/// segment's ends; then its foot point is on that segment.
///
///                :      p    :              p lies between the bisectors (dotted) at the ends of segment i, so its
///                :      |    :              foot point f lies on this segment, ends included
///     o----------o------f----o---------o
///     segment i - 1  segment i   segment i + 1
class Line {
 public:
  /// The straight piece between two points.
  struct Segment {
    double s, x, y;    ///< start: arc length, position
    double ux, uy;     ///< unit direction
    double length;     ///< [m]
    double heading;    ///< at the start [rad]; continuous along the line, not wrapped
    double curvature;  ///< change of heading per metre [1/m]
  };

  Line() = default;

  /// The line through `points`; repeated points are dropped. Throws `MapError` if there are fewer than two distinct
  /// points or a number is not finite. O(n).
  [[nodiscard]] static Line from_points(std::span<Point const> points) {
    Line line;
    line.reserve(points.size());
    for (auto const& p : points) line.append(p.x(), p.y());
    line.finish();
    return line;
  }

  /// The line through `samples` with interpolated headings; samples closer than 1e-9 m to the previous one are dropped.
  /// Throws like `from_points`. O(n).
  [[nodiscard]] static Line from_samples(std::span<LineSample const> samples) {
    Line line;
    line.reserve(samples.size());
    std::vector<double> headings;
    headings.reserve(samples.size());
    for (auto const& sample : samples) {
      if (!std::isfinite(sample.heading))
        throw MapError("line", "a sample's heading is not a finite number", "give radians");
      if (line.append(sample.x, sample.y)) headings.push_back(sample.heading);
    }
    line.finish();
    line.set_headings(headings);
    return line;
  }

  [[nodiscard]] bool empty() const { return segments_.empty(); }
  [[nodiscard]] double length() const { return length_; }
  [[nodiscard]] std::span<Segment const> segments() const { return segments_; }

  /// The vertices: one more than segments.
  [[nodiscard]] std::vector<Point> points() const {
    std::vector<Point> result;
    result.reserve(segments_.size() + 1);
    for (auto const& segment : segments_) result.emplace_back(segment.x, segment.y);
    if (!empty()) result.push_back(end_of(segments_.back()));
    return result;
  }

  /// Samples from which `from_samples` makes the same line.
  [[nodiscard]] std::vector<LineSample> samples() const {
    std::vector<LineSample> result;
    result.reserve(segments_.size() + 1);
    for (auto const& g : segments_) result.push_back({g.x, g.y, g.heading});
    if (!empty()) {
      auto const& g = segments_.back();
      Point const p = end_of(g);
      result.push_back({p.x(), p.y(), g.heading + g.curvature * g.length});
    }
    return result;
  }

  /// The segment that contains `s`, searched from `cursor` on, which is set to it. The line must not be empty.
  Segment const& segment_at(double s, std::uint32_t& cursor) const {
    CAMBIUM_ASSERT(!empty(), "a query on an empty line");
    auto const* const first = segments_.data();
    auto const* at = first + std::min(cursor, last_);
    auto const* const end = first + last_;
    // Steps to the next segment are frequent but hard to predict, so the first one is added without a branch.
    at += at < end ? static_cast<std::ptrdiff_t>(s >= at[1].s) : 0;
    while (at < end && s >= at[1].s) ++at;
    while (at > first && s < at->s) --at;
    cursor = static_cast<std::uint32_t>(at - first);
    return *at;
  }

  /// Position and heading at arc length `s`; the heading is continuous along the line and not wrapped.
  [[nodiscard]] Pose pose(double s, std::uint32_t& cursor) const {
    auto const& g = segment_at(s, cursor);
    double const ds = s - g.s;
    double const inside = std::clamp(ds, 0.0, g.length);
    return {g.x + g.ux * ds, g.y + g.uy * ds, g.heading + g.curvature * inside};
  }

  /// The same by binary search. O(log n).
  [[nodiscard]] Pose pose(double s) const {
    auto cursor = find(s);
    return pose(s, cursor);
  }

  [[nodiscard]] Pose begin_pose() const { return pose(0.0); }
  [[nodiscard]] Pose end_pose() const { return pose(length_); }

  /// Curvature (left positive) of the interpolated heading at `s` [1/m]; 0 for a line from `from_points`. O(log n).
  [[nodiscard]] double curvature(double s) const { return segments_[find(s)].curvature; }

  /// Index of the segment that contains `s`. O(log n).
  [[nodiscard]] std::uint32_t find(double s) const {
    CAMBIUM_ASSERT(!empty(), "a query on an empty line");
    auto const* at = segments_.data();
    for (std::size_t left = segments_.size(); left > 1;) {  // a binary search without unpredictable branches
      std::size_t const half = left / 2;
      at += s < at[half].s ? 0 : half;
      left -= half;
    }
    return static_cast<std::uint32_t>(at - segments_.data());
  }

  /// The exact nearest point of the line, the first of several. O(n).
  [[nodiscard]] Projection project(Point const& p) const {
    CAMBIUM_ASSERT(!empty(), "a query on an empty line");
    std::uint32_t best = 0;
    double best_squared = std::numeric_limits<double>::infinity();
    for (std::uint32_t i = 0; i <= last(); ++i) {
      double const squared = squared_distance(segments_[i], p);
      if (squared < best_squared) {
        best_squared = squared;
        best = i;
      }
    }
    return foot(best, p);
  }

  /// The foot point near segment `hint`: walks along the line to the nearest local minimum of the distance. For any
  /// hint, it equals the exact projection if the point is closer to the line than the line's radius of curvature and
  /// the line does not pass near it twice. O(segments passed).
  [[nodiscard]] Projection project(Point const& p, std::uint32_t hint) const {
    CAMBIUM_ASSERT(!empty(), "a query on an empty line");
    auto const i = std::min(hint, last());
    // Usual case for a vehicle that follows the line: the foot point is well inside this segment or the next one.
    for (auto const next : {i, i + 1}) {
      if (next > last()) break;
      auto const& g = segments_[next];
      double const dx = p.x() - g.x, dy = p.y() - g.y;
      double const along = dx * g.ux + dy * g.uy, across = g.ux * dy - g.uy * dx;
      double const margin = sharpest_ * std::abs(across);  // the bisectors at its ends are within this distance of them
      if (along < margin) break;
      if (along <= g.length - margin) return {g.s + along, across, next};
    }
    return descend(p, i);
  }

 private:
  [[nodiscard]] std::uint32_t last() const { return last_; }

  [[nodiscard]] static Point end_of(Segment const& g) { return {g.x + g.ux * g.length, g.y + g.uy * g.length}; }

  [[nodiscard]] static double along_of(Segment const& g, Point const& p) {
    return (p.x() - g.x) * g.ux + (p.y() - g.y) * g.uy;
  }

  [[nodiscard]] static double squared_distance(Segment const& g, Point const& p) {
    double const t = std::clamp(along_of(g, p), 0.0, g.length);
    double const dx = p.x() - (g.x + g.ux * t), dy = p.y() - (g.y + g.uy * t);
    return dx * dx + dy * dy;
  }

  [[nodiscard]] Projection foot(std::uint32_t i, Point const& p) const {
    auto const& g = segments_[i];
    double const dx = p.x() - g.x, dy = p.y() - g.y;
    double const along = dx * g.ux + dy * g.uy;
    double const across = g.ux * dy - g.uy * dx;
    bool const before = along < 0.0 && i > 0, beyond = along > g.length && i < last();
    if (!before && !beyond) return {g.s + along, across, i};
    // The foot point is an inner vertex, so the offset is the distance to it.
    double const excess = before ? along : along - g.length;
    return {before ? g.s : g.s + g.length, std::copysign(portable::hypot(across, excess), across), i};
  }

  /// The nearest local minimum of the distance to `p`, starting at segment `i`.
  CAMBIUM_NOINLINE [[nodiscard]] Projection descend(Point const& p, std::uint32_t i) const {
    double along = along_of(segments_[i], p);
    // The bisector at a vertex separates the points nearer to the segment before it from those nearer to the next one.
    if (along > 0.5 * segments_[i].length) {
      while (i < last()) {
        double const next = along_of(segments_[i + 1], p);
        if (along - segments_[i].length + next <= 0.0) break;
        along = next;
        ++i;
      }
    } else {
      while (i > 0) {
        double const previous = along_of(segments_[i - 1], p);
        if (previous - segments_[i - 1].length + along > 0.0) break;
        along = previous;
        --i;
      }
    }
    return foot(i, p);
  }

  void reserve(std::size_t points) {
    if (points > 1) segments_.reserve(points - 1);
  }

  /// Adds a vertex unless it repeats the last one; returns whether it was added.
  bool append(double x, double y) {
    if (!std::isfinite(x) || !std::isfinite(y))
      throw MapError("line", "a point is not a finite number", "give coordinates in metres");
    if (!has_first_) {
      has_first_ = true;
      end_x_ = x;
      end_y_ = y;
      return true;
    }
    double const dx = x - end_x_, dy = y - end_y_;
    double const distance = portable::hypot(dx, dy);
    if (distance < 1e-9) return false;
    double heading = portable::atan2(dy, dx);
    if (!segments_.empty())
      heading = segments_.back().heading + std::remainder(heading - segments_.back().heading, 2 * pi);
    segments_.push_back({length_, end_x_, end_y_, dx / distance, dy / distance, distance, heading, 0.0});
    length_ += distance;
    end_x_ = x;
    end_y_ = y;
    return true;
  }

  void finish() {
    if (segments_.empty())
      throw MapError("line", "fewer than two distinct points", "give at least two points apart from each other");
    last_ = static_cast<std::uint32_t>(segments_.size() - 1);
    for (std::uint32_t i = 0; i < last_; ++i) {
      auto const &a = segments_[i], &b = segments_[i + 1];
      double const cos = a.ux * b.ux + a.uy * b.uy, sin = a.ux * b.uy - a.uy * b.ux;
      sharpest_ = std::max(sharpest_, std::abs(sin) / std::max(1.0 + cos, 1e-12));
    }
    sharpest_ += 1e-9;
  }

  void set_headings(std::span<double const> headings) {
    double heading = headings.front();
    for (std::size_t i = 0; i < segments_.size(); ++i) {
      double const turn = std::remainder(headings[i + 1] - heading, 2 * pi);
      segments_[i].heading = heading;
      segments_[i].curvature = turn / segments_[i].length;
      heading += turn;
    }
  }

  std::vector<Segment> segments_;
  std::uint32_t last_ = 0;  ///< index of the last segment
  double sharpest_ = 0.0;   ///< tangent of half the sharpest turn at a vertex
  double length_ = 0.0;
  double end_x_ = 0.0, end_y_ = 0.0;
  bool has_first_ = false;
};

}  // namespace cambium::inline v0_1::geometry
