#pragma once

#include "cambium/behavior/lane_change/driver_actions.hpp"
#include "cambium/planner/mcts/mcts.hpp"

#include "traffic.hpp"

namespace benchmark {

/// What the tree searches choose from: macro actions, or to drive as one does at junctions.
using Actions = cb::DriverActions<cb::Intersection>;

/// A tree search that expects `Others` of the others, with its usual settings.
template <class Others>
using Search = cb::Mcts<Prediction<Actions, Others>, Actions, cb::TrafficReward, Others>;

template <class Others>
[[nodiscard]] Search<Others> search() {
  Search<Others> planner;
  planner.options.budget.iterations = 150;
  return planner;
}

template <class Others>
[[nodiscard]] Driver with_speed(examples::ParameterFile& file, Search<Others> const& planner, std::string const& name) {
  return with_speed(file, planner, name, [](Search<Others>& own, double speed) {
    own.reward.desired_speed = speed;
    own.actions.driver.idm.desired_speed = own.actions.macro.idm.desired_speed = speed;
    own.actions.macro.highest_speed = 1.1 * speed;
  });
}

}  // namespace benchmark
