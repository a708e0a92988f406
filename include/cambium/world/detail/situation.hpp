#pragma once

#include <cstdint>
#include <tuple>
#include <variant>

#include "cambium/goal/goal.hpp"
#include "cambium/goal/goal_situation.hpp"
#include "cambium/world/frame.hpp"

namespace cambium::inline v0_1::detail {

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

/// Records which parts of its goal sequence an agent in traffic has reached.
template <class Agent, class Record>
void pass_goals(Agent const& agent, Goal const& goal, Record& record) {
  auto const* const sequence = std::get_if<GoalSequence>(&goal);
  if (sequence && record.status != AgentStatus::not_started)
    record.goals_passed = static_cast<std::uint8_t>(sequence->pass(situation_of(agent, record)));
}

}  // namespace cambium::inline v0_1::detail
