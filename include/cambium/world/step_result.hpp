#pragma once

#include <cstdint>

#include "cambium/core/ids.hpp"

namespace cambium {

/// Why a step, or an agent's part in it, was not valid.
enum class StepProblem : std::uint8_t {
  none,
  bad_duration,  ///< dt is not a number above 0 and up to `World::longest_step`: nothing happened
  no_plan,       ///< a behaviour failed
  no_execution,  ///< a plan does not reach the end of the step, or its execution failed
  not_finite,    ///< the next state would not have been a finite number
  bad_speed,     ///< the next speed would have been negative, or above 1000 m/s
};

/// What became of a step. Agents with a problem keep their last valid state and leave traffic; all others have moved.
struct [[nodiscard("a step that is not valid may not have moved the world: check the result")]] StepResult {
  StepProblem problem = StepProblem::none;  ///< the first
  AgentId agent = none<AgentId>;            ///< who had it
  std::uint32_t failed = 0;                 ///< agents with a problem
  std::uint32_t left = 0;                   ///< agents that arrived, left the map or expired in this step

  [[nodiscard]] bool valid() const { return problem == StepProblem::none; }
  explicit operator bool() const { return valid(); }
};

/// The problem as a clause for messages.
[[nodiscard]] constexpr char const* to_string(StepProblem problem) {
  switch (problem) {
    case StepProblem::none:
      return "no problem";
    case StepProblem::bad_duration:
      return "the step length is not above 0 and up to an hour";
    case StepProblem::no_plan:
      return "the behaviour found no plan";
    case StepProblem::no_execution:
      return "the plan does not reach the end of the step";
    case StepProblem::not_finite:
      return "the next state is not a finite number";
    case StepProblem::bad_speed:
      return "the next speed is not from 0 to 1000 m/s";
  }
  return "unknown problem";
}

}  // namespace cambium
