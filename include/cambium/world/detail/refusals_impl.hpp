#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "cambium/core/error.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/corridor/lane_place.hpp"
#include "cambium/map/lanes/signals.hpp"
#include "cambium/map/map.hpp"
#include "cambium/world/detail/refusals.hpp"

namespace cambium::inline v0_1::detail {

CAMBIUM_COLD double checked_speed(double speed, std::string const& where) {
  if (speed >= -standstill_noise && speed <= fastest) return std::max(speed, 0.0);
  throw WorldError(where, "its speed is " + rounded_text(speed) + ", not a number from 0 to 1000 m/s",
                   "give metres per second along the heading, 0 for a vehicle that reverses");
}

CAMBIUM_COLD void check_acceleration(double acceleration, std::string const& where) {
  if (std::abs(acceleration) <= 100.0) return;
  throw WorldError(where, "its acceleration is " + rounded_text(acceleration) + ", not a number from -100 to 100 m/s^2",
                   "give metres per second squared along the heading, 0 if it is unknown");
}

CAMBIUM_COLD double distance_outside(map::RoadCorridor const& road, map::LanePlace const& at) {
  auto const& corridor = road.corridors[at.corridor];
  auto const widths = corridor.widths_at(std::clamp(at.s, 0.0, corridor.length()), at.segment);
  double const aside = std::max({at.lateral - widths.left, -at.lateral - widths.right, 0.0});
  return portable::hypot(aside, std::max({-at.s, at.s - corridor.length(), 0.0}));
}

CAMBIUM_COLD void check_heading(Map const& map, map::RoadCorridor const& road, map::LanePlace const& at,
                                std::string const& where) {
  LaneId const lane = road.corridors[at.corridor].pieces[at.piece].lane;
  if (!is_valid(lane) || std::abs(at.heading_error) <= geometry::pi / 2) return;
  throw WorldError(where, "it heads against the direction of its lane (" + map.describe(lane) + ")",
                   "give a heading along the lane, in radians counter-clockwise from +x");
}

CAMBIUM_COLD void check_set_place(Map const& map, map::RoadCorridor const& road, map::LanePlace const& at,
                                  std::string const& where) {
  if (double const distance = distance_outside(road, at); !(distance <= entering_radius))
    throw WorldError(where,
                     "its position is " + rounded_text(distance) + " m outside the lanes of its route, more than the " +
                         rounded_text(entering_radius) + " m allowed",
                     "check the frame of the position, or give Reroute::yes for a new route from there");
  check_heading(map, road, at, where);
}

CAMBIUM_COLD void require_light_plan(Map const& map, LightId id, map::LightPlan const& plan) {
  std::string const where = "light " + to_string(id);
  if (index_of(id) >= map.lights().size())
    throw WorldError(where, "the map has no such traffic light", "see Map::lights for those it has");
  if (!plan.is_possible())
    throw WorldError(where, "its plan has a phase that is negative or longer than a day",
                     "give green_begin <= green_end within the cycle");
}

CAMBIUM_COLD void require_same_roster(std::size_t records, std::uint32_t is, std::size_t agents, std::uint32_t now) {
  if (records == agents && is == now) return;
  throw WorldError("World",
                   records != agents ? "the frame has " + std::to_string(records) + " records, the roster " +
                                           std::to_string(agents) + " agents"
                                     : "the frame is from before an agent entered, left, was re-routed or got another "
                                       "model of behaviour",
                   "restore a frame of this world recorded since then");
}

CAMBIUM_COLD void require_kept(std::size_t steps_back, std::size_t kept) {
  if (steps_back == 0 || steps_back > kept)
    throw WorldError("history", "there is no frame " + std::to_string(steps_back) + " steps back",
                     "call keep_history before stepping");
}

CAMBIUM_COLD std::string name_of(AgentId id) { return "agent " + to_string(id); }

CAMBIUM_COLD void refuse_slot(Slot slot) {
  throw WorldError("slot " + std::to_string(index_of(slot)), "the world has no such slot",
                   "World::slot_of returns that of an agent");
}

CAMBIUM_COLD void refuse(AgentId id, char const* what, char const* remedy) {
  throw WorldError(name_of(id), what, remedy);
}

}  // namespace cambium::inline v0_1::detail
