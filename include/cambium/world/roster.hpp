#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/geometry/shape.hpp"
#include "cambium/goal/goal.hpp"
#include "cambium/map/corridor.hpp"
#include "cambium/world/static_object.hpp"
#include "cambium/world/traffic_index.hpp"

namespace cambium {

/// A free corridor as it was given, and as the world has it: with lane coordinates of its own, behind those of the map.
struct FreeRoad {
  std::shared_ptr<map::RoadCorridor const> given, numbered;
};

/// Who the agents of a world are: what does not change while nobody enters or leaves. Shared by copies of the world,
/// copied on write. Agents are in order of their ids; an agent's place there is its slot, the same as in the frame.
template <class Behavior, class Execution, class Dynamics, class Observer>
struct Roster {
  struct Agent {
    AgentId id = none<AgentId>;
    geometry::Shape shape;
    std::shared_ptr<map::RoadCorridor const> road;
    Behavior behavior;
    Execution execution;
    Dynamics dynamics;
    Observer observer;
  };

  std::uint64_t seed = 0;
  std::uint32_t next_agent_id = 0;
  std::uint32_t next_object_id = 0;
  std::vector<Agent> agents;
  std::vector<Goal> goals;             ///< by slot
  bool has_sequences = false;          ///< one of them is, or was, a `GoalSequence`
  std::vector<map::LightPlan> lights;  ///< by `LightId`; off beyond its end
  std::vector<StaticObject> objects;
  std::vector<TrafficEntry> object_entries;  ///< objects on the lanes that they stand in; slot: place in `objects`
  std::vector<FreeRoad> free_roads;          ///< those that agents have entered on

  /// The agent's slot; nothing if there is no such agent. O(log n).
  [[nodiscard]] std::optional<std::size_t> slot_of(AgentId id) const {
    auto const at =
        std::lower_bound(agents.begin(), agents.end(), id, [](Agent const& a, AgentId b) { return a.id < b; });
    if (at == agents.end() || at->id != id) return std::nullopt;
    return static_cast<std::size_t>(at - agents.begin());
  }

  /// Takes in an agent whose id nobody has; returns its slot. O(n).
  std::size_t insert(Agent agent, Goal goal) {
    auto const place =
        std::lower_bound(agents.begin(), agents.end(), agent.id, [](Agent const& a, AgentId b) { return a.id < b; });
    auto const slot = place - agents.begin();
    next_agent_id = std::max(next_agent_id, static_cast<std::uint32_t>(agent.id) + 1);
    agents.insert(place, std::move(agent));
    has_sequences = has_sequences || std::holds_alternative<GoalSequence>(goal);
    goals.insert(goals.begin() + slot, std::move(goal));
    return static_cast<std::size_t>(slot);
  }

  /// Takes the agent at `slot` out. O(n).
  void erase(std::size_t slot) {
    agents.erase(agents.begin() + static_cast<std::ptrdiff_t>(slot));
    goals.erase(goals.begin() + static_cast<std::ptrdiff_t>(slot));
  }

  /// Takes all out but those at `slots`, which ascend. O(n).
  void keep(std::vector<std::size_t> const& slots) {
    for (std::size_t to = 0; to < slots.size(); ++to) {
      if (to == slots[to]) continue;
      agents[to] = std::move(agents[slots[to]]);
      goals[to] = std::move(goals[slots[to]]);
    }
    agents.erase(agents.begin() + static_cast<std::ptrdiff_t>(slots.size()), agents.end());
    goals.erase(goals.begin() + static_cast<std::ptrdiff_t>(slots.size()), goals.end());
  }

  /// Takes in a static object, with `entries` for the lanes that it stands in; returns its id. O(objects).
  ObjectId insert(StaticObject object, std::vector<TrafficEntry> const& entries) {
    object_entries.reserve(object_entries.size() + entries.size());
    objects.push_back(std::move(object));
    for (auto const& entry : entries)
      object_entries.insert(std::upper_bound(object_entries.begin(), object_entries.end(), entry), entry);
    return static_cast<ObjectId>(next_object_id++);
  }

  /// Takes the object at `place` out. O(objects).
  void erase_object(std::size_t place) {
    objects.erase(objects.begin() + static_cast<std::ptrdiff_t>(place));
    auto const slot = static_cast<std::uint32_t>(place);
    std::erase_if(object_entries, [slot](TrafficEntry const& entry) { return entry.slot == slot; });
    for (auto& entry : object_entries) entry.slot -= entry.slot > slot;
  }
};

}  // namespace cambium
