#pragma once

#include "cambium/core/ids.hpp"
#include "cambium/world/detail/on_lanes.hpp"
#include "cambium/world/detail/situation.hpp"
#include "cambium/world/frame.hpp"

namespace cambium::inline v0_1 {

/// The record of the agent at `slot` of `world` once it has driven from `before` to `state`: its lane, its status and
/// the parts of its goal that it has passed are what a step of the world finds. Its memory stays.
template <class World>
[[nodiscard]] typename World::Record driven_to(World const& world, Slot slot, typename World::Record const& before,
                                               typename World::State const& state) {
  if (before.status != AgentStatus::driving) return before;  // it has left
  auto record = before;
  auto const& agent = world.roster().agents[slot];
  double const duration = state.time - before.state.time;
  record.state = state;
  record.action = {};
  if (duration > 0.0) record.action.acceleration = (state.speed - before.state.speed) / duration;
  record.acceleration = static_cast<float>(record.action.acceleration);
  detail::move_on_lane(world.map(), *agent.road, 0.5 * (before.state.speed + state.speed) * duration, record);
  detail::pass_goals(agent, world.roster().goals[slot], record);
  return record;
}

}  // namespace cambium::inline v0_1
