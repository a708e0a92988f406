#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/map/corridor/detail/corridor_signals.hpp"
#include "cambium/map/corridor/detail/make_road_corridor.hpp"
#include "cambium/map/corridor/stop_lines.hpp"
#include "cambium/map/map.hpp"

namespace cambium::map::detail {

/// See `map::stop_lines`.
[[nodiscard]] inline std::vector<StopLine> find_stop_lines(Map const& map) {
  constexpr double reach = 40.0;  // [m] behind a signal to the junction where it counts
  std::vector<StopLine> lines;
  for (auto const& lane : map.lanes()) {
    if (lane.signals.empty()) continue;
    auto const corridor = LaneJoiner(map).join(map::straight_route(map, lane.id, lane.length() + reach).lanes);
    for (auto const& signal : corridor_signals(map, corridor)) {
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

}  // namespace cambium::map::detail
