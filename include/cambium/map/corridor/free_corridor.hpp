#pragma once

#include <memory>
#include <span>

#include "cambium/geometry/pose.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/road/lane_type.hpp"

namespace cambium::inline v0_1::map {

/// Properties of a free corridor.
struct FreeCorridorOptions {
  double width = 2.0;                 ///< half of it to either side of the points [m]
  LaneType type = LaneType::walking;  ///< what it is for
  double view = 200.0;                ///< how far back the lanes that it crosses are looked along [m]

  friend bool operator==(FreeCorridorOptions const&, FreeCorridorOptions const&) = default;
};

/// A way through `points` [m], its corners rounded, that belongs to no lane, as a road corridor of one lane corridor:
/// for pedestrians and cyclists who move beside the lanes and across them. Its `crossings` are the drivable lanes that
/// it crosses, whose traffic goes first; a way along a lane is one long crossing of it. Bridges count as level. Worlds
/// take it in `AgentSpec::road`; give agents on one way the same corridor, so that they are neighbours on it. Throws
/// `MapError` for fewer than two distinct points, numbers that are not finite, a length beyond 10 km, a width or
/// view that is not positive, or a type of lane to drive on. O(length log lanes).
[[nodiscard]] inline std::shared_ptr<RoadCorridor const> build_free_corridor(Map const& map,
                                                                             std::span<geometry::Point const> points,
                                                                             FreeCorridorOptions const& options = {}) {
  return map.queries().free_corridor(map, points, options);
}

/// What `road` was built with by `build_free_corridor`.
[[nodiscard]] inline FreeCorridorOptions free_corridor_options(RoadCorridor const& road) {
  auto const& corridor = road.corridors.front();
  return {.width = 2.0 * corridor.widths.front().left, .type = corridor.pieces.front().type, .view = road.view};
}

}  // namespace cambium::inline v0_1::map
