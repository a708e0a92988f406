#pragma once

#include <algorithm>
#include <cmath>

#include "cambium/behavior/law/follow_motion.hpp"
#include "cambium/behavior/law/idm.hpp"
#include "cambium/core/described.hpp"
#include "cambium/core/portable_math.hpp"

namespace cambium {

/// Acceleration [m/s^2] that just avoids a collision if the leader keeps its acceleration (constant-acceleration
/// heuristic; Kesting, Treiber, Helbing 2010, eq. 2.3). The leader's acceleration counts up to `most` [m/s^2]; an
/// oncoming one, to which the formula does not apply, is not expected to slow down.
[[nodiscard]] inline double cah_acceleration(double speed, Constraint const& leader, double most) {
  double const a = std::min(leader.acceleration, leader.speed < 0.0 ? 0.0 : most), gap = std::max(leader.gap, 1e-9);
  double const closing = speed - leader.speed;
  double const denominator = leader.speed * leader.speed - 2.0 * gap * a;
  // The leader stops before the two are closest; the case below covers a leader that already stands.
  bool const stops_first = leader.speed >= 0.0 && leader.speed * closing <= -2.0 * gap * a;
  if (stops_first && denominator > 0.0) return speed * speed * a / denominator;
  return a - (closing > 0.0 ? closing * closing / (2.0 * gap) : 0.0);
}

/// Blends IDM's acceleration with that of the heuristic where IDM brakes harder than necessary (eq. 2.6). `coolness`, 0
/// to 1, says how far the driver trusts the heuristic.
[[nodiscard]] inline double acc_blend(double idm, double cah, double comfortable_deceleration, double coolness) {
  if (idm >= cah) return idm;
  double const b = comfortable_deceleration;
  return (1.0 - coolness) * idm + coolness * (cah + b * portable::tanh((idm - cah) / b));
}

/// A driver's car following at one speed [m/s] by the ACC model (Kesting, Treiber, Helbing 2010, "Enhanced intelligent
/// driver model to access the impact of driving strategies on traffic capacity"), within the parameters' bounds; equals
/// IDM if `coolness` is 0.
class AccLaw {
 public:
  static constexpr bool asks_acceleration = true;  ///< of leaders

  /// Of a driver with IDM parameters `p` at `speed` that desires `desired_speed` [m/s]; `coolness` weighs the
  /// constant-acceleration heuristic, 0 to 1.
  template <HasIdmParameters P>
  AccLaw(P const& p, double coolness, double speed, double desired_speed)
      : terms_(p, desired_speed), comfortable_(p.comfortable_deceleration), coolness_(coolness), speed_(speed) {}

  /// Acceleration behind a leader [m/s^2].
  [[nodiscard]] double operator()(Constraint const& leader) const { return (*this)(speed_, leader); }

  /// The same at another speed [m/s].
  [[nodiscard]] double operator()(double speed, Constraint const& leader) const {
    if (!(leader.gap > 0.0)) return terms_.low;
    // The blend takes unbounded accelerations.
    double const idm = terms_.unbounded(terms_.free(speed), speed, leader.gap, leader.speed);
    if (coolness_ == 0.0 || std::isinf(leader.gap)) return terms_.bounded(idm);
    return terms_.bounded(acc_blend(idm, cah_acceleration(speed, leader, terms_.maximum), comfortable_, coolness_));
  }

  [[nodiscard]] double speed() const { return speed_; }                                      ///< [m/s]
  [[nodiscard]] double desired_speed() const { return 1.0 / terms_.inverse_desired_speed; }  ///< [m/s]

  /// Motion over `dt` [s] behind a leader of constant speed; IDM's own, within `tolerance`, if `coolness` is 0.
  [[nodiscard]] LongitudinalMotion<double> motion(Constraint const& leader, double dt) const {
    if (coolness_ == 0.0) return detail::idm_motion(terms_, speed_, leader.gap, leader.speed, dt, Idm{}.tolerance);
    return follow_motion(*this, speed_, leader, dt);
  }

 private:
  IdmTerms<double> terms_;
  double comfortable_, coolness_, speed_;
};

/// The ACC model as a driver's law: IDM without the overreaction to small gaps, such as after another vehicle has cut
/// in, if the leader's acceleration makes them harmless.
struct Acc {
  static constexpr bool asks_acceleration = true;

  double desired_speed = Idm{}.desired_speed;
  double time_headway = Idm{}.time_headway;
  double minimum_gap = Idm{}.minimum_gap;
  double maximum_acceleration = Idm{}.maximum_acceleration;
  double comfortable_deceleration = Idm{}.comfortable_deceleration;
  double exponent = Idm{}.exponent;
  double lowest_acceleration = Idm{}.lowest_acceleration;
  double highest_acceleration = Idm{}.highest_acceleration;
  double coolness = 0.99;

  static constexpr char const* name = "acc";
  static constexpr char const* summary =
      "IDM, but where it brakes harder than the constant-acceleration heuristic c requires: (1 - coolness) a_IDM + "
      "coolness (c + b tanh((a_IDM - c) / b))";
  static constexpr char const* source = "Kesting, Treiber, Helbing 2010, eq. 2.3 and 2.6";
  static constexpr auto parameters() {
    return join_parameters(
        idm_parameters<Acc>(),
        parameter_list(parameter("coolness", &Acc::coolness, "-", Range{0, 1},
                                 "0: IDM; 1: brakes no harder than the leader's acceleration requires")));
  }

  [[nodiscard]] AccLaw at(double speed, double desired) const { return {*this, coolness, speed, desired}; }
  [[nodiscard]] double acceleration(double speed, double desired, Constraint const& leader) const {
    return at(speed, desired)(leader);
  }
};

}  // namespace cambium
