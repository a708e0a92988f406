#pragma once

#include <algorithm>
#include <concepts>
#include <limits>

#include "cambium/behavior/law/gap_before_merge.hpp"
#include "cambium/behavior/view.hpp"

namespace cambium {

/// Something ahead to which a car-following law responds: a road user, the end of the lane, the gap to open for a
/// vehicle that merges. It moves along the lane or stands.
struct Constraint {
  double gap = std::numeric_limits<double>::infinity();  ///< from the own front end [m]
  double speed = 0.0;                                    ///< along the lane [m/s]
  double acceleration = 0.0;                             ///< of a leader, if the law asks for it [m/s^2]
};

namespace detail {

/// A neighbour as a constraint, with its acceleration if `Law` asks for it.
template <class Law, class View>
[[nodiscard]] Constraint constraint_of(View const& view, RoadUser const& user) {
  Constraint constraint{user.gap, user.speed, 0.0};
  if constexpr (Law::asks_acceleration)
    if (is_valid(user.agent)) {
      constraint.acceleration = view.acceleration(user);
      double const gap = user.s - user.rear - view.place().s - view.shape().front;
      // Before a merge the gap has to open, whatever the leader's acceleration; near it, the law must not rely on that.
      constexpr double soon = 3.0, hardest = -1e3;  // [s], [m/s^2]
      double const opens = user.gap - gap;
      if (opens > 0.1)
        constraint.acceleration =
            std::min(constraint.acceleration, opens < opening_share * soon * view.state().speed ? hardest : -1.0);
    }
  return constraint;
}

/// The same in a lane beside, which has another lane coordinate.
template <class Law, class View>
[[nodiscard]] Constraint constraint_beside(View const& view, RoadUser const& user) {
  Constraint constraint{user.gap, user.speed, 0.0};
  if constexpr (Law::asks_acceleration)
    if (is_valid(user.agent)) constraint.acceleration = view.acceleration(user);
  return constraint;
}

}  // namespace detail

}  // namespace cambium
