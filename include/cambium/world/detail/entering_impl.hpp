#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <variant>

#include "cambium/core/error.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/goal/goal.hpp"
#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/map/corridor/free_corridor.hpp"
#include "cambium/map/corridor/lane_place.hpp"
#include "cambium/map/map.hpp"
#include "cambium/world/detail/entering.hpp"
#include "cambium/world/detail/entering_route.hpp"
#include "cambium/world/detail/objects_on_lanes.hpp"
#include "cambium/world/detail/on_lanes.hpp"
#include "cambium/world/detail/refusals.hpp"

namespace cambium::inline v0_1::detail {

/// The place in lane `lane` where an agent of `spec` enters `road`, on the main corridor if that contains the lane.
[[nodiscard]] inline map::LanePlace entering_position(Map const& map, EnteringSpec const& spec,
                                                      map::RoadCorridor const& road, LaneId lane,
                                                      std::string const& where) {
  auto const holds = [lane](map::CorridorPiece const& piece) { return piece.lane == lane; };
  auto const& main = road.corridors[road.main].pieces;
  auto const number = std::any_of(main.begin(), main.end(), holds) ? road.main : road.corridor_of(lane);
  if (number == none<CorridorId>)
    throw WorldError(where, "its route does not contain the lane that it enters in (" + map.describe(lane) + ")",
                     "give a route through that lane, or another position");
  // A corridor may pass the same position twice, so the search starts in the lane.
  auto const& corridor = road.corridors[number];
  auto const piece = std::find_if(corridor.pieces.begin(), corridor.pieces.end(), holds);
  double const in_lane = map.lane(lane).path.project(spec.position).s;
  map::LanePlace hint;
  hint.piece = static_cast<PieceId>(piece - corridor.pieces.begin());
  hint.segment = corridor.center.find(std::clamp(in_lane - piece->lane_offset, piece->begin, piece->end));
  auto at = map::locate(road, number, {spec.position.x(), spec.position.y(), 0.0}, hint);
  double const along = corridor.center.pose(at.s).heading;
  at.heading_error = spec.heading ? geometry::angle_difference(*spec.heading, along) : 0.0;
  check_heading(map, road, at, where);
  return at;
}

CAMBIUM_COLD FreeRoad const* find_free_road(std::span<FreeRoad const> known, std::vector<geometry::Point> const& way,
                                            map::FreeCorridorOptions const& options) {
  for (auto const& road : known)
    if (road.given->way == way && map::free_corridor_options(*road.given) == options) return &road;
  return nullptr;
}

CAMBIUM_COLD std::shared_ptr<map::RoadCorridor const> numbered_road(
    Map const& map, std::span<FreeRoad const> known, std::shared_ptr<map::RoadCorridor const> const& given,
    std::string const& where) {
  constexpr double apart = 10.0;  // [m]
  double begin = lane_coordinate_end(map);
  if (!given->way.empty())
    if (auto const* const same = find_free_road(known, given->way, map::free_corridor_options(*given)))
      return same->numbered;
  for (auto const& road : known) {
    if (road.given == given || road.numbered == given) return road.numbered;
    auto const& way = road.numbered->corridors.front();
    begin = std::max(begin, way.pieces.front().index_offset + std::ceil(way.length() + apart));
  }
  if (given->corridors.size() != 1 || given->corridors.front().pieces.size() != 1 ||
      is_valid(given->corridors.front().pieces.front().lane))
    throw WorldError(where, "its road is not a free corridor", "give the route, or what build_free_corridor returned");
  auto road = std::make_shared<map::RoadCorridor>(*given);
  road->corridors.front().pieces.front().index_offset = begin;
  return road;
}

/// The place where an agent of `spec` enters the free corridor `road`. Throws `WorldError` if its position is too far
/// from the corridor.
[[nodiscard]] inline map::LanePlace entering_free(EnteringSpec const& spec, map::RoadCorridor const& road,
                                                  std::string const& where) {
  auto at = map::locate(road, CorridorId{}, {spec.position.x(), spec.position.y(), spec.heading.value_or(0.0)});
  if (!(distance_outside(road, at) <= entering_radius))
    throw WorldError(where, "its position is more than " + rounded_text(entering_radius) + " m from its road",
                     "give a position on that road");
  if (!spec.heading) at.heading_error = 0.0;
  return at;
}

CAMBIUM_COLD void check_numbers(EnteringSpec const& spec, std::string const& where) {
  if (!spec.position.allFinite() || (spec.heading && !std::isfinite(*spec.heading)))
    throw WorldError(where, "its position or heading is missing or not a finite number",
                     "give a position in metres and a heading in radians");
  check_parameters(spec.shape, where);
  if (!(spec.shape.length() > 0 && spec.shape.width() > 0))
    throw WorldError(where, "its shape has no length or no width", "leave the shape out to get a car");
}

CAMBIUM_COLD Entrance entrance(Map const& map, RosterBase const& roster, EnteringSpec const& spec,
                               std::string const& where) {
  if (spec.road) {
    auto const road = numbered_road(map, roster.free_roads, spec.road, where);
    return {road, none<LaneId>, entering_free(spec, *road, where)};
  }
  LaneId const lane = spec.route ? entering_lane(map, spec.position, spec.heading, *spec.route, where)
                                 : entering_lane(map, spec.position, spec.heading, where);
  auto const route = entering_route(map, lane, spec.route, spec.goal, where);
  auto const road = map::build_road_corridor(map, route);
  auto const at = entering_position(map, spec, *road, lane, where);
  if (!spec.route || distance_outside(*road, at) == 0.0) return {road, lane, at};
  // The agent is beside the lanes of its route. The road also has the parallel lanes: take the one it is in.
  auto beside = spec.heading ? map::nearest_corridor(*road, {spec.position.x(), spec.position.y(), *spec.heading})
                             : map::nearest_corridor(*road, spec.position);
  if (!(distance_outside(*road, beside) < distance_outside(*road, at))) return {road, lane, at};
  check_heading(map, *road, beside, where);
  return {road, road->corridors[beside.corridor].pieces[beside.piece].lane, beside};
}

CAMBIUM_COLD Entrance entrance_again(Map const& map, RosterBase const& roster, EnteringSpec const& spec,
                                     std::size_t passed, std::string const& where) {
  if (!is_valid(spec.road->corridors.front().pieces.front().lane))
    throw WorldError(where, "it is on a free corridor and cannot get a new route",
                     "remove the agent and add it with another road");
  Goal left = spec.goal;
  if (auto* const sequence = std::get_if<GoalSequence>(&left)) {
    auto& parts = sequence->parts;
    parts.erase(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(std::min(passed, parts.size())));
  }
  return entrance(map, roster, {spec.position, spec.heading, spec.shape, left, {}, {}}, where);
}

CAMBIUM_COLD Goal entering_goal(Map const& map, Goal const& goal, LaneId lane, std::string const& where) {
  return complete_goal(map, goal, lane, where, true);
}

CAMBIUM_COLD std::shared_ptr<map::RoadCorridor const> free_road_along(Map const& map, RosterBase const& roster,
                                                                      std::vector<geometry::Point> const& way) {
  auto const* const known = find_free_road(roster.free_roads, way, {});
  return known != nullptr ? known->given : map::build_free_corridor(map, way);
}

CAMBIUM_COLD void enter_free_road(RosterBase& roster, std::shared_ptr<map::RoadCorridor const> const& given,
                                  std::shared_ptr<map::RoadCorridor const> const& numbered) {
  for (auto const& known : roster.free_roads)
    if (known.numbered == numbered) return;
  roster.free_roads.push_back({given, numbered});
  for (Slot i{}; index_of(i) < roster.objects.size(); ++i)
    enter_object(numbered->corridors.front(), roster.objects[i], i, roster.object_entries);
  std::sort(roster.object_entries.begin(), roster.object_entries.end());
}

CAMBIUM_COLD void check_outline(geometry::Polygon const& outline) {
  if (outline.size() == 0) throw WorldError("object", "its outline has no corners", "give at least three");
  double around = 0.0;
  for (std::size_t i = 0; i < outline.size(); ++i) around += (outline.edge(i).second - outline.edge(i).first).norm();
  if (around > 10'000.0) throw WorldError("object", "its outline is longer than 10 km", "give coordinates in metres");
}

CAMBIUM_COLD ObjectId enter_object(Map const& map, RosterBase& roster, geometry::Polygon outline) {
  StaticObject object{static_cast<ObjectId>(roster.next_object_id), std::move(outline)};
  auto const lanes = object_entries(map, roster.free_roads, object, static_cast<Slot>(roster.objects.size()));
  return roster.insert(std::move(object), lanes);
}

CAMBIUM_COLD bool is_too_large(Map const& map, geometry::Shape const& shape, map::RoadCorridor const& road) {
  auto const& options = map.options();
  return !options.conflict_shape.holds(shape) && !options.large_conflict_shape.holds(shape) &&
         std::any_of(road.corridors.begin(), road.corridors.end(),
                     [](auto const& corridor) { return !corridor.conflicts.empty(); });
}

CAMBIUM_COLD void refuse_too_large(std::string const& where) {
  throw WorldError(where, "its shape is too large for the conflicts computed on its road",
                   "load the map with a MapOptions::large_conflict_shape at least as large");
}

CAMBIUM_COLD void check_id(AgentId id, bool is_taken, std::string const& where) {
  if (!is_valid(id)) throw WorldError(where, "there is no such id, or all ids are taken", "give an unused id");
  if (is_taken)
    throw WorldError(where, "the world already has an agent with this id", "leave the id out to get a free one");
}

}  // namespace cambium::inline v0_1::detail
