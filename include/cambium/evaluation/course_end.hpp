#pragma once

#include <cstdint>

#include "cambium/core/ids.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/evaluation/off_road.hpp"
#include "cambium/world/frame.hpp"

namespace cambium::inline v0_1 {

/// How an agent's course ends.
enum class CourseEnd : std::uint8_t {
  none,       ///< it goes on
  over,       ///< it reached the end of its route or of the map, or its behaviour expired
  collision,  ///< it touches an agent or an object
  off_road,   ///< it left the road or its route, drives in an oncoming lane, or its step failed
};

/// Whether and how an agent's course ends: the common definition for runs, rewards and planners. `collides` is the
/// evaluator that decides what counts as a collision; `heeds_road` says whether leaving the road ends the course. Costs
/// as much as these evaluators.
template <class World, class Collides = Collision>
[[nodiscard]] CourseEnd course_end(World& world, Slot slot, Collides const& collides = {}, bool heeds_road = true) {
  switch (world.frame().agents[slot].status) {
    case AgentStatus::driving:
      break;
    case AgentStatus::not_started:
      return CourseEnd::none;
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

}  // namespace cambium::inline v0_1
