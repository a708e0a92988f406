#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <optional>

#include "cambium/behavior/law/constraint.hpp"
#include "cambium/behavior/law/follow_lane.hpp"
#include "cambium/behavior/view.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/portable_math.hpp"

namespace cambium::inline v0_1 {

/// A parameter struct with the fields of the Intelligent Driver Model, which the functions below read.
template <class P>
concept HasIdmParameters = requires(P const p) {
  { p.desired_speed } -> std::convertible_to<double>;
  p.time_headway;
  p.minimum_gap;
  p.maximum_acceleration;
  p.comfortable_deceleration;
  p.exponent;
  p.lowest_acceleration;
  p.highest_acceleration;
};

/// The description of these fields, shared by all models that have them.
template <class P>
[[nodiscard]] constexpr auto idm_parameters() {
  return parameter_list(
      parameter("desired_speed", &P::desired_speed, "m/s", Range{0.1, 100}, "speed on a free road"),
      parameter("time_headway", &P::time_headway, "s", Range{0, 20}, "time gap kept to the leader"),
      parameter("minimum_gap", &P::minimum_gap, "m", Range{0, 100}, "gap kept at standstill"),
      parameter("maximum_acceleration", &P::maximum_acceleration, "m/s^2", Range{0.01, 20},
                "acceleration from rest on a free road"),
      parameter("comfortable_deceleration", &P::comfortable_deceleration, "m/s^2", Range{0.01, 20},
                "braking that the driver finds normal"),
      parameter("exponent", &P::exponent, "-", Range{1, 100},
                "how late the acceleration falls off towards the desired speed"),
      parameter("lowest_acceleration", &P::lowest_acceleration, "m/s^2", Range{-50, -0.01}, "hardest braking"),
      parameter("highest_acceleration", &P::highest_acceleration, "m/s^2", Range{0, 50},
                "upper bound of the acceleration"));
}

class IdmLaw;

/// The Intelligent Driver Model as a driver's law. Defaults are BARK's.
struct Idm {
  double desired_speed = 15.0;
  double time_headway = 1.5;
  double minimum_gap = 2.0;
  double maximum_acceleration = 1.7;
  double comfortable_deceleration = 1.67;
  double exponent = 4.0;
  double lowest_acceleration = -5.0;
  double highest_acceleration = 8.0;
  double tolerance = 1e-4;

  static constexpr char const* name = "idm";
  static constexpr char const* summary =
      "a = a_max (1 - (v/v0)^4 - (s*/s)^2), s* = s0 + max(0, v T + v (v - v_leader) / (2 sqrt(a_max b)))";
  static constexpr char const* source = "Treiber, Hennecke, Helbing 2000, eq. 3 and 4; defaults: BARK";
  static constexpr auto parameters() {
    return join_parameters(idm_parameters<Idm>(),
                           parameter_list(parameter("tolerance", &Idm::tolerance, "m/s^2", Range{1e-12, 1},
                                                    "integration error in speed, per second")));
  }

  /// The law at `speed` with `desired` speed [m/s].
  [[nodiscard]] IdmLaw at(double speed, double desired) const;
  [[nodiscard]] double acceleration(double speed, double desired, Constraint const& leader) const;
};
static_assert(HasIdmParameters<Idm>);

/// x to the power of `exponent`, without `pow` for IDM's usual 4; with other exponents, 0 for x <= 0.
template <class Scalar>
[[nodiscard]] Scalar idm_power(Scalar x, double exponent) {
  if (exponent == 4.0) return (x * x) * (x * x);
  if (x <= Scalar(0)) return Scalar(0);
  using portable::pow;
  return pow(x, Scalar(exponent));
}

/// IDM's formula (Treiber, Hennecke, Helbing 2000, eq. 3 and 4) with all terms that depend on the parameters alone:
///
///   a  = a_max (1 - (v / v0)^exponent - (s* / s)^2)
///   s* = s0 + max(0, v T + v (v - v_leader) / (2 sqrt(a_max b)))
template <class Scalar>
struct IdmTerms {
  template <HasIdmParameters P>
  explicit IdmTerms(P const& p) : IdmTerms(p, p.desired_speed) {}

  template <HasIdmParameters P>
  IdmTerms(P const& p, double desired_speed)
      : inverse_desired_speed(Scalar(1.0 / desired_speed)),
        headway(Scalar(p.time_headway)),
        closing(Scalar(0.5 / std::sqrt(p.maximum_acceleration * p.comfortable_deceleration))),
        minimum_gap(Scalar(p.minimum_gap)),
        maximum(Scalar(p.maximum_acceleration)),
        low(Scalar(p.lowest_acceleration)),
        high(Scalar(p.highest_acceleration)),
        exponent(p.exponent) {}

