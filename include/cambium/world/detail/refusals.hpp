#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "cambium/core/ids.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/corridor/lane_place.hpp"
#include "cambium/map/lanes/signals.hpp"
#include "cambium/map/map.hpp"

namespace cambium::detail {

/// Farthest that an agent may be from a lane that it enters on, or from those of its route where its state is set [m].
inline constexpr double entering_radius = 5.0;
/// Speeds beyond this are no vehicle's [m/s].
inline constexpr double fastest = 1000.0;
/// Measured speeds of who stands come down to minus this [m/s].
inline constexpr double standstill_noise = 0.1;

/// The speed of an agent of which `speed` [m/s] is said: that, but noise about standstill counts as 0. Throws
/// `WorldError` for what is no number, negative beyond noise, or no vehicle's.
[[nodiscard]] double checked_speed(double speed, std::string const& where);

/// How far a place is outside of its lane corridor [m].
[[nodiscard]] double distance_outside(map::RoadCorridor const& road, map::LanePlace const& at);

/// Throws `WorldError` where an agent at `at` on its road heads against the direction of its lane. Free corridors may
/// be walked in any direction.
void check_heading(Map const& map, map::RoadCorridor const& road, map::LanePlace const& at, std::string const& where);

/// Throws `WorldError` where an agent may not be set to the place `at` of its road: see `World::set_state`.
void check_set_place(Map const& map, map::RoadCorridor const& road, map::LanePlace const& at, std::string const& where);

/// Throws `WorldError` for a light that the map does not have and for numbers that are no plan.
void require_light_plan(Map const& map, LightId id, map::LightPlan const& plan);

/// Throws `WorldError` where a frame of `records`, of revision `is` of its roster, is not one of the roster of `agents`
/// at revision `now`.
void require_same_roster(std::size_t records, std::uint32_t is, std::size_t agents, std::uint32_t now);

/// Throws `WorldError` where `steps_back` is none of the `kept` frames.
void require_kept(std::size_t steps_back, std::size_t kept);

/// "agent 7", for messages.
[[nodiscard]] std::string name_of(AgentId id);

/// Throws `WorldError` of an agent: what is wrong, and what to do about it.
[[noreturn]] void refuse(AgentId id, char const* what, char const* remedy = "");

}  // namespace cambium::detail

#ifndef CAMBIUM_COMPILED
#include "cambium/world/detail/refusals_impl.hpp"
#endif
