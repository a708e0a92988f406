#pragma once

#include <algorithm>
#include <concepts>
#include <limits>

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
            std::min(constraint.acceleration, opens < map::opening_share * soon * view.state().speed ? hardest : -1.0);
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

/// A driver's car-following law at one speed, such as `IdmLaw` and `AccLaw`:
/// - `law(constraint)`: its acceleration behind a constraint [m/s^2], never higher than on a free road. Before a lower
///   speed limit the rules lower the desired speed evenly; a law that follows it with a lag passes the sign too fast;
/// - `law.speed()`, `law.desired_speed()` [m/s];
/// - `law.motion(constraint, dt, tolerance)`: the `LongitudinalMotion` of a step of `dt` [s] behind a constraint that
///   keeps its speed; `tolerance` [m/s^2], see `idm_motion`;
/// - `Law::asks_acceleration`: whether it wants to know a leader's acceleration.
template <class L>
concept CarFollowingLaw = requires(L const law, Constraint const& constraint, double x) {
  { law(constraint) } -> std::convertible_to<double>;
  { law.speed() } -> std::convertible_to<double>;
  { law.desired_speed() } -> std::convertible_to<double>;
  { law.motion(constraint, x, x).distance } -> std::convertible_to<double>;
  { L::asks_acceleration } -> std::convertible_to<bool>;
};

/// The parameters of a driver that `RoadRules` reads, whatever its law: its desired speed [m/s], and how hard it brakes
/// comfortably (above 0) and at most (below 0) [m/s^2].
template <class P>
concept HasDriverParameters = requires(P const p) {
  { p.desired_speed } -> std::convertible_to<double>;
  { p.comfortable_deceleration } -> std::convertible_to<double>;
  { p.lowest_acceleration } -> std::convertible_to<double>;
};

/// Keeps the strictest of a driver's constraints: the one to which the car-following law responds with the lowest
/// acceleration; among equals, the nearest. Without constraints the road is free.
template <CarFollowingLaw Law>
class Strictest {
 public:
  /// Refers to `law`, which has to live as long.
  explicit Strictest(Law const& law) : law_(&law) {}

  /// Keeps `other` if it is stricter.
  void heed(Constraint const& other) {
    if (constraint_.gap < free_road) {  // a single constraint needs no comparison
      double const a = (*law_)(other);
      if (!(a < acceleration() || (a == acceleration() && other.gap < constraint_.gap))) return;
      acceleration_ = a;
    } else {
      acceleration_ = not_asked;  // that of the free road may have been asked for
    }
    constraint_ = other;
  }

  [[nodiscard]] Law const& law() const { return *law_; }
  [[nodiscard]] Constraint const& constraint() const { return constraint_; }

  /// The law's response [m/s^2].
  [[nodiscard]] double acceleration() {
    if (acceleration_ == not_asked) acceleration_ = (*law_)(constraint_);
    return acceleration_;
  }

 private:
  static constexpr double free_road = std::numeric_limits<double>::infinity(), not_asked = free_road;

  Law const* law_;
  Constraint constraint_;
  double acceleration_ = not_asked;
};

}  // namespace cambium
