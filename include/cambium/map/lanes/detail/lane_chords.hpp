#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "cambium/core/portable_math.hpp"
#include "cambium/map/lanes/lane.hpp"

namespace cambium::inline v0_1::map::detail {

/// A straight piece that stands for a stretch of a lane's path.
struct LaneChord {
  std::uint32_t lane{};
  double x{}, y{}, ux{}, uy{}, length{};  ///< as in `geometry::Line::Segment`
  PathStretch on_path;                    ///< path positions [m]
  PathStretch on_road;                    ///< road stations [m]
};

/// Appends chords that keep within `tolerance` of the lane's path and are not longer than `longest` [m]: a straight
/// road is one segment however long.
inline void add_chords(Lane const& lane, double tolerance, double longest, std::vector<LaneChord>& chords) {
  auto const segments = lane.path.segments();
  auto const scale = (lane.road_end - lane.road_begin) / lane.length();
  for (std::size_t i = 0; i < segments.size();) {
    auto const& first = segments[i];
    // Directions, as slopes from the first segment's, in which the chord passes all vertices so far within the
    // tolerance.
    double low = -1.0, high = 1.0, x = first.length, y = 0.0;
    std::size_t j = i;
    for (; j + 1 < segments.size(); ++j) {
      auto const& g = segments[j + 1];
      double const dx = g.x + g.ux * g.length - first.x, dy = g.y + g.uy * g.length - first.y;
      double const next_x = dx * first.ux + dy * first.uy, next_y = first.ux * dy - first.uy * dx;
      low = std::max(low, (y - tolerance) / x);
      high = std::min(high, (y + tolerance) / x);
      bool const fits = next_x > x && next_y >= low * next_x && next_y <= high * next_x;
      if (!fits || g.s + g.length - first.s > longest) break;
      x = next_x;
      y = next_y;
    }
    double const length = portable::hypot(x, y), ux = (first.ux * x - first.uy * y) / length,
                 uy = (first.uy * x + first.ux * y) / length;
    double const from = first.s, to = segments[j].s + segments[j].length;
    auto const pieces = std::max(1.0, std::ceil(length / longest));
    for (double k = 0.0; k < pieces; ++k) {
      PathStretch const on_path{from + k / pieces * (to - from), from + (k + 1.0) / pieces * (to - from)};
      PathStretch const on_road =
          lane.along_road ? PathStretch{lane.road_begin + scale * on_path.begin, lane.road_begin + scale * on_path.end}
                          : PathStretch{lane.road_end - scale * on_path.end, lane.road_end - scale * on_path.begin};
      double const along = k / pieces * length;
      chords.push_back({static_cast<std::uint32_t>(lane.id), first.x + along * ux, first.y + along * uy, ux, uy,
                        length / pieces, on_path, on_road});
    }
    i = j + 1;
  }
}

/// The path positions of `a` that are closer than `clearance` to `b`: what is that close to `b` is convex, a rectangle
/// with two half discs. Nothing where that is shorter than a micrometre.
[[nodiscard]] inline std::optional<PathStretch> stretch_near(LaneChord const& a, LaneChord const& b, double clearance) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double const dx = a.x - b.x, dy = a.y - b.y;
  PathStretch result{infinity, -infinity};
  auto const add_disc = [&](double cx, double cy) {  // where |c + s u| < clearance
    double const half = cx * a.ux + cy * a.uy;
    double const root = half * half - (cx * cx + cy * cy - clearance * clearance);
    if (root > 0.0) result.add({-half - std::sqrt(root), -half + std::sqrt(root)});
  };
  add_disc(dx, dy);
  add_disc(dx - b.ux * b.length, dy - b.uy * b.length);
  PathStretch inside{-infinity, infinity};
  auto const cut = [&inside](double value, double slope, double low, double high) {
    if (std::abs(slope) < 1e-12) {
      if (value <= low || value >= high) inside = {infinity, -infinity};
      return;
    }
    double const p = (low - value) / slope, q = (high - value) / slope;
    inside = {std::max(inside.begin, std::min(p, q)), std::min(inside.end, std::max(p, q))};
  };
  cut(dx * b.ux + dy * b.uy, a.ux * b.ux + a.uy * b.uy, 0.0, b.length);
  cut(b.ux * dy - b.uy * dx, b.ux * a.uy - b.uy * a.ux, -clearance, clearance);
  if (inside.begin < inside.end) result.add(inside);
  result = {std::max(result.begin, 0.0), std::min(result.end, a.length)};
  if (!(result.end - result.begin > 1e-6)) return std::nullopt;
  double const scale = (a.on_path.end - a.on_path.begin) / a.length;
  return PathStretch{a.on_path.begin + scale * result.begin, a.on_path.begin + scale * result.end};
}

}  // namespace cambium::inline v0_1::map::detail
