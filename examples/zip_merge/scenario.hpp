#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/lane_change/zip_merge.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/map/routing/route.hpp"
#include "cambium/world/world.hpp"

#include "../merging/scenario.hpp"

namespace zip_merge {

using Simulation =
    cambium::World<cambium::BehaviorSet<cambium::ZipMerge>, cambium::InterpolateExecution, cambium::SingleTrack>;

/// The same merges as in the example `merging`.
struct Site : merging::Site {};

/// Somebody on the way to the merge.
struct Coming {
  cambium::Slot slot{};
  std::size_t entrance{};
  double merge_at{};  ///< [m] along its lane corridor
};

struct Scenario {
  Simulation world;
  cambium::AgentId ego = cambium::none<cambium::AgentId>;
  std::vector<cambium::AgentId> marked;        ///< all that come from the ramp
  std::vector<Coming> coming{};                ///< who has not reached the merge yet
  std::optional<std::size_t> last{};           ///< entrance of who has reached it last
  std::vector<std::uint64_t> counts = {0, 0};  ///< pairs one after the other at the merge, and those from one lane
};

/// The driver as a zip merger: the same car following.
[[nodiscard]] inline cambium::ZipMerge zip(cambium::IdmClassic const& driver) {
  cambium::ZipMerge result;
  result.idm = {.desired_speed = driver.desired_speed,
                .time_headway = driver.time_headway,
                .minimum_gap = driver.minimum_gap,
                .maximum_acceleration = driver.maximum_acceleration,
                .comfortable_deceleration = driver.comfortable_deceleration};
  return result;
}

/// Dense traffic as in the example `merging`, of drivers who merge like a zip.
[[nodiscard]] inline Scenario sample_scenario(Site const& site, std::uint64_t seed, std::uint32_t number) {
  auto const sampled = merging::sample_scenario(site, seed, number);
  Scenario scenario{Simulation(site.map, {.seed = seed}), sampled.ego, sampled.marked};
  for (std::size_t i = 0; i < sampled.world.size(); ++i) {
    auto const& agent = sampled.world.roster().agents[i];
    auto const& state = sampled.world.frame().agents[i].state;
    scenario.world.add({.position = {state.x, state.y},
                        .heading = state.heading,
                        .speed = state.speed,
                        .shape = agent.shape,
                        .behavior = zip(std::get<cambium::IdmClassic>(agent.behavior)),
                        .goal = sampled.world.roster().goals[i],
                        .route = cambium::map::Route{.lanes = agent.road->route},
                        .id = agent.id});
    for (std::size_t k = 0; k < site.entrances.size(); ++k)
      if (site.entrances[k].merges() && site.entrances[k].route.lanes == agent.road->route)
        scenario.coming.push_back({static_cast<cambium::Slot>(i), k, site.entrances[k].merge_at});
  }
  return scenario;
}

/// Notes who has come to the merge in the last step; true when the ego has merged. Pairs count while vehicles of both
/// lanes come.
[[nodiscard]] inline bool is_done(Scenario& scenario) {
  auto const& agents = scenario.world.frame().agents;
  auto& coming = scenario.coming;
  auto const beyond = [&](Coming const& one) { return agents[one.slot].lane.s - one.merge_at; };
  auto const arrived =
      std::stable_partition(coming.begin(), coming.end(), [&](auto const& c) { return beyond(c) < 0.0; });
  std::sort(arrived, coming.end(), [&](auto const& a, auto const& b) { return beyond(a) > beyond(b); });
  for (auto one = arrived; one != coming.end(); ++one) {
    auto const has_others = [&](Coming const& other) { return other.entrance != one->entrance; };
    if (scenario.last && std::any_of(coming.begin(), coming.end(), has_others)) {
      ++scenario.counts[0];
      scenario.counts[1] += scenario.last == one->entrance;
    }
    scenario.last = one->entrance;
  }
  coming.erase(arrived, coming.end());
  return scenario.world.reached_goal(scenario.ego);
}

}  // namespace zip_merge
