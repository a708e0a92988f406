#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/geometry/shape.hpp"
#include "cambium/goal/goal.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/world/static_object.hpp"
#include "cambium/world/traffic_index.hpp"

namespace cambium::inline v0_1 {

/// A free corridor as the user gave it, and a copy whose lane coordinates follow those of the map.
struct FreeRoad {
  std::shared_ptr<map::RoadCorridor const> given, numbered;
};

namespace detail {
/// Removes all elements except those at `slots` (ascending). O(elements).
template <class T>
void keep_at(std::vector<Slot> const& slots, IdVector<T, Slot>& list) {
  for (std::size_t to = 0; to < slots.size(); ++to)
    if (to != index_of(slots[to])) list[to] = std::move(list[slots[to]]);
  list.erase(list.begin() + static_cast<std::ptrdiff_t>(slots.size()), list.end());
}
}  // namespace detail

/// What a roster keeps about the world as a whole.
struct RosterFacts {
  std::uint64_t seed = 0;
  /// Counts the changes that make earlier frames invalid: agents, roads, models of behaviour.
  std::uint32_t revision = 0;
  std::uint32_t next_agent_id = 0;
  std::uint32_t next_object_id = 0;
  std::vector<map::LightPlan> lights{};               ///< by `LightId`; lights beyond the end are off
  geometry::Shape largest_shape{0.0, 0.0, 0.0, 0.0};  ///< holds those of all agents that are, or were, in the world
};

/// The part of a roster that does not depend on the world's models.
struct RosterBase : RosterFacts {
  IdVector<Goal, Slot> goals;  ///< by slot
  bool has_sequences = false;  ///< a goal is, or was, a `GoalSequence`
  IdVector<StaticObject, Slot> objects;
  std::vector<TrafficEntry> object_entries;  ///< objects on lanes; `slot` indexes `objects`
  std::vector<FreeRoad> free_roads;          ///< free corridors that agents have entered on

  RosterBase();
  RosterBase(RosterBase const&);
  RosterBase(RosterBase&&) noexcept;
  RosterBase& operator=(RosterBase const&);
  RosterBase& operator=(RosterBase&&) noexcept;
  ~RosterBase();

  /// Adds a static object, with `entries` for the lanes that it lies on; returns its id. O(objects).
  ObjectId insert(StaticObject object, std::vector<TrafficEntry> const& entries);

  /// Removes the object at index `place`. O(objects).
  void erase_object(Slot slot);

  /// Appends the goal at `slot` of another roster; `NoGoal` if `other` is null.
  void assume_goal(RosterBase const* other, Slot slot);

  /// Copies the `seen` static objects of another roster, with their lane entries.
  void assume_objects(RosterBase const& other, IdVector<std::uint8_t, Slot> const& seen);

 protected:
  void insert_goal(Slot slot, Goal goal);
  void erase_goal(Slot slot);
  void keep_goals(std::vector<Slot> const& slots);
};

/// The agents of a world, with everything about them that a step does not change. Copies of the world share the roster;
/// it is copied on write. Agents are sorted by id; an agent's index is its slot, the same as in the frame.
template <class Behavior, class Execution, class Dynamics, class Observer>
struct Roster : RosterBase {
  /// What a step does not change of one agent.
  struct Agent {
    AgentId id = none<AgentId>;
    geometry::Shape shape;
    std::shared_ptr<map::RoadCorridor const> road;
    Behavior behavior;
    Execution execution;
    Dynamics dynamics;
    Observer observer;
  };

  IdVector<Agent, Slot> agents;

  /// The agent's slot; nothing if the roster has no such agent. O(log n).
  [[nodiscard]] std::optional<Slot> slot_of(AgentId id) const {
    auto const slot = place_of(id);
    if (index_of(slot) == agents.size() || agents[slot].id != id) return std::nullopt;
    return slot;
  }

  using RosterBase::insert;
  /// Adds an agent with an unused id; returns its slot. O(n).
  Slot insert(Agent agent, Goal goal) {
    auto const slot = place_of(agent.id);
    next_agent_id = std::max(next_agent_id, static_cast<std::uint32_t>(agent.id) + 1);
    largest_shape = geometry::joined(largest_shape, agent.shape);
    agents.insert(agents.begin() + static_cast<std::ptrdiff_t>(slot), std::move(agent));
    insert_goal(slot, std::move(goal));
    return slot;
  }

  /// Removes the agent at `slot`. O(n).
  void erase(Slot slot) {
    agents.erase(agents.begin() + static_cast<std::ptrdiff_t>(slot));
    erase_goal(slot);
  }

  /// Removes all agents except those at `slots` (ascending). O(n).
  void keep(std::vector<Slot> const& slots) {
    detail::keep_at(slots, agents);
    keep_goals(slots);
  }

 private:
  /// The slot of `id`, or the slot at which to insert it to keep the agents sorted.
  [[nodiscard]] Slot place_of(AgentId id) const {
    auto const at = std::lower_bound(agents.begin(), agents.end(), id,
                                     [](Agent const& agent, AgentId other) { return agent.id < other; });
    return static_cast<Slot>(at - agents.begin());
  }
};

}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/world/roster_impl.hpp"
#endif
