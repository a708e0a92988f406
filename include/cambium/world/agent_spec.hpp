#pragma once

#include <limits>
#include <memory>
#include <optional>

#include "cambium/core/ids.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/geometry/shape.hpp"
#include "cambium/goal/goal.hpp"
#include "cambium/map/corridor.hpp"
#include "cambium/map/route.hpp"

namespace cambium {

/// An agent that is to enter a world: see `World::AgentSpec`.
template <class Behavior, class Execution, class Dynamics, class Observer>
struct AgentSpecOf {
  geometry::Point position{std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::quiet_NaN()};  ///< of the reference point [m]
  std::optional<double> heading{};                                     ///< [rad]; along the lane where not given
  double speed = 0.0;                                                  ///< [m/s]
  geometry::Shape shape{};                                             ///< a car where not given
  Behavior behavior{};
  Goal goal{};
  std::optional<map::Route> route{};                ///< else the shortest to the goal; without a goal straight on
  std::shared_ptr<map::RoadCorridor const> road{};  ///< instead of a route: see `map::build_free_corridor`
  Execution execution{};
  Dynamics dynamics{};
  Observer observer{};
  std::optional<AgentId> id{};  ///< else the next free one
};

}  // namespace cambium
