#pragma once

#include <algorithm>
#include <cmath>

#include "cambium/map/lane.hpp"
#include "cambium/map/map.hpp"

namespace cambium::map::detail {

/// Where the path of `lane`, one of `road`'s, passes the road station `s` [m].
[[nodiscard]] inline double path_position(Road const& road, Lane const& lane, double s) {
  double const share = std::clamp((s - lane.road_begin) / (lane.road_end - lane.road_begin), 0.0, 1.0);
  if (share == 0.0) return lane.along_road ? 0.0 : lane.length();
  if (share == 1.0) return lane.along_road ? lane.length() : 0.0;
  // A point of the station's cross-section about as far to the side as the path is there.
  double const guess = (lane.along_road ? share : 1.0 - share) * lane.length();
  auto const station = road.reference_line.at(s);
  auto const near = lane.path.pose(guess);
  double const nx = -std::sin(station.heading), ny = std::cos(station.heading);
  double const t = (near.x - station.x) * nx + (near.y - station.y) * ny;
  auto const foot = lane.path.project({station.x + t * nx, station.y + t * ny}, lane.path.find(guess));
  return std::clamp(foot.s, 0.0, lane.length());
}

/// The stretch of the path of `lane` between two road stations, `from` < `to` [m].
[[nodiscard]] inline PathStretch path_stretch(Road const& road, Lane const& lane, double from, double to) {
  double const a = path_position(road, lane, from), b = path_position(road, lane, to);
  return {std::min(a, b), std::max(a, b)};
}

}  // namespace cambium::map::detail
