#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/goal/goal.hpp"
#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/routing/route.hpp"
#include "cambium/world/detail/check_described.hpp"
#include "cambium/world/detail/objects_on_lanes.hpp"
#include "cambium/world/detail/refusals.hpp"

namespace cambium::inline v0_1::detail {

/// The lane of `route` whose path is nearest to `position`, where each radian of heading error counts as 3 m. The path
/// decides and not the borders, because a merging lane's path leaves the lane. Throws `WorldError` if each lane is more
/// than `entering_radius` away or runs against `heading`.
[[nodiscard]] inline LaneId entering_lane(Map const& map, geometry::Point const& position,
                                          std::optional<double> heading, map::Route const& route,
                                          std::string const& where) {
  if (route.lanes.empty()) throw WorldError(where, "its route is empty", "leave the route out to get the shortest");
  LaneId best = none<LaneId>;
  double smallest = std::numeric_limits<double>::infinity();
  for (auto const id : route.lanes) {
    if (index_of(id) >= map.lanes().size())
      throw WorldError(where, "its route names a lane that the map does not have", "use Map::find_lane");
    auto const& lane = map.lane(id);
    auto const foot = lane.path.project(position);
    auto const widths = lane.widths_at(std::clamp(foot.s, 0.0, lane.length()));
    double const beyond = std::max({-foot.s, foot.s - lane.length(), 0.0});
    double const outside =
        portable::hypot(std::max({foot.lateral - widths.left, -foot.lateral - widths.right, 0.0}), beyond);
    double const distance = portable::hypot(foot.lateral, beyond);
    double const along = lane.path.pose(foot.s).heading;
    double const turn = heading ? std::abs(geometry::angle_difference(*heading, along)) : 0.0;
    if (outside > entering_radius || turn > geometry::pi / 2 || distance + 3.0 * turn >= smallest) continue;
    smallest = distance + 3.0 * turn;
    best = id;
  }
  if (!is_valid(best))
    throw WorldError(
        where,
        "no lane of its route comes within " + rounded_text(entering_radius) + " m of its position, in its direction",
        "give a route that starts at the position");
  return best;
}

/// The drivable lane at `position` that fits `heading`; without a heading, the nearest one. Throws `WorldError` if
/// there is none within `entering_radius`.
[[nodiscard]] inline LaneId entering_lane(Map const& map, geometry::Point const& position,
                                          std::optional<double> heading, std::string const& where) {
  if (heading) {
    if (auto const hit = map.nearest_lane({position.x(), position.y(), *heading}, entering_radius)) return hit->lane;
  } else {
    for (auto const& hit : map.lanes_near(position, entering_radius))
      if (map.lane(hit.lane).drivable()) return hit.lane;
  }
  throw WorldError(where, "no drivable lane within " + rounded_text(entering_radius) + " m of its position",
                   "give a position on a lane and a heading along it");
}

/// Throws `WorldError` if the map has no such lane.
inline void check_lane_of_goal(Map const& map, LaneId lane, std::string const& where) {
  if (index_of(lane) >= map.lanes().size())
    throw WorldError(where, "its goal names lane " + to_string(lane) + ", which the map does not have",
                     "use Map::find_lane");
}

/// Throws `WorldError` if the map has no such lane, or if the stretch from `from` to `to` [m] lies outside it.
inline void check_stretch_of(Map const& map, LaneId lane, double from, double to, std::string const& where) {
  check_lane_of_goal(map, lane, where);
  if (double const length = map.lane(lane).length(); from > length || to < 0.0)
    throw WorldError(
        where,
        "its goal's stretch lies outside lane " + to_string(lane) + ", which is " + rounded_text(length) + " m long",
        "give from and to as arc lengths on the lane's path");
}

/// See `entering_goal`.
[[nodiscard]] inline Goal complete_goal(Map const& map, Goal goal, LaneId lane, std::string const& where,
                                        bool is_outer) {
  check_if_described(goal, where);
  if (auto const* const reach = std::get_if<ReachLane>(&goal))
    check_stretch_of(map, reach->lane, reach->from, reach->to, where);
  if (auto const* const limits = std::get_if<LaneLimits>(&goal); limits && is_valid(limits->lane))
    check_stretch_of(map, limits->lane, limits->from, limits->to, where);
  if (auto* const beside = std::get_if<ReachLaneBeside>(&goal); beside && !is_valid(beside->from)) beside->from = lane;
  if (auto const* const own = std::get_if<OwnGoal>(&goal)) own->check(where);
  auto const complete = [&](std::vector<Goal>& parts) {
    if (parts.empty())
      throw WorldError(where, "its goal has no parts and can never be reached", "give it parts, or NoGoal");
    for (auto& part : parts) part = complete_goal(map, std::move(part), lane, where, false);
  };
  if (auto* const all = std::get_if<AllGoals>(&goal)) complete(all->parts);
  if (auto* const any = std::get_if<AnyGoal>(&goal)) complete(any->parts);
  if (auto* const sequence = std::get_if<GoalSequence>(&goal)) {
    if (!is_outer)
      throw WorldError(where, "its goal has a sequence within another goal", "make the sequence the outermost goal");
    if (sequence->parts.size() > 255)
      throw WorldError(where, "its goal is a sequence of more than 255 parts", "leave some out");
    complete(sequence->parts);
  }
  return goal;
}

/// Collects the lanes where the route to a goal may end.
class Destinations {
 public:
  Destinations(Map const& map, std::string const& where) : map_(&map), where_(&where) {}

