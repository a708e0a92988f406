#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "cambium/geometry/line.hpp"
#include "cambium/map/corridor/corridor.hpp"

namespace cambium::inline v0_1::map::detail {

/// The bends of a corridor's centre line. Curvature is averaged over 4 m, so kinks in the file are not bends. A bend
/// ends where its curvature falls more than a tenth below its sharpest.
[[nodiscard]] inline std::vector<Bend> bends_of(geometry::Line const& center) {
  constexpr double step = 1.0, half = 2.0, least = 1e-3;  // [m], [m], [1/m]
  std::vector<Bend> bends;
  double gentlest = 0.0;  // of the last one
  std::uint32_t behind = 0, ahead = 0;
  for (double s = 0.0; s < center.length(); s += step) {
    double const from = std::max(0.0, s - half), to = std::min(center.length(), s + half);
    double const turn = center.pose(to, ahead).heading - center.pose(from, behind).heading;
    double const curvature = std::abs(turn) / std::max(to - from, half);
    if (curvature < least) continue;
    double const low = std::min(curvature, gentlest), high = bends.empty() ? 0.0 : bends.back().curvature;
    if (!bends.empty() && s - bends.back().end < 1.5 * step && low > 0.9 * std::max(curvature, high)) {
      bends.back() = {bends.back().begin, s, std::max(curvature, high)};
      gentlest = low;
    } else {
      bends.push_back({s, s, curvature});
      gentlest = curvature;
    }
  }
  for (auto& bend : bends) bend = {bend.begin - 0.5 * step, bend.end + 0.5 * step, bend.curvature};
  return bends;
}

/// Notes the corridor's bends, by its centre line.
inline void find_bends(LaneCorridor& corridor) {
  corridor.bends = bends_of(corridor.center);
  for (auto const& bend : corridor.bends) corridor.sharpest_bend = std::max(corridor.sharpest_bend, bend.curvature);
}

}  // namespace cambium::inline v0_1::map::detail