  /// Speed-dependent part of the desired gap s* [m]. Below 0 if the leader is much faster; it is then cut off at 0,
  /// because the square in the formula would mistake a faster leader for a close one.
  [[nodiscard]] Scalar dynamic_gap(Scalar speed, Scalar leader_speed) const {
    return speed * (headway + (speed - leader_speed) * closing);
  }
  /// Ratio of the desired gap to the actual gap, s* / s [-].
  [[nodiscard]] Scalar closeness(Scalar dynamic, Scalar inverse_gap) const {
    using std::max;
    return (minimum_gap + max(Scalar(0), dynamic)) * inverse_gap;
  }
  /// Share of the maximum acceleration that a free road leaves, 1 - (v / v0)^exponent [-].
  [[nodiscard]] Scalar free(Scalar speed) const {
    return Scalar(1) - idm_power(Scalar(speed * inverse_desired_speed), exponent);
  }
  /// Acceleration without bounds [m/s^2]. `gap` [m] bumper to bumper, above 0, infinite on a free road.
  [[nodiscard]] Scalar unbounded(Scalar free, Scalar speed, Scalar gap, Scalar leader_speed) const {
    Scalar const close = closeness(dynamic_gap(speed, leader_speed), Scalar(1) / gap);
    return maximum * (free - close * close);
  }
  [[nodiscard]] Scalar bounded(Scalar acceleration) const {
    using std::max;
    using std::min;
    return min(max(acceleration, low), high);
  }

  Scalar inverse_desired_speed, headway, closing, minimum_gap, maximum, low, high;
  double exponent;
};

/// Desired gap s* [m] (Treiber, Hennecke, Helbing 2000, eq. 4).
template <HasIdmParameters P, class Scalar>
[[nodiscard]] Scalar idm_desired_gap(P const& p, Scalar speed, Scalar leader_speed) {
  IdmTerms<Scalar> const terms(p);
  return terms.closeness(terms.dynamic_gap(speed, leader_speed), Scalar(1));
}

/// Acceleration [m/s^2] of a follower (Treiber, Hennecke, Helbing 2000, eq. 3), within the parameters' bounds. `gap`
/// [m] bumper to bumper, infinite on a free road; `leader_speed` [m/s]. A gap ≤ 0 yields the lower bound.
template <HasIdmParameters P, class Scalar>
[[nodiscard]] Scalar idm_acceleration(P const& p, Scalar speed, Scalar gap, Scalar leader_speed) {
  IdmTerms<Scalar> const terms(p);
  if (!(gap > Scalar(0))) return terms.low;
  return terms.bounded(terms.unbounded(terms.free(speed), speed, gap, leader_speed));
}

/// Gap [m] at which a platoon keeps `speed` [m/s] (Treiber, Hennecke, Helbing 2000, eq. 5); infinite at the desired
/// speed.
template <HasIdmParameters P>
[[nodiscard]] double idm_equilibrium_gap(P const& p, double speed) {
  double const free = 1.0 - idm_power(speed / p.desired_speed, p.exponent);
  return free <= 0 ? std::numeric_limits<double>::infinity()
                   : (p.minimum_gap + speed * p.time_headway) / std::sqrt(free);
}

/// Speed [m/s] at which a platoon keeps `gap` [m], the inverse of `idm_equilibrium_gap`. 0 below the minimum gap.
template <HasIdmParameters P>
[[nodiscard]] double idm_equilibrium_speed(P const& p, double gap) {
  double low = 0.0, high = p.desired_speed;
  for (int i = 0; i < 60; ++i) {
    double const middle = 0.5 * (low + high);
    (idm_equilibrium_gap(p, middle) <= gap ? low : high) = middle;
  }
  return low;
}

namespace detail {

/// Acceleration of a follower and its total derivative along the motion.
template <class Scalar>
struct IdmResponse {
  Scalar acceleration;  ///< [m/s^2]
  Scalar jerk;          ///< [m/s^3], with constant leader speed; 0 at a bound
  bool bounded;         ///< the acceleration is at a bound
};

/// IDM over a step with constant leader speed.
template <class Scalar>
class IdmStep {
 public:
  IdmStep(IdmTerms<Scalar> const& terms, Scalar leader_speed) : terms_(terms), leader_speed_(leader_speed) {}

  [[nodiscard]] IdmTerms<Scalar> const& terms() const { return terms_; }
  [[nodiscard]] Scalar leader_speed() const { return leader_speed_; }

