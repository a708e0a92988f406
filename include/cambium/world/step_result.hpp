#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>

#include "cambium/core/ids.hpp"

namespace cambium::inline v0_1 {

/// Why a step failed, as a whole or for one agent.
enum class StepProblem : std::uint8_t {
  none,
  bad_duration,  ///< dt is not above 0 and at most `World::longest_step`: the world is unchanged
  no_plan,       ///< a behaviour returned no plan
  no_execution,  ///< a plan ends before the step does, or its execution failed
  not_finite,    ///< the next state is not finite
  bad_speed,     ///< the next speed is negative, or above 1000 m/s
  too_far,       ///< the next position is more than 10^9 m from the origin of the map
};

/// The result of a step. Agents with a problem keep their last valid state and leave traffic; all others have moved.
struct [[nodiscard("a step that is not valid may not have moved the world: check the result")]] StepResult {
  StepProblem problem = StepProblem::none;  ///< the first problem
  AgentId agent = none<AgentId>;            ///< the agent that had it
  std::uint32_t failed = 0;                 ///< number of agents with a problem
  std::uint32_t left = 0;                   ///< number of agents that left traffic without a problem in this step

  [[nodiscard]] bool valid() const { return problem == StepProblem::none; }
  explicit operator bool() const { return valid(); }
};

/// The problem as a clause for messages.
[[nodiscard]] constexpr char const* to_string(StepProblem problem) {
  constexpr char const* clauses[] = {"no problem",
                                     "the step length is not above 0 and up to an hour",
                                     "the behaviour found no plan",
                                     "the plan does not reach the end of the step",
                                     "the next state is not a finite number",
                                     "the next speed is not from 0 to 1000 m/s",
                                     "the next position is more than 1e9 m from the origin of the map"};
  auto const number = static_cast<std::size_t>(problem);
  return number < std::size(clauses) ? clauses[number] : "unknown problem";
}

}  // namespace cambium::inline v0_1
