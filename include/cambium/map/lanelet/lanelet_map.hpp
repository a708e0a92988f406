#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "cambium/core/diagnostic.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/map/lanelet/lanelet.hpp"
#include "cambium/map/map.hpp"

namespace cambium::map {

/// A map made of lanelets.
struct LaneletMap {
  std::shared_ptr<Map const> map;
  std::map<std::int64_t, LaneId> lanes;  ///< by the id of the lanelet; without those that were left out
  std::vector<Diagnostic> diagnostics;
};

/// The map of `lanelets`; `file` names them in messages. Lanelets side by side become one road (named by the id of the
/// leftmost), those that cross others, with those that leave or enter the road beside them, a junction. What cannot be
/// used is left out, with a diagnostic: bounds that cross or have fewer than two points, links to lanelets that are not
/// there or do not begin where the other ends (to 0.5 m and 0.5 rad), neighbours that do not lie beside each other.
/// Traffic keeps to the right. Throws `MapError` where no lanelet is left, and as `build_map`. O(n^2) comparisons of
/// boxes for n lanelets.
[[nodiscard]] LaneletMap build_lanelet_map(std::vector<Lanelet> lanelets, MapOptions const& options = {},
                                           std::string const& file = "lanelets");

/// The drivable lanes of a map as lanelets, whose ids are those of the lanes plus `first_id`: what a writer of lanelet
/// formats needs. Linear in the map.
[[nodiscard]] std::vector<Lanelet> lanelets_of(Map const& map, std::int64_t first_id = 1);

}  // namespace cambium::map

#ifndef CAMBIUM_COMPILED
#include "cambium/map/lanelet/lanelet_map_impl.hpp"
#endif
