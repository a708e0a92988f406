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

/// A neighbour in the lane of `place`, where the own vehicle is or would be, as a constraint, with its acceleration if
/// `Law` asks for it. Before a merge the gap includes a share of the way there (`gap_before_merge`), which shrinks as
/// the own vehicle drives. So a leader that pulls away counts as that much slower, but never as slower than the own
/// vehicle. For a law that asks for accelerations it brakes, the harder the nearer the merge is: otherwise such a law
/// takes a small gap for harmless.
template <class Law, class View>
[[nodiscard]] Constraint constraint_of(View const& view, RoadUser const& user, map::LanePlace const& place) {
  Constraint constraint{user.gap, user.speed, 0.0};
  if (!is_valid(user.agent)) return constraint;
  double const ahead = user.gap - (user.s - user.rear - place.s - view.shape().front), speed = view.state().speed;
  constexpr double soon = 3.0;  // [s]
  bool const has_to_open = ahead > 0.1;
  double const vanishes = opening_share * speed, nearness = soon * vanishes / ahead;
  if (has_to_open) constraint.speed = std::min(user.speed, std::max(speed, user.speed - vanishes));
  if constexpr (Law::asks_acceleration) {
    constraint.acceleration = view.acceleration(user);
    if (has_to_open) constraint.acceleration = std::min(constraint.acceleration, -nearness * nearness);
  }
  return constraint;
}
template <class Law, class View>
[[nodiscard]] Constraint constraint_of(View const& view, RoadUser const& user) {
  return constraint_of<Law>(view, user, view.place());
}

/// A road user in another lane, from which the own vehicle has `user.gap` as it is.
template <class Law, class View>
[[nodiscard]] Constraint constraint_beside(View const& view, RoadUser const& user) {
  Constraint constraint{user.gap, user.speed, 0.0};
  if constexpr (Law::asks_acceleration)
    if (is_valid(user.agent)) constraint.acceleration = view.acceleration(user);
  return constraint;
}

}  // namespace detail

}  // namespace cambium
