#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "cambium/geometry/line.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/road/cubic.hpp"
#include "cambium/map/road/reference_line.hpp"

namespace cambium::inline v0_1::map::detail {

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

}  // namespace cambium::inline v0_1::map::detail
