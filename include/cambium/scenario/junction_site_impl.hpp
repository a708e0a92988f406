#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cambium/behavior/presets.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/scenario/junction_site.hpp"
#include "cambium/scenario/traffic_inflow.hpp"

namespace cambium::inline v0_1 {

namespace detail {

/// The next vehicle; a car where the drawn one would not fit.
CAMBIUM_COLD geometry::Shape random_shape(Map const& map, VehicleMix const& mix, map::Route const& route,
                                          RandomStream& random) {
  auto const shape = mix(random);
  return shape == geometry::bicycle() || fits_route(map, route, shape) ? shape : geometry::car();
}

/// Distance [m] that an agent on lane `from` can drive before its body reaches the junction's conflict zones. Negative
/// if it is in one already, or if the lane is too narrow for it (for example where it opens).
CAMBIUM_COLD double room_before_zones(JunctionSite::World const& world, AgentId id, LaneId from) {
  auto const slot = world.slot_of(id);
  auto const& agent = world.roster().agents[slot];
  auto const& at = world.frame().agents[slot].lane;
  auto const& corridor = agent.road->corridors[at.corridor];
  if (corridor.lane_at(at.s).lane != from) return -1.0;
  if (corridor.width_at(at.s - agent.shape.rear) < agent.shape.width()) return -1.0;
  bool const large = !world.map().options().conflict_shape.holds(agent.shape);
  double hold = std::numeric_limits<double>::infinity();
  for (auto const& conflict : corridor.conflicts)
    hold = std::min(hold, conflict.section[large][1].place_to_wait(agent.shape.front, false));
  return hold - at.s;
}

/// Tries once to put a vehicle on its way to a junction before which it can still stop, and 18 m away from all others.
/// `world` has all agents of `scenario`.
CAMBIUM_COLD void try_to_add(JunctionSite const& site, JunctionTraffic const& traffic, LaneId from,
                             RandomStream& random, JunctionSite::World& world,
                             Scenario<JunctionSite::World>& scenario) {
  auto const& map = *site.map;
  auto const route = site.random_route(from, random);
  double junction = 0.0;
  std::size_t lanes = 0;
  while (lanes < route.lanes.size() && !map.in_junction(route.lanes[lanes]))
    junction += map.lane(route.lanes[lanes++]).length();
  double const last = std::min(map.lane(from).length(), junction - 6.0);
  if (lanes == route.lanes.size() || last < 5.0) return;
  double const s = 4.0 + uniform01(random) * (last - 4.0);
  auto const pose = map.lane(from).path.pose(s);
  for (auto const& agent : world.frame().agents)
    if (portable::hypot(agent.state.x - pose.x, agent.state.y - pose.y) < 18.0) return;
  auto const shape = random_shape(map, traffic.mix, route, random);
  bool const cycles = shape == geometry::bicycle();
  std::optional<AgentId> id;
  if (traffic.scattered_ids) id = static_cast<AgentId>(random() >> 33);
  double const desired = 8.0 + 7.0 * uniform01(random);
  auto idm = cycles ? presets::cyclist() : presets::normal();
  if (!cycles) idm.desired_speed = desired;
  UrbanDriver driver;
  presets::follow_as(idm, driver.law);
  driver.lateral.keep.keep_to_side = cycles;
  JunctionSite::World::AgentSpec spec{.position = pose.position(),
                                      .heading = pose.heading,
                                      .shape = shape,
                                      .behavior = driver,
                                      .route = route,
                                      .dynamics = cycles ? presets::bicycle_dynamics() : SingleTrack{},
                                      .id = id};
  id = world.add(spec);
  double const room = std::min(junction - s - shape.front, room_before_zones(world, *id, from)) - 1.0;
  double const wanted = 3.0 + 9.0 * uniform01(random);
  if (room < 0.0) return world.remove(*id);
  spec.speed = std::min(cycles ? idm.desired_speed : wanted, std::sqrt(2.0 * 1.5 * room));
  spec.id = id;
  scenario.agents.push_back(std::move(spec));
}

/// Phases of 20 s for each of the map's lights in turn: 15 s green, 3 s yellow, and 2 s to clear the junction.
CAMBIUM_COLD std::vector<map::LightPlan> lights_in_turn(Map const& map) {
  constexpr double phase = 20.0;
  std::vector<map::LightPlan> plans(map.lights().size());
  for (std::size_t i = 0; i < plans.size(); ++i) {
    double const begin = phase * static_cast<double>(i);
    plans[i] = {.cycle = phase * static_cast<double>(plans.size()), .green_begin = begin, .green_end = begin + 15.0};
  }
  return plans;
}

}  // namespace detail

CAMBIUM_COLD map::Route JunctionSite::random_route(LaneId from, RandomStream& random) const {
  detail::require_lanes(map, {from}, "JunctionSite::random_route: from", "find_junction_site");
  return cambium::random_route(*map, from, random);
}

CAMBIUM_COLD Scenario<JunctionSite::World> JunctionSite::sample(std::uint64_t seed, std::uint32_t number,
                                                                JunctionTraffic const& traffic) const {
  check_parameters(traffic);
  detail::require_lanes(map, entrances, "JunctionSite::entrances", "find_junction_site");
  Scenario<World> scenario{.map = map, .seed = seed};
  if (traffic.lights) scenario.lights = detail::lights_in_turn(*map);
  World world(map);
  RandomStream random(seed, number, 0);
  auto const wanted = 4 + uniform_index(random, static_cast<std::uint32_t>(traffic.most_vehicles - 3));
  auto const lanes = static_cast<std::uint32_t>(entrances.size());
  for (std::uint32_t i = 0; i < std::max(400u, 8 * wanted) && scenario.agents.size() < wanted; ++i)
    if (i < 8 * wanted || scenario.agents.size() < 2)
      detail::try_to_add(*this, traffic, entrances[uniform_index(random, lanes)], random, world, scenario);
  if (scenario.agents.size() < 2)
    throw WorldError("scenario " + std::to_string(number), "no traffic fits on the map before its junctions",
                     "give a map with longer lanes there");
  scenario.ego = *scenario.agents.front().id;
  return scenario;
}

CAMBIUM_COLD JunctionSite find_junction_site(std::shared_ptr<Map const> map, std::string const& where) {
  detail::require_map(map, where);
  JunctionSite site{.map = std::move(map), .entrances = {}};
  std::vector<LaneId> all;
  bool crosses = false;
  for (auto const& lane : site.map->lanes()) {
    if (!lane.drivable()) continue;
    if (site.map->in_junction(lane.id)) {
      for (auto const& overlap : lane.overlaps)
        crosses = crosses || overlap.kind == map::OverlapKind::crossing ||
                  (overlap.kind == map::OverlapKind::merge && site.map->in_junction(overlap.other));
    } else if (lane.length() >= 15.0) {
      all.push_back(lane.id);
      if (lane.predecessors.empty()) site.entrances.push_back(lane.id);
    }
  }
  if (site.entrances.size() < 2) site.entrances = std::move(all);
  if (!crosses || site.entrances.empty())
    throw MapError(where, "no ways cross or merge in a junction of this map",
                   "give a map with an intersection, such as maps/intersection_4way.xodr");
  return site;
}

}  // namespace cambium::inline v0_1
