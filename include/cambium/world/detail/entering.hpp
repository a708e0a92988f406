#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <variant>
#include <vector>

#include "cambium/behavior/behavior_set.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/shape.hpp"
#include "cambium/goal/goal.hpp"
#include "cambium/map/build_corridor.hpp"
#include "cambium/map/lane_position.hpp"
#include "cambium/map/map.hpp"
#include "cambium/world/detail/check_described.hpp"
#include "cambium/world/detail/entering_route.hpp"
#include "cambium/world/detail/objects_on_lanes.hpp"
#include "cambium/world/detail/on_lanes.hpp"
#include "cambium/world/detail/refusals.hpp"
#include "cambium/world/detail/seen.hpp"
#include "cambium/world/frame.hpp"

namespace cambium::detail {

/// Times no farther apart are the same [s].
inline constexpr double same_time = 1e-9;

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
  double const in_lane = map.lane(lane).path.project(spec.position).s;
  map::LanePosition hint;
  hint.piece = static_cast<std::uint16_t>(piece - corridor.pieces.begin());
  hint.segment = corridor.center.find(std::clamp(in_lane - piece->lane_offset, piece->begin, piece->end));
  auto at = map::locate(road, number, {spec.position.x(), spec.position.y(), 0.0}, hint);
  double const along = corridor.center.pose(at.s).heading;
  at.heading_error = spec.heading ? geometry::angle_difference(*spec.heading, along) : 0.0;
  check_heading(map, road, at, where);
  return at;
}

/// The free corridor `given` as a world of `map` has it, which has met `known` before: with lane coordinates of its
/// own. Throws `WorldError` where it has lanes.
[[nodiscard]] inline std::shared_ptr<map::RoadCorridor const> numbered_road(
    Map const& map, std::span<FreeRoad const> known, std::shared_ptr<map::RoadCorridor const> const& given,
    std::string const& where) {
  constexpr double apart = 10.0;  // [m]
  double begin = lane_coordinate_end(map);
  for (auto const& road : known) {
    if (road.given == given || road.numbered == given) return road.numbered;
    auto const& way = road.numbered->corridors.front();
    begin = std::max(begin, way.pieces.front().index_offset + std::ceil(way.length() + apart));
  }
  if (given->corridors.size() != 1 || given->corridors.front().pieces.size() != 1 ||
      is_valid(given->corridors.front().pieces.front().lane))
    throw WorldError(where, "its road is no free corridor", "give the route, or what build_free_corridor returned");
  auto road = std::make_shared<map::RoadCorridor>(*given);
  road->corridors.front().pieces.front().index_offset = begin;
  return road;
}

/// Where on the free corridor `road` an agent of `spec` enters. Throws `WorldError` where that is far.
template <class Spec>
[[nodiscard]] map::LanePosition entering_free(Spec const& spec, map::RoadCorridor const& road,
                                              std::string const& where) {
  auto at = map::locate(road, 0, {spec.position.x(), spec.position.y(), spec.heading.value_or(0.0)});
  if (!(distance_outside(road, at) <= entering_radius))
    throw WorldError(where, "its position is more than 5 m from its road", "enter on it");
  if (!spec.heading) at.heading_error = 0.0;
  return at;
}

/// Throws `WorldError` or `ParameterError` where a number of `spec` is no good.
template <class Spec>
void check_entering(Spec const& spec, std::string const& where) {
  if (!spec.position.allFinite() || (spec.heading && !std::isfinite(*spec.heading)))
    throw WorldError(where, "its position or heading is missing or not a finite number");
  (void)checked_speed(spec.speed, where);
  check_if_described(spec.behavior.given(), where);
  check_if_described(spec.shape, where);
  check_if_described(spec.execution, where);
  check_if_described(spec.dynamics, where);
  check_observer(spec.observer, where);
  if (!(spec.shape.length() > 0 && spec.shape.width() > 0))
    throw WorldError(where, "its shape has no length or no width", "leave the shape out to get a car");
}

/// Where an agent enters.
struct Entrance {
  std::shared_ptr<map::RoadCorridor const> road;
  LaneId lane = none<LaneId>;
  map::LanePosition place;
};

/// Where an agent of `spec` enters. Throws `WorldError` where its lane, its route or its road is no good.
template <class Roster, class Spec>
[[nodiscard]] Entrance entrance(Map const& map, Roster const& roster, Spec const& spec, std::string const& where) {
  if (spec.road) {
    auto const road = numbered_road(map, roster.free_roads, spec.road, where);
    return {road, none<LaneId>, entering_free(spec, *road, where)};
  }
  LaneId const lane = spec.route ? entering_lane(map, spec.position, spec.heading, *spec.route, where)
                                 : entering_lane(map, spec.position, spec.heading, where);
  auto const route = entering_route(map, lane, spec.route, spec.goal.given(), where);
  auto const road = map::build_road_corridor(map, route);
  return {road, lane, entering_position(map, spec, *road, lane, where)};
}

