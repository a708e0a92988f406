#pragma once

#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/drivers.hpp"
#include "cambium/behavior/open_loop/constant_acceleration.hpp"
#include "cambium/behavior/pedestrian/pedestrian.hpp"
#include "cambium/behavior/wrap/human_driver.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/observer/observer_set.hpp"
#include "cambium/observer/occluded.hpp"
#include "cambium/observer/parametric.hpp"
#include "cambium/observer/perfect.hpp"
#include "cambium/world/world.hpp"

namespace cambium::inline v0_1 {

/// The world that the scenario sets of the repository need (`examples/benchmark/sets`): the drivers that their files
/// name, and how these see.
using BenchmarkTraffic =
    World<BehaviorSet<IdmClassic, Mobil, UrbanDriver, ConstantAcceleration, Pedestrian, HumanDriver<Mobil>,
                      HumanDriver<UrbanDriver>>,
          InterpolateExecution, SingleTrack, ObserverSet<PerfectObserver, OccludedObserver, ParametricObserver>>;

}  // namespace cambium::inline v0_1
