#pragma once

#include <algorithm>
#include <cmath>

#include "cambium/behavior/law/constraint.hpp"
#include "cambium/behavior/law/follow_motion.hpp"
#include "cambium/behavior/law/idm.hpp"
#include "cambium/core/described.hpp"
#include "cambium/core/portable_math.hpp"

namespace cambium::inline v0_1 {

/// The Improved Intelligent Driver Model's formula (Treiber, Kesting 2013, section 11.3.7) with all terms that depend
/// on the parameters alone.
struct ImprovedIdmTerms : IdmTerms<double> {
  template <HasIdmParameters P>
  ImprovedIdmTerms(P const& p, double desired_speed)
      : IdmTerms(p, desired_speed), desired(desired_speed), comfortable(p.comfortable_deceleration) {}

  /// Acceleration on a free road [m/s^2].
  [[nodiscard]] double free_road(double speed) const {
    if (speed <= desired) return maximum * free(speed);
    return comfortable * (portable::pow(desired / speed, maximum * exponent / comfortable) - 1.0);
  }
  /// Acceleration without bounds [m/s^2], where `free` is that on a free road.
  [[nodiscard]] double behind(Constraint const& leader, double free, double speed) const {
    double const z = closeness(dynamic_gap(speed, leader.speed), 1.0 / leader.gap);
    if (z >= 1.0) return std::min(free, 0.0) + maximum * (1.0 - z * z);
    return free > 0.0 && z > 0.0 ? free * (1.0 - portable::pow(z, 2.0 * maximum / free)) : free;
  }

  double desired, comfortable;  ///< [m/s, m/s^2]
};

/// A driver's car following by the Improved Intelligent Driver Model at one speed [m/s], see `ImprovedIdm`.
class ImprovedIdmLaw {
 public:
  static constexpr bool asks_acceleration = false;  ///< of leaders

  /// At that speed, of a driver who desires `desired_speed` [m/s].
  template <HasIdmParameters P>
  ImprovedIdmLaw(P const& p, double speed, double desired_speed)
      : terms_(p, desired_speed), speed_(speed), free_(terms_.free_road(speed)) {}

  /// Acceleration behind a leader [m/s^2].
  [[nodiscard]] double operator()(Constraint const& leader) const { return respond(leader, free_, speed_); }
  /// The same at another speed [m/s].
  [[nodiscard]] double operator()(double speed, Constraint const& leader) const {
    return respond(leader, terms_.free_road(speed), speed);
  }

  [[nodiscard]] double speed() const { return speed_; }                  ///< [m/s]
  [[nodiscard]] double desired_speed() const { return terms_.desired; }  ///< [m/s]

  /// Motion of a step of `dt` [s] behind a leader of constant speed.
  [[nodiscard]] LongitudinalMotion<double> motion(Constraint const& leader, double dt) const {
    return follow_motion(*this, speed_, leader, dt);
  }

 private:
  [[nodiscard]] double respond(Constraint const& leader, double free, double speed) const {
    return leader.gap > 0.0 ? terms_.bounded(terms_.behind(leader, free, speed)) : terms_.low;
  }

  ImprovedIdmTerms terms_;
  double speed_;
  double free_;  ///< acceleration on a free road [m/s^2]
};

/// The Improved Intelligent Driver Model as a driver's law: unlike IDM's, its steady gap is that of the time headway at
/// all speeds below the desired one, and above that it brakes gently (Treiber, Kesting 2013, section 11.3.7).
struct ImprovedIdm {
  double desired_speed = Idm{}.desired_speed;
  double time_headway = Idm{}.time_headway;
  double minimum_gap = Idm{}.minimum_gap;
  double maximum_acceleration = Idm{}.maximum_acceleration;
  double comfortable_deceleration = Idm{}.comfortable_deceleration;
  double exponent = Idm{}.exponent;
  double lowest_acceleration = Idm{}.lowest_acceleration;
  double highest_acceleration = Idm{}.highest_acceleration;

  static constexpr char const* name = "improved_idm";
  static constexpr char const* summary =
      "free road: f = a (1 - (v/v0)^4), above v0 f = -b (1 - (v0/v)^(4 a / b)); with z = s*/s of IDM and v <= v0: "
      "f (1 - z^(2 a / f)) if z < 1, else a (1 - z^2); above v0: f, and where z > 1 f + a (1 - z^2)";
  static constexpr char const* source = "Treiber, Kesting 2013, section 11.3.7 (second-hand); defaults: BARK's of IDM";
  static constexpr auto parameters() { return idm_parameters<ImprovedIdm>(); }

  [[nodiscard]] ImprovedIdmLaw at(double speed, double desired) const { return {*this, speed, desired}; }
  /// At `speed` with `desired` speed [m/s], within the bounds [m/s^2].
  [[nodiscard]] double acceleration(double speed, double desired, Constraint const& leader) const {
    return at(speed, desired)(leader);
  }
};

}  // namespace cambium::inline v0_1