  [[nodiscard]] std::vector<LaneId> of(Goal const& goal) const {
    return goal.visit([this](auto const& g) { return lanes(g); });
  }

 private:
  template <class G>
  [[nodiscard]] std::vector<LaneId> lanes(G const&) const {
    return {};
  }

  [[nodiscard]] std::vector<LaneId> lanes(ReachLane const& goal) const {
    check_stretch_of(*map_, goal.lane, goal.from, goal.to, *where_);
    return {goal.lane};
  }
  [[nodiscard]] std::vector<LaneId> lanes(LaneLimits const& goal) const {
    if (!is_valid(goal.lane)) return {};
    check_stretch_of(*map_, goal.lane, goal.from, goal.to, *where_);
    return {goal.lane};
  }

  /// If several goals must hold at once, the route leads to the first one that names lanes.
  [[nodiscard]] std::vector<LaneId> lanes(AllGoals const& goal) const {
    std::vector<LaneId> first;
    for (auto const& part : goal.parts)
      if (auto found = of(part); first.empty()) first = std::move(found);
    return first;
  }
  [[nodiscard]] std::vector<LaneId> lanes(AnyGoal const& goal) const {
    std::vector<LaneId> all;
    for (auto const& part : goal.parts)
      for (auto const lane : of(part)) all.push_back(lane);
    return all;
  }

  [[nodiscard]] std::vector<LaneId> lanes(OwnGoal const& goal) const {
    auto lanes = goal.lanes(*map_);
    for (auto const lane : lanes) check_lane_of_goal(*map_, lane, *where_);
    return lanes;
  }

  [[nodiscard]] std::vector<LaneId> lanes(ReachPolygon const& goal) const {
    std::vector<LaneId> lanes;
    auto points = points_around(goal.area, 1.0);
    points.insert(points.begin(), goal.area.bounding_box().center());
    for (auto const& p : points)
      for (auto const& hit : map_->lanes_near(p, entering_radius))
        if (map_->lane(hit.lane).drivable() && std::find(lanes.begin(), lanes.end(), hit.lane) == lanes.end())
          lanes.push_back(hit.lane);
    if (lanes.empty())
      throw WorldError(*where_, "its goal, a polygon, is not near a drivable lane",
                       "give a goal on a lane, or add the agent with a route");
    return lanes;
  }

  Map const* map_;
  std::string const* where_;
};

/// The shortest route from `start` to the first reachable lane of `ends`. Throws `WorldError` if none is reachable.
[[nodiscard]] inline map::Route route_to_one(Map const& map, LaneId start, std::vector<LaneId> const& ends,
                                             std::string const& where) {
  for (auto const end : ends)
    if (auto route = map.shortest_route(start, end)) return *route;
  throw WorldError(where, "there is no route from " + map.describe(start) + " to " + map.describe(ends.front()),
                   "choose a goal that can be reached from that lane");
}

/// The route from `start`: the given one; else the one to the goal, through all parts of a sequence; without a goal,
/// straight on. Throws `WorldError` if no route leads to the goal.
[[nodiscard]] inline map::Route entering_route(Map const& map, LaneId start, std::optional<map::Route> const& given,
                                               Goal const& goal, std::string const& where) {
  if (given) return *given;
  Destinations const destinations(map, where);
  auto const* const sequence = std::get_if<GoalSequence>(&goal);
  std::size_t const stages = sequence ? sequence->parts.size() : 1;
  map::Route route;
  for (std::size_t i = 0; i < stages; ++i) {
    auto const ends = destinations.of(sequence ? sequence->parts[i] : goal);
    if (ends.empty()) continue;
    auto const part = route_to_one(map, route.lanes.empty() ? start : route.lanes.back(), ends, where);
    route.lanes.insert(route.lanes.end(), part.lanes.begin() + (route.lanes.empty() ? 0 : 1), part.lanes.end());
    route.length += part.length;
    route.cost += part.cost;
  }
  return route.lanes.empty() ? map::straight_route(map, start) : route;
}

}  // namespace cambium::inline v0_1::detail
