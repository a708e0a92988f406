#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/geometry/line.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/map/curve_layout.hpp"
#include "cambium/map/lane.hpp"
#include "cambium/map/polyline_roads.hpp"
#include "cambium/map/road_plan.hpp"

/// Roads from points, for planners that bring lanes of their own.

namespace cambium::map {

namespace detail {

/// A smooth curve through `values` at the stations `s`, monotone between them: it leaves neither the range of two
/// neighbouring values nor has it kinks (Fritsch, Butland 1984).
[[nodiscard]] inline std::vector<CubicRecord> monotone_profile(std::span<double const> s,
                                                               std::span<double const> values) {
  auto const n = s.size();
  std::vector<double> rise(n), slope(n);
  for (std::size_t i = 0; i + 1 < n; ++i) rise[i] = (values[i + 1] - values[i]) / (s[i + 1] - s[i]);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    if (!(rise[i - 1] * rise[i] > 0.0)) continue;
    double const before = s[i] - s[i - 1], behind = s[i + 1] - s[i],
                 share = (before + 2 * behind) / (3 * (before + behind));
    slope[i] = rise[i - 1] * rise[i] / (share * rise[i] + (1 - share) * rise[i - 1]);
  }
  std::vector<CubicRecord> records;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    double const h = s[i + 1] - s[i];
    records.push_back({s[i], values[i], slope[i], (3 * rise[i] - 2 * slope[i] - slope[i + 1]) / h,
                       (slope[i] + slope[i + 1] - 2 * rise[i]) / (h * h)});
  }
  return records;
}

/// Where the line to the right of `pose` meets `polyline` as that passes ahead, not back: the distance [m]. Where it
/// meets none of its segments, the ends go on straight, and that counts which is met nearer to it. Infinite where it
/// does not within 100 m.
[[nodiscard]] inline double distance_to_the_right(geometry::Pose const& pose,
                                                  std::span<geometry::Point const> polyline) {
  constexpr double farthest = 100.0, tolerance = 1e-6;
  using Hit = std::pair<double, double>;  // how far beyond the polyline's ends, how far to the right
  Hit best{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  for (std::size_t i = 0; i + 1 < polyline.size(); ++i) {
    auto const a = geometry::to_local(pose, polyline[i]), b = geometry::to_local(pose, polyline[i + 1]);
    if (!(a.x() < b.x())) continue;
    double const u = -a.x() / (b.x() - a.x());
    double const beyond = std::max({-u - tolerance, u - 1.0 - tolerance, 0.0}) * (b - a).norm();
    if (beyond > 0.0 && (u < 0.0 ? i > 0 : i + 2 < polyline.size())) continue;
    double const right = -(a.y() + u * (b.y() - a.y()));
    if (right > -1e-6 && right < farthest) best = std::min(best, Hit{beyond, right});
  }
  return best.second;
}

[[nodiscard]] inline std::vector<double> stations_of(std::vector<Geometry> const& line) {
  std::vector<double> stations;
  for (auto const& g : line) stations.push_back(g.s);
  stations.push_back(line.back().s + line.back().length);
  return stations;
}

}  // namespace detail

CAMBIUM_COLD RoadPlan lane_along(std::span<geometry::Point const> center, std::span<SideWidths const> widths,
                                 std::span<double const> headings) {
  if (widths.size() != 1 && widths.size() != center.size())
    throw MapError(
        "polyline",
        "it has " + std::to_string(center.size()) + " points, but " + std::to_string(widths.size()) + " widths",
        "give one, or one a point");
  RoadPlan plan;
  plan.line = curve_through(center, headings);
  auto const stations = detail::stations_of(plan.line);
  std::vector<double> offsets, whole;
  for (std::size_t i = 0; i < widths.size(); ++i) {
    auto const& w = widths[i];
    if (!(w.left >= 0.0 && w.right >= 0.0 && w.left + w.right <= 1000.0))
      throw MapError("polyline",
                     "the width at point " + std::to_string(i) + " is negative, beyond 1 km or not a number",
                     "give widths in m");
    offsets.push_back(w.left);
    whole.push_back(w.left + w.right);
  }
  auto const profile = [&](std::vector<double> const& values) {
    return values.size() == 1 ? std::vector<CubicRecord>{{0.0, values.front(), 0.0, 0.0, 0.0}}
                              : detail::monotone_profile(stations, values);
  };
  plan.lane_offset = profile(offsets);
  plan.sections = {{.right = {{.widths = profile(whole)}}}};
  return plan;
}

CAMBIUM_COLD RoadPlan lanes_between(std::span<std::vector<geometry::Point> const> borders) {
  if (borders.size() < 2) throw MapError("polylines", "there are fewer than two borders", "give at least two");
  RoadPlan plan;
  plan.line = curve_through(borders.front());
  std::vector<double> stations;
  for (auto const& g : plan.line) {
    auto const pieces = static_cast<int>(std::ceil(g.length / 2.0));
    for (int k = 0; k < pieces; ++k) stations.push_back(g.s + g.length * k / pieces);
  }
  stations.push_back(plan.line.back().s + plan.line.back().length);
  plan.sections.push_back({});
  ReferenceLine const reference(plan.line);
  std::vector<double> inner(stations.size(), 0.0);
  for (std::size_t lane = 1; lane < borders.size(); ++lane) {
    (void)curve_through(borders[lane]);  // the same errors as for the leftmost
    std::vector<double> widths;
    for (std::size_t i = 0; i < stations.size(); ++i) {
      auto const p = reference.at(stations[i]);
      double const outer = detail::distance_to_the_right({p.x, p.y, p.heading}, borders[lane]);
      if (!(outer > inner[i] - 1e-6) || !std::isfinite(outer))
        throw MapError("polylines",
                       "border " + std::to_string(lane) + " does not pass within 100 m to the right of border " +
                           std::to_string(lane - 1) + " at " + cambium::detail::rounded_text(stations[i]) + " m",
                       "give borders from left to right, in travel direction");
      widths.push_back(std::max(0.0, outer - inner[i]));
      inner[i] = outer;
    }
    plan.sections.front().right.push_back({.widths = detail::monotone_profile(stations, widths)});
  }
  return plan;
}

}  // namespace cambium::map
