#pragma once

#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/map/map.hpp"

namespace cambium::inline v0_1::map {

/// Where the traffic of a lane stops, from border to border of the lane (see `CorridorSignal`).
struct StopLine {
  geometry::Point left{0.0, 0.0};   ///< [m], as seen by those who come to it
  geometry::Point right{0.0, 0.0};  ///< [m]
  LightId light = none<LightId>;    ///< the light above it; none: a sign
};

/// The stop lines of a map, where lane corridors have them, each once, in the order of the lanes. O(n^2) for n signals.
[[nodiscard]] inline std::vector<StopLine> stop_lines(Map const& map) { return map.queries().stop_lines(map); }

}  // namespace cambium::inline v0_1::map
