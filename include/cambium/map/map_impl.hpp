#pragma once

#include <algorithm>

#include "cambium/core/portable_math.hpp"
#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/map/corridor/detail/built_corridors.hpp"
#include "cambium/map/corridor/detail/corridor_signals.hpp"
#include "cambium/map/corridor/detail/find_road_corridor.hpp"
#include "cambium/map/corridor/detail/junction_areas.hpp"
#include "cambium/map/corridor/detail/make_free_corridor.hpp"
#include "cambium/map/corridor/detail/make_road_corridor.hpp"
#include "cambium/map/corridor/stop_lines.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/routing/detail/find_routes.hpp"

namespace cambium::inline v0_1::map {

namespace detail {

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
      geometry::Point const aside(-portable::sin(at.heading), portable::cos(at.heading));
      StopLine const line{at.position() + widths.left * aside, at.position() - widths.right * aside, signal.light};
      bool const is_known = std::any_of(lines.begin(), lines.end(), [&line](StopLine const& known) {
        return known.light == line.light && (known.left - line.left).norm() + (known.right - line.right).norm() < 0.2;
      });
      if (!is_known) lines.push_back(line);
    }
  }
  return lines;
}

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
  [[nodiscard]] std::vector<Corridor> roads_ahead(Map const& map, LaneId from) const override {
    std::vector<Corridor> roads;
    for (auto const& route : routes_ahead(map, from)) roads.push_back(road_corridor(map, route.lanes));
    return roads;
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

}  // namespace cambium::inline v0_1::map
