#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "cambium/core/ids.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/corridor/lane_place.hpp"
#include "cambium/map/lanes/signals.hpp"
#include "cambium/map/map.hpp"

namespace cambium::inline v0_1::detail {

/// Largest distance of an agent from its lane when it enters, or from the lanes of its route when its state is set [m].
inline constexpr double entering_radius = 5.0;
/// Largest accepted speed [m/s].
inline constexpr double fastest = 1000.0;
/// Measurement noise [m/s]: negative speeds of at most this size count as 0.
inline constexpr double standstill_noise = 0.1;

/// Returns `speed` [m/s], with negative noise at standstill replaced by 0. Throws `WorldError` if it is not a number,
/// negative beyond noise, or too large.
[[nodiscard]] double checked_speed(double speed, std::string const& where);

/// Throws `WorldError` unless `acceleration` [m/s^2] is a number within 100 m/s^2.
void check_acceleration(double acceleration, std::string const& where);

/// The distance of a place outside its lane corridor [m]; 0 inside.
[[nodiscard]] double distance_outside(map::RoadCorridor const& road, map::LanePlace const& at);

/// Throws `WorldError` if an agent at `at` on its road heads against the direction of its lane. Free corridors allow
/// any heading.
void check_heading(Map const& map, map::RoadCorridor const& road, map::LanePlace const& at, std::string const& where);

/// Throws `WorldError` if `World::set_state` does not allow the place `at` of the road.
void check_set_place(Map const& map, map::RoadCorridor const& road, map::LanePlace const& at, std::string const& where);

/// Throws `WorldError` if the map has no such light or the phases are invalid.
void require_light_plan(Map const& map, LightId id, map::LightPlan const& plan);

/// Throws `WorldError` unless a frame with `records` records and roster revision `is` fits a roster with `agents`
/// agents and revision `now`.
void require_same_roster(std::size_t records, std::uint32_t is, std::size_t agents, std::uint32_t now);

/// Throws `WorldError` unless `steps_back` is from 1 to `kept`.
void require_kept(std::size_t steps_back, std::size_t kept);

/// The agent's name for messages, such as "agent 7".
[[nodiscard]] std::string name_of(AgentId id);

/// Throws `WorldError` about a slot that the world does not have.
[[noreturn]] void refuse_slot(Slot slot);

/// Throws `WorldError` about an agent: what is wrong, and what to do.
[[noreturn]] void refuse(AgentId id, char const* what, char const* remedy = "");

}  // namespace cambium::inline v0_1::detail

#ifndef CAMBIUM_COMPILED
#include "cambium/world/detail/refusals_impl.hpp"
#endif
