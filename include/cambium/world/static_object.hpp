#pragma once

#include "cambium/core/ids.hpp"
#include "cambium/geometry/collision.hpp"
#include "cambium/geometry/oriented_box.hpp"
#include "cambium/geometry/polygon.hpp"

namespace cambium {

/// Something that stands in the way and never moves. Behaviours meet it as a neighbour of speed 0, evaluators as an
/// obstacle.
struct StaticObject {
  ObjectId id = none<ObjectId>;  ///< given by the world
  geometry::Polygon outline;     ///< map frame
};

}  // namespace cambium
