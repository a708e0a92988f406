#pragma once

#include "traffic.hpp"

namespace benchmark {

/// A tree search with its usual settings.
template <class Others>
[[nodiscard]] Search<Others> search() {
  Search<Others> planner;
  planner.options.budget.iterations = 150;
  return planner;
}

template <class Others>
[[nodiscard]] Contender with_speed(examples::ParameterFile& file, Search<Others> const& planner,
                                   std::string const& name) {
  return with_speed(file, planner, name, [](Search<Others>& own, double speed) {
    own.reward.desired_speed = speed;
    own.actions.driver.law.desired_speed = own.actions.macro.law.desired_speed = speed;
    own.actions.macro.highest_speed = 1.1 * speed;
  });
}

}  // namespace benchmark
