#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "cambium/core/distributions.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/core/random.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/evaluation/off_road.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/goal/goal.hpp"
#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/scenario/lane_traffic.hpp"
#include "cambium/scenario/merging_site.hpp"

namespace cambium::inline v0_1 {

namespace detail {

/// Where, along the route's lane corridor, other lanes' traffic begins to merge with it; its length if nowhere.
CAMBIUM_COLD void find_merge(Map const& map, MergingSite::Entrance& entrance) {
  double s = 0.0;
  entrance.merge_at = entrance.length;
  for (auto const id : entrance.route.lanes) {
    auto const& lane = map.lane(id);
    double at = lane.length();
    for (auto const& overlap : lane.overlaps)
      if (overlap.kind == map::OverlapKind::merge) at = std::min(at, overlap.begin);
    if (is_valid(lane.merges_into)) at = std::min(at, lane.merge_begin);
    if (at < lane.length() && s + at < entrance.merge_at) {
      entrance.merge_at = s + at;
      entrance.gives_up_lane = is_valid(lane.merges_into);
    }
    s += lane.length();
  }
}

/// The lanes where traffic may enter: they begin the map, are wide enough for a car and lead somewhere.
CAMBIUM_COLD std::vector<MergingSite::Entrance> find_entrances(Map const& map) {
  std::vector<MergingSite::Entrance> entrances;
  for (auto const& lane : map.lanes()) {
    auto const& width = lane.widths.front();
    if (!lane.drivable() || !lane.predecessors.empty() || width.left + width.right < 2.0) continue;
    MergingSite::Entrance entrance{map::straight_route(map, lane.id)};
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
CAMBIUM_COLD std::optional<std::size_t> find_ramp(std::vector<MergingSite::Entrance> const& entrances) {
  auto const is_less = [](MergingSite::Entrance const& a, MergingSite::Entrance const& b) {
    if (a.gives_up_lane != b.gives_up_lane) return b.gives_up_lane;
    return a.merge_at < b.merge_at;
  };
  std::optional<std::size_t> ramp;
  for (std::size_t i = 0; i < entrances.size(); ++i) {
    if (!entrances[i].merges() || entrances[i].merge_at < 20.0) continue;
    if (!ramp || is_less(entrances[*ramp], entrances[i])) ramp = i;
  }
  return ramp;
}

/// How often the entrances' routes cross each other, or meet like streets rather than like lanes.
CAMBIUM_COLD std::size_t count_crossings(Map const& map, std::vector<MergingSite::Entrance> const& entrances) {
  std::set<LaneId> used;
  for (auto const& entrance : entrances) used.insert(entrance.route.lanes.begin(), entrance.route.lanes.end());
  auto const heading_at = [&map](LaneId lane, double s) { return map.lane(lane).path.pose(s).heading; };
  auto const is_crossing = [&](LaneId id, map::Overlap const& overlap) {
    if (overlap.kind != map::OverlapKind::merge) return overlap.kind == map::OverlapKind::crossing;
    double const turn = heading_at(id, overlap.begin) - heading_at(overlap.other, overlap.other_begin);
    return portable::cos(turn) < portable::cos(geometry::pi / 6);
  };
  std::size_t count = 0;
  for (auto const id : used)
    for (auto const& overlap : map.lane(id).overlaps)
      count += overlap.other > id && used.contains(overlap.other) && is_crossing(id, overlap);
  return count;
}

/// Why `find_ramp` finds nothing on a map.
CAMBIUM_COLD std::string missing_for_merging(Map const& map, std::vector<MergingSite::Entrance> const& entrances) {
  std::size_t merges = 0;
  for (auto const& lane : map.lanes())
    for (auto const& overlap : lane.overlaps)
      merges += lane.id < overlap.other && overlap.kind == map::OverlapKind::merge;
  if (merges == 0) return "no lane of this map merges into another";
  std::string const has = "it has " + std::to_string(merges) + (merges == 1 ? " merge" : " merges");
  if (entrances.empty())
    return has + ", but no lane where traffic could enter: each continues another lane, or is narrow or short";
  return has + ", but none lies 20 m or more down the straight ways from the " + std::to_string(entrances.size()) +
         (entrances.size() == 1 ? " lane" : " lanes") + " where traffic enters: those that continue no other";
}

/// Where the merge is done: in the lane 60 m behind its begin, or the last one of the route.
CAMBIUM_COLD ReachLane behind_merge(Map const& map, MergingSite::Entrance const& entrance) {
  double const place = entrance.merge_at + 60.0;
  double s = 0.0;
  for (auto const id : entrance.route.lanes) {
    double const end = s + map.lane(id).length();
    if (end > place + 10.0) return {id, std::max(0.0, place - s)};  // 10 m: nobody passes them between two steps
    s = end;
  }
  return {entrance.route.lanes.back()};
}

/// Whether a vehicle that has just entered and the one behind it can drive on without braking hard, merging traffic
/// included.
CAMBIUM_COLD bool enters_safely(MergingSite::World& world, AgentId id) {
  constexpr double headway = 0.6;  // [s]
  if (Collision{}(world, world.slot_of(id)) || OffRoad{}(world, world.slot_of(id))) return false;
  auto const view = world.observe(id);
  auto const driver = [&](AgentId agent) {
    return std::get<IdmClassic>(world.roster().agents[world.slot_of(agent)].behavior);
  };
  if (auto const front = view.ahead())
    if (front->gap < LaneTraffic::safe_gap(driver(id), view.state().speed, front->speed, headway)) return false;
  if (auto const rear = view.behind())
    if (rear->gap < LaneTraffic::safe_gap(driver(rear->agent), rear->speed, view.state().speed, headway)) return false;
  return true;
}

/// Traffic from one entrance, a little denser or thinner each time.
CAMBIUM_COLD LaneTraffic traffic_from(MergingSite const& site, MergingSite::Entrance const& entrance,
                                      VehicleMix const& mix, RandomStream& random) {
  LaneTraffic traffic;
  traffic.begin = std::max(0.0, entrance.traffic_end - 250.0);
  traffic.end = entrance.traffic_end - 5.0 * uniform01(random);
  double const share = 0.5 + 0.4 * uniform01(random);  // of the free speed
  traffic.speed = Uniform{0.8 * share * site.free_speed, std::min(1.2 * share, 1.0) * site.free_speed};
  traffic.desired_speed = Uniform{0.85 * site.free_speed, 1.15 * site.free_speed};
  traffic.mix = mix;
  return traffic;
}

/// One draw of a scenario, which may lack an ego or others; `attempt` numbers the draws.
CAMBIUM_COLD Scenario<MergingSite::World> draw_merging(MergingSite const& site, VehicleMix const& mix,
                                                       std::uint64_t seed, std::uint32_t number,
                                                       std::uint32_t attempt) {
  Scenario<MergingSite::World> scenario{.map = site.map, .seed = seed};
  MergingSite::World world(site.map);
  RandomStream random(seed, number, attempt);
  std::vector<AgentId> merging;
  for (std::size_t k = 0; k < site.entrances.size(); ++k) {
    auto const i = (site.ramp + k) % site.entrances.size();  // the ramp first: somebody has to merge
    auto const& entrance = site.entrances[i];
    auto const traffic = traffic_from(site, entrance, mix, random);
    auto const road = map::build_road_corridor(*site.map, entrance.route);
    auto const& corridor = road->corridors[road->main];
    for (auto const& vehicle : traffic.sample(random)) {
      auto const pose = corridor.center.pose(vehicle.s);
      MergingSite::World::AgentSpec spec{.position = pose.position(),
                                         .heading = pose.heading,
                                         .speed = vehicle.speed,
                                         .shape = vehicle.shape,
                                         .behavior = vehicle.driver,
                                         .route = entrance.route};
      if (i == site.ramp) spec.goal = behind_merge(*site.map, entrance);
      auto const id = world.add(spec);
      if (!enters_safely(world, id)) {
        world.remove(id);
        continue;
      }
      spec.id = id;
      scenario.agents.push_back(std::move(spec));
      if (i == site.ramp) merging.push_back(id);
    }
  }
  if (!merging.empty() && merging.size() < scenario.agents.size()) scenario.ego = merging[merging.size() / 2];
  return scenario;
}

/// Sets who yields at the merge, without changing the traffic's draws.
CAMBIUM_COLD void set_merging(Scenario<MergingSite::World>& scenario, std::uint32_t number,
                              MergingTraffic const& traffic) {
  RandomStream random(scenario.seed, number, 0, 1);
  for (auto& agent : scenario.agents) {
    bool const is_through = std::holds_alternative<NoGoal>(agent.goal),
               insists = uniform01(random) < traffic.non_yielding_share;
    auto& merging = std::get<IdmClassic>(agent.behavior).lateral.merging;
    if (is_through && insists) merging = Merging::ignored;
    if (!is_through && traffic.ramp_waits) merging = Merging::gives_way;
  }
}

}  // namespace detail

CAMBIUM_COLD Scenario<MergingSite::World> MergingSite::sample(std::uint64_t seed, std::uint32_t number,
                                                              MergingTraffic const& traffic) const {
  check_parameters(traffic);
  for (auto const& entrance : entrances)
    detail::require_lanes(map, entrance.route.lanes, "MergingSite::entrances", "find_merging_site");
  if (ramp >= entrances.size())
    throw WorldError("MergingSite", "its ramp is none of its entrances", "take it as find_merging_site returns it");
  for (std::uint32_t attempt = 0; attempt < 100; ++attempt) {
    auto scenario = detail::draw_merging(*this, traffic.mix, seed, number, attempt);
    if (!is_valid(scenario.ego)) continue;
    detail::set_merging(scenario, number, traffic);
    return scenario;
  }
  throw WorldError("scenario " + std::to_string(number), "no traffic fits on the map before its merge",
                   "give a map with longer lanes there");
}

CAMBIUM_COLD MergingSite find_merging_site(std::shared_ptr<Map const> map, std::string const& where) {
  detail::require_map(map, where);
  MergingSite site;
  site.map = std::move(map);
  site.entrances = detail::find_entrances(*site.map);
  auto const ramp = detail::find_ramp(site.entrances);
  if (!ramp)
    throw MapError(where, detail::missing_for_merging(*site.map, site.entrances),
                   "give a map whose on-ramp or lane drop begins at its edge, such as maps/merging.xodr");
  site.ramp = *ramp;
  site.crossings = detail::count_crossings(*site.map, site.entrances);
  auto const limit = site.map->lane(site.entrances[site.ramp].route.lanes.front()).speed_limit_at(0.0);
  if (std::isfinite(limit)) site.free_speed = limit;
  return site;
}

}  // namespace cambium::inline v0_1
