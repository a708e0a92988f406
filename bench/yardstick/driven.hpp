#pragma once

#include <bit>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "cambium/behavior/behavior_set.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/random.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/geometry/polygon.hpp"
#include "cambium/geometry/shape.hpp"
#include "cambium/goal/goal.hpp"
#include "cambium/map/map.hpp"
#include "cambium/world/world.hpp"

// Where traffic drives, as one hash for each model and map.

namespace yardstick {

namespace cb = cambium;

/// FNV-1a over the bits of numbers.
class Hash {
 public:
  void add(std::uint64_t word) {
    for (int byte = 0; byte < 8; ++byte) value_ = (value_ ^ (word >> (8 * byte) & 0xff)) * 1099511628211ull;
  }
  void add(double x) { add(std::bit_cast<std::uint64_t>(x)); }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 1469598103934665603ull;
};

/// Vehicles anywhere on the lanes of the map, some of them close together, some with a goal, one in five long; two
/// obstacles.
template <class World>
void fill(World& world, std::uint64_t seed) {
  auto const& map = world.map();
  std::vector<cb::LaneId> lanes;
  for (auto const& lane : map.lanes())
    if (lane.drivable() && lane.length() > 12.0) lanes.push_back(lane.id);
  if (lanes.empty()) return;
  cb::RandomStream random(seed, 0, 0);
  auto const any = [&] { return lanes[cb::uniform_index(random, static_cast<std::uint32_t>(lanes.size()))]; };
  auto cluster = any();
  for (int i = 0; i < 72 && world.size() < 24; ++i) {
    if (i % 4 == 0) cluster = any();
    auto const& lane = map.lane(cluster);
    auto const pose = lane.path.pose(5.0 + cb::uniform01(random) * (lane.length() - 10.0));
    typename World::AgentSpec spec{
        .position = pose.position(), .heading = pose.heading, .speed = 16.0 * cb::uniform01(random)};
    if (i % 5 == 4) spec.shape = cb::geometry::truck();
    if (cb::uniform01(random) < 0.4) spec.goal = cb::ReachLane{any()};
    for (bool const again : {false, true}) {
      try {
        world.add(spec);
        break;
      } catch (cb::Error const&) {  // the goal cannot be reached from there
        if (again) continue;
        spec.goal = cb::NoGoal{};
      }
    }
  }
  for (int i = 0; i < 2; ++i) {
    auto const p = map.lane(any()).path.pose(6.0).position();
    world.add_object(
        cb::geometry::Polygon({{p.x() - 0.5, p.y() - 0.5}, {p.x() + 0.5, p.y() - 0.5}, {p.x(), p.y() + 0.5}}));
  }
}

/// One line: the model, the map, and a hash of where its vehicles drive there with three lengths of a step.
template <class Behavior, class Execution = cb::InterpolateExecution>
std::string driven(std::string const& map_name, std::shared_ptr<cb::Map const> const& map) {
  Hash hash;
  for (double const dt : {0.1, 0.2, 0.5}) {
    cb::World<cb::BehaviorSet<Behavior>, Execution, cb::SingleTrack> world(map, {.seed = 7});
    fill(world, static_cast<std::uint64_t>(10.0 * dt));
    for (int step = 0; step < 100; ++step) {
      auto const result = world.step(dt);
      hash.add(static_cast<std::uint64_t>(result.failed));
      for (auto const& agent : world.frame().agents) {
        hash.add(static_cast<std::uint64_t>(agent.status));
        for (double const x : {agent.state.x, agent.state.y, agent.state.heading, agent.state.speed, agent.lane.s,
                               agent.lane.lateral, agent.action.acceleration})
          hash.add(x);
      }
    }
  }
  char text[256];
  std::snprintf(text, sizeof text, "%-24s %-44s %016llx", Behavior::name, map_name.c_str(),
                static_cast<unsigned long long>(hash.value()));
  return text;
}

}  // namespace yardstick
