#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/drivers.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/map/map.hpp"
#include "cambium/scenario/scenario.hpp"
#include "cambium/world/world.hpp"

namespace cambium::inline v0_1 {

/// A road with several lanes in one direction: samples traffic of cars and trucks on all of them. Made by
/// `find_highway_site`.
struct HighwaySite {
  /// The worlds that the sampled scenarios are for; `with_behaviors` makes them fit others.
  using World = cambium::World<BehaviorSet<Mobil>, InterpolateExecution, SingleTrack>;

  std::shared_ptr<Map const> map;
  std::vector<LaneId> lanes;  ///< where traffic enters, side by side, the innermost one first
  std::vector<LaneId> exits;  ///< last lanes of the ways that leave the road
  double length{};            ///< of the shortest way straight on from `lanes`, to a merge or the end [m]

  /// Scenario `number` of a seed: drivers by the presets of the literature who keep right; the outer a lane, the slower
  /// its traffic and the more trucks. Some are bound for an exit, if there is one: it is their goal. The ego, a car
  /// near the beginning of the middle lane, takes an exit or drives straight on. Throws `WorldError` if the road is too
  /// short for traffic. O(vehicles).
  [[nodiscard]] Scenario<World> sample(std::uint64_t seed, std::uint32_t number) const;
};

/// Finds where a road with several lanes begins, at an edge of the map if there is one; of those, the one with the most
/// lanes, and of these, the longest. Throws `MapError` at `where`, the map's file, if there is none of 150 m. O(lanes).
[[nodiscard]] HighwaySite find_highway_site(std::shared_ptr<Map const> map, std::string const& where = "map");

}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/scenario/highway_site_impl.hpp"
#endif
