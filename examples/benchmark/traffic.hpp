#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/open_loop/constant_acceleration.hpp"
#include "cambium/behavior/drivers.hpp"
#include "cambium/behavior/actions/driver_actions.hpp"
#include "cambium/behavior/actions/idm_proposal.hpp"
#include "cambium/benchmark/benchmark_traffic.hpp"
#include "cambium/benchmark/contender.hpp"
#include "cambium/planner/frenet/frenet_planner.hpp"
#include "cambium/planner/mcts/mcts.hpp"
#include "cambium/planner/policy/policy_tree_planner.hpp"
#include "cambium/planner/policy/proposal_planner.hpp"
#include "cambium/world/extern_world.hpp"
#include "cambium/world/world.hpp"

#include "../common/parameter_file.hpp"
#include "../common/thawed.hpp"

namespace benchmark {

namespace cb = cambium;

using Traffic = cb::BenchmarkTraffic;
using Spec = Traffic::AgentSpec;

/// What planners predict with.
template <class... Behaviors>
using Prediction = Traffic::WithBehaviors<cb::BehaviorSet<Behaviors...>>;

/// What the tree searches choose from: macro actions, or to drive as one does in town.
using Actions = cb::DriverActions<cb::UrbanDriver>;

/// A tree search that expects `Others` of the others.
template <class Others>
using Search = cb::Mcts<Prediction<Actions, Others>, Actions, cb::TrafficReward, Others>;

using Expecting = Search<cb::UrbanDriver>;
using Learning = Search<cb::HeadwayHypotheses<cb::UrbanDriver>>;
using PolicyTree = cb::PolicyTreePlanner<Prediction<Actions, cb::UrbanDriver>>;
using Proposals = cb::ProposalPlanner<Prediction<cb::IdmProposal, cb::ConstantAcceleration>>;
using Frenet = cb::FrenetPlanner<Prediction<cb::ConstantAcceleration>>;

/// All behaviours under test: they share a world, so that it is compiled once.
using Tested =
    cb::OneOf<cb::IdmClassic, cb::Mobil, cb::UrbanDriver, Expecting, Learning, PolicyTree, Proposals, Frenet>;
using TestedWorld = cb::ContenderWorld<Traffic, Tested>;

using Contender = cb::Contender<Traffic>;

/// The snapshot of a failed run, and what thaws it.
[[nodiscard]] std::string freeze(cb::FailedRun<TestedWorld> const& run);
[[nodiscard]] std::unique_ptr<examples::Thawed> thaw(std::shared_ptr<cb::Map const> map, std::string_view bytes,
                                                     std::string const& where);

/// The speed that the scenario's driver of the ego likes: contenders drive in its place and have the same wish.
[[nodiscard]] double desired_speed(Spec const& ego);

/// A driver by its name, its parameters as text and hash, and what drives the ego.
[[nodiscard]] Contender driver(std::string name, std::string parameters, std::uint64_t hash,
                               std::function<Tested(Spec const&)> choose);

/// A driver whose parameters are `planner` with what the file says of `name`. Where the file gives no desired speed, it
/// has that of the scenario's ego: `set_speed(planner, speed)`.
template <class Planner, class SetSpeed>
[[nodiscard]] Contender with_speed(examples::ParameterFile& file, Planner planner, std::string const& name,
                                   SetSpeed set_speed) {
  auto const usual = planner;
  file.take(planner, name);
  auto const at_speed = [usual, set_speed, name, file](double speed) {
    auto own = usual;
    set_speed(own, speed);
    file.set(own, name);
    return own;
  };
  file.show(at_speed(1.0), name);  // printed where the file gives it
  return driver(name, cb::to_string(planner), cb::hash_parameters(planner),
                [at_speed](Spec const& ego) { return Tested(at_speed(desired_speed(ego))); });
}

// The shipped behaviours; each planner in a source file of its own, because planners take long to compile.
[[nodiscard]] Contender idm(examples::ParameterFile& file);
[[nodiscard]] Contender mobil(examples::ParameterFile& file);
[[nodiscard]] Contender urban(examples::ParameterFile& file);
[[nodiscard]] Contender proposals(examples::ParameterFile& file);
[[nodiscard]] Contender policy_tree(examples::ParameterFile& file);
[[nodiscard]] Contender frenet(examples::ParameterFile& file);
[[nodiscard]] Contender mcts_single_agent(examples::ParameterFile& file);
[[nodiscard]] Contender mcts_cooperative(examples::ParameterFile& file);
[[nodiscard]] Contender mcts_hypothesis(examples::ParameterFile& file);

/// All of them.
[[nodiscard]] inline std::vector<Contender> shipped(examples::ParameterFile& file) {
  return {idm(file),
          mobil(file),
          urban(file),
          proposals(file),
          policy_tree(file),
          frenet(file),
          mcts_single_agent(file),
          mcts_cooperative(file),
          mcts_hypothesis(file)};
}

}  // namespace benchmark

CAMBIUM_EXTERN_WORLD(benchmark::TestedWorld);
CAMBIUM_EXTERN_PLANNING(benchmark::TestedWorld, cambium::ContenderBehavior<benchmark::Expecting>);
CAMBIUM_EXTERN_PLANNING(benchmark::TestedWorld, cambium::ContenderBehavior<benchmark::Learning>);
CAMBIUM_EXTERN_PLANNING(benchmark::TestedWorld, cambium::ContenderBehavior<benchmark::PolicyTree>);
CAMBIUM_EXTERN_PLANNING(benchmark::TestedWorld, cambium::ContenderBehavior<benchmark::Proposals>);
CAMBIUM_EXTERN_PLANNING(benchmark::TestedWorld, cambium::ContenderBehavior<benchmark::Frenet>);
