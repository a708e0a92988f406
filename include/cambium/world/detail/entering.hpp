#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <variant>

#include "cambium/behavior/behavior_set.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/geometry/polygon.hpp"
#include "cambium/geometry/shape.hpp"
#include "cambium/goal/goal.hpp"
#include "cambium/map/corridor/lane_place.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/routing/route.hpp"
#include "cambium/world/detail/check_described.hpp"
#include "cambium/world/detail/refusals.hpp"
#include "cambium/world/detail/seen.hpp"
#include "cambium/world/frame.hpp"
#include "cambium/world/roster.hpp"

namespace cambium::detail {

/// Times that differ by at most this count as equal [s].
inline constexpr double same_time = 1e-9;

/// The part of an entering agent that does not depend on the world's models.
struct EnteringSpec {
  geometry::Point position;
  std::optional<double> heading;
  geometry::Shape const& shape;
  Goal const& goal;
  std::optional<map::Route> const& route;
  std::shared_ptr<map::RoadCorridor const> const& road;
};

/// Where an agent enters.
struct Entrance {
  std::shared_ptr<map::RoadCorridor const> road;
  LaneId lane = none<LaneId>;
  map::LanePlace place;
};

/// Throws `WorldError` or `ParameterError` if position, heading or shape are invalid.
void check_numbers(EnteringSpec const& spec, std::string const& where);

/// The place and road where an agent of `spec` enters. Throws `WorldError` if its lane, route or road is invalid.
[[nodiscard]] Entrance entrance(Map const& map, RosterBase const& roster, EnteringSpec const& spec,
                                std::string const& where);

/// The same for an agent that gets a new route, to the parts of its goal after the first `passed` ones.
[[nodiscard]] Entrance entrance_again(Map const& map, RosterBase const& roster, EnteringSpec const& spec,
                                      std::size_t passed, std::string const& where);

/// The agent's goal, complete: lanes beside count from the one that it enters in. Throws `WorldError` for a sequence
/// that is too long, or within another goal, or for one without parts, and `ParameterError` for a number out of its
/// range, limits that leave nothing between them, or a lane or stretch that the map does not have.
[[nodiscard]] Goal entering_goal(Map const& map, Goal const& goal, LaneId lane, std::string const& where);

/// Registers a free corridor when its first agent enters, with the objects that stand on it.
void enter_free_road(RosterBase& roster, std::shared_ptr<map::RoadCorridor const> const& given,
                     std::shared_ptr<map::RoadCorridor const> const& numbered);

/// Throws `WorldError` if the outline is invalid.
void check_outline(geometry::Polygon const& outline);

/// Adds a static object; see `World::add_object`.
ObjectId enter_object(Map const& map, RosterBase& roster, geometry::Polygon outline);

/// Whether `road` has conflicts and `shape` is larger than the largest shape for which the map has computed them.
[[nodiscard]] bool is_too_large(Map const& map, geometry::Shape const& shape, map::RoadCorridor const& road);
[[noreturn]] void refuse_too_large(std::string const& where);

/// Whether `behavior` respects the conflicts on its road and `shape` is too large for them.
template <class Behavior>
[[nodiscard]] bool is_too_large(Map const& map, Behavior const& behavior, geometry::Shape const& shape,
                                map::RoadCorridor const& road) {
  bool const heeds =
      std::visit([](auto const& model) { return heeds_conflicts<std::decay_t<decltype(model)>>(); }, behavior);
  return heeds && is_too_large(map, shape, road);
}

/// Throws `WorldError` if no agent with this id can enter.
void check_id(AgentId id, bool is_taken, std::string const& where);

/// An entering agent: everything that a world stores of it.
template <class World>
struct Entrant {
  typename World::RosterType::Agent agent;
  Goal goal;
  typename World::Record record;
};

/// The agent of `spec`, with id `id`, entering at `time` [s]. Throws `WorldError` or `ParameterError` if its numbers,
/// id, lane, route or parameters are invalid. O(agents), plus routing.
template <class World>
[[nodiscard]] Entrant<World> entrant(Map const& map, typename World::RosterType const& roster,
                                     typename World::AgentSpec const& spec, AgentId id, double time) {
  using Set = typename World::Behaviors;
  std::string const where = name_of(id);
  EnteringSpec const entering{spec.position, spec.heading, spec.shape, spec.goal, spec.route, spec.road};
  check_id(id, roster.slot_of(id).has_value(), where);
  check_numbers(entering, where);
  typename World::Record record;
  record.state.speed = checked_speed(spec.speed, where);
  check_if_described(spec.behavior.given(), where);
  check_if_described(spec.execution, where);
  check_if_described(spec.dynamics, where);
  check_observer(spec.observer, where);
  auto const [road, lane, place] = entrance(map, roster, entering, where);
  if (is_too_large(map, spec.behavior.given(), spec.shape, *road)) refuse_too_large(where);
  record.lane = place;
  record.state.time = time;
  record.state.x = spec.position.x();
  record.state.y = spec.position.y();
  record.state.heading = spec.heading.value_or(road->corridors[place.corridor].center.pose(place.s).heading);
  record.memory = Set::initial_memory(spec.behavior.given());
  if (Set::start_time(spec.behavior.given()) > time + same_time) record.status = AgentStatus::not_started;
  forget_past(record);
  return {{id, spec.shape, road, spec.behavior.given(), spec.execution, spec.dynamics, spec.observer},
          entering_goal(map, spec.goal.given(), lane, where),
          record};
}

}  // namespace cambium::detail

#ifndef CAMBIUM_COMPILED
#include "cambium/world/detail/entering_impl.hpp"
#endif