  [[nodiscard]] IdmResponse<Scalar> operator()(Scalar speed, Scalar gap) const {
    Scalar const inverse_gap = Scalar(1) / gap;
    Scalar const dynamic = terms_.dynamic_gap(speed, leader_speed_);
    bool const interacts = dynamic > Scalar(0);
    Scalar const closeness = terms_.closeness(dynamic, inverse_gap);
    auto const [free, free_slope] = free_road(speed * terms_.inverse_desired_speed);
    Scalar const wanted = terms_.maximum * ((Scalar(1) - free) - closeness * closeness);
    if (!(gap > Scalar(0)) || wanted <= terms_.low) return {terms_.low, Scalar(0), true};
    if (wanted >= terms_.high) return {terms_.high, Scalar(0), true};
    Scalar const dynamic_slope =
        interacts ? terms_.headway + (Scalar(2) * speed - leader_speed_) * terms_.closing : Scalar(0);
    Scalar const by_speed =
        free_slope * terms_.inverse_desired_speed + Scalar(2) * closeness * inverse_gap * dynamic_slope;
    Scalar const by_gap = Scalar(2) * closeness * closeness * inverse_gap;
    return {wanted, terms_.maximum * (by_gap * (leader_speed_ - speed) - by_speed * wanted), false};
  }

 private:
  struct FreeRoad {
    Scalar power, slope;
  };

  /// x^exponent and its derivative.
  [[nodiscard]] FreeRoad free_road(Scalar x) const {
    if (terms_.exponent == 4.0) {
      Scalar const square = x * x;
      return {square * square, Scalar(4) * square * x};
    }
    Scalar const power = idm_power(x, terms_.exponent);
    return {power, x > Scalar(0) ? Scalar(terms_.exponent) * power / x : Scalar(0)};
  }

  IdmTerms<Scalar> const& terms_;
  Scalar leader_speed_;
};

/// Result of one trial step of the integration scheme.
template <class Scalar>
struct IdmTrial {
  Scalar distance, speed;
  bool accurate;
};

/// One trial step over `step` [s], from speed `v` and `gap`, where the model responds with `now`.
template <class Scalar>
[[nodiscard]] IdmTrial<Scalar> try_idm_step(IdmStep<Scalar> const& response, IdmResponse<Scalar> const& now, Scalar v,
                                            Scalar gap, double step, double tolerance) {
  using std::abs;
  using std::min;
  auto const square = [](Scalar x) { return x * x; };
  auto const largest_square = Scalar(4.0 * tolerance);  // of the third-order term
  Scalar const leader_speed = response.leader_speed(), highest = min(response.terms().maximum, response.terms().high);
  auto const [a1, j1, bounded1] = now;
  bool const stands = v <= Scalar(0) && a1 <= Scalar(0);
  auto const h = Scalar(step), half = Scalar(step / 2), third_part = Scalar(step * (1.0 / 3)),
             sixth = Scalar(step * (1.0 / 6)), eighth = Scalar(step * step / 8);
  Scalar const middle_speed = v + half * a1 + eighth * j1;
  Scalar const middle_gap = gap + half * (leader_speed - v) - eighth * a1;
  auto const [a2, j2, bounded2] =
      response(stands ? Scalar(0) : middle_speed, stands ? gap + half * leader_speed : middle_gap);
  Scalar const third = third_part * (j2 - j1);
  Scalar next_speed = min(Scalar(v + h * (a1 + half * j1 + third)), Scalar(v + h * highest));
  Scalar distance = min(Scalar(h * (v + sixth * (a1 + Scalar(2) * a2))), Scalar(h * (v + half * highest)));
  bool const stops = stands || next_speed < Scalar(0) || middle_speed < Scalar(0);
  if (stops) {  // constant deceleration until it stops
    distance = stands ? Scalar(0) : min(Scalar(h * v), Scalar(v * v / (Scalar(2) * abs(a1))));
    next_speed = Scalar(0);
  }
  bool accurate = stops ? v <= Scalar(tolerance) && a2 <= Scalar(0) : square(third) <= largest_square;
  Scalar const expected = a1 + h * j2;  // at the end of the step, if the jerk changes linearly
  if (accurate && (bounded1 || bounded2 || expected < response.terms().low))
    accurate =
        square(response(next_speed, gap + h * leader_speed - distance).acceleration - expected) <= largest_square;
  return {distance, next_speed, accurate};
}

/// Bounds of the step of `idm_motion` [s]: a shorter one is never needed, a longer one might miss a change.
inline constexpr double shortest_idm_step = 1e-3, longest_idm_step = 0.25;

/// `idm_motion` in more than one step. Takes its arguments by value so that the caller's can stay in registers.
template <class Scalar>
CAMBIUM_NOINLINE [[nodiscard]] LongitudinalMotion<Scalar> idm_motion_in_steps(IdmTerms<Scalar> terms, Scalar speed,
                                                                              Scalar gap, Scalar leader_speed,
                                                                              double dt, double tolerance) {
  IdmStep<Scalar> const response(terms, leader_speed);
  LongitudinalMotion<Scalar> motion{Scalar(0), speed};
  double left = dt, step = std::min(dt, longest_idm_step);
  while (true) {
    auto const now = response(motion.speed, gap);
    auto trial = try_idm_step(response, now, motion.speed, gap, step, tolerance);
    while (!trial.accurate && step > shortest_idm_step) {
      step /= 2;
      trial = try_idm_step(response, now, motion.speed, gap, step, tolerance);
    }
    motion.distance += trial.distance;
    motion.speed = trial.speed;
    gap += Scalar(step) * response.leader_speed() - trial.distance;
    left -= step;
    if (left <= dt * 1e-12) return motion;
    step = std::min({2 * step, longest_idm_step, left});
  }
}

/// As `idm_motion` below, for terms already computed.
template <class Scalar>
[[nodiscard]] LongitudinalMotion<Scalar> idm_motion(IdmTerms<Scalar> const& terms, Scalar speed, Scalar gap,
                                                    Scalar leader_speed, double dt, double tolerance) {
  IdmStep<Scalar> const response(terms, leader_speed);
  if (dt <= longest_idm_step) {
    auto const trial = try_idm_step(response, response(speed, gap), speed, gap, dt, tolerance);
    if (trial.accurate) return {trial.distance, trial.speed};
  }
  return idm_motion_in_steps(terms, speed, gap, leader_speed, dt, tolerance);
}

}  // namespace detail

/// Motion over `dt` [s] of an IDM follower behind a leader of constant speed. Solves the model's differential equation
/// by the two-derivative Runge-Kutta scheme of order 4 with two stages (Chan and Tsai 2010), which needs the jerk but
/// only two evaluations. The step is halved while its third-order term exceeds 2 sqrt(tolerance) m/s per second, which
/// keeps the error in speed near `tolerance` [m/s per s]; where the acceleration reaches a bound, the step is halved
/// until it meets the bound with the same accuracy. A vehicle whose speed reaches 0 stops and stands until the model
/// lets it start. `dt` > 0.
template <HasIdmParameters P, class Scalar>
[[nodiscard]] LongitudinalMotion<Scalar> idm_motion(P const& p, Scalar speed, Scalar gap, Scalar leader_speed,
                                                    double dt, double tolerance) {
  return detail::idm_motion(IdmTerms<Scalar>(p), speed, gap, leader_speed, dt, tolerance);
}

/// A driver's car following by IDM at one speed [m/s]: the law that answers constraints.
class IdmLaw {
 public:
  static constexpr bool asks_acceleration = false;  ///< of leaders

