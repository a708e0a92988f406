#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/map/build_corridor.hpp"
#include "cambium/map/map.hpp"

namespace cambium::map {

/// Where the traffic of a lane stops, from border to border of the lane (see `CorridorSignal`).
struct StopLine {
  geometry::Point left{0.0, 0.0};   ///< [m], as seen by those who come to it
  geometry::Point right{0.0, 0.0};  ///< [m]
  LightId light = none<LightId>;    ///< the light above it; none: a sign
};

/// The stop lines of a map, where lane corridors have them, each once, in the order of the lanes. O(n^2) for n signals.
[[nodiscard]] inline std::vector<StopLine> stop_lines(Map const& map) {
  constexpr double reach = 40.0;  // [m] behind a signal to the junction where it counts
  std::vector<StopLine> lines;
  for (auto const& lane : map.lanes()) {
    if (lane.signals.empty()) continue;
    auto const corridor = detail::LaneJoiner(map).join(straight_route(map, lane.id, lane.length() + reach).lanes);
    for (auto const& signal : detail::corridor_signals(map, corridor)) {
      auto const at = corridor.center.pose(signal.line);
      auto const widths = corridor.widths_at(signal.line);
      geometry::Point const aside(-std::sin(at.heading), std::cos(at.heading));
      StopLine const line{at.position() + widths.left * aside, at.position() - widths.right * aside, signal.light};
      bool const is_known = std::any_of(lines.begin(), lines.end(), [&line](StopLine const& known) {
        return known.light == line.light && (known.left - line.left).norm() + (known.right - line.right).norm() < 0.2;
      });
      if (!is_known) lines.push_back(line);
    }
  }
  return lines;
}

}  // namespace cambium::map
