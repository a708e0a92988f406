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

#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/junction/intersection.hpp"
#include "cambium/behavior/presets.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/core/random.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/map/map.hpp"
#include "cambium/world/world.hpp"

namespace intersection {

using Simulation =
    cambium::World<cambium::BehaviorSet<cambium::Intersection>, cambium::InterpolateExecution, cambium::SingleTrack>;

/// What the scenarios on a map have in common.
struct Site {
  std::shared_ptr<cambium::Map const> map;
  std::vector<cambium::LaneId> entrances;  ///< lanes where traffic starts
  double trucks = 0.15;                    ///< share of trucks among the vehicles, where they fit
  double bicycles = 0.0;                   ///< share of bicycles
  bool scattered_ids = false;              ///< instead of 0, 1, 2, ...
  bool lights = false;                     ///< traffic lights are on: one after the other is green for 15 s
};

[[nodiscard]] inline bool in_junction(cambium::Map const& map, cambium::LaneId lane) {
  return is_valid(map.road(map.lane(lane).road).junction);
}

/// Finds where traffic may start: lanes outside of junctions that begin the map, else all. Throws `MapError` where no
/// ways cross in a junction.
[[nodiscard]] inline Site find_site(std::shared_ptr<cambium::Map const> map, std::string const& file) {
  Site site;
  site.map = std::move(map);
  std::vector<cambium::LaneId> all;
  bool crosses = false;
  for (auto const& lane : site.map->lanes()) {
    if (!lane.drivable()) continue;
    if (in_junction(*site.map, lane.id)) {
      for (auto const& overlap : lane.overlaps)
        crosses = crosses || overlap.kind == cambium::map::OverlapKind::crossing ||
                  (overlap.kind == cambium::map::OverlapKind::merge && in_junction(*site.map, overlap.other));
    } else if (lane.length() >= 15.0) {
      all.push_back(lane.id);
      if (lane.predecessors.empty()) site.entrances.push_back(lane.id);
    }
  }
  if (site.entrances.size() < 2) site.entrances = std::move(all);
  if (!crosses || site.entrances.empty())
    throw cambium::MapError(file, "no ways cross or merge in a junction of this map",
                            "give a map with an intersection, such as maps/intersection_4way.xodr");
  return site;
}

/// A way at random until it ends, comes round or, behind a junction, is 400 m long.
[[nodiscard]] inline cambium::map::Route random_route(cambium::Map const& map, cambium::LaneId from,
                                                      cambium::RandomStream& random) {
  cambium::map::Route route{{from}, map.lane(from).length()};
  while (route.length < 400.0 || in_junction(map, route.lanes.back())) {
    std::vector<cambium::LaneId> next;
    for (auto const lane : map.lane(route.lanes.back()).successors)
      if (map.lane(lane).drivable() && std::find(route.lanes.begin(), route.lanes.end(), lane) == route.lanes.end())
        next.push_back(lane);
    if (next.empty()) break;
    route.lanes.push_back(next[cambium::uniform_index(random, static_cast<std::uint32_t>(next.size()))]);
    route.length += map.lane(route.lanes.back()).length();
  }
  return route;
}

/// A sampled situation: the world as it begins, and who is followed.
struct Scenario {
  Simulation world;
  cambium::AgentId ego = cambium::none<cambium::AgentId>;
  std::vector<cambium::AgentId> marked;
};

/// Whether one of `shape` that follows the route keeps out of the lanes beside, outside of junctions: those who drive
/// there do not look out for whom a bend swings into their way.
[[nodiscard]] inline bool fits(cambium::Map const& map, cambium::map::Route const& route,
                               cambium::geometry::Shape const& shape) {
  double const sharpest = 0.9 / (0.5 * shape.front * shape.front);  // [1/m]: it swings out by 0.9 m
  return std::all_of(route.lanes.begin(), route.lanes.end(), [&](cambium::LaneId id) {
    auto const segments = map.lane(id).path.segments();
    return in_junction(map, id) || std::all_of(segments.begin(), segments.end(), [&](auto const& segment) {
             return std::abs(segment.curvature) < sharpest;
           });
  });
}

/// Mostly cars, and some vans and trucks where these fit.
[[nodiscard]] inline cambium::geometry::Shape random_shape(Site const& site, cambium::map::Route const& route,
                                                           cambium::RandomStream& random) {
  using namespace cambium::geometry;
  double const share = cambium::uniform01(random);
  if (share >= 1.0 - site.bicycles) return bicycle();
  auto const shape = share < site.trucks ? truck() : share < site.trucks + 0.15 ? van() : car();
  return fits(*site.map, route, shape) ? shape : car();
}

/// How far an agent may go before it is where bodies of those in the junction may reach [m]; negative where it is, or
/// where its lane is too narrow for it, as where one opens.
[[nodiscard]] inline double room_before_zones(Simulation const& world, cambium::AgentId id) {
  auto const slot = world.slot_of(id);
  auto const& agent = world.roster().agents[slot];
  auto const& at = world.frame().agents[slot].lane;
  auto const& corridor = agent.road->corridors[at.corridor];
  if (corridor.width_at(at.s - agent.shape.rear) < agent.shape.width()) return -1.0;
  bool const large = !world.map().options().conflict_shape.holds(agent.shape);
  double hold = std::numeric_limits<double>::infinity();
  for (auto const& conflict : corridor.conflicts) hold = std::min(hold, conflict.hold[large]);
  return hold - at.s;
}

/// Puts a vehicle on its way to a junction before which it can still stop, unless another one is near.
inline void try_to_add(Site const& site, Scenario& scenario, cambium::LaneId from, cambium::RandomStream& random) {
  auto const& map = scenario.world.map();
  auto const route = random_route(map, from, random);
  double junction = 0.0;
  std::size_t lanes = 0;
  while (lanes < route.lanes.size() && !in_junction(map, route.lanes[lanes]))
    junction += map.lane(route.lanes[lanes++]).length();
  double const last = std::min(map.lane(from).length(), junction - 6.0);
  if (lanes == route.lanes.size() || last < 5.0) return;
  double const s = 4.0 + cambium::uniform01(random) * (last - 4.0);
  auto const pose = map.lane(from).path.pose(s);
  for (auto const& agent : scenario.world.frame().agents)
    if (std::hypot(agent.state.x - pose.x, agent.state.y - pose.y) < 18.0) return;
  auto const shape = random_shape(site, route, random);
  bool const cycles = shape == cambium::geometry::bicycle();
  auto& world = scenario.world;
  std::optional<cambium::AgentId> id;
  if (site.scattered_ids) id = static_cast<cambium::AgentId>(random() >> 33);
  double const desired = 8.0 + 7.0 * cambium::uniform01(random);
  auto const idm = cycles ? cambium::presets::cyclist() : cambium::IdmParameters{.desired_speed = desired};
  id = world.add({.position = pose.position(),
                  .heading = pose.heading,
                  .shape = shape,
                  .behavior = cambium::Intersection{.idm = idm},
                  .route = route,
                  .dynamics = cycles ? cambium::presets::bicycle_dynamics() : cambium::SingleTrack{},
                  .id = id});
  double const room = std::min(junction - s - shape.front, room_before_zones(world, *id)) - 1.0;
  double const wanted = 3.0 + 9.0 * cambium::uniform01(random);
  if (room < 0.0) return world.remove(*id);
  auto state = world.state(*id);
  state.speed = std::min(cycles ? idm.desired_speed : wanted, std::sqrt(2.0 * 1.5 * room));
  world.set_state(*id, state);
  if (!is_valid(scenario.ego)) scenario.ego = *id;
}

/// Switches the map's traffic lights on.
inline void switch_on_lights(Simulation& world) {
  auto const lights = world.map().lights();
  double const phase = 20.0;  // [s] 15 s green, 3 s yellow, and 2 s to clear the junction
  for (auto const& light : lights) {
    double const begin = phase * static_cast<double>(index_of(light.id));
    world.set_light(
        light.id,
        {.cycle = phase * static_cast<double>(lights.size()), .green_begin = begin, .green_end = begin + 15.0});
  }
}

/// Four to twelve vehicles from everywhere. Throws `WorldError` where the map has no room before its junctions.
[[nodiscard]] inline Scenario sample_scenario(Site const& site, std::uint64_t seed, std::uint32_t number) {
  Scenario scenario{Simulation(site.map, {.seed = seed}), cambium::none<cambium::AgentId>, {}};
  if (site.lights) switch_on_lights(scenario.world);
  cambium::RandomStream random(seed, number, 0);
  auto const wanted = 4 + cambium::uniform_index(random, 9);
  auto const entrances = static_cast<std::uint32_t>(site.entrances.size());
  for (std::uint32_t i = 0; i < 400 && scenario.world.size() < wanted; ++i)
    if (i < 8 * wanted || scenario.world.size() < 2)
      try_to_add(site, scenario, site.entrances[cambium::uniform_index(random, entrances)], random);
  if (scenario.world.size() < 2)
    throw cambium::WorldError("scenario " + std::to_string(number), "no traffic fits on the map before its junctions",
                              "give a map with longer lanes there");
  return scenario;
}

/// Whether the agent in a slot of the world has its last junction behind it, or has left the map.
[[nodiscard]] inline bool is_through(Simulation const& world, std::size_t slot) {
  auto const& record = world.frame().agents[slot];
  if (record.status != cambium::AgentStatus::driving) return true;
  auto const& conflicts = world.roster().agents[slot].road->corridors[record.lane.corridor].conflicts;
  double const rear = record.lane.s - world.roster().agents[slot].shape.rear;
  return std::none_of(conflicts.begin(), conflicts.end(),
                      [rear](auto const& conflict) { return conflict.hull().end > rear; });
}

/// Whether everybody is through.
[[nodiscard]] inline bool is_done(Scenario const& scenario) {
  for (std::size_t i = 0; i < scenario.world.size(); ++i)
    if (!is_through(scenario.world, i)) return false;
  return true;
}

/// What the summary says of the site.
[[nodiscard]] inline std::vector<std::pair<std::string, std::size_t>> facts_of(Site const& site) {
  return {{"entrances", site.entrances.size()}, {"lights", site.lights ? 1 : 0}};
}

}  // namespace intersection
