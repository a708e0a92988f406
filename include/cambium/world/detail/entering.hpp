#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "cambium/behavior/behavior_set.hpp"
#include "cambium/core/constants.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/geometry/polygon.hpp"
#include "cambium/geometry/shape.hpp"
#include "cambium/goal/goal.hpp"
#include "cambium/map/corridor/lane_place.hpp"
#include "cambium/map/fwd.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/routing/route.hpp"
#include "cambium/world/detail/check_described.hpp"
#include "cambium/world/detail/refusals.hpp"
#include "cambium/world/detail/seen.hpp"
#include "cambium/world/frame.hpp"
#include "cambium/world/roster.hpp"

namespace cambium::inline v0_1::detail {

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

/// The road and place where an agent of `spec` enters. Throws `WorldError` if its lane, route or road is invalid.
[[nodiscard]] Entrance entrance(Map const& map, RosterBase const& roster, EnteringSpec const& spec,
                                std::string const& where);

/// The same for an agent that is re-routed. The new route leads to the goal without its first `passed` parts.
[[nodiscard]] Entrance entrance_again(Map const& map, RosterBase const& roster, EnteringSpec const& spec,
                                      std::size_t passed, std::string const& where);

/// Completes the agent's goal: a `ReachLaneBeside` without a start counts lanes from the lane the agent enters in.
/// Throws `WorldError` if a goal names a lane or stretch that the map lacks, has no parts, or nests a sequence, or if a
/// sequence is too long. Throws `ParameterError` if a number is out of range or limits leave nothing between them.
[[nodiscard]] Goal entering_goal(Map const& map, Goal const& goal, LaneId lane, std::string const& where);

/// The road of `known` that was built through the points of `way` with `options`; null if there is none.
[[nodiscard]] FreeRoad const* find_free_road(std::span<FreeRoad const> known, std::vector<geometry::Point> const& way,
                                             map::FreeCorridorOptions const& options);

/// The free corridor through the points of `way`, which agents on equal ways share. Throws `MapError` as
/// `map::build_free_corridor`.
[[nodiscard]] std::shared_ptr<map::RoadCorridor const> free_road_along(Map const& map, RosterBase const& roster,
                                                                       std::vector<geometry::Point> const& way);

/// The free corridor `given` with a range of lane coordinates of its own, beyond those of the map and of the free
/// corridors `known` to the world. Throws `WorldError` if `given` contains lanes.
[[nodiscard]] std::shared_ptr<map::RoadCorridor const> numbered_road(
    Map const& map, std::span<FreeRoad const> known, std::shared_ptr<map::RoadCorridor const> const& given,
    std::string const& where);

/// Registers a free corridor when its first agent enters, and adds index entries for the static objects on it.
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

/// An entering agent: everything that a world stores about it.
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
  check_models(spec, where);
  auto const [road, lane, place] = entrance(map, roster, entering, where);
  if (is_too_large(map, spec.behavior.given(), spec.shape, *road)) refuse_too_large(where);
  check_acceleration(spec.acceleration, where);
  record.action.acceleration = spec.acceleration;
  record.acceleration = static_cast<float>(spec.acceleration);
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

}  // namespace cambium::inline v0_1::detail

#ifndef CAMBIUM_COMPILED
#include "cambium/world/detail/entering_impl.hpp"
#endif
