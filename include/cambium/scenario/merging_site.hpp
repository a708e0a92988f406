#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/drivers.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/routing/route.hpp"
#include "cambium/scenario/scenario.hpp"
#include "cambium/scenario/vehicle_mix.hpp"
#include "cambium/world/world.hpp"

namespace cambium::inline v0_1 {

/// What traffic at a merge consists of.
struct MergingTraffic {
  VehicleMix mix{};
  double non_yielding_share = 0.0;
  bool ramp_waits = false;

  static constexpr char const* name = "merging_traffic";
  static constexpr auto parameters() {
    using P = MergingTraffic;
    return parameter_list(parameter("mix", &P::mix, "which vehicles"),
                          parameter("non_yielding_share", &P::non_yielding_share, "-", Range{0, 1},
                                    "part of the drivers on the through road who open no gap (`Merging::ignored`)"),
                          parameter("ramp_waits", &P::ramp_waits,
                                    "1: drivers on the ramp wait for a gap (`Merging::gives_way`); 0: they force "
                                    "their way"));
  }
};

/// A place where traffic merges, at an on-ramp or a lane drop: samples dense traffic from every entrance up to it. Made
/// by `find_merging_site`.
struct MergingSite {
  /// A way into the map: a lane where traffic enters, and the route straight on from there.
  struct Entrance {
    map::Route route;
    double length{};             ///< of the lane corridor from the entrance to its end [m]
    double merge_at{};           ///< where its path begins to swing onto a neighbour's or to overlap with another's [m]
    bool gives_up_lane = false;  ///< its lane ends in the merge: its vehicles are those that merge
    double traffic_end{};        ///< traffic starts before this place: the merge, on the lanes beside it too [m]

    [[nodiscard]] bool merges() const { return merge_at < length; }
  };

  /// The worlds that the sampled scenarios are for; `with_behaviors` makes them fit others.
  using World = cambium::World<BehaviorSet<IdmClassic>, InterpolateExecution, SingleTrack>;

  std::shared_ptr<Map const> map;
  std::vector<Entrance> entrances;
  std::size_t ramp{};        ///< the entrance whose vehicles merge
  std::size_t crossings{};   ///< places where routes cross or meet at an angle; car following gives way at none of them
  double free_speed = 13.9;  ///< [m/s]: the speed limit at the ramp, else 50 km/h

  /// Scenario `number` of a seed: cars and trucks on all entrances, with gaps that leave time to brake, merging traffic
  /// included. The goal of all vehicles on the ramp is the lane behind the merge; the ego is the one in their middle.
  /// Throws `ParameterError` if a parameter of `traffic` is out of range, `WorldError` if the map has no room before
  /// the merge. O(vehicles^2).
  [[nodiscard]] Scenario<World> sample(std::uint64_t seed, std::uint32_t number,
                                       MergingTraffic const& traffic = {}) const;
};

/// Finds the merge of a map: among the lanes that begin at its edge, the one that ends in a merge after the longest
/// way. Throws `MapError` at `where`, the map's file, if no traffic merges. O(lanes).
[[nodiscard]] MergingSite find_merging_site(std::shared_ptr<Map const> map, std::string const& where = "map");

}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/scenario/merging_site_impl.hpp"
#endif
