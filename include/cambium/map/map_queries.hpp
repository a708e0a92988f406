#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/map/fwd.hpp"
#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/routing/route.hpp"

namespace cambium::inline v0_1::geometry {
class Polygon;
}

namespace cambium::inline v0_1::map {

/// The rare queries of a map that take long to compile: routes, corridors, areas of junctions. Whoever makes a map
/// compiles them (`map_impl.hpp`); everybody else calls them through the map, by the functions named here.
class MapQueries {
 public:
  using Corridor = std::shared_ptr<RoadCorridor const>;

  virtual ~MapQueries() = default;
  /// `Map::routes`, `Map::reachable`.
  [[nodiscard]] virtual std::vector<Route> routes(std::span<Lane const> lanes, LaneStation from, LaneStation to,
                                                  RouteOptions const& options) const = 0;
  [[nodiscard]] virtual std::vector<ReachedLane> reachable(std::span<Lane const> lanes, LaneStation from, double budget,
                                                           RouteOptions const& options) const = 0;
  /// `straight_route`, `roads_ahead`, and the `build_road_corridor`s.
  [[nodiscard]] virtual Route straight_route(Map const& map, LaneId from, double max_length) const = 0;
  [[nodiscard]] virtual std::vector<Corridor> roads_ahead(Map const& map, LaneId from) const = 0;
  [[nodiscard]] virtual Corridor road_corridor(Map const& map, std::vector<LaneId> const& route) const = 0;
  [[nodiscard]] virtual Corridor road_corridor(Map const& map, geometry::Pose const& start, geometry::Point const& goal,
                                               RouteOptions const& options) const = 0;
  [[nodiscard]] virtual Corridor road_corridor(Map const& map, geometry::Pose const& start,
                                               geometry::Polygon const& goal, RouteOptions const& options) const = 0;
  [[nodiscard]] virtual Corridor road_corridor(Map const& map, std::span<std::string const> roads,
                                               RoadDirection direction) const = 0;
  /// `build_free_corridor`.
  [[nodiscard]] virtual Corridor free_corridor(Map const& map, std::span<geometry::Point const> points,
                                               FreeCorridorOptions const& options) const = 0;
  /// `junction_area`, `conflict_areas`, `stop_lines`.
  [[nodiscard]] virtual std::optional<geometry::Polygon> junction_area(Map const& map, JunctionId id) const = 0;
  [[nodiscard]] virtual std::vector<ConflictArea> conflict_areas(Map const& map, JunctionId id) const = 0;
  [[nodiscard]] virtual std::vector<StopLine> stop_lines(Map const& map) const = 0;
};

}  // namespace cambium::inline v0_1::map
