#pragma once

#include <algorithm>
#include <tuple>

#include "cambium/core/ids.hpp"
#include "cambium/world/frame.hpp"

namespace cambium::inline v0_1::detail {

/// Whether the other agent's bounding circle comes within `distance` [m] of the agent in slot `own`.
template <class World>
[[nodiscard]] bool is_near(World const& world, Slot own, Slot slot, double distance) {
  auto const& here = world.frame().agents[own].state;
  auto const& [shape, state] = std::tie(world.roster().agents[slot].shape, world.frame().agents[slot].state);
  double const reach = distance + std::max(shape.front, shape.rear) + std::max(shape.left, shape.right);
  double const dx = state.x - here.x, dy = state.y - here.y;
  return slot != own && dx * dx + dy * dy <= reach * reach;
}

/// See `ObservedWorld::around`; calls `visit(slot)`, for unseen agents, too.
template <class World, class Visit>
void for_each_around(World const& world, Slot own, double distance, Visit const& visit) {
  auto const& here = world.frame().agents[own].state;
  auto const visit_near = [&](Slot slot) {
    if (is_near(world, own, slot, distance)) visit(slot);
  };
  if constexpr (World::Behaviors::looks_around) {
    world.plane().for_each_near({here.x - distance, here.y - distance, here.x + distance, here.y + distance},
                                visit_near);
  } else {
    for (Slot i{}; index_of(i) < world.size(); ++i)
      if (world.frame().agents[i].status == AgentStatus::driving) visit_near(i);
  }
}

}  // namespace cambium::inline v0_1::detail
