#pragma once

#include <limits>
#include <variant>

#include "cambium/core/ids.hpp"
#include "cambium/geometry/collision.hpp"
#include "cambium/geometry/oriented_box.hpp"
#include "cambium/geometry/polygon.hpp"
#include "cambium/geometry/shape.hpp"

namespace cambium {

/// Where an agent is, as goals ask it.
struct GoalSituation {
  geometry::Pose pose;
  geometry::Shape shape;
  LaneId lane = none<LaneId>;  ///< of its lane corridor
  double lane_position{};      ///< along that lane's path [m]
};

/// Drives straight on: without a route of its own for 2 km (see `map::straight_route`), or until a lane would come
/// again.
struct NoGoal {
  [[nodiscard]] bool at_goal(GoalSituation const&) const { return false; }
};

/// Reached with the whole shape inside of `area` (map frame).
struct ReachPolygon {
  geometry::Polygon area;
  [[nodiscard]] bool at_goal(GoalSituation const& at) const {
    return geometry::contains(area, geometry::box_of(at.shape, at.pose));
  }
};

/// Reached with the reference point in `lane`, between `from` and `to` [m] along its path.
struct ReachLane {
  LaneId lane = none<LaneId>;
  double from = 0.0;
  double to = std::numeric_limits<double>::infinity();
  [[nodiscard]] bool at_goal(GoalSituation const& at) const {
    return at.lane == lane && at.lane_position >= from && at.lane_position <= to;
  }
};

/// What an agent wants to reach; decides its route where none is given.
using Goal = std::variant<NoGoal, ReachPolygon, ReachLane>;

/// True when the goal is reached. Pure.
[[nodiscard]] inline bool at_goal(Goal const& goal, GoalSituation const& situation) {
  return std::visit([&](auto const& g) { return g.at_goal(situation); }, goal);
}

}  // namespace cambium
