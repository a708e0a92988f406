#pragma once

#include <algorithm>
#include <cstddef>

#include "cambium/core/macros.hpp"
#include "cambium/goal/goal.hpp"

namespace cambium::inline v0_1 {

CAMBIUM_NOINLINE CAMBIUM_COLD bool at_goal(Goal const& goal, GoalSituation const& situation) {
  return goal.visit([&](auto const& g) { return g.at_goal(situation); });
}

CAMBIUM_NOINLINE CAMBIUM_COLD bool AllGoals::at_goal(GoalSituation const& at) const {
  return !parts.empty() &&
         std::all_of(parts.begin(), parts.end(), [&](Goal const& part) { return cambium::at_goal(part, at); });
}

CAMBIUM_NOINLINE CAMBIUM_COLD bool AnyGoal::at_goal(GoalSituation const& at) const {
  return std::any_of(parts.begin(), parts.end(), [&](Goal const& part) { return cambium::at_goal(part, at); });
}

CAMBIUM_NOINLINE CAMBIUM_COLD std::size_t GoalSequence::pass(GoalSituation const& at) const {
  auto passed = at.passed;
  while (passed < parts.size() && cambium::at_goal(parts[passed], at)) ++passed;
  return passed;
}

}  // namespace cambium::inline v0_1
