#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "cambium/map/map.hpp"
#include "cambium/viewer/recording.hpp"
#include "cambium/world/frame.hpp"

namespace cambium {

/// The lanes of a map as a recording shows them.
[[nodiscard]] inline std::vector<RecordedLane> recorded_lanes(Map const& map) {
  std::vector<RecordedLane> lanes;
  for (auto const& lane : map.lanes()) {
    if (lane.left.empty() || lane.right.empty()) continue;
    auto const& road = map.road(lane.road);
    auto const kind = !lane.drivable()          ? RecordedLaneKind::other
                      : is_valid(road.junction) ? RecordedLaneKind::junction
                                                : RecordedLaneKind::driving;
    lanes.push_back(
        {lane.left.points(), lane.right.points(), road.name + ":" + std::to_string(lane.number), kind, true});
  }
  // Shoulders first, lanes over them: what is drawn last is seen.
  std::stable_sort(lanes.begin(), lanes.end(), [](RecordedLane const& a, RecordedLane const& b) {
    return a.kind == RecordedLaneKind::other && b.kind != RecordedLaneKind::other;
  });
  return lanes;
}

/// Writes a world's course into a recording: lanes, agents and objects as they are now; then a frame for each call of
/// `record`. Agents that enter later are not shown.
class WorldRecorder {
 public:
  template <class World>
  explicit WorldRecorder(World const& world, std::string title = {}) {
    recording_.title = std::move(title);
    recording_.lanes = recorded_lanes(world.map());
    for (auto const& agent : world.roster().agents)
      recording_.agents.push_back({agent.id, agent.shape, "", RecordedAgentKind::other});
    record(world);
  }

  /// How an agent is shown.
  void show_as(AgentId id, RecordedAgentKind kind, std::string label = {}) {
    for (auto& agent : recording_.agents)
      if (agent.id == id) {
        agent.kind = kind;
        agent.label = std::move(label);
      }
  }

  /// Adds the world's current frame.
  template <class World>
  void record(World const& world) {
    RecordedFrame frame{world.time(), std::vector<RecordedPose>(recording_.agents.size())};
    auto const& agents = world.roster().agents;
    std::size_t slot = 0;
    for (std::size_t i = 0; i < recording_.agents.size(); ++i) {  // both are in order of the ids
      while (slot < agents.size() && agents[slot].id < recording_.agents[i].id) ++slot;
      if (slot == agents.size()) break;
      if (agents[slot].id != recording_.agents[i].id) continue;
      auto const& r = world.frame().agents[slot];
      frame.poses[i] = {r.state.x,
                        r.state.y,
                        r.state.heading,
                        r.state.speed,
                        r.action.acceleration,
                        r.status == AgentStatus::driving};
    }
    recording_.frames.push_back(std::move(frame));
  }

  [[nodiscard]] Recording& recording() { return recording_; }
  [[nodiscard]] Recording const& recording() const { return recording_; }

 private:
  Recording recording_;
};

}  // namespace cambium
