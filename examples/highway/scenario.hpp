#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/lane_change/mobil.hpp"
#include "cambium/behavior/presets.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/random.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/map/map.hpp"
#include "cambium/scenario/lane_traffic.hpp"
#include "cambium/world/world.hpp"

namespace highway {

using Simulation =
    cambium::World<cambium::BehaviorSet<cambium::Mobil>, cambium::InterpolateExecution, cambium::SingleTrack>;

/// What the scenarios on a map have in common.
struct Site {
  std::shared_ptr<cambium::Map const> map;
  std::vector<cambium::LaneId> lanes;  ///< where traffic enters, side by side, the innermost one first
  std::vector<cambium::LaneId> exits;  ///< last lanes of the ways that leave the road
  double length{};                     ///< of the shortest of the ways straight on from there [m]
};

/// The lanes beside `lane` that may be driven along, and itself; the innermost one first.
[[nodiscard]] inline std::vector<cambium::LaneId> lanes_beside(cambium::Map const& map, cambium::LaneId lane) {
  auto const is_lane = [&](cambium::LaneId id) {
    if (!is_valid(id) || !map.lane(id).drivable()) return false;
    auto const& width = map.lane(id).widths.front();
    return width.left + width.right > 2.5;
  };
  std::vector<cambium::LaneId> lanes;
  auto leftmost = lane;
  while (is_lane(map.lane(leftmost).left_neighbor)) leftmost = map.lane(leftmost).left_neighbor;
  for (auto id = leftmost; is_lane(id); id = map.lane(id).right_neighbor) lanes.push_back(id);
  if (map.road(map.lane(lane).road).left_hand_traffic) std::reverse(lanes.begin(), lanes.end());
  return lanes;
}

/// Lanes that end the map and can be reached from the outermost lane by leaving the road at a fork.
[[nodiscard]] inline std::vector<cambium::LaneId> find_exits(cambium::Map const& map,
                                                             std::vector<cambium::LaneId> const& lanes) {
  std::vector<cambium::RoadId> ends;  // of the ways straight on
  for (auto const id : lanes) ends.push_back(map.lane(cambium::map::straight_route(map, id).lanes.back()).road);
  std::vector<cambium::LaneId> exits;
  for (auto const& found : map.reachable(lanes.back(), 1500.0)) {
    auto const& lane = map.lane(found.lane);
    bool const goes_on = std::find(ends.begin(), ends.end(), lane.road) != ends.end();
    if (lane.drivable() && lane.successors.empty() && !is_valid(lane.merges_into) && !goes_on && lane.length() > 30.0)
      exits.push_back(found.lane);
  }
  return exits;
}

/// How far traffic from the site's lanes goes straight on [m]: to where the first of them is merged into, or ends.
[[nodiscard]] inline double usable_length(Site const& site) {
  double length = site.length;
  for (auto const id : site.lanes) {
    auto const road = cambium::map::build_road_corridor(*site.map, cambium::map::straight_route(*site.map, id));
    for (auto const& corridor : road->corridors)
      for (auto const& feeder : corridor.feeders)
        if (feeder.is_still_to_merge()) length = std::min(length, feeder.free_until);
    length = std::min(length, road->corridors[road->main].pieces[0].lane_end);
  }
  return length;
}

/// Finds where a road of several lanes begins, at an edge of the map if there is one; of those the one with the most
/// lanes, of these the longest. Throws `MapError` where there is none.
[[nodiscard]] inline Site find_site(std::shared_ptr<cambium::Map const> map, std::string const& file) {
  constexpr double shortest = 150.0;
  std::vector<Site> sites;
  for (auto const& lane : map->lanes()) {
    if (!lane.drivable() || lane.length() < 50.0) continue;
    Site site{map, lanes_beside(*map, lane.id), {}, 1e9};
    for (auto const id : site.lanes) site.length = std::min(site.length, cambium::map::straight_route(*map, id).length);
    if (site.lanes.size() >= 2 && site.lanes[0] == lane.id && site.length >= shortest) sites.push_back(std::move(site));
  }
  std::stable_sort(sites.begin(), sites.end(), [&](Site const& a, Site const& b) {
    auto const rank = [&](Site const& s) {
      return std::tuple(map->lane(s.lanes[0]).predecessors.empty(), s.lanes.size(), s.length);
    };
    return rank(a) > rank(b);
  });
  for (auto& site : sites) {
    site.length = usable_length(site);  // traffic begins where the lanes are still apart
    if (site.length < shortest) continue;
    site.exits = find_exits(*map, site.lanes);
    return site;
  }
  throw cambium::MapError(file,
                          "nowhere on this map two lanes side by side go on for 150 m before a merge or their end",
                          "give a map with a highway, such as maps/highway_exit.xodr");
}

/// A sampled situation.
struct Scenario {
  Simulation world;
  cambium::AgentId ego = cambium::none<cambium::AgentId>;
  cambium::geometry::Point start{0.0, 0.0};  ///< where the ego begins
  std::vector<cambium::AgentId> marked{};    ///< who takes an exit
  std::vector<cambium::CorridorId> lanes{};  ///< lane corridors that the agents were in, by slot
  std::vector<std::uint64_t> counts = {0};   ///< lane changes
};

/// A driver by one of the presets, a little different from the others, who keeps right.
[[nodiscard]] inline cambium::Mobil sample_driver(bool is_truck, cambium::RandomStream& random) {
  namespace presets = cambium::presets;
  cambium::Mobil driver;
  double const kind = cambium::uniform01(random);
  driver.idm = is_truck     ? presets::kesting_2010_truck()
               : kind < 0.2 ? presets::aggressive()
               : kind < 0.4 ? presets::timid()
                            : presets::kesting_2010_car();
  driver.idm.desired_speed *= cambium::Uniform{0.9, 1.1}(random);
  driver.politeness = kind < 0.2 ? 0.0 : 0.3;
  driver.keep_right = true;
  driver.bias = is_truck ? 0.6 : 0.3;
  driver.route_horizon = 800.0;  // exits are announced early
  driver.route_bias = 4.0;
  driver.changing.others = presets::kesting_2010_car();
  driver.changing.trucks = presets::kesting_2010_truck();
  return driver;
}

/// Traffic on one lane, the outer the slower and with the more trucks; `share` from 0, innermost, to 1, outermost.
[[nodiscard]] inline cambium::LaneTraffic traffic_on(cambium::Map const& map, Site const& site, cambium::LaneId lane,
                                                     double share) {
  auto const& widths = map.lane(lane).widths.front();
  cambium::LaneTraffic traffic;
  traffic.end = std::min(0.45 * site.length, 500.0);
  traffic.lowest_speed = 27.0 - 6.0 * share;
  traffic.highest_speed = 32.0 - 8.0 * share;
  traffic.lowest_desired_speed = traffic.highest_desired_speed = 40.0;  // the driver is another one
  traffic.shortest_headway = 1.0;
  traffic.longest_headway = 4.0;
  traffic.truck_share = widths.left + widths.right > 3.3 ? 0.35 * share * share : 0.0;
  return traffic;
}

/// Traffic on all lanes, some of it bound for an exit, where there is one. The ego begins in the middle of the inner
/// lanes; it takes an exit, or drives to the end. `attempt` numbers the draws of one scenario.
[[nodiscard]] inline Scenario draw_scenario(Site const& site, std::uint64_t seed, std::uint32_t number,
                                            std::uint32_t attempt) {
  Scenario scenario{Simulation(site.map, {.seed = seed})};
  cambium::RandomStream random(seed, number, attempt);
  auto const& map = *site.map;
  double const ego_at = std::min(0.12 * site.length, 150.0);
  double nearest = 1e9;
  for (std::size_t i = 0; i < site.lanes.size(); ++i) {
    double const share = static_cast<double>(i) / static_cast<double>(site.lanes.size() - 1);
    auto const road = cambium::map::build_road_corridor(map, cambium::map::straight_route(map, site.lanes[i]));
    for (auto const& vehicle : traffic_on(map, site, site.lanes[i], share).sample(random)) {
      auto const pose = road->corridors[road->main].center.pose(vehicle.s);
      bool const is_truck = vehicle.shape.length() > 7.5;
      bool const is_early = vehicle.s < 1.5 * ego_at;  // to see much of it, and to reach an exit
      bool const is_ego =
          is_early && !is_truck && i == (site.lanes.size() - 1) / 2 && std::abs(vehicle.s - ego_at) < nearest;
      bool const exits = is_early && !site.exits.empty() && (is_ego || cambium::uniform01(random) < 0.15);
      auto const exit = exits ? cambium::uniform_index(random, static_cast<std::uint32_t>(site.exits.size())) : 0;
      auto driver = sample_driver(is_truck, random);
      if (exits) driver.changing.rest = 1.0;  // several lanes may have to be crossed
      auto const id =
          scenario.world.add({.position = pose.position(),
                              .heading = pose.heading,
                              .speed = std::min(vehicle.speed, driver.idm.desired_speed),
                              .shape = vehicle.shape,
                              .behavior = driver,
                              .goal = exits ? cambium::Goal(cambium::ReachLane{site.exits[exit]}) : cambium::Goal()});
      if (exits) scenario.marked.push_back(id);
      if (!is_ego) continue;
      scenario.ego = id;
      scenario.start = pose.position();
      nearest = std::abs(vehicle.s - ego_at);
    }
  }
  for (auto const& record : scenario.world.frame().agents) scenario.lanes.push_back(record.lane.corridor);
  return scenario;
}

/// The first draw that has an ego. Throws `WorldError` where there is none: the road has no room.
[[nodiscard]] inline Scenario sample_scenario(Site const& site, std::uint64_t seed, std::uint32_t number) {
  for (std::uint32_t attempt = 0; attempt < 100; ++attempt) {
    auto scenario = draw_scenario(site, seed, number, attempt);
    if (is_valid(scenario.ego)) return scenario;
  }
  throw cambium::WorldError("scenario " + std::to_string(number), "no traffic fits on the road",
                            "give a map with longer lanes");
}

/// Counts lane changes; true when the ego is on its exit, or without one has come 500 m far or near the end.
[[nodiscard]] inline bool is_done(Scenario& scenario) {
  auto const& world = scenario.world;
  for (std::size_t i = 0; i < world.size(); ++i) {
    auto const& record = world.frame().agents[i];
    scenario.counts[0] += record.lane.corridor != scenario.lanes[i];
    scenario.lanes[i] = record.lane.corridor;
  }
  auto const& record = world.record(scenario.ego);
  if (!std::holds_alternative<cambium::NoGoal>(world.roster().goals[world.slot_of(scenario.ego)]))
    return world.reached_goal(scenario.ego);
  auto const& corridor = world.roster().agents[world.slot_of(scenario.ego)].road->corridors[record.lane.corridor];
  cambium::geometry::Point const here{record.state.x, record.state.y};
  return corridor.length_until_end(record.lane.s) < 30.0 || (here - scenario.start).norm() > 500.0;
}

/// What the summary says of the site.
[[nodiscard]] inline std::vector<std::pair<std::string, std::size_t>> facts_of(Site const& site) {
  return {{"lanes", site.lanes.size()}, {"exits", site.exits.size()}};
}

}  // namespace highway
