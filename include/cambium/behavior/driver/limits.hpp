#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <utility>

#include "cambium/behavior/law/braking.hpp"
#include "cambium/behavior/law/constraint.hpp"
#include "cambium/behavior/law/follow_motion.hpp"
#include "cambium/behavior/view.hpp"
#include "cambium/core/constants.hpp"
#include "cambium/core/described.hpp"

namespace cambium::inline v0_1 {

/// A car-following law: a described struct of parameters with
/// - the six that every driver has: desired speed [m/s], time headway [s], minimum gap [m], maximum acceleration and
///   comfortable deceleration (above 0), and lowest acceleration (below 0) [m/s^2];
/// - `double acceleration(double speed, double desired_speed, Constraint const& leader) const` [m/s^2]: never higher
///   than on a free road. Below the lowest, the driver brakes with the lowest; above, nothing bounds it. NaN is driven,
///   and the step reports it. The leader's gap is above 0, and infinite on a free road. `desired_speed` is the
///   parameter, or lower where a speed limit is; a law that responds late to a lower one passes the sign too fast.
///
/// A law may further have
/// - `static constexpr bool asks_acceleration = true`, if it wants to know a leader's acceleration;
/// - `at(speed, desired_speed)`, which returns what `AtSpeed` is for all laws, if it is computed faster for several
///   leaders at one speed, or has a better integration scheme than `follow_motion`.
template <class L>
concept CarFollowingLaw = std::copyable<L> && std::default_initializable<L> && Described<L> &&
    requires(L const law, Constraint const& leader, double x) {
  { L::name } -> std::convertible_to<char const*>;
  { law.desired_speed } -> std::convertible_to<double>;
  { law.time_headway } -> std::convertible_to<double>;
  { law.minimum_gap } -> std::convertible_to<double>;
  { law.maximum_acceleration } -> std::convertible_to<double>;
  { law.comfortable_deceleration } -> std::convertible_to<double>;
  { law.lowest_acceleration } -> std::convertible_to<double>;
  { law.acceleration(x, x, leader) } -> std::convertible_to<double>;
};

/// A law at one speed, by its `acceleration` alone.
template <CarFollowingLaw Law>
class AtSpeed {
 public:
  static constexpr bool asks_acceleration = requires { requires Law::asks_acceleration; };

  /// Refers to `law`, which has to live as long. Speeds in m/s.
  AtSpeed(Law const& law, double speed, double desired_speed)
      : law_(&law), speed_(speed), desired_speed_(desired_speed) {}

  /// Acceleration behind a leader [m/s^2].
  [[nodiscard]] double operator()(Constraint const& leader) const { return (*this)(speed_, leader); }
  /// The same at another speed [m/s].
  [[nodiscard]] double operator()(double speed, Constraint const& leader) const {
    if (!(leader.gap > 0.0)) return law_->lowest_acceleration;
    double const a = law_->acceleration(speed, desired_speed_, leader);
    return a < law_->lowest_acceleration ? law_->lowest_acceleration : a;
  }

  [[nodiscard]] double speed() const { return speed_; }                  ///< [m/s]
  [[nodiscard]] double desired_speed() const { return desired_speed_; }  ///< [m/s]

  /// Motion of a step of `dt` [s] behind a leader of constant speed.
  [[nodiscard]] LongitudinalMotion<double> motion(Constraint const& leader, double dt) const {
    return follow_motion(*this, speed_, leader, dt);
  }

 private:
  Law const* law_;
  double speed_, desired_speed_;
};

/// `law` at `speed` with `desired_speed` [m/s].
template <CarFollowingLaw Law>
[[nodiscard]] auto at_speed(Law const& law, double speed, double desired_speed) {
  if constexpr (requires { law.at(speed, desired_speed); })
    return law.at(speed, desired_speed);
  else
    return AtSpeed<Law>(law, speed, desired_speed);
}

/// What bounds a driver's motion in this step: the strictest constraint of its law, and the shortest motion. Bends,
/// signals and conflicts bound the motion instead of being constraints of the law, because a driver brakes for them
/// evenly and exactly to a point, while a law would keep a time headway to them.
template <CarFollowingLaw Law>
class Limits {
  static constexpr double infinite = std::numeric_limits<double>::infinity(), not_asked = infinite;

 public:
  using Response = decltype(at_speed(std::declval<Law const&>(), 0.0, 0.0));

  /// Of a driver at `speed` that desires `desired_speed` [m/s]. Refers to `law`, which has to live as long.
  Limits(Law const& law, double speed, double desired_speed, Merging counted = Merging::counts)
      : merging(counted), law_(&law), desired_speed_(desired_speed), response_(at_speed(law, speed, desired_speed)) {}

  [[nodiscard]] Law const& law() const { return *law_; }                 ///< the driver's parameters
  [[nodiscard]] double desired_speed() const { return desired_speed_; }  ///< within speed limits [m/s]
  [[nodiscard]] Response const& response() const { return response_; }   ///< the law at the driver's speed

