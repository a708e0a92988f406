#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/geometry/shape.hpp"
#include "cambium/goal/goal.hpp"
#include "cambium/map/corridor.hpp"
#include "cambium/world/static_object.hpp"
#include "cambium/world/traffic_index.hpp"

namespace cambium {

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
  std::map<std::vector<LaneId>, std::shared_ptr<map::RoadCorridor const>> corridors;  ///< built so far, by route

  /// The agent's slot; nothing if there is no such agent. O(log n).
  [[nodiscard]] std::optional<std::size_t> slot_of(AgentId id) const {
    auto const at =
        std::lower_bound(agents.begin(), agents.end(), id, [](Agent const& a, AgentId b) { return a.id < b; });
    if (at == agents.end() || at->id != id) return std::nullopt;
    return static_cast<std::size_t>(at - agents.begin());
  }
};

}  // namespace cambium
