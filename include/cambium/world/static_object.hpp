#pragma once

#include "cambium/core/ids.hpp"
#include "cambium/geometry/collision.hpp"
#include "cambium/geometry/oriented_box.hpp"
#include "cambium/geometry/polygon.hpp"

namespace cambium::inline v0_1 {

/// An obstacle that never moves. Behaviours see it as a neighbour of speed 0; evaluators report contact with it.
struct StaticObject {
  ObjectId id = none<ObjectId>;  ///< assigned by the world
  geometry::Polygon outline;     ///< map frame
};

}  // namespace cambium::inline v0_1