  /// Keeps a constraint if it is stricter: if the law responds to it with a lower acceleration; among equals, the
  /// nearer one. If the gap is not above 0, or the gap or the speed is NaN, the driver brakes as hard as it can.
  void heed(Constraint const& other) {
    if (std::isnan(other.speed)) [[unlikely]]
      return heed({0.0, 0.0});
    if (is_constrained()) {  // a single constraint needs no comparison
      double const now = acceleration(), a = response_(other);
      if (a > now || (a == now && other.gap >= constraint_.gap) || std::isnan(now)) return;
      acceleration_ = a;
    } else {
      acceleration_ = not_asked;  // that of the free road may have been asked for
    }
    constraint_ = other;
  }
  /// As if none had been kept yet.
  void forget_constraints() {
    constraint_ = {};
    acceleration_ = not_asked;
  }
  /// Whether the road is not free.
  [[nodiscard]] bool is_constrained() const { return constraint_.gap != infinite; }
  /// Keeps a motion over the step if it is shorter. Its distance and its final speed have to agree. A distance of 0 or
  /// less stops the vehicle.
  void bound(LongitudinalMotion<double> const& motion) {
    bound_ = nearer(bound_, motion.distance <= 0.0 ? LongitudinalMotion<double>{0.0, 0.0} : motion);
  }

  /// Lets the vehicle stop within `distance` [m], by braking with `deceleration` [m/s^2] if that suffices, see
  /// `motion_before_stop`.
  void stop_within(double distance, double deceleration, double dt) {
    bound(motion_before_stop(response_.speed(), distance, deceleration, -law_->lowest_acceleration, dt, jerk_bound));
  }

  [[nodiscard]] Constraint const& constraint() const { return constraint_; }
  /// The law's response to the constraint [m/s^2].
  [[nodiscard]] double acceleration() {
    if (acceleration_ == not_asked) acceleration_ = response_(constraint_);
    return acceleration_;
  }
  /// The law's motion over `dt` [s], without the bound.
  [[nodiscard]] LongitudinalMotion<double> motion(double dt) const { return response_.motion(constraint_, dt); }
  /// `motion` over `dt` [s], or the bound if that is shorter, as smoothly as the driver can, see
  /// `bounded_acceleration`; without that where a constraint comes so near that braking evenly takes half of what the
  /// driver can brake. A driver that stops behind one that stands takes the brake back before it stands itself.
  [[nodiscard]] LongitudinalMotion<double> within(LongitudinalMotion<double> const& motion, double dt) const {
    if (!jerk_bound.matters() || is_urgent()) return nearer(motion, bound_);
    auto const wanted = nearer(softly(motion, dt), bound_);
    double const v = response_.speed(), a = (wanted.speed - v) / dt;
    double const smooth =
        bounded_acceleration(a, v, law_->comfortable_deceleration, law_->lowest_acceleration, jerk_bound, dt);
    if (!(smooth < a) && !(smooth > a)) return wanted;
    double const end = v + smooth * dt;
    auto const smoothly = end > 0.0 ? LongitudinalMotion<double>{0.5 * (v + end) * dt, end}
                                    : LongitudinalMotion<double>{smooth < 0.0 ? v * v / (-2.0 * smooth) : 0.0, 0.0};
    auto const& [place, deceleration] = place_to_wait;
    bool const rolls_over = smooth > a && !can_stop(smoothly.speed, place - smoothly.distance, deceleration);
    return rolls_over ? wanted : smoothly;
  }

  Merging merging = Merging::counts;  ///< how road users count that merge into the lane
  bool gives_way = false;             ///< it heeds conflicts
  double highest_speed = infinite;    ///< in the bends within the braking distance [m/s]
  bool is_at_light = false;           ///< it stands before a light that stops it
  JerkBound jerk_bound{};             ///< of the driver while it need not hurry
  struct {
    double distance = infinite, deceleration = 1.0;  ///< [m, m/s^2]
  } place_to_wait{};  ///< it brakes harder than `jerk_bound` permits rather than be unable to stop there

 private:
  /// `motion`, or the longer one that ends softly at a standstill, if the constraint stands and enough of the gap is
  /// left.
  [[nodiscard]] LongitudinalMotion<double> softly(LongitudinalMotion<double> const& motion, double dt) const {
    if (constraint_.speed > standing_speed) return motion;
    double const least = std::max(0.5, 0.5 * law_->minimum_gap);  // [m]
    double const v = response_.speed(), end = v + dt * detail::approach(v, 0.0, jerk_bound, dt);
    if (!(motion.speed < end)) return motion;
    return soft_stop(v, jerk_bound.planned()) + least < constraint_.gap
               ? LongitudinalMotion<double>{0.5 * (v + end) * dt, end}
               : motion;
  }
  [[nodiscard]] bool is_urgent() const {
    double const closing = response_.speed() - constraint_.speed;
    return closing > 0.0 && closing * closing > -law_->lowest_acceleration * constraint_.gap;
  }
  [[nodiscard]] static LongitudinalMotion<double> nearer(LongitudinalMotion<double> const& motion,
                                                         LongitudinalMotion<double> const& other) {
    return motion.distance <= other.distance || std::isnan(motion.distance) ? motion : other;  // NaN is not lost
  }

  Law const* law_;
  double desired_speed_;
  Response response_;
  Constraint constraint_;
  double acceleration_ = not_asked;
  LongitudinalMotion<double> bound_{infinite, infinite};
};

}  // namespace cambium::inline v0_1
