#pragma once

#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/geometry/polygon.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/corridor/detail/road_list_search.hpp"
#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/routing/route.hpp"

namespace cambium::map::detail {

inline constexpr double goal_radius = 5.0;  ///< how far from a lane a start or goal may be [m]

[[nodiscard]] inline std::string place_text(geometry::Point const& p) {
  return "(" + cambium::detail::rounded_text(p.x()) + ", " + cambium::detail::rounded_text(p.y()) + ")";
}

/// The drivable lanes that hold `p`; where none does the nearest one.
[[nodiscard]] inline std::vector<LaneStation> stations_at(Map const& map, geometry::Point const& p) {
  std::vector<LaneStation> stations;
  for (auto const& hit : map.lanes_near(p, goal_radius))
    if (map.lane(hit.lane).drivable() && (hit.distance == 0.0 || stations.empty()))
      stations.push_back({hit.lane, hit.s});
  return stations;
}

/// Where the paths of drivable lanes come into `area` first; where none does, the lanes at its middle.
[[nodiscard]] inline std::vector<LaneStation> stations_in(Map const& map, geometry::Polygon const& area) {
  constexpr double step = 0.5;  // [m]
  auto const& box = area.bounding_box();
  auto const center = box.center();
  double const radius = std::hypot(box.max_x - center.x(), box.max_y - center.y());
  std::vector<LaneStation> stations;
  for (auto const& hit : map.lanes_near(center, radius)) {
    auto const& lane = map.lane(hit.lane);
    if (!lane.drivable()) continue;
    int const count = static_cast<int>(std::ceil(lane.length() / step));
    for (int i = 0; i <= count; ++i) {
      double const s = lane.length() * i / count;
      if (!area.contains(lane.path.pose(s).position())) continue;
      stations.push_back({hit.lane, s});
      break;
    }
  }
  return stations.empty() ? stations_at(map, center) : stations;
}

/// The corridor along the cheapest route from `start` to any of `goals`.
[[nodiscard]] inline std::shared_ptr<RoadCorridor const> corridor_to(Map const& map, geometry::Pose const& start,
                                                                     std::span<LaneStation const> goals,
                                                                     geometry::Point const& goal,
                                                                     RouteOptions const& options) {
  auto const from = map.nearest_lane(start, goal_radius);
  if (!from)
    throw MapError("road corridor", "no drivable lane near its start " + place_text(start.position()),
                   "start within 5 m of a lane and along it");
  if (goals.empty())
    throw MapError("road corridor", "no drivable lane near its goal " + place_text(goal),
                   "give a goal within 5 m of a lane");
  std::optional<Route> best;
  for (auto const& to : goals) {
    auto route = map.shortest_route({from->lane, from->s}, to, options);
    if (route && (!best || route->cost < best->cost)) best = std::move(route);
  }
  if (!best)
    throw MapError("road corridor",
                   "there is no route from " + map.describe(from->lane) + " to " + map.describe(goals.front().lane),
                   "choose a goal that the lane leads to");
  return map.queries().road_corridor(map, best->lanes);
}

// See the `build_road_corridor`s of find_corridor.hpp.

[[nodiscard]] inline std::shared_ptr<RoadCorridor const> find_road_corridor(Map const& map, geometry::Pose const& start,
                                                                            geometry::Point const& goal,
                                                                            RouteOptions const& options) {
  return corridor_to(map, start, stations_at(map, goal), goal, options);
}

[[nodiscard]] inline std::shared_ptr<RoadCorridor const> find_road_corridor(Map const& map, geometry::Pose const& start,
                                                                            geometry::Polygon const& goal,
                                                                            RouteOptions const& options) {
  auto goals = stations_in(map, goal);
  if (auto const from = map.nearest_lane(start, goal_radius); from && goal.contains(start.position()))
    goals = {{from->lane, from->s}};
  return corridor_to(map, start, goals, goal.bounding_box().center(), options);
}

[[nodiscard]] inline std::shared_ptr<RoadCorridor const> find_road_corridor(Map const& map,
                                                                            std::span<std::string const> roads,
                                                                            RoadDirection direction) {
  std::vector<RoadId> order;
  for (auto const& name : roads) order.push_back(map.find_road(name).id);
  if (order.empty()) throw MapError("road corridor", "it has no road", "give at least one");
  if (auto const route = RoadListSearch(map, order).find(direction))
    return map.queries().road_corridor(map, route->lanes);
  std::string names;
  for (auto const& name : roads) names += (names.empty() ? "" : ", ") + name;
  throw MapError("road corridor", "the roads " + names + " do not lead into each other in this direction",
                 "list every road on the way, connecting roads too");
}

}  // namespace cambium::map::detail
