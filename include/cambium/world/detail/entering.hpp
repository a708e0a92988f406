#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
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

/// The lanes where a goal's route may end; none for goals without a place.
[[nodiscard]] inline std::vector<LaneId> destinations(Map const& map, Goal const& goal, std::string const& where) {
  std::vector<LaneId> lanes;
  if (auto const* lane = std::get_if<ReachLane>(&goal)) {
    if (index_of(lane->lane) >= map.lanes().size())
      throw WorldError(where, "its goal names lane " + to_string(lane->lane) + ", which the map does not have",
                       "use Map::find_lane");
    if (!(lane->from <= lane->to))
      throw WorldError(where, "its goal's stretch of lane ends before it begins", "give from <= to");
    lanes.push_back(lane->lane);
  }
  if (auto const* polygon = std::get_if<ReachPolygon>(&goal)) {
    auto points = points_around(polygon->area, 1.0);
    points.insert(points.begin(), polygon->area.bounding_box().center());
    for (auto const& p : points)
      for (auto const& hit : map.lanes_near(p, entering_radius))
        if (map.lane(hit.lane).drivable() && std::find(lanes.begin(), lanes.end(), hit.lane) == lanes.end())
          lanes.push_back(hit.lane);
    if (lanes.empty())
      throw WorldError(where, "its goal, a polygon, is not near a drivable lane",
                       "give the route too, or a goal on a lane");
  }
  return lanes;
}

/// The route from `start`: as given, else to the goal, else straight on. Throws `WorldError` where there is none.
[[nodiscard]] inline map::Route entering_route(Map const& map, LaneId start, std::optional<map::Route> const& given,
                                               Goal const& goal, std::string const& where) {
  if (given) return *given;
  auto const ends = destinations(map, goal, where);
  if (ends.empty()) return map::straight_route(map, start);
  for (auto const end : ends)
    if (auto route = map.shortest_route(start, end)) return *route;
  throw WorldError(where, "there is no route from " + map.describe(start) + " to " + map.describe(ends.front()),
                   "choose a goal that the lane leads to");
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

template <class... Alternatives>
void check_if_described(std::variant<Alternatives...> const& any, std::string const& where);

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
  check_if_described(spec.observer, where);
  if (!(spec.shape.length() > 0 && spec.shape.width() > 0))
    throw WorldError(where, "its shape has no length or no width", "leave the shape out to get a car");
}

}  // namespace cambium::detail
