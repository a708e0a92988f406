#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/map/fwd.hpp"
#include "cambium/viewer/recording.hpp"
#include "cambium/world/frame.hpp"

namespace cambium::inline v0_1 {

struct StaticObject;

/// The lanes of a map, for a recording.
[[nodiscard]] std::vector<RecordedLane> recorded_lanes(Map const& map);

/// The stop lines of a map (see `map::stop_lines`), for a recording.
[[nodiscard]] std::vector<RecordedStopLine> recorded_stop_lines(Map const& map);

/// A free corridor, for a recording: a strip drawn below the lanes.
[[nodiscard]] RecordedLane recorded_way(map::LaneCorridor const& way);

/// A static object, for a recording: the rectangle around its outline that is aligned with its longest side.
[[nodiscard]] std::pair<RecordedAgent, RecordedPose> recorded_object(StaticObject const& object);

/// Records a world. The constructor takes lanes, stop lines, agents, objects and the first frame; each call of `record`
/// adds a frame, and the agents that have entered since. Objects that enter later are not recorded.
class WorldRecorder {
 public:
  /// Begins with the map and the agents of `world` as it is.
  template <class World>
  explicit WorldRecorder(World const& world, std::string title = {}) {
    recording_.title = std::move(title);
    for (auto const& road : world.roster().free_roads)
      recording_.lanes.push_back(recorded_way(road.numbered->corridors.front()));
    for (auto& lane : recorded_lanes(world.map())) recording_.lanes.push_back(std::move(lane));
    recording_.stop_lines = recorded_stop_lines(world.map());
    add_entrants(world);
    for (auto const& object : world.roster().objects) {
      auto [shown, pose] = recorded_object(object);
      recording_.agents.push_back(std::move(shown));
      objects_.push_back(pose);
    }
    record(world);
  }

  /// Sets an agent's colour class and label. No effect if the recording has no such agent.
  void show_as(AgentId id, RecordedAgentKind kind, std::string const& label = {}) {
    for (auto& agent : recording_.agents)
      if (agent.id == id) {
        agent.kind = kind;
        agent.label = label;
      }
  }

  /// Adds the world's current frame.
  template <class World>
  void record(World const& world) {
    add_entrants(world);
    RecordedFrame frame{world.time(), std::vector<RecordedPose>(agents_)};
    for (auto const& light : world.roster().lights) frame.lights.push_back(light.at(frame.time));
    auto const& agents = world.roster().agents;
    std::size_t slot = 0;
    for (std::size_t i = 0; i < agents_; ++i) {  // both lists are sorted by id
      while (slot < agents.size() && agents[slot].id < recording_.agents[i].id) ++slot;
      if (slot == agents.size()) break;
      if (agents[slot].id != recording_.agents[i].id) continue;
      auto const& r = world.frame().agents[slot];
      frame.poses[i] = {r.state.x,
                        r.state.y,
                        r.state.heading,
                        r.state.speed,
                        static_cast<double>(r.acceleration),
                        r.status == AgentStatus::driving};
    }
    frame.poses.insert(frame.poses.end(), objects_.begin(), objects_.end());
    recording_.frames.push_back(std::move(frame));
  }

  [[nodiscard]] Recording& recording() { return recording_; }
  [[nodiscard]] Recording const& recording() const { return recording_; }

 private:
  /// Adds the agents that are not recorded yet, absent in all earlier frames.
  template <class World>
  void add_entrants(World const& world) {
    std::size_t i = 0;
    for (auto const& agent : world.roster().agents) {  // both lists are sorted by id
      while (i < agents_ && recording_.agents[i].id < agent.id) ++i;
      if (i < agents_ && recording_.agents[i].id == agent.id) continue;
      auto const place = static_cast<std::ptrdiff_t>(i);
      recording_.agents.insert(recording_.agents.begin() + place,
                               {agent.id, agent.shape, "", RecordedAgentKind::other});
      for (auto& frame : recording_.frames) frame.poses.insert(frame.poses.begin() + place, RecordedPose{});
      ++agents_;
    }
  }

  Recording recording_;
  std::size_t agents_ = 0;             ///< number of the world's agents; its objects follow them
  std::vector<RecordedPose> objects_;  ///< the same in every frame
};

}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/viewer/record_world_impl.hpp"
#endif
