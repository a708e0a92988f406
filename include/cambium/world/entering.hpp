#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/goal/goal.hpp"
#include "cambium/map/build_corridor.hpp"
#include "cambium/map/map.hpp"
#include "cambium/world/static_object.hpp"
#include "cambium/world/traffic_index.hpp"

namespace cambium::detail {

/// Farthest that an agent may enter from the nearest lane [m].
inline constexpr double entering_radius = 5.0;
/// Farthest that an agent with a route may enter from the path of one of its lanes [m].
inline constexpr double path_radius = 2.5;

/// The nearest lane of `route` at `position`: a path that swings over to its neighbour counts as its own lane there.
[[nodiscard]] inline LaneId entering_lane(Map const& map, geometry::Point const& position, map::Route const& route, std::string const& where) {
  LaneId nearest = none<LaneId>;
  double smallest = path_radius;
  for (auto const id : route.lanes) {
    if (index_of(id) >= map.lanes().size()) throw WorldError(where, "its route names a lane that the map does not have", "use Map::find_lane");
    auto const& lane = map.lane(id);
    auto const foot = lane.path.project(position);
    double const distance = std::hypot(foot.lateral, std::max({-foot.s, foot.s - lane.length(), 0.0}));
    if (distance >= smallest) continue;
    smallest = distance;
    nearest = id;
  }
  if (!is_valid(nearest)) throw WorldError(where, "no lane of its route comes within 2.5 m of its position", "begin the route there");
  return nearest;
}

/// The drivable lane at `position`; without a heading the nearest one. Throws `WorldError` where there is none.
[[nodiscard]] inline LaneId entering_lane(Map const& map, geometry::Point const& position, std::optional<double> heading,
                                          std::string const& where) {
  if (heading) {
    if (auto const hit = map.nearest_lane({position.x(), position.y(), *heading}, entering_radius)) return hit->lane;
  } else {
    for (auto const& hit : map.lanes_near(position, entering_radius))
      if (map.lane(hit.lane).drivable()) return hit.lane;
  }
  throw WorldError(where, "no drivable lane within " + std::to_string(static_cast<int>(entering_radius)) + " m of its position",
                   "enter on a lane and along its direction");
}

/// The lane where a goal's route ends; nothing for goals without a place.
[[nodiscard]] inline std::optional<LaneId> destination(Map const& map, Goal const& goal, std::string const& where) {
  if (auto const* lane = std::get_if<ReachLane>(&goal)) {
    if (index_of(lane->lane) >= map.lanes().size())
      throw WorldError(where, "its goal names lane " + to_string(lane->lane) + ", which the map does not have", "use Map::find_lane");
    return lane->lane;
  }
  if (auto const* polygon = std::get_if<ReachPolygon>(&goal)) {
    geometry::Point center(0, 0);
    for (auto const& p : polygon->area.points()) center += p;
    return entering_lane(map, center / static_cast<double>(polygon->area.points().size()), std::nullopt, where + ": its goal");
  }
  return std::nullopt;
}

/// The route from `start`: as given, else to the goal, else straight on. Throws `WorldError` where there is none.
[[nodiscard]] inline map::Route entering_route(Map const& map, LaneId start, std::optional<map::Route> const& given, Goal const& goal,
                                               std::string const& where) {
  if (given) return *given;
  if (auto const end = destination(map, goal, where)) {
    if (auto route = map.shortest_route(start, *end)) return *route;
    throw WorldError(where, "there is no route from " + map.describe(start) + " to " + map.describe(*end), "choose a goal that the lane leads to");
  }
  return map::straight_route(map, start);
}

/// A corridor of `road` that holds `lane`: the main one if it does.
[[nodiscard]] inline std::uint16_t entering_corridor(map::RoadCorridor const& road, LaneId lane) {
  for (auto const& piece : road.corridors[road.main].pieces)
    if (piece.lane == lane) return road.main;
  return road.corridor_of(lane);
}

/// Index entries of a static object: one in each drivable lane whose borders it reaches across.
[[nodiscard]] inline std::vector<TrafficEntry> object_entries(Map const& map, StaticObject const& object, std::uint32_t slot) {
  constexpr double spacing = 0.5;  // [m] between the points of the outline that are looked at
  std::vector<geometry::Point> points;
  auto const& corners = object.outline.points();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    geometry::Point const a = corners[i], b = corners[(i + 1) % corners.size()];
    int const parts = std::max(1, static_cast<int>(std::ceil((b - a).norm() / spacing)));
    for (int k = 0; k < parts; ++k) points.emplace_back(a + (b - a) * (static_cast<double>(k) / parts));
  }
  struct Stretch {
    double begin = std::numeric_limits<double>::infinity(), end = -std::numeric_limits<double>::infinity();
  };
  std::map<LaneId, Stretch> stretches;
  for (auto const& p : points)
    for (auto const& hit : map.lanes_near(p, 0.0)) {
      if (!map.lane(hit.lane).drivable()) continue;
      auto& stretch = stretches[hit.lane];
      stretch.begin = std::min(stretch.begin, hit.s);
      stretch.end = std::max(stretch.end, hit.s);
    }
  std::vector<TrafficEntry> entries;
  for (auto const& [lane, stretch] : stretches) {
    double const half = (stretch.end - stretch.begin) / 2;
    entries.push_back({map.lane(lane).index_begin + stretch.begin + half, half, half, 0.0, slot, static_cast<std::uint32_t>(object.id)});
  }
  return entries;
}

}  // namespace cambium::detail
