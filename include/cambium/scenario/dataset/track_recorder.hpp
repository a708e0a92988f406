#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "cambium/core/ids.hpp"
#include "cambium/geometry/shape.hpp"
#include "cambium/scenario/dataset/recorded_traffic.hpp"
#include "cambium/world/frame.hpp"

namespace cambium::inline v0_1 {

/// The type of a body by its size, because a world does not say it.
[[nodiscard]] constexpr TrackType type_of_body(double length, double width) {
  if (length <= geometry::longest_on_foot) return TrackType::pedestrian;
  if (width <= 0.7 && length <= 2.2) return TrackType::bicycle;
  if (width <= 1.0 && length <= 3.0) return TrackType::motorcycle;
  return length <= 6.5 ? TrackType::car : TrackType::truck;
}

/// Records a world as traffic that can be written, replayed and compared. The constructor takes the map, the objects
/// (as rectangles around them) and the first states; each call of `record` adds a state of every agent in traffic.
/// `RecordedTraffic::time_step` is what the caller steps by.
class TrackRecorder {
 public:
  /// Begins with the agents of `world` as it is; `time_step` [s] is that of its steps.
  template <class World>
  explicit TrackRecorder(World const& world, double time_step, std::string name = "run") {
    traffic_.name = std::move(name);
    traffic_.time_step = time_step;
    traffic_.map = world.shared_map();
    traffic_.lights = world.roster().lights;
    std::int64_t id = 4'000'000'000;  // far from those of agents
    for (auto const& object : world.roster().objects) {
      auto const& box = object.outline.bounding_box();
      traffic_.tracks.push_back({.id = id++,
                                 .type = TrackType::other,
                                 .length = box.max_x - box.min_x,
                                 .width = box.max_y - box.min_y,
                                 .stands = true,
                                 .states = {State{world.time(), box.center().x(), box.center().y(), 0.0, 0.0}}});
      for (auto const& corner : object.outline.points())
        traffic_.tracks.back().outline.push_back(corner - box.center());
    }
    record(world);
  }

  /// Adds the world's current state. O(agents log agents).
  template <class World>
  void record(World const& world) {
    auto const& agents = world.roster().agents;
    for (Slot slot{}; index_of(slot) < agents.size(); ++slot) {
      auto const& record = world.frame().agents[slot];
      if (record.status != AgentStatus::driving) continue;
      auto const& agent = agents[slot];
      auto const [at, is_new] = places_.try_emplace(agent.id, traffic_.tracks.size());
      if (is_new) {
        double const length = agent.shape.length(), width = agent.shape.width();
        traffic_.tracks.push_back(
            {static_cast<std::int64_t>(index_of(agent.id)), type_of_body(length, width), length, width, false, {}});
      }
      auto const& s = record.state;
      auto& states = traffic_.tracks[at->second].states;
      if (states.empty() || states.back().time < world.time())
        states.push_back(middle_state({world.time(), s.x, s.y, s.heading, s.speed}, agent.shape));
    }
  }

  [[nodiscard]] RecordedTraffic const& traffic() const { return traffic_; }
  [[nodiscard]] RecordedTraffic& traffic() { return traffic_; }

 private:
  RecordedTraffic traffic_;
  std::map<AgentId, std::size_t> places_;
};

}  // namespace cambium::inline v0_1
