#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/goal/goal.hpp"
#include "cambium/map/build_corridor.hpp"
#include "cambium/map/lane_position.hpp"
#include "cambium/map/map.hpp"
#include "cambium/world/detail/on_lanes.hpp"

namespace cambium::detail {

/// Farthest that an agent may enter from the nearest lane [m].
inline constexpr double entering_radius = 5.0;
/// Farthest that an agent with a route may enter from the path of one of its lanes [m].
inline constexpr double path_radius = 2.5;

/// The lane of `route` whose path comes nearest to `position`, a radian off `heading` counting as 3 m: a path that
/// swings over to its neighbour counts as its own lane there. Throws `WorldError` where none comes near, or only
/// against it.
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
    double const distance = std::hypot(foot.lateral, std::max({-foot.s, foot.s - lane.length(), 0.0}));
    double const along = lane.path.pose(foot.s).heading;
    double const turn = heading ? std::abs(geometry::angle_difference(*heading, along)) : 0.0;
    if (distance > path_radius || turn > geometry::pi / 2 || distance + 3.0 * turn >= smallest) continue;
    smallest = distance + 3.0 * turn;
    best = id;
  }
  if (!is_valid(best))
    throw WorldError(where, "no lane of its route comes within 2.5 m of its position, in its direction",
                     "begin the route there");
  return best;
}

/// The drivable lane at `position`; without a heading the nearest one. Throws `WorldError` where there is none.
[[nodiscard]] inline LaneId entering_lane(Map const& map, geometry::Point const& position,
                                          std::optional<double> heading, std::string const& where) {
  if (heading) {
    if (auto const hit = map.nearest_lane({position.x(), position.y(), *heading}, entering_radius)) return hit->lane;
  } else {
    for (auto const& hit : map.lanes_near(position, entering_radius))
      if (map.lane(hit.lane).drivable()) return hit.lane;
  }
  throw WorldError(
      where, "no drivable lane within " + std::to_string(static_cast<int>(entering_radius)) + " m of its position",
      "enter on a lane and along its direction");
}

template <class... Alternatives>
void check_if_described(std::variant<Alternatives...> const& any, std::string const& where);

/// The agent's goal, complete: lanes beside count from the one that it enters in. Throws `WorldError` for a sequence
/// that is too long, or within another goal, and `ParameterError` for a number out of its range.
[[nodiscard]] inline Goal entering_goal(Goal goal, LaneId lane, std::string const& where, bool is_outer = true) {
  check_if_described(goal, where);
  if (auto* const beside = std::get_if<ReachLaneBeside>(&goal); beside && !is_valid(beside->from)) beside->from = lane;
  auto const complete = [&](std::vector<Goal>& parts) {
    for (auto& part : parts) part = entering_goal(std::move(part), lane, where, false);
  };
  if (auto* const all = std::get_if<AllGoals>(&goal)) complete(all->parts);
  if (auto* const any = std::get_if<AnyGoal>(&goal)) complete(any->parts);
  if (auto* const sequence = std::get_if<GoalSequence>(&goal)) {
    if (!is_outer) throw WorldError(where, "its goal has a sequence within another goal", "put the sequence outside");
    if (sequence->parts.size() > 255)
      throw WorldError(where, "its goal is a sequence of more than 255 parts", "leave some out");
    complete(sequence->parts);
  }
  return goal;
}

/// Lanes where a goal's route may end, collected from its parts.
class Destinations {
 public:
  Destinations(Map const& map, std::string const& where) : map_(&map), where_(&where) {}

  [[nodiscard]] std::vector<LaneId> of(Goal const& goal) const {
    return std::visit([this](auto const& g) { return lanes(g); }, goal);
  }

 private:
  template <class G>
  [[nodiscard]] std::vector<LaneId> lanes(G const&) const {
    return {};
  }

  [[nodiscard]] std::vector<LaneId> lanes(ReachLane const& goal) const { return lane(goal.lane, goal.from, goal.to); }
  [[nodiscard]] std::vector<LaneId> lanes(LaneLimits const& goal) const {
    return is_valid(goal.lane) ? lane(goal.lane, goal.from, goal.to) : std::vector<LaneId>{};
  }

  /// Of goals to be reached at once the first place counts.
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
                       "give the route too, or a goal on a lane");
    return lanes;
  }

  [[nodiscard]] std::vector<LaneId> lane(LaneId lane, double from, double to) const {
    if (index_of(lane) >= map_->lanes().size())
      throw WorldError(*where_, "its goal names lane " + to_string(lane) + ", which the map does not have",
                       "use Map::find_lane");
    if (!(from <= to)) throw WorldError(*where_, "its goal's stretch of lane ends before it begins", "give from <= to");
    return {lane};
  }

  Map const* map_;
  std::string const* where_;
};

