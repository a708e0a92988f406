#pragma once

#include <algorithm>
#include <concepts>
#include <limits>
#include <optional>

#include "cambium/behavior/law/gap_before_merge.hpp"
#include "cambium/behavior/view.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/geometry/shape.hpp"

namespace cambium::inline v0_1 {

/// Something ahead to which a car-following law responds: a road user, the end of the lane, the gap to open for a
/// vehicle that merges. It moves along the lane or stands.
struct Constraint {
  double gap = std::numeric_limits<double>::infinity();  ///< from the own front end [m]
  double speed = 0.0;                                    ///< along the lane [m/s]
  double acceleration = 0.0;                             ///< of a leader, if the law asks for it [m/s^2]
};

namespace detail {

/// Whether a road user on foot is beside the vehicle, wholly behind its front end. The vehicle need not wait for it;
/// both would wait for good where the vehicle stands in the pedestrian's way.
[[nodiscard]] inline bool is_passed(RoadUser const& user) {
  return user.gap < -user.length() && user.length() <= geometry::longest_on_foot;
}

/// The next road user ahead of `passed`, which `is_passed`, and of others like that. O(those, log n).
template <class View>
CAMBIUM_NOINLINE [[nodiscard]] std::optional<RoadUser> next_beyond(View const& view, Look const& look,
                                                                   RoadUser passed) {
  for (auto at = view.place();;) {
    at.s = passed.s > at.s ? passed.s + 1e-6 : at.s + 0.1;  // an observer that errs may find the same one again
    at.piece = view.corridor().piece_at(at.s, at.piece);
    auto next = view.ahead(at, look);
    if (!next) return next;
    next->gap += at.s - view.place().s;
    if (!is_passed(*next)) return next;
    passed = *next;
  }
}

/// The next road user ahead in the own lane that the vehicle has not passed.
template <class View>
[[nodiscard]] std::optional<RoadUser> next_ahead(View const& view, Look const& look) {
  auto next = view.ahead(look);
  if (next && is_passed(*next)) [[unlikely]]
    next = next_beyond(view, look, *next);
  return next;
}

/// A neighbour in the lane of `place`, where the own vehicle is or would be, as a constraint, with its acceleration if
/// `Law` asks for it. Before a merge the gap includes a share of the way there (`gap_before_merge`), which shrinks as
/// the own vehicle drives. So a leader that pulls away counts as that much slower, but never as slower than the own
/// vehicle. For a law that asks for accelerations it brakes, the harder the nearer the merge is: otherwise such a law
/// takes a small gap for harmless.
template <class Law, class View>
[[nodiscard]] Constraint constraint_of(View const& view, RoadUser const& user, map::LanePlace const& place) {
  if (is_passed(user)) [[unlikely]]
    return {};
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

}  // namespace cambium::inline v0_1
