#pragma once

#include <algorithm>
#include <cmath>

#include "cambium/behavior/law/constraint.hpp"
#include "cambium/behavior/law/idm.hpp"
#include "cambium/core/described.hpp"
#include "cambium/core/portable_math.hpp"

namespace cambium {

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

  /// At `speed` with `desired` speed [m/s], within the bounds [m/s^2].
  [[nodiscard]] double acceleration(double speed, double desired, Constraint const& leader) const {
    IdmTerms<double> const terms(*this, desired);
    if (!(leader.gap > 0.0)) return terms.low;
    double const a = maximum_acceleration, b = comfortable_deceleration;
    double const free =
        speed <= desired ? a * terms.free(speed) : -b * (1.0 - portable::pow(desired / speed, a * exponent / b));
    double const z = terms.closeness(terms.dynamic_gap(speed, leader.speed), 1.0 / leader.gap);
    if (z >= 1.0) return terms.bounded(std::min(free, 0.0) + a * (1.0 - z * z));
    return terms.bounded(free > 0.0 && z > 0.0 ? free * (1.0 - portable::pow(z, 2.0 * a / free)) : free);
  }
};

}  // namespace cambium
