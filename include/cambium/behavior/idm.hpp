#pragma once

#include <algorithm>
#include <cmath>
#include <tuple>

#include "cambium/behavior/follow_lane.hpp"
#include "cambium/core/parameters.hpp"

namespace cambium {

/// The parameters of the Intelligent Driver Model, as fields of a parameter struct: what the functions below ask for.
template <class P>
concept HasIdmParameters = requires(P const p) {
  p.desired_speed;
  p.time_headway;
  p.minimum_gap;
  p.maximum_acceleration;
  p.comfortable_deceleration;
  p.exponent;
  p.lowest_acceleration;
  p.highest_acceleration;
};

/// The one description of those fields, for the models that have them.
template <class P>
[[nodiscard]] constexpr auto idm_parameters() {
  return std::make_tuple(
      parameter("desired_speed", &P::desired_speed, "m/s", Range{0.1, 100}, "speed on a free road"),
      parameter("time_headway", &P::time_headway, "s", Range{0, 20}, "time gap kept to the leader"),
      parameter("minimum_gap", &P::minimum_gap, "m", Range{0, 100}, "gap kept in standing traffic"),
      parameter("maximum_acceleration", &P::maximum_acceleration, "m/s^2", Range{0.01, 20}, "acceleration from rest on a free road"),
      parameter("comfortable_deceleration", &P::comfortable_deceleration, "m/s^2", Range{0.01, 20}, "braking that the driver finds normal"),
      parameter("exponent", &P::exponent, "-", Range{0.1, 100}, "how late the acceleration falls off towards the desired speed"),
      parameter("lowest_acceleration", &P::lowest_acceleration, "m/s^2", Range{-50, 0}, "hardest braking"),
      parameter("highest_acceleration", &P::highest_acceleration, "m/s^2", Range{0, 50}, "upper bound of the acceleration"));
}

/// x to the power of `exponent`; IDM's usual 4 without `pow`.
template <class Scalar>
[[nodiscard]] Scalar idm_power(Scalar x, double exponent) {
  if (exponent == 4.0) return (x * x) * (x * x);
  using std::pow;
  return pow(x, Scalar(exponent));
}

/// Desired gap s* [m] (Treiber, Hennecke, Helbing 2000, eq. 4), its dynamic part not below 0, so that a faster leader is not
/// mistaken for a close one.
template <HasIdmParameters P, class Scalar>
[[nodiscard]] Scalar idm_desired_gap(P const& p, Scalar speed, Scalar leader_speed) {
  using std::max;
  double const inverse = 0.5 / std::sqrt(p.maximum_acceleration * p.comfortable_deceleration);
  return p.minimum_gap + max(Scalar(0), speed * (p.time_headway + (speed - leader_speed) * inverse));
}

/// Acceleration [m/s^2] of a follower (Treiber, Hennecke, Helbing 2000, eq. 3), within the parameters' bounds. `gap` [m] bumper
/// to bumper, infinite on a free road; `leader_speed` [m/s]. A gap ≤ 0 yields the lower bound.
template <HasIdmParameters P, class Scalar>
[[nodiscard]] Scalar idm_acceleration(P const& p, Scalar speed, Scalar gap, Scalar leader_speed) {
  if (!(gap > Scalar(0))) return Scalar(p.lowest_acceleration);
  Scalar const closeness = idm_desired_gap(p, speed, leader_speed) / gap;
  Scalar const a = p.maximum_acceleration * (1.0 - idm_power(Scalar(speed / p.desired_speed), p.exponent) - closeness * closeness);
  using std::max;
  using std::min;
  return min(max(a, Scalar(p.lowest_acceleration)), Scalar(p.highest_acceleration));
}

/// The gap [m] at which followers at one speed keep it (Treiber, Hennecke, Helbing 2000, eq. 5); infinite at the desired speed.
template <HasIdmParameters P>
[[nodiscard]] double idm_equilibrium_gap(P const& p, double speed) {
  double const free = 1.0 - idm_power(speed / p.desired_speed, p.exponent);
  return free <= 0 ? std::numeric_limits<double>::infinity() : (p.minimum_gap + speed * p.time_headway) / std::sqrt(free);
}

namespace detail {

/// IDM's right-hand side with what does not change within a step taken out: the leader keeps its speed.
template <class Scalar>
struct IdmStep {
  Scalar inverse_desired_speed, headway, closing, minimum_gap, a, low, high, leader_speed;
  double exponent;

