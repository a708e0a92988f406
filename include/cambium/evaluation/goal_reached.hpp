#pragma once

#include "cambium/core/ids.hpp"

namespace cambium {

/// Whether an agent is at its goal. Throws `WorldError` if the world does not have the agent.
struct GoalReached {
  struct Result {
    bool goal_reached = false;
  };

  AgentId agent = none<AgentId>;

  template <class World>
  [[nodiscard]] Result evaluate(World const& world) const {
    return {world.reached_goal(agent)};
  }
};

}  // namespace cambium
