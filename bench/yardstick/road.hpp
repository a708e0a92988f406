#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "idm.hpp"

// The road of yardstick L2: three lanes that wind along a straight axis and repeat after a period, so that a vehicle
// that reaches the end goes on at the start without a step in place or heading.

namespace yardstick {

struct Point {
  double x;
  double y;
};

/// A lane's centre line as a polyline. It goes on for a piece behind its end, so that looking ahead needs no wrap.
class LaneLine {
 public:
  struct Segment {
    Point start;
    Point direction;  // unit vector
    double position;  // arc length at the start [m]
    double length;    // [m]
  };

  struct Projection {
    double position;  // arc length [m]
    double lateral;   // to the left [m]
  };

  LaneLine() = default;

  /// `points` in order; the segments from number `period` on repeat those from 0 on.
  LaneLine(std::vector<Point> const& points, std::size_t period) : period_(static_cast<std::uint32_t>(period)) {
    double position = 0.0;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      double const dx = points[i + 1].x - points[i].x;
      double const dy = points[i + 1].y - points[i].y;
      double const length = std::hypot(dx, dy);
      segments_.push_back({points[i], {dx / length, dy / length}, position, length});
      position += length;
    }
    length_ = segments_[period].position;
  }

  /// Projects `point`, walking from segment `cursor`, which is moved along. O(segments passed).
  [[nodiscard]] Projection project(Point point, std::uint32_t& cursor) const {
    double along = along_segment(cursor, point);
    while (along > segments_[cursor].length && cursor + 1 < segments_.size()) along = along_segment(++cursor, point);
    while (along < 0.0 && cursor > 0) along = along_segment(--cursor, point);
    Segment const& segment = segments_[cursor];
    double const dx = point.x - segment.start.x;
    double const dy = point.y - segment.start.y;
    return {segment.position + std::clamp(along, 0.0, segment.length),
            dy * segment.direction.x - dx * segment.direction.y};
  }

  /// The point at arc length `position`, which lies on segment `cursor` or ahead of it.
  [[nodiscard]] Point ahead(double position, std::uint32_t cursor) const {
    Segment const* segment = &segments_[cursor];
    while (position > segment->position + segment->length) ++segment;
    double const along = position - segment->position;
    return {segment->start.x + along * segment->direction.x, segment->start.y + along * segment->direction.y};
  }

  /// Arc length of one period [m].
  [[nodiscard]] double length() const { return length_; }
  /// Segments in one period.
  [[nodiscard]] std::uint32_t period() const { return period_; }
  [[nodiscard]] Segment const& segment(std::size_t i) const { return segments_[i]; }

 private:
  [[nodiscard]] double along_segment(std::uint32_t i, Point point) const {
    Segment const& segment = segments_[i];
    return (point.x - segment.start.x) * segment.direction.x + (point.y - segment.start.y) * segment.direction.y;
  }

  std::vector<Segment> segments_;
  double length_ = 0.0;
  std::uint32_t period_ = 0;
};

/// Three lanes, 3.5 m wide, segments of about 5 m (1 cm from the curve), smallest radius about 200 m.
/// The axis points at 1 rad: no line of it is parallel to a coordinate axis, and sines see arguments of usual size.
struct Road {
  std::array<LaneLine, lane_count> lanes;
  Point shift;  ///< from the end of the road to its start

  explicit Road(double wanted_length) {
    auto const waves = static_cast<std::size_t>(std::ceil(wanted_length / wave_length));
    double const length = static_cast<double>(waves) * wave_length;
    shift = {-length * std::cos(axis), -length * std::sin(axis)};
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      std::vector<Point> points;
      double const offset = (static_cast<double>(lane) - 1.0) * lane_width;
      for (std::size_t i = 0; i <= (waves + 1) * segments_per_wave; ++i) points.push_back(point(i, offset));
      lanes[lane] = LaneLine(points, waves * segments_per_wave);
    }
  }

 private:
  static constexpr double axis = 1.0;
  static constexpr double lane_width = 3.5;
  static constexpr double wave_length = 90.0;
  static constexpr double amplitude = 1.0;
  static constexpr std::size_t segments_per_wave = 18;

  // A cosine along the axis, so that the ends of a wave are parallel to it, moved along its normal by `offset`.
  [[nodiscard]] static Point point(std::size_t i, double offset) {
    double const wave_number = 2.0 * 3.14159265358979323846 / wave_length;
    double const u = wave_length * static_cast<double>(i) / static_cast<double>(segments_per_wave);
    double const slope = -amplitude * wave_number * std::sin(wave_number * u);
    double const norm = std::hypot(1.0, slope);
    double const along = u - offset * slope / norm;
    double const across = amplitude * std::cos(wave_number * u) + offset / norm;
    return {along * std::cos(axis) - across * std::sin(axis), along * std::sin(axis) + across * std::cos(axis)};
  }
};

}  // namespace yardstick
