#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "cambium/core/error.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/map/corridor.hpp"
#include "cambium/map/lane_position.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/signals.hpp"

namespace cambium::detail {

/// Farthest that an agent may be from a lane that it enters on, or from those of its route where its state is set [m].
inline constexpr double entering_radius = 5.0;
/// Speeds beyond this are no vehicle's [m/s].
inline constexpr double fastest = 1000.0;
/// Measured speeds of who stands come down to minus this [m/s].
inline constexpr double standstill_noise = 0.1;

/// The speed of an agent of which `speed` [m/s] is said: that, but noise about standstill counts as 0. Throws
/// `WorldError` for what is no number, negative beyond noise, or no vehicle's.
[[nodiscard]] inline double checked_speed(double speed, std::string const& where) {
  if (speed >= -standstill_noise && speed <= fastest) return std::max(speed, 0.0);
  throw WorldError(where, "its speed is " + rounded_text(speed) + ", not a number from 0 to 1000 m/s",
                   "give metres per second along the heading; nobody drives in reverse: give 0 to who does");
}

/// How far a place is outside of its lane corridor [m].
[[nodiscard]] inline double distance_outside(map::RoadCorridor const& road, map::LanePosition const& at) {
  auto const& corridor = road.corridors[at.corridor];
  auto const widths = corridor.widths_at(std::clamp(at.s, 0.0, corridor.length()), at.segment);
  double const aside = std::max({at.lateral - widths.left, -at.lateral - widths.right, 0.0});
  return std::hypot(aside, std::max({-at.s, at.s - corridor.length(), 0.0}));
}

/// Throws `WorldError` where an agent at `at` on its road heads against the direction of its lane. Free corridors may
/// be walked in any direction.
inline void check_heading(Map const& map, map::RoadCorridor const& road, map::LanePosition const& at,
                          std::string const& where) {
  LaneId const lane = road.corridors[at.corridor].pieces[at.piece].lane;
  if (!is_valid(lane) || std::abs(at.heading_error) <= geometry::pi / 2) return;
  throw WorldError(where, "it heads against the direction of its lane (" + map.describe(lane) + ")",
                   "give a heading along the lane, in radians counter-clockwise from +x");
}

/// Throws `WorldError` where an agent may not be set to the place `at` of its road: see `World::set_state`.
inline void check_set_place(Map const& map, map::RoadCorridor const& road, map::LanePosition const& at,
                            std::string const& where) {
  if (double const distance = distance_outside(road, at); !(distance <= entering_radius))
    throw WorldError(where,
                     "its position is " + rounded_text(distance) + " m from the lanes of its route; at most 5 m count",
                     "check the frame of the position, or give Reroute::yes for a new route from there");
  check_heading(map, road, at, where);
}

/// Throws `WorldError` for a light that the map does not have and for numbers that are no plan.
inline void require_light_plan(Map const& map, LightId id, map::LightPlan const& plan) {
  std::string const where = "light " + to_string(id);
  if (index_of(id) >= map.lights().size())
    throw WorldError(where, "the map has no such traffic light", "see Map::lights for those it has");
  if (!plan.is_possible())
    throw WorldError(where, "its plan has a negative phase, or one of more than a day",
                     "give green_begin <= green_end within the cycle");
}

/// Throws `WorldError` where a frame of `records` is not one of a roster of `agents`.
inline void require_same_size(std::size_t records, std::size_t agents) {
  if (records != agents)
    throw WorldError(
        "World",
        "the frame has " + std::to_string(records) + " records, the roster " + std::to_string(agents) + " agents",
        "restore frames of this world from since the last agent entered or left");
}

/// Throws `WorldError` where `steps_back` is none of the `kept` frames.
inline void require_kept(std::size_t steps_back, std::size_t kept) {
  if (steps_back == 0 || steps_back > kept)
    throw WorldError("history", "there is no frame " + std::to_string(steps_back) + " steps back",
                     "call keep_history before stepping");
}

}  // namespace cambium::detail
