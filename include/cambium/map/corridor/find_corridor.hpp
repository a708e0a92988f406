#pragma once

#include <memory>
#include <span>
#include <string>

#include "cambium/geometry/pose.hpp"
#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/routing/route.hpp"

namespace cambium::map {

/// The road corridor along the cheapest route from the lane at `start` (see `Map::nearest_lane`) to a lane at `goal`.
/// Throws `MapError` where there is no lane within 5 m of either, or no route.
[[nodiscard]] inline std::shared_ptr<RoadCorridor const> build_road_corridor(Map const& map,
                                                                             geometry::Pose const& start,
                                                                             geometry::Point const& goal,
                                                                             RouteOptions const& options = {}) {
  return map.queries().road_corridor(map, start, goal, options);
}

/// As above, to the first place in the polygon `goal` that a route comes to, which is the start where it holds that;
/// where no lane passes through it, to its middle.
[[nodiscard]] inline std::shared_ptr<RoadCorridor const> build_road_corridor(Map const& map,
                                                                             geometry::Pose const& start,
                                                                             geometry::Polygon const& goal,
                                                                             RouteOptions const& options = {}) {
  return map.queries().road_corridor(map, start, goal, options);
}

/// The road corridor along roads, given by the file's ids in the order in which they are driven, the first one in
/// `direction`; a road may come again. Lanes are changed where that is needed, whatever the marks say. Throws
/// `MapError` for a road that the map does not have, and where the roads do not lead into each other that way. O(n log
/// n) in the lanes of the roads, but for the corridor.
[[nodiscard]] inline std::shared_ptr<RoadCorridor const> build_road_corridor(Map const& map,
                                                                             std::span<std::string const> roads,
                                                                             RoadDirection direction) {
  return map.queries().road_corridor(map, roads, direction);
}

}  // namespace cambium::map
