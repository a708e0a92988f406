#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "cambium/behavior/presets.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/random.hpp"
#include "cambium/core/stable_sort.hpp"
#include "cambium/goal/goal.hpp"
#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/map/routing/route.hpp"
#include "cambium/scenario/highway_site.hpp"
#include "cambium/scenario/lane_traffic.hpp"

namespace cambium::inline v0_1 {

namespace detail {

/// `lane` and the drivable lanes beside it, the innermost one first.
CAMBIUM_COLD std::vector<LaneId> lanes_beside(Map const& map, LaneId lane) {
  auto const is_lane = [&](LaneId id) {
    if (!is_valid(id) || !map.lane(id).drivable()) return false;
    auto const& width = map.lane(id).widths.front();
    return width.left + width.right > 2.5;
  };
  std::vector<LaneId> lanes;
  auto leftmost = lane;
  while (is_lane(map.lane(leftmost).left_neighbor)) leftmost = map.lane(leftmost).left_neighbor;
  for (auto id = leftmost; is_lane(id); id = map.lane(id).right_neighbor) lanes.push_back(id);
  if (map.road(map.lane(lane).road).left_hand_traffic) std::reverse(lanes.begin(), lanes.end());
  return lanes;
}

/// Lanes that end the map and can be reached from the outermost lane by leaving the road at a fork.
CAMBIUM_COLD std::vector<LaneId> find_exits(Map const& map, std::vector<LaneId> const& lanes) {
  std::vector<RoadId> ends;  // of the ways straight on
  for (auto const id : lanes) ends.push_back(map.lane(map::straight_route(map, id).lanes.back()).road);
  std::vector<LaneId> exits;
  for (auto const& found : map.reachable(lanes.back(), 1500.0)) {
    auto const& lane = map.lane(found.lane);
    bool const goes_on = std::find(ends.begin(), ends.end(), lane.road) != ends.end();
    if (lane.drivable() && lane.successors.empty() && !is_valid(lane.merges_into) && !goes_on && lane.length() > 30.0)
      exits.push_back(found.lane);
  }
  return exits;
}

/// How far traffic from the site's lanes goes straight on [m]: to where a lane merges with another or ends.
CAMBIUM_COLD double usable_length(HighwaySite const& site) {
  double length = site.length;
  for (auto const id : site.lanes) {
    auto const road = map::build_road_corridor(*site.map, map::straight_route(*site.map, id));
    for (auto const& corridor : road->corridors)
      for (auto const& feeder : corridor.feeders)
        if (feeder.is_still_to_merge()) length = std::min(length, feeder.free_until);
    length = std::min(length, road->corridors[road->main].pieces[0].lane_end);
  }
  return length;
}

/// A driver by one of the presets, a little different from the others, who keeps right.
CAMBIUM_COLD Mobil sample_highway_driver(bool is_truck, RandomStream& random) {
  Mobil driver;
  double const kind = uniform01(random);
  driver.law = is_truck     ? presets::kesting_2010_truck()
               : kind < 0.2 ? presets::aggressive()
               : kind < 0.4 ? presets::timid()
                            : presets::kesting_2010_car();
  driver.law.desired_speed *= Uniform{0.9, 1.1}(random);
  auto& rule = driver.lateral.rule;
  rule.politeness = kind < 0.2 ? 0.0 : 0.3;
  rule.keep_right = true;
  rule.bias = is_truck ? 0.6 : 0.3;
  rule.route_horizon = 800.0;  // exits are announced early
  rule.route_bias = 4.0;
  driver.lateral.others = presets::kesting_2010_car();
  driver.lateral.trucks = presets::kesting_2010_truck();
  return driver;
}

/// Traffic on one lane; `share` goes from 0 on the innermost lane to 1 on the outermost.
CAMBIUM_COLD LaneTraffic highway_traffic(HighwaySite const& site, LaneId lane, double share) {
  auto const& widths = site.map->lane(lane).widths.front();
  LaneTraffic traffic;
  traffic.end = std::min(0.45 * site.length, 500.0);
  traffic.speed = Uniform{27.0 - 6.0 * share, 32.0 - 8.0 * share};
  traffic.desired_speed = Uniform{40.0, 40.0};  // these drivers are replaced
  traffic.headway = Uniform{1.0, 4.0};
  traffic.mix.truck_share = widths.left + widths.right > 3.3 ? 0.35 * share * share : 0.0;
  return traffic;
}

/// One draw of a scenario, which may lack an ego; `attempt` numbers the draws.
CAMBIUM_COLD Scenario<HighwaySite::World> draw_highway(HighwaySite const& site, std::uint64_t seed,
                                                       std::uint32_t number, std::uint32_t attempt) {
  Scenario<HighwaySite::World> scenario{.map = site.map, .seed = seed};
  RandomStream random(seed, number, attempt);
  double const ego_at = std::min(0.12 * site.length, 150.0);
  double nearest = 1e9;
  for (std::size_t i = 0; i < site.lanes.size(); ++i) {
    double const share = static_cast<double>(i) / static_cast<double>(site.lanes.size() - 1);
    auto const road = map::build_road_corridor(*site.map, map::straight_route(*site.map, site.lanes[i]));
    for (auto const& vehicle : highway_traffic(site, site.lanes[i], share).sample(random)) {
      auto const pose = road->corridors[road->main].center.pose(vehicle.s);
      bool const is_truck = vehicle.shape.length() > 7.5;
      bool const is_early = vehicle.s < 1.5 * ego_at;  // it drives far, and can reach an exit
      bool const is_ego =
          is_early && !is_truck && i == (site.lanes.size() - 1) / 2 && std::abs(vehicle.s - ego_at) < nearest;
      bool const exits = is_early && !site.exits.empty() && (is_ego || uniform01(random) < 0.15);
      auto const exit = exits ? uniform_index(random, static_cast<std::uint32_t>(site.exits.size())) : 0;
      auto driver = sample_highway_driver(is_truck, random);
      if (exits) driver.lateral.rest = 1.0;  // several lanes may have to be crossed
      auto const id = static_cast<AgentId>(scenario.agents.size());
      scenario.agents.push_back({.position = pose.position(),
                                 .heading = pose.heading,
                                 .speed = std::min(vehicle.speed, driver.law.desired_speed),
                                 .shape = vehicle.shape,
                                 .behavior = driver,
                                 .goal = exits ? Goal(ReachLane{site.exits[exit]}) : Goal(),
                                 .id = id});
      if (!is_ego) continue;
      scenario.ego = id;
      nearest = std::abs(vehicle.s - ego_at);
    }
  }
  return scenario;
}

}  // namespace detail

CAMBIUM_COLD Scenario<HighwaySite::World> HighwaySite::sample(std::uint64_t seed, std::uint32_t number) const {
  detail::require_lanes(map, lanes, "HighwaySite::lanes", "find_highway_site");
  detail::require_lanes(map, exits.empty() ? lanes : exits, "HighwaySite::exits", "find_highway_site");
  if (lanes.size() < 2 || !(length > 0.0 && length < 1e7))
    throw WorldError("HighwaySite", "it has less than two lanes, or no length in metres",
                     "take it as find_highway_site returns it");
  for (std::uint32_t attempt = 0; attempt < 100; ++attempt) {
    auto scenario = detail::draw_highway(*this, seed, number, attempt);
    if (is_valid(scenario.ego)) return scenario;
  }
  throw WorldError("scenario " + std::to_string(number), "no traffic fits on the road", "give a map with longer lanes");
}

CAMBIUM_COLD HighwaySite find_highway_site(std::shared_ptr<Map const> map, std::string const& where) {
  detail::require_map(map, where);
  constexpr double shortest = 150.0;
  std::vector<HighwaySite> sites;
  for (auto const& lane : map->lanes()) {
    if (!lane.drivable() || lane.length() < 50.0) continue;
    HighwaySite site{map, detail::lanes_beside(*map, lane.id), {}, 1e9};
    for (auto const id : site.lanes) site.length = std::min(site.length, map::straight_route(*map, id).length);
    if (site.lanes.size() >= 2 && site.lanes[0] == lane.id && site.length >= shortest) sites.push_back(std::move(site));
  }
  detail::stable_sort_by(sites, [&](HighwaySite const& a, HighwaySite const& b) {
    auto const rank = [&](HighwaySite const& s) {
      return std::tuple(map->lane(s.lanes[0]).predecessors.empty(), s.lanes.size(), s.length);
    };
    return rank(a) > rank(b);
  });
  for (auto& site : sites) {
    site.length = detail::usable_length(site);  // traffic begins where the lanes are still apart
    if (site.length < shortest) continue;
    site.exits = detail::find_exits(*map, site.lanes);
    return site;
  }
  throw MapError(where, "nowhere on this map do two lanes side by side go on for 150 m before a merge or their end",
                 "give a map with a highway, such as maps/highway_exit.xodr");
}

}  // namespace cambium::inline v0_1
