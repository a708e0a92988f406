#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/following/idm_classic.hpp"
#include "cambium/core/random.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/map/map.hpp"
#include "cambium/scenario/lane_traffic.hpp"
#include "cambium/world/world.hpp"

namespace merging {

using Simulation =
    cambium::World<cambium::BehaviorSet<cambium::IdmClassic>, cambium::InterpolateExecution, cambium::SingleTrack>;

/// A way into the map: a lane where traffic enters, and the route straight on from there.
struct Entrance {
  cambium::map::Route route;
  double length{};             ///< of the lane corridor from the entrance to its end [m]
  double merge_at{};           ///< where its path begins to swing onto a neighbour's, or to overlap with another's [m]
  bool gives_up_lane = false;  ///< its lane ends in the merge: this is who merges
  double traffic_end{};        ///< traffic stands before this place: the merge, on the lanes beside it too [m]

  [[nodiscard]] bool merges() const { return merge_at < length; }
};

/// What the scenarios on a map have in common.
struct Site {
  std::shared_ptr<cambium::Map const> map;
  std::vector<Entrance> entrances;
  std::size_t ramp{};        ///< the entrance whose vehicles merge
  std::size_t crossings{};   ///< places where routes cross or meet at an angle
  double free_speed = 13.9;  ///< [m/s]: the speed limit there, else 50 km/h
};

/// Where, along the route's lane corridor, other lanes' traffic begins to merge with it; its length if nowhere.
inline void find_merge(cambium::Map const& map, Entrance& entrance) {
  double s = 0.0;
  entrance.merge_at = entrance.length;
  for (auto const id : entrance.route.lanes) {
    auto const& lane = map.lane(id);
    double at = lane.length();
    for (auto const& overlap : lane.overlaps)
      if (overlap.kind == cambium::map::OverlapKind::merge) at = std::min(at, overlap.begin);
    if (is_valid(lane.merges_into)) at = std::min(at, lane.merge_begin);
    if (at < lane.length() && s + at < entrance.merge_at) {
      entrance.merge_at = s + at;
      entrance.gives_up_lane = is_valid(lane.merges_into);
    }
    s += lane.length();
  }
}

/// The lanes where traffic may enter: they begin the map, are wide enough for a car and lead somewhere.
[[nodiscard]] inline std::vector<Entrance> find_entrances(cambium::Map const& map) {
  std::vector<Entrance> entrances;
  for (auto const& lane : map.lanes()) {
    auto const& width = lane.widths.front();
    if (!lane.drivable() || !lane.predecessors.empty() || width.left + width.right < 2.0) continue;
    Entrance entrance{cambium::map::straight_route(map, lane.id)};
    for (auto const id : entrance.route.lanes) entrance.length += map.lane(id).length();
    find_merge(map, entrance);
    if (entrance.length > 30.0) entrances.push_back(std::move(entrance));
  }
  for (auto& e : entrances) {
    e.traffic_end = std::min(e.merge_at, e.length - 20.0);
    if (e.merges()) continue;
    auto const road = map.lane(e.route.lanes.front()).road;
    for (auto const& beside : entrances)
      if (beside.merges() && map.lane(beside.route.lanes.front()).road == road)
        e.traffic_end = std::min(e.traffic_end, beside.merge_at);
  }
  return entrances;
}

/// The entrance whose vehicles merge: one that gives up its lane; of those, the one with the longest way to the merge.
[[nodiscard]] inline std::optional<std::size_t> find_ramp(std::vector<Entrance> const& entrances) {
  auto const better = [](Entrance const& a, Entrance const& b) {
    if (a.gives_up_lane != b.gives_up_lane) return b.gives_up_lane;
    return a.merge_at < b.merge_at;
  };
  std::optional<std::size_t> ramp;
  for (std::size_t i = 0; i < entrances.size(); ++i) {
    if (!entrances[i].merges() || entrances[i].merge_at < 20.0) continue;
    if (!ramp || better(entrances[*ramp], entrances[i])) ramp = i;
  }
  return ramp;
}

/// How often the entrances' routes cross each other, or meet like streets, not like lanes.
[[nodiscard]] inline std::size_t count_crossings(cambium::Map const& map, std::vector<Entrance> const& entrances) {
  std::set<cambium::LaneId> used;
  for (auto const& entrance : entrances) used.insert(entrance.route.lanes.begin(), entrance.route.lanes.end());
  auto const heading_at = [&map](cambium::LaneId lane, double s) { return map.lane(lane).path.pose(s).heading; };
  auto const is_crossing = [&](cambium::LaneId id, cambium::map::Overlap const& overlap) {
    if (overlap.kind != cambium::map::OverlapKind::merge) return overlap.kind == cambium::map::OverlapKind::crossing;
    double const turn = heading_at(id, overlap.begin) - heading_at(overlap.other, overlap.other_begin);
    return std::cos(turn) < std::cos(cambium::geometry::pi / 6);
  };
  std::size_t count = 0;
  for (auto const id : used)
    for (auto const& overlap : map.lane(id).overlaps)
      count += overlap.other > id && used.contains(overlap.other) && is_crossing(id, overlap);
  return count;
}

/// Says so where the traffic's routes cross or meet at an angle; `who`: the program and its map.
inline void warn_of_crossings(Site const& site, std::string const& who) {
  if (site.crossings > 0)
    std::cerr
        << who << ": " << site.crossings << (site.crossings == 1 ? " place" : " places")
        << " where the traffic's routes cross or meet at an angle; nobody gives way there, so expect collisions\n";
}

/// How many merges there are on a map, wherever they are.
[[nodiscard]] inline std::size_t count_merges(cambium::Map const& map) {
  std::size_t count = 0;
  for (auto const& lane : map.lanes())
    for (auto const& overlap : lane.overlaps)
      count += lane.id < overlap.other && overlap.kind == cambium::map::OverlapKind::merge;
  return count;
}

/// What a map lacks on which `find_ramp` finds nothing.
[[nodiscard]] inline std::string what_is_missing(cambium::Map const& map, std::vector<Entrance> const& entrances) {
  auto const merges = count_merges(map);
  if (merges == 0) return "no lane of this map merges into another";
  std::string const has = "it has " + std::to_string(merges) + (merges == 1 ? " merge" : " merges");
  if (entrances.empty())
    return has + ", but no lane where traffic could enter: each is the continuation of another, narrow or short";
  return has + ", but none lies 20 m or more down the straight ways from the " + std::to_string(entrances.size()) +
         (entrances.size() == 1 ? " lane" : " lanes") + " where traffic enters: those that continue no other";
}

/// Finds the merge of a map: the entrances, and which of them is the ramp. Throws `MapError` where nothing merges.
[[nodiscard]] inline Site find_site(std::shared_ptr<cambium::Map const> map, std::string const& file) {
  Site site;
  site.map = std::move(map);
  site.entrances = find_entrances(*site.map);
  auto const ramp = find_ramp(site.entrances);
  if (!ramp)
    throw cambium::MapError(file, what_is_missing(*site.map, site.entrances),
                            "give a map whose on-ramp or lane drop begins at its edge, such as maps/merging.xodr");
  site.ramp = *ramp;
  site.crossings = count_crossings(*site.map, site.entrances);
  auto const limit = site.map->lane(site.entrances[site.ramp].route.lanes.front()).speed_limit_at(0.0);
  if (std::isfinite(limit)) site.free_speed = limit;
  return site;
}

/// Where the merge is done: in the lane 60 m behind its begin, or the last one of the route.
[[nodiscard]] inline cambium::ReachLane behind_merge(cambium::Map const& map, Entrance const& entrance) {
  double const place = entrance.merge_at + 60.0;
  double s = 0.0;
  for (auto const id : entrance.route.lanes) {
    double const end = s + map.lane(id).length();
    if (end > place + 10.0) return {id, std::max(0.0, place - s)};  // 10 m: nobody passes them between two steps
    s = end;
  }
  return {entrance.route.lanes.back()};
}

/// A sampled situation: the world as it begins, and who is the one that has to merge.
struct Scenario {
  Simulation world;
  cambium::AgentId ego = cambium::none<cambium::AgentId>;
  std::vector<cambium::AgentId> marked;  ///< all that come from the ramp
};

/// Whether a vehicle that has just entered and the one behind it could drive on without braking hard, merging traffic
/// included.
[[nodiscard]] inline bool enters_safely(Simulation& world, cambium::AgentId id) {
  constexpr double headway = 0.6;  // [s]
  if (cambium::Collision{}(world, world.slot_of(id))) return false;
  auto const view = world.observe(id);
  auto const driver = [&](cambium::AgentId agent) {
    return std::get<cambium::IdmClassic>(world.roster().agents[world.slot_of(agent)].behavior);
  };
  if (auto const front = view.ahead())
    if (front->gap < cambium::LaneTraffic::safe_gap(driver(id), view.state().speed, front->speed, headway))
      return false;
  if (auto const rear = view.behind())
    if (rear->gap < cambium::LaneTraffic::safe_gap(driver(rear->agent), rear->speed, view.state().speed, headway))
      return false;
  return true;
}

/// Dense traffic from every entrance up to its merge. The ego is the vehicle in the middle of those on the ramp; its
/// goal is the lane behind the merge. `attempt` numbers the draws of one scenario.
[[nodiscard]] inline Scenario draw_scenario(Site const& site, std::uint64_t seed, std::uint32_t number,
                                            std::uint32_t attempt) {
  Scenario scenario{Simulation(site.map, {.seed = seed}), cambium::none<cambium::AgentId>, {}};
  cambium::RandomStream random(seed, number, attempt);
  for (std::size_t k = 0; k < site.entrances.size(); ++k) {
    auto const i = (site.ramp + k) % site.entrances.size();  // the ramp first: somebody has to merge
    auto const& entrance = site.entrances[i];
    cambium::LaneTraffic traffic;
    traffic.begin = std::max(0.0, entrance.traffic_end - 250.0);
    traffic.end = entrance.traffic_end - 5.0 * cambium::uniform01(random);
    double const share = 0.5 + 0.4 * cambium::uniform01(random);  // of the free speed: how dense it is today
    traffic.lowest_speed = 0.8 * share * site.free_speed;
    traffic.highest_speed = std::min(1.2 * share, 1.0) * site.free_speed;
    traffic.lowest_desired_speed = 0.85 * site.free_speed;
    traffic.highest_desired_speed = 1.15 * site.free_speed;
    auto const road = cambium::map::build_road_corridor(*site.map, entrance.route);
    auto const& corridor = road->corridors[road->main];
    for (auto const& vehicle : traffic.sample(random)) {
      auto const pose = corridor.center.pose(vehicle.s);
      Simulation::AgentSpec spec{.position = pose.position(),
                                 .heading = pose.heading,
                                 .speed = vehicle.speed,
                                 .shape = vehicle.shape,
                                 .behavior = vehicle.driver,
                                 .route = entrance.route};
      if (i == site.ramp) spec.goal = behind_merge(*site.map, entrance);
      auto const id = scenario.world.add(spec);
      if (!enters_safely(scenario.world, id)) {
        scenario.world.remove(id);
        continue;
      }
      if (i == site.ramp) scenario.marked.push_back(id);
    }
  }
  if (!scenario.marked.empty()) scenario.ego = scenario.marked[scenario.marked.size() / 2];
  return scenario;
}

/// The first draw in which somebody merges among others. Throws `WorldError` where there is none: the map has no room
/// before its merge.
[[nodiscard]] inline Scenario sample_scenario(Site const& site, std::uint64_t seed, std::uint32_t number) {
  for (std::uint32_t attempt = 0; attempt < 100; ++attempt) {
    auto scenario = draw_scenario(site, seed, number, attempt);
    if (is_valid(scenario.ego) && scenario.world.size() > scenario.marked.size()) return scenario;
  }
  throw cambium::WorldError("scenario " + std::to_string(number), "no traffic fits on the map before its merge",
                            "give a map with longer lanes there");
}

/// Whether the ego has merged.
[[nodiscard]] inline bool is_done(Scenario const& scenario) { return scenario.world.reached_goal(scenario.ego); }

/// What the summary says of the site.
[[nodiscard]] inline std::vector<std::pair<std::string, std::size_t>> facts_of(Site const& site) {
  return {{"entrances", site.entrances.size()}};
}

}  // namespace merging