/// The way from `start` to the first of `ends` that it leads to. Throws `WorldError` where there is none.
[[nodiscard]] inline map::Route route_to_one(Map const& map, LaneId start, std::vector<LaneId> const& ends,
                                             std::string const& where) {
  for (auto const end : ends)
    if (auto route = map.shortest_route(start, end)) return *route;
  throw WorldError(where, "there is no route from " + map.describe(start) + " to " + map.describe(ends.front()),
                   "choose a goal that the lane leads to");
}

/// The route from `start`: as given, else to the goal, by way of all places of a sequence, else straight on. Throws
/// `WorldError` where there is none.
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

/// Where on `road` an agent of `spec` enters, in lane `lane`: in the main corridor if that holds the lane.
template <class Spec>
[[nodiscard]] map::LanePosition entering_position(Map const& map, Spec const& spec, map::RoadCorridor const& road,
                                                  LaneId lane, std::string const& where) {
  auto const holds = [lane](map::CorridorPiece const& piece) { return piece.lane == lane; };
  auto const& main = road.corridors[road.main].pieces;
  auto const number = std::any_of(main.begin(), main.end(), holds) ? road.main : road.corridor_of(lane);
  if (number == map::no_corridor)
    throw WorldError(where, "its route does not hold the lane it enters in (" + map.describe(lane) + ")");
  // A corridor may come by the same place twice: the search begins in the lane.
  auto const& corridor = road.corridors[number];
  auto const piece = std::find_if(corridor.pieces.begin(), corridor.pieces.end(), holds);
  double const in_lane = map.lane(lane).index_begin + map.lane(lane).path.project(spec.position).s;
  map::LanePosition hint;
  hint.piece = static_cast<std::uint16_t>(piece - corridor.pieces.begin());
  hint.segment = corridor.center.find(std::clamp(in_lane - piece->index_offset, piece->begin, piece->end));
  auto at = map::locate(road, number, {spec.position.x(), spec.position.y(), 0.0}, hint);
  double const along = corridor.center.pose(at.s).heading;
  at.heading_error = spec.heading ? geometry::angle_difference(*spec.heading, along) : 0.0;
  if (std::abs(at.heading_error) > geometry::pi / 2)
    throw WorldError(where, "it heads against the direction of its lane (" + map.describe(lane) + ")",
                     "leave the heading out, or enter along the lane");
  return at;
}

/// Speeds beyond this are no vehicle's [m/s].
inline constexpr double fastest = 1000.0;

/// Throws `ParameterError` where a parameter of a described struct, or of the one that a set holds, is out of its
/// range.
template <class Parameters>
void check_if_described(Parameters const& parameters, std::string const& where) {
  if constexpr (Described<Parameters>) check_parameters(parameters, where);
  if constexpr (requires { parameters.any(); }) check_if_described(parameters.any(), where);
}
template <class... Alternatives>
void check_if_described(std::variant<Alternatives...> const& any, std::string const& where) {
  std::visit([&where](auto const& parameters) { check_if_described(parameters, where); }, any);
}

/// As above for an observer, or for those that it is made of.
template <class Observer>
void check_observer(Observer const& observer, std::string const& where) {
  if constexpr (requires { observer.stages; })
    std::apply([&where](auto const&... stage) { (check_observer(stage, where), ...); }, observer.stages);
  else if constexpr (requires { observer.any; })
    std::visit([&where](auto const& one) { check_observer(one, where); }, observer.any);
  else
    check_if_described(observer, where);
}

/// Throws `WorldError` or `ParameterError` where a number of `spec` is no good.
template <class Spec>
void check_entering(Spec const& spec, std::string const& where) {
  if (!spec.position.allFinite() || (spec.heading && !std::isfinite(*spec.heading)))
    throw WorldError(where, "its position or heading is missing or not a finite number");
  if (!(spec.speed >= 0 && spec.speed <= fastest))
    throw WorldError(where, "its speed is not a number from 0 to 1000 m/s", "give metres per second");
  check_if_described(spec.behavior, where);
  check_if_described(spec.shape, where);
  check_if_described(spec.execution, where);
  check_if_described(spec.dynamics, where);
  check_observer(spec.observer, where);
  if (!(spec.shape.length() > 0 && spec.shape.width() > 0))
    throw WorldError(where, "its shape has no length or no width", "leave the shape out to get a car");
}

}  // namespace cambium::detail
