#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "cambium/behavior/law/follow_motion.hpp"
#include "cambium/behavior/law/idm.hpp"
#include "cambium/behavior/law/improved_idm.hpp"
#include "cambium/core/described.hpp"
#include "cambium/core/portable_math.hpp"

namespace cambium::inline v0_1 {

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

class AccLaw;

/// Blends a law's acceleration with that of the heuristic where the law brakes harder than necessary (eq. 2.6).
/// `coolness`, 0 to 1, says how far the driver trusts the heuristic.
[[nodiscard]] inline double acc_blend(double base, double cah, double comfortable_deceleration, double coolness) {
  if (base >= cah) return base;
  double const b = comfortable_deceleration;
  return (1.0 - coolness) * base + coolness * (cah + b * portable::tanh((base - cah) / b));
}

/// The ACC model as a driver's law: without overreaction to small gaps, such as after another vehicle has cut in, if
/// the leader's acceleration makes them harmless. It is based on IDM as in Kesting, Treiber, Helbing 2010, "Enhanced
/// intelligent driver model to access the impact of driving strategies on traffic capacity", or on the Improved IDM as
/// in Treiber, Kesting 2013, section 11.3.8. Defaults are about the means of how people drive cars, see
/// `presets::normal`.
struct Acc {
  static constexpr bool asks_acceleration = true;

  enum class Base : std::uint8_t { idm, improved_idm };

  double desired_speed = Idm{}.desired_speed;
  double time_headway = 1.2;
  double minimum_gap = 2.0;
  double maximum_acceleration = 1.8;
  double comfortable_deceleration = 2.3;
  double exponent = Idm{}.exponent;
  double lowest_acceleration = -8.0;
  double highest_acceleration = Idm{}.highest_acceleration;
  double coolness = 0.99;
  Base base = Base::improved_idm;

  static constexpr char const* name = "acc";
  static constexpr char const* summary =
      "its base, but where that brakes harder than the constant-acceleration heuristic c requires: (1 - coolness) "
      "a_base + coolness (c + b tanh((a_base - c) / b))";
  static constexpr char const* source =
      "Kesting, Treiber, Helbing 2010, eq. 2.3 and 2.6; Treiber, Kesting 2013, 11.3.8";
  static constexpr auto parameters() {
    return join_parameters(
        idm_parameters<Acc>(),
        parameter_list(parameter("coolness", &Acc::coolness, "-", Range{0, 1},
                                 "0: the base; 1: brakes no harder than the leader's acceleration requires"),
                       choice("base", &Acc::base, "idm|improved_idm", "the law whose overreaction it prevents")));
  }

  [[nodiscard]] AccLaw at(double speed, double desired) const;
  [[nodiscard]] double acceleration(double speed, double desired, Constraint const& leader) const;
};

/// A driver's car following at one speed [m/s] by the ACC model, within the parameters' bounds; equals the base if
/// `coolness` is 0.
class AccLaw {
 public:
  static constexpr bool asks_acceleration = true;  ///< of leaders

  /// Of a driver with IDM parameters `p` at `speed` that desires `desired_speed` [m/s]; `coolness` weighs the
  /// constant-acceleration heuristic, 0 to 1.
  template <HasIdmParameters P>
  AccLaw(P const& p, double coolness, double speed, double desired_speed, Acc::Base base)
      : terms_(p, desired_speed),
        coolness_(coolness),
        is_improved_(base == Acc::Base::improved_idm),
        speed_(speed),
        free_(free_road(speed)) {}

  /// Acceleration behind a leader [m/s^2].
  [[nodiscard]] double operator()(Constraint const& leader) const { return respond(leader, free_, speed_); }

  /// The same at another speed [m/s].
  [[nodiscard]] double operator()(double speed, Constraint const& leader) const {
    return respond(leader, free_road(speed), speed);
  }

  [[nodiscard]] double speed() const { return speed_; }                  ///< [m/s]
  [[nodiscard]] double desired_speed() const { return terms_.desired; }  ///< [m/s]

  /// Motion over `dt` [s] behind a leader of constant speed; IDM's own, within its tolerance, if `coolness` is 0.
  [[nodiscard]] LongitudinalMotion<double> motion(Constraint const& leader, double dt) const {
    if (coolness_ == 0.0 && !is_improved_) {
      IdmTerms<double> const& terms = terms_;
      return detail::idm_motion(terms, speed_, leader.gap, leader.speed, dt, Idm{}.tolerance);
    }
    return follow_motion(*this, speed_, leader, dt);
  }

 private:
  /// For the base: the acceleration on a free road [m/s^2], or for IDM its share [-].
  [[nodiscard]] double free_road(double speed) const {
    return is_improved_ ? terms_.free_road(speed) : terms_.free(speed);
  }
  [[nodiscard]] double respond(Constraint const& leader, double free, double speed) const {
    if (!(leader.gap > 0.0)) return terms_.low;
    // The blend takes unbounded accelerations.
    double const base =
        is_improved_ ? terms_.behind(leader, free, speed) : terms_.unbounded(free, speed, leader.gap, leader.speed);
    if (coolness_ == 0.0 || std::isinf(leader.gap)) return terms_.bounded(base);
    double const cah = cah_acceleration(speed, leader, terms_.maximum);
    return terms_.bounded(acc_blend(base, cah, terms_.comfortable, coolness_));
  }

  ImprovedIdmTerms terms_;
  double coolness_;
  bool is_improved_;
  double speed_, free_;
};

inline AccLaw Acc::at(double speed, double desired) const { return {*this, coolness, speed, desired, base}; }
inline double Acc::acceleration(double speed, double desired, Constraint const& leader) const {
  return at(speed, desired)(leader);
}

}  // namespace cambium::inline v0_1
