#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cambium/core/diagnostic.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/map/lanelet/lanelet.hpp"
#include "cambium/map/map.hpp"

namespace cambium::inline v0_1::map {

/// A map made of lanelets.
struct LaneletMap {
  std::shared_ptr<Map const> map;
  std::map<std::int64_t, LaneId> lanes;  ///< by the id of the lanelet; without those that were left out
  std::vector<Diagnostic> diagnostics;
};

/// The map of `lanelets`; `file` names them in messages. Each lanelet becomes a road, named by its id, with one lane:
/// its path is the middle between its own bounds (points of equal shares of their lengths), smoothed, so that it turns
/// no more than these do. Lanelets whose bounds meet are linked, whatever the turn; where the file does not say so,
/// with a diagnostic. Neighbours are those that run beside each other for at least half of their length; lanes are
/// changed where they do. Lanelets that cross others, with those that leave or enter the same road beside them, lie in
/// a junction. What cannot be used is left out, with a diagnostic: bounds that cross or have fewer than two points,
/// links to lanelets that are not there or begin more than 0.4 m away, neighbours elsewhere. Traffic keeps to the
/// right. The diagnostics begin with those `found` before. Throws `MapError` where no lanelet is left, and as
/// `build_map`. O(n^2) comparisons of boxes for n lanelets.
[[nodiscard]] LaneletMap build_lanelet_map(std::vector<Lanelet> lanelets, MapOptions const& options = {},
                                           std::string const& file = "lanelets", std::vector<Diagnostic> found = {});

/// How far before the lanelet's end `place` lies, along the middle between its bounds [m], to a micrometre: of a stop
/// line. 0 for what lies behind its end or farther from its begin than it is long, or without usable bounds. O(points).
[[nodiscard]] double distance_before_end(Lanelet const& lanelet, geometry::Point const& place);

/// The ends, left and right, of a line across the lanelet that far before its end [m]; nothing without usable bounds.
/// O(points).
[[nodiscard]] std::optional<std::array<geometry::Point, 2>> line_before_end(Lanelet const& lanelet, double distance);

/// The drivable lanes of a map as lanelets, whose ids are those of the lanes plus `first_id`: what a writer of lanelet
/// formats needs. The lanes of a section are cut, to a metre, where their limits or permitted changes change; the parts
/// behind the first have ids beyond those of all lanes. O(lanes log points).
[[nodiscard]] std::vector<Lanelet> lanelets_of(Map const& map, std::int64_t first_id = 1);

}  // namespace cambium::inline v0_1::map

#ifndef CAMBIUM_COMPILED
#include "cambium/map/lanelet/lanelet_map_impl.hpp"
#endif
