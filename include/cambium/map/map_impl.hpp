#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cambium/core/macros.hpp"
#include "cambium/map/corridor/detail/built_corridors.hpp"
#include "cambium/map/corridor/detail/find_road_corridor.hpp"
#include "cambium/map/corridor/detail/find_stop_lines.hpp"
#include "cambium/map/corridor/detail/junction_areas.hpp"
#include "cambium/map/corridor/detail/make_free_corridor.hpp"
#include "cambium/map/corridor/detail/make_road_corridor.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/routing/detail/find_routes.hpp"

namespace cambium::map {

namespace detail {

/// Answers by the functions of this room, and remembers the road corridors along routes.
class CompiledQueries final : public MapQueries {
 public:
  [[nodiscard]] std::vector<Route> routes(std::span<Lane const> lanes, LaneStation from, LaneStation to,
                                          RouteOptions const& options) const override {
    return find_routes(lanes, from, to, options);
  }
  [[nodiscard]] std::vector<ReachedLane> reachable(std::span<Lane const> lanes, LaneStation from, double budget,
                                                   RouteOptions const& options) const override {
    return find_reachable(lanes, from, budget, options);
  }
  [[nodiscard]] Route straight_route(Map const& map, LaneId from, double max_length) const override {
    return detail::straight_route(map, from, max_length);
  }
  [[nodiscard]] Corridor road_corridor(Map const& map, std::vector<LaneId> const& route) const override {
    if (auto known = built_.find(route)) return known;
    return built_.add(make_road_corridor(map, route));
  }
  [[nodiscard]] Corridor road_corridor(Map const& map, geometry::Pose const& start, geometry::Point const& goal,
                                       RouteOptions const& options) const override {
    return find_road_corridor(map, start, goal, options);
  }
  [[nodiscard]] Corridor road_corridor(Map const& map, geometry::Pose const& start, geometry::Polygon const& goal,
                                       RouteOptions const& options) const override {
    return find_road_corridor(map, start, goal, options);
  }
  [[nodiscard]] Corridor road_corridor(Map const& map, std::span<std::string const> roads,
                                       RoadDirection direction) const override {
    return find_road_corridor(map, roads, direction);
  }
  [[nodiscard]] Corridor free_corridor(Map const& map, std::span<geometry::Point const> points,
                                       FreeCorridorOptions const& options) const override {
    return make_free_corridor(map, points, options);
  }
  [[nodiscard]] std::optional<geometry::Polygon> junction_area(Map const& map, JunctionId id) const override {
    return detail::junction_area(map, id);
  }
  [[nodiscard]] std::vector<ConflictArea> conflict_areas(Map const& map, JunctionId id) const override {
    return detail::conflict_areas(map, id);
  }
  [[nodiscard]] std::vector<StopLine> stop_lines(Map const& map) const override { return find_stop_lines(map); }

 private:
  mutable BuiltCorridors built_;  ///< safe on many threads
};

[[nodiscard]] inline geometry::Box bounds_of(std::span<Lane const> lanes) {
  geometry::Box box;
  for (auto const& lane : lanes)
    for (auto const* line : {&lane.path, &lane.left, &lane.right})
      for (auto const& p : line->points()) box.add(p.x(), p.y());
  return box;
}

}  // namespace detail

CAMBIUM_COLD Map::Map(Parts parts)
    : parts_(std::move(parts)),
      tree_(parts_.lanes),
      bounds_(detail::bounds_of(parts_.lanes)),
      queries_(std::make_unique<detail::CompiledQueries const>()) {}

}  // namespace cambium::map
