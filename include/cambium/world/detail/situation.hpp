#pragma once

#include <tuple>

#include "cambium/goal/goal_situation.hpp"

namespace cambium::detail {

/// An agent's situation as goals see it, from `agent` in the roster and its `record` in the frame.
template <class Agent, class Record>
[[nodiscard]] GoalSituation situation_of(Agent const& agent, Record const& record) {
  auto const& [state, lane] = std::tie(record.state, record.lane);
  auto const& piece = agent.road->corridors[lane.corridor].pieces[lane.piece];
  return {{state.x, state.y, state.heading},
          agent.shape,
          piece.lane,
          lane.s + piece.lane_offset,
          state.speed,
          lane.lateral,
          lane.heading_error,
          agent.road.get(),
          lane.corridor,
          lane.s,
          record.goals_passed};
}

}  // namespace cambium::detail