  template <HasIdmParameters P>
  IdmStep(P const& p, Scalar leader)
      : inverse_desired_speed(1.0 / p.desired_speed),
        headway(p.time_headway),
        closing(0.5 / std::sqrt(p.maximum_acceleration * p.comfortable_deceleration)),
        minimum_gap(p.minimum_gap),
        a(p.maximum_acceleration),
        low(p.lowest_acceleration),
        high(p.highest_acceleration),
        leader_speed(leader),
        exponent(p.exponent) {}

  [[nodiscard]] Scalar operator()(Scalar speed, Scalar gap) const {
    using std::max;
    using std::min;
    Scalar const dynamic = max(Scalar(0), speed * (headway + (speed - leader_speed) * closing));
    Scalar const closeness = (minimum_gap + dynamic) / gap;
    Scalar const free = idm_power(Scalar(speed * inverse_desired_speed), exponent);
    Scalar const wanted = min(max(a * ((1.0 - free) - closeness * closeness), low), high);
    return gap > Scalar(0) ? wanted : low;
  }
};

}  // namespace detail

/// Motion over `dt` [s] of an IDM follower behind a leader that keeps its speed: the model's differential equation, solved by
/// the classical Runge-Kutta scheme. Its step is halved until two estimates of the error are within `tolerance` [m/s per s]: the
/// difference to the embedded third-order solution, and the square of how far the acceleration is from running straight (which sees
/// the kinks of the bounds). The vehicle stops where its speed reaches 0 and stands until the model lets it start. `dt` > 0.
template <HasIdmParameters P, class Scalar>
[[nodiscard]] LongitudinalMotion<Scalar> idm_motion(P const& p, Scalar speed, Scalar gap, Scalar leader_speed, double dt,
                                                    double tolerance) {
  using std::abs;
  using std::max;
  constexpr double shortest = 1e-3;  // [s] where the speed or a bound is met, no step need be shorter
  double const straight = 2.7 * std::sqrt(tolerance);
  detail::IdmStep<Scalar> const acceleration(p, leader_speed);
  LongitudinalMotion<Scalar> motion{Scalar(0), speed};
  double left = dt, h = dt;
  Scalar k1 = acceleration(speed, gap);
  while (true) {
    Scalar const v1 = motion.speed;
    Scalar const v2 = max(Scalar(0), v1 + h / 2 * k1);
    Scalar const k2 = acceleration(v2, gap + h / 2 * (leader_speed - v1));
    Scalar const v3 = max(Scalar(0), v1 + h / 2 * k2);
    Scalar const k3 = acceleration(v3, gap + h / 2 * (leader_speed - v2));
    Scalar const v4 = max(Scalar(0), v1 + h * k3);
    Scalar const k4 = acceleration(v4, gap + h * (leader_speed - v3));
    Scalar const mean = (k1 + 2.0 * (k2 + k3) + k4) / 6.0;
    Scalar next_speed = v1 + h * mean;
    Scalar distance = h / 6 * (v1 + 2.0 * (v2 + v3) + v4);
    bool const stops = next_speed < Scalar(0) || (v1 == Scalar(0) && k1 < Scalar(0));
    if (stops) {  // constant deceleration until it stands
      distance = v1 > Scalar(0) ? v1 * v1 / (-2.0 * mean) : Scalar(0);
      next_speed = Scalar(0);
    }
    Scalar const next_gap = gap + h * leader_speed - distance;
    Scalar const k5 = acceleration(next_speed, next_gap);
    bool const accurate = stops ? v1 <= Scalar(tolerance) && k4 <= Scalar(0) && k5 <= Scalar(0)
                                : abs(k5 - k4) <= Scalar(6 * tolerance) && abs(k1 - k2 - k3 + k4) <= Scalar(straight);
    if (!accurate && h > shortest) {
      h /= 2;
      continue;
    }
    motion.distance += distance;
    motion.speed = next_speed;
    left -= h;
    if (left <= dt * 1e-12) return motion;
    gap = next_gap;
    k1 = k5;
    h = 2 * h < left ? 2 * h : left;
  }
}

}  // namespace cambium
