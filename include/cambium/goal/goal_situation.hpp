#pragma once

#include <cstddef>

#include "cambium/core/ids.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/geometry/shape.hpp"
#include "cambium/map/corridor/corridor.hpp"

namespace cambium::inline v0_1 {

/// An agent's situation: the input of a goal.
struct GoalSituation {
  geometry::Pose pose;
  geometry::Shape shape;
  LaneId lane = none<LaneId>;               ///< of its lane corridor
  double lane_position{};                   ///< along that lane's path [m]
  double speed{};                           ///< [m/s]
  double lateral{};                         ///< from the lane corridor's centre line, left positive [m]
  double heading_error{};                   ///< from the lane corridor's direction [rad]
  map::RoadCorridor const* road = nullptr;  ///< the lanes of its route
  CorridorId corridor = none<CorridorId>;   ///< number of its lane corridor there
  double s{};                               ///< position along that corridor [m]
  std::size_t passed{};                     ///< number of parts of its `GoalSequence` already reached
};

}  // namespace cambium::inline v0_1