/// Notes a free corridor that nobody has entered on before, and which objects stand on it.
template <class Roster>
void enter_free_road(Roster& roster, std::shared_ptr<map::RoadCorridor const> const& given,
                     std::shared_ptr<map::RoadCorridor const> const& numbered) {
  for (auto const& known : roster.free_roads)
    if (known.numbered == numbered) return;
  roster.free_roads.push_back({given, numbered});
  for (std::uint32_t i = 0; i < roster.objects.size(); ++i)
    enter_object(numbered->corridors.front(), roster.objects[i], i, roster.object_entries);
  std::sort(roster.object_entries.begin(), roster.object_entries.end());
}

/// Whether `behavior` heeds the conflicts on its road and `shape` is larger than those they are found for.
template <class Behavior>
[[nodiscard]] bool is_too_large(Map const& map, Behavior const& behavior, geometry::Shape const& shape,
                                map::RoadCorridor const& road) {
  bool const heeds =
      std::visit([](auto const& model) { return heeds_conflicts<std::decay_t<decltype(model)>>; }, behavior);
  auto const& options = map.options();
  return heeds && !options.conflict_shape.holds(shape) && !options.large_conflict_shape.holds(shape) &&
         std::any_of(road.corridors.begin(), road.corridors.end(),
                     [](auto const& corridor) { return !corridor.conflicts.empty(); });
}

[[nodiscard]] inline WorldError too_large(std::string const& where) {
  return {where, "its shape is larger than the one that conflicts on its way are found for",
          "load the map with a MapOptions::large_conflict_shape that holds it"};
}

/// Where `agent`, put into `state`, begins anew, as if it were added there with the parts of `goal` that are not
/// `passed` yet. Throws `WorldError` as `entrance`, or where the agent is too large for the conflicts of its new way.
template <class World>
[[nodiscard]] Entrance entrance_again(Map const& map, typename World::RosterType const& roster,
                                      typename World::RosterType::Agent const& agent, Goal goal, std::size_t passed,
                                      typename World::State const& state, std::string const& where) {
  if (auto* const sequence = std::get_if<GoalSequence>(&goal)) {
    auto& parts = sequence->parts;
    parts.erase(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(std::min(passed, parts.size())));
  }
  typename World::AgentSpec const spec{
      .position = {state.x, state.y}, .heading = state.heading, .goal = std::move(goal)};
  auto again = entrance(map, roster, spec, where);
  if (is_too_large(map, agent.behavior, agent.shape, *again.road)) throw too_large(where);
  return again;
}

/// An agent about to enter: all that a world takes in of it.
template <class World>
struct Entrant {
  typename World::RosterType::Agent agent;
  Goal goal;
  typename World::Record record;
};

/// The agent of `spec`, of identity `id`, that enters at `time` [s]. Throws `WorldError` or `ParameterError` where its
/// numbers, its id, its lane, its route or its parameters are no good. O(agents), plus routing.
template <class World>
[[nodiscard]] Entrant<World> entrant(Map const& map, typename World::RosterType const& roster,
                                     typename World::AgentSpec const& spec, AgentId id, double time) {
  using Set = typename World::Behaviors;
  std::string const where = "agent " + to_string(id);
  if (!is_valid(id))
    throw WorldError(where, "there is no such id, or no further one is free", "give an id that nobody has");
  if (roster.slot_of(id))
    throw WorldError(where, "the world has an agent of that id already", "leave the id out to get a free one");
  check_entering(spec, where);
  auto const [road, lane, place] = entrance(map, roster, spec, where);
  if (is_too_large(map, spec.behavior.given(), spec.shape, *road)) throw too_large(where);
  typename World::Record record;
  record.lane = place;
  record.state.time = time;
  record.state.x = spec.position.x();
  record.state.y = spec.position.y();
  record.state.heading = spec.heading.value_or(road->corridors[place.corridor].center.pose(place.s).heading);
  record.state.speed = checked_speed(spec.speed, where);
  record.memory = Set::initial_memory(spec.behavior.given());
  if (Set::start_time(spec.behavior.given()) > time + same_time) record.status = AgentStatus::not_started;
  forget_past(record);
  return {{id, spec.shape, road, spec.behavior.given(), spec.execution, spec.dynamics, spec.observer},
          entering_goal(map, spec.goal.given(), lane, where),
          record};
}

}  // namespace cambium::detail
