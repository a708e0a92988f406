#pragma once

#include "cambium/behavior/lane_change/driver_actions.hpp"
#include "cambium/planner/mcts/mcts.hpp"

#include "traffic.hpp"

namespace benchmark {

/// What the tree searches choose from: macro actions, or to drive as one does at junctions.
using Actions = cb::DriverActions<cb::Intersection>;

/// A tree search that expects `Others` of the others. Its settings were tuned on seeds other than those of the sets.
template <class Others>
using Search = cb::Mcts<Prediction<Actions, Others>, Actions, cb::Reward<cb::LaneChangeUrgency>, Others>;

template <class Others>
[[nodiscard]] Search<Others> search() {
  Search<Others> planner;
  planner.options.budget.iterations = 150;
  planner.options.selection.exploration = 0.15;
  planner.options.rollout.hold = 5;               // random actions that last a second, not 0.2 s
  planner.reward.traffic.speed_deviation = -1.0;  // else nothing moves it before the goal is near
  planner.reward.template term<cb::LaneChangeUrgency>() = {.weight = -40.0,
                                                           .per_second = true};  // nor into the lane of its exit
  return planner;
}

template <class Others>
[[nodiscard]] Contender with_speed(examples::ParameterFile& file, Search<Others> const& planner,
                                   std::string const& name) {
  return with_speed(file, planner, name, [](Search<Others>& own, double speed) {
    own.reward.traffic.desired_speed = speed;
    own.actions.driver.idm.desired_speed = own.actions.macro.idm.desired_speed = speed;
    own.actions.macro.highest_speed = 1.1 * speed;
  });
}

}  // namespace benchmark
