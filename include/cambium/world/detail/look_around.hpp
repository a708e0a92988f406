#pragma once

#include <algorithm>
#include <cstdint>
#include <tuple>

#include "cambium/world/detail/seen.hpp"
#include "cambium/world/frame.hpp"

namespace cambium::detail {

/// Calls `visit(slot)` for every other agent in traffic that the agent in slot `own` sees, in the order of their ids.
template <class World, class Visit>
void for_each_other(World const& world, Slot own, Visit const& visit) {
  for (Slot i{}; index_of(i) < world.size(); ++i)
    if (i != own && world.frame().agents[i].status == AgentStatus::driving && is_seen(world, own, i)) visit(i);
}

/// Whether the agent in slot `own` sees the other one in slot `slot`, and its bounding circle comes within `distance`
/// [m].
template <class World>
[[nodiscard]] bool is_near(World const& world, Slot own, Slot slot, double distance) {
  auto const& here = world.frame().agents[own].state;
  auto const& [shape, state] = std::tie(world.roster().agents[slot].shape, world.frame().agents[slot].state);
  double const reach = distance + std::max(shape.front, shape.rear) + std::max(shape.left, shape.right);
  double const dx = state.x - here.x, dy = state.y - here.y;
  return slot != own && dx * dx + dy * dy <= reach * reach && is_seen(world, own, slot);
}

/// See `ObservedWorld::around`; calls `visit(slot)`.
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

/// Calls `f(id, outline)` for each static object that the agent in slot `own` sees, in the order of their ids.
template <class World, class F>
void for_each_object(World const& world, Slot own, F&& f) {
  auto const& objects = world.roster().objects;
  for (Slot i{}; index_of(i) < objects.size(); ++i)
    if (is_object_seen(world, own, i)) f(objects[i].id, objects[i].outline);
}

}  // namespace cambium::detail
