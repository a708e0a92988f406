#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/routing/route.hpp"

namespace cambium::inline v0_1::map {

/// The way straight on from `from`: at forks the successor that turns least (within 50 m), of equal ones the smallest
/// id. Ends at a dead end, where a lane would come again, or with the lane that makes it `max_length` [m] long. Throws
/// `MapError` for a lane that the map does not have.
[[nodiscard]] inline Route straight_route(Map const& map, LaneId from, double max_length = Map::straight_on) {
  return map.queries().straight_route(map, from, max_length);
}

/// The road corridor along `route`: its lanes and all beside them, as lane corridors. Throws `MapError` where the route
/// has no lane, names one that the map does not have, or jumps.
///
/// A lane corridor follows successors as long as these are beside the route: at forks it stays on the route if it can,
/// else it goes straight on. A lane that merges into its neighbour continues there, so two lane corridors may share
/// their further lanes. A lane that opens beside the route begins a lane corridor of its own. Where consecutive lanes
/// do not quite meet, the corridor bridges the gap within 1 m (or twice the gap). The feeders of a lane corridor are
/// lanes that are not in it:
/// - lanes that merge into it: on the overlap, and from `MapOptions::merge_view` before it on, free until the overlap
/// begins;
/// - lanes that lead into one of its lanes without an overlap: likewise, free until that lane begins;
/// - lanes that have just split off: on the overlap;
/// - lanes that lead to its begin: 100 m back, with negative images (of a ring, the corridor's own last lanes too).
/// Lanes that cross the corridor are no feeders but conflicts, and so are lanes that merge with it in a junction. No
/// stretch of a lane has two images in one corridor.
///
/// The map remembers road corridors: the same route gives the same object again, at once, as long as it is in use or
/// among the last 8 MB that were asked for. Older ones are dropped whenever 8 MB of new ones have come. Safe on many
/// threads.
[[nodiscard]] inline std::shared_ptr<RoadCorridor const> build_road_corridor(Map const& map, Route const& route) {
  return map.queries().road_corridor(map, route.lanes);
}

/// The roads by which traffic in lane `from` may go on: one for each way at the first fork within 120 m, 300 m straight
/// on from there; where there is no fork, the one straight on. All begin with `from`. Throws `MapError` for a lane that
/// the map does not have. The map remembers them as above; building one takes up to a millisecond.
[[nodiscard]] inline std::vector<std::shared_ptr<RoadCorridor const>> roads_ahead(Map const& map, LaneId from) {
  return map.queries().roads_ahead(map, from);
}

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

}  // namespace cambium::inline v0_1::map
