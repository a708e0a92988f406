#pragma once

#include <algorithm>
#include <cmath>
#include <compare>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/polygon.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/routing/route.hpp"

namespace cambium::inline v0_1::map::detail {

inline constexpr double goal_radius = 5.0;  ///< how far from a lane a start or goal may be [m]

[[nodiscard]] inline std::string place_text(geometry::Point const& p) {
  return "(" + cambium::detail::rounded_text(p.x()) + ", " + cambium::detail::rounded_text(p.y()) + ")";
}

/// The drivable lanes that hold `p`; where none does, the nearest one.
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
  double const radius = portable::hypot(box.max_x - center.x(), box.max_y - center.y());
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

/// The lanes by which traffic in one direction comes onto a road, or leaves it.
[[nodiscard]] inline std::vector<LaneId> lanes_at_end(Map const& map, Road const& road, RoadDirection direction,
                                                      bool entry) {
  bool const forward = direction == RoadDirection::forward;
  std::vector<LaneId> lanes;
  for (std::size_t i = 0; i < road.sections.size() && lanes.empty(); ++i) {
    auto const& section = road.sections[forward == entry ? i : road.sections.size() - 1 - i];
    for (auto const& lane : section.lanes)
      for (auto const id : {lane.id, lane.opposite})
        if (is_valid(id) && map.lane(id).drivable() && map.lane(id).along_road == forward) lanes.push_back(id);
  }
  return lanes;
}

/// The cheapest lanes along a list of roads, in which a road may come more than once: Dijkstra's algorithm over the
/// lanes of each entry of the list. O(n log n) in those lanes.
class RoadListSearch {
 public:
  /// Both must outlive the search; `order` is not empty.
  RoadListSearch(Map const& map, std::span<RoadId const> order) : map_(map), order_(order) {}

  /// The route from the begin of the first road, driven in `direction`, to the end of the last one.
  [[nodiscard]] std::optional<Route> find(RoadDirection direction) {
    find_exits(direction);
    for (auto const lane : lanes_at_end(map_, map_.road(order_.front()), direction, true))
      offer({0, lane}, 0.0, {0, lane});
    while (!open_.empty()) {
      auto const [cost, place] = *open_.begin();
      open_.erase(open_.begin());
      if (place.step == order_.size()) return route_to(place, cost);
      follow(place, cost);
    }
    return std::nullopt;
  }

 private:
  /// A lane of the list's entry `step`; one step further, the end of the list.
  struct Place {
    std::size_t step{};
    LaneId lane = none<LaneId>;
    friend auto operator<=>(Place const&, Place const&) = default;
  };
  struct Reached {
    double cost{};
    Place from;
  };

  void find_exits(RoadDirection direction) {
    for (auto const way : {RoadDirection::forward, RoadDirection::backward}) {
      if (order_.size() == 1 && way != direction) continue;
      for (auto const lane : lanes_at_end(map_, map_.road(order_.back()), way, false)) exits_.push_back(lane);
    }
  }

  void offer(Place const& to, double cost, Place const& from) {
    auto const [known, is_new] = reached_.try_emplace(to, Reached{cost, from});
    if (!is_new) {
      if (known->second.cost <= cost) return;
      open_.erase({known->second.cost, to});
      known->second = {cost, from};
    }
    open_.emplace(cost, to);
  }

  void follow(Place const& at, double cost) {
    auto const& lane = map_.lane(at.lane);
    for (auto const side : {lane.left_neighbor, lane.right_neighbor})
      if (is_valid(side) && map_.lane(side).drivable()) offer({at.step, side}, cost + lane_change_cost_, at);
    for (auto const next : lane.successors) {
      if (!map_.lane(next).drivable()) continue;
      if (stays_on_road(lane, map_.lane(next)))
        offer({at.step, next}, cost + lane.length(), at);
      else if (at.step + 1 < order_.size() && map_.lane(next).road == order_[at.step + 1])
        offer({at.step + 1, next}, cost + lane.length(), at);
    }
    bool const leaves = std::find(exits_.begin(), exits_.end(), at.lane) != exits_.end();
    if (leaves && at.step + 1 == order_.size()) offer({order_.size(), at.lane}, cost + lane.length(), at);
  }

  /// Whether a lane's successor is in one of the road's further sections, and not at its other end.
  [[nodiscard]] static bool stays_on_road(Lane const& lane, Lane const& next) {
    return next.road == lane.road && next.along_road == lane.along_road &&
           (lane.along_road ? next.section > lane.section : next.section < lane.section);
  }

  [[nodiscard]] Route route_to(Place const& end, double cost) const {
    Route route{{}, map_.lane(end.lane).length(), cost};
    for (Place at = reached_.at(end).from;; at = reached_.at(at).from) {
      if (!route.lanes.empty()) {
        auto const& ahead = map_.lane(at.lane).successors;
        if (std::find(ahead.begin(), ahead.end(), route.lanes.back()) != ahead.end())
          route.length += map_.lane(at.lane).length();
      }
      route.lanes.push_back(at.lane);
      if (reached_.at(at).from == at) break;
    }
    std::reverse(route.lanes.begin(), route.lanes.end());
    return route;
  }

  Map const& map_;
  std::span<RoadId const> order_;
  double lane_change_cost_ = RouteOptions{}.lane_change_cost;  // [m]
  std::vector<LaneId> exits_;
  std::map<Place, Reached> reached_;
  std::set<std::pair<double, Place>> open_;
};

// See the `build_road_corridor`s of build_corridor.hpp.

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

}  // namespace cambium::inline v0_1::map::detail
