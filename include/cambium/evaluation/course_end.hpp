#pragma once

#include <cstdint>

#include "cambium/core/ids.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/evaluation/off_road.hpp"
#include "cambium/world/frame.hpp"

namespace cambium {

/// How an agent's course ends.
enum class CourseEnd : std::uint8_t {
  none,       ///< it goes on
  over,       ///< it has come to the end of its route or of the map, or its behaviour has no more to do
  collision,  ///< it touches somebody or something
  off_road,   ///< it has left the road or its route, drives in an oncoming lane, or could not be moved on
};

/// Whether an agent's course is over, and how: the one place that says so, for runs, rewards and planners. `collides`:
/// what says that it counts as a collision, an evaluator; `heeds_road`: whether it matters that it stays on the road.
/// O(those).
template <class World, class Collides = Collision>
[[nodiscard]] CourseEnd course_end(World const& world, Slot slot, Collides const& collides = {},
                                   bool heeds_road = true) {
  switch (world.frame().agents[slot].status) {
    case AgentStatus::driving:
      break;
    case AgentStatus::off_route:
    case AgentStatus::failed:
      return CourseEnd::off_road;
    default:
      return CourseEnd::over;
  }
  if (collides(world, slot)) return CourseEnd::collision;
  bool const leaves = heeds_road && (OffRoad{}(world, slot) || OncomingLane{}(world, slot));
  return leaves ? CourseEnd::off_road : CourseEnd::none;
}

}  // namespace cambium
