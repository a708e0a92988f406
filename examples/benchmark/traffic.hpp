#pragma once

#include <string>
#include <vector>

#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/following/constant_acceleration.hpp"
#include "cambium/behavior/following/idm_classic.hpp"
#include "cambium/behavior/junction/intersection.hpp"
#include "cambium/behavior/lane_change/mobil.hpp"
#include "cambium/behavior/pedestrian/pedestrian.hpp"
#include "cambium/benchmark/contender.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/observer/observer_set.hpp"
#include "cambium/observer/occluded.hpp"
#include "cambium/observer/perfect.hpp"
#include "cambium/snapshot/freeze_run.hpp"
#include "cambium/world/world.hpp"

#include "../common/parameter_file.hpp"
#include "../common/thawed.hpp"

namespace benchmark {

namespace cb = cambium;

/// The drivers that scenario files may name, and how these see.
using Traffic =
    cb::World<cb::BehaviorSet<cb::IdmClassic, cb::Mobil, cb::Intersection, cb::ConstantAcceleration, cb::Pedestrian>,
              cb::InterpolateExecution, cb::SingleTrack, cb::ObserverSet<cb::PerfectObserver, cb::OccludedObserver>>;

/// A behaviour under test, and how to thaw the snapshot of a run that it failed.
struct Driver {
  cb::Contender<Traffic> contender;
  examples::Thaw thaw;
};
using Spec = Traffic::AgentSpec;

/// What planners predict with.
template <class... Behaviors>
using Prediction = Traffic::WithBehaviors<cb::BehaviorSet<Behaviors...>>;

/// The speed that the scenario's driver of the ego likes: contenders drive in its place and have the same wish.
[[nodiscard]] double desired_speed(Spec const& ego);

/// A driver whose parameters are `planner` with what the file says of `name`, but for the ego's desired speed:
/// `set_speed(planner, speed)`.
template <class Planner, class SetSpeed>
[[nodiscard]] Driver with_speed(examples::ParameterFile& file, Planner planner, std::string const& name,
                                SetSpeed set_speed) {
  file.take(planner, name);
  auto const choose = [planner, set_speed](Spec const& ego, cb::Scenario<Traffic> const&) {
    auto own = planner;
    set_speed(own, desired_speed(ego));
    return own;
  };
  return {cb::contender_by<Traffic>(name, cb::to_string(planner), cb::hash_parameters(planner), choose, cb::freeze_run),
          &examples::thaw<cb::ContenderWorld<Traffic, Planner>, cb::RunPosition>};
}

// The shipped behaviours, a source file each, because planners take long to compile.
[[nodiscard]] Driver idm(examples::ParameterFile& file);
[[nodiscard]] Driver mobil(examples::ParameterFile& file);
[[nodiscard]] Driver intersection(examples::ParameterFile& file);
[[nodiscard]] Driver proposals(examples::ParameterFile& file);
[[nodiscard]] Driver policy_tree(examples::ParameterFile& file);
[[nodiscard]] Driver frenet(examples::ParameterFile& file);
[[nodiscard]] Driver mcts_single_agent(examples::ParameterFile& file);
[[nodiscard]] Driver mcts_cooperative(examples::ParameterFile& file);
[[nodiscard]] Driver mcts_hypothesis(examples::ParameterFile& file);

/// All of them.
[[nodiscard]] inline std::vector<Driver> shipped(examples::ParameterFile& file) {
  return {idm(file),
          mobil(file),
          intersection(file),
          proposals(file),
          policy_tree(file),
          frenet(file),
          mcts_single_agent(file),
          mcts_cooperative(file),
          mcts_hypothesis(file)};
}

}  // namespace benchmark