  template <HasIdmParameters P>
  IdmLaw(P const& p, double speed) : IdmLaw(p, speed, p.desired_speed) {}

  template <HasIdmParameters P>
  IdmLaw(P const& p, double speed, double desired_speed, double tolerance = 1e-4)
      : terms_(p, desired_speed), speed_(speed), rest_(terms_.free(speed)), tolerance_(tolerance) {}

  /// Acceleration on a free road [m/s^2].
  [[nodiscard]] double free() const { return terms_.bounded(terms_.maximum * rest_); }

  /// Acceleration behind a leader [m/s^2].
  [[nodiscard]] double operator()(double gap, double leader_speed) const {
    if (!(gap > 0.0)) return terms_.low;
    return terms_.bounded(terms_.unbounded(rest_, speed_, gap, leader_speed));
  }
  [[nodiscard]] double operator()(Constraint const& c) const { return (*this)(c.gap, c.speed); }
  [[nodiscard]] double operator()(std::optional<RoadUser> const& leader) const {
    return leader ? (*this)(leader->gap, leader->speed) : free();
  }

  [[nodiscard]] double speed() const { return speed_; }                                      ///< [m/s]
  [[nodiscard]] double desired_speed() const { return 1.0 / terms_.inverse_desired_speed; }  ///< [m/s]
  [[nodiscard]] double minimum_gap() const { return terms_.minimum_gap; }                    ///< [m]

  /// See `idm_motion`.
  [[nodiscard]] LongitudinalMotion<double> motion(Constraint const& c, double dt) const {
    return detail::idm_motion(terms_, speed_, c.gap, c.speed, dt, tolerance_);
  }

 private:
  IdmTerms<double> terms_;
  double speed_;
  double rest_;       ///< see `IdmTerms::free`
  double tolerance_;  ///< [m/s^2]
};

inline IdmLaw Idm::at(double speed, double desired) const { return {*this, speed, desired, tolerance}; }
inline double Idm::acceleration(double speed, double desired, Constraint const& leader) const {
  return at(speed, desired)(leader);
}

}  // namespace cambium::inline v0_1
