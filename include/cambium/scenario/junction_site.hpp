#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/drivers.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/random.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/routing/route.hpp"
#include "cambium/scenario/scenario.hpp"
#include "cambium/scenario/vehicle_mix.hpp"
#include "cambium/world/world.hpp"

namespace cambium::inline v0_1 {

/// What traffic at junctions consists of.
struct JunctionTraffic {
  VehicleMix mix{.truck_share = 0.15, .van_share = 0.15};
  int most_vehicles = 12;
  bool lights = false;
  bool scattered_ids = false;

  static constexpr char const* name = "junction_traffic";
  static constexpr auto parameters() {
    using P = JunctionTraffic;
    return parameter_list(
        parameter("mix", &P::mix, "which vehicles; trucks and vans only on routes whose bends they can drive"),
        parameter("most_vehicles", &P::most_vehicles, "-", Range{4, 1000},
                  "there are 4 to this many, but no more than fit at distances of 18 m"),
        parameter("lights", &P::lights,
                  "1: traffic lights are on, green for 15 s one after the other; 0: they are off"),
        parameter("scattered_ids", &P::scattered_ids, "1: random agent ids; 0: ascending ones"));
  }
};

/// A map with junctions where ways cross or merge: samples vehicles that approach them from everywhere. Made by
/// `find_junction_site`.
struct JunctionSite {
  /// The worlds that the sampled scenarios are for; `with_behaviors` makes them fit others.
  using World = cambium::World<BehaviorSet<UrbanDriver>, InterpolateExecution, SingleTrack>;

  std::shared_ptr<Map const> map;
  std::vector<LaneId> entrances;  ///< lanes where vehicles start

  /// A random route that begins in lane `from`. It ends where the map ends, where it would come round, or, outside of
  /// junctions, after 400 m. O(lanes of the route).
  [[nodiscard]] map::Route random_route(LaneId from, RandomStream& random) const;

  /// Scenario `number` of a seed: four to `most_vehicles` vehicles, each before its first junction, and slow enough to
  /// stop there by comfortable braking. The ego is the first one. Throws `ParameterError` if a parameter of `traffic`
  /// is out of range, `WorldError` if the map has no room before its junctions. O(vehicles^2).
  [[nodiscard]] Scenario<World> sample(std::uint64_t seed, std::uint32_t number,
                                       JunctionTraffic const& traffic = {}) const;
};

/// Finds where traffic can approach the junctions of a map: on lanes that begin at its edge if there are two, else on
/// all lanes outside of junctions. Throws `MapError` at `where`, the map's file, if no ways cross or merge in a
/// junction. O(lanes).
[[nodiscard]] JunctionSite find_junction_site(std::shared_ptr<Map const> map, std::string const& where = "map");

}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/scenario/junction_site_impl.hpp"
#endif
