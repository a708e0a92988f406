#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "cambium/behavior/idm.hpp"
#include "cambium/behavior/view.hpp"

namespace cambium::detail {

/// A driver's car following at one speed [m/s]; agrees with `idm_acceleration` but for rounding.
class IdmLaw {
 public:
  template <HasIdmParameters P>
  IdmLaw(P const& p, double speed) : IdmLaw(p, speed, p.desired_speed) {}

  template <HasIdmParameters P>
  IdmLaw(P const& p, double speed, double desired_speed)
      : terms_(p, desired_speed),
        speed_(speed),
        rest_(1.0 - idm_power(speed * terms_.inverse_desired_speed, p.exponent)) {}

  /// [m/s^2], on a free road.
  [[nodiscard]] double free() const { return bounded(terms_.maximum * rest_); }

  /// [m/s^2], behind a leader.
  [[nodiscard]] double operator()(double gap, double leader_speed) const {
    if (!(gap > 0.0)) return terms_.low;
    double const dynamic = speed_ * (terms_.headway + (speed_ - leader_speed) * terms_.closing);
    double const closeness = (terms_.minimum_gap + std::max(0.0, dynamic)) / gap;
    return bounded(terms_.maximum * (rest_ - closeness * closeness));
  }

  [[nodiscard]] double operator()(std::optional<RoadUser> const& leader) const {
    return leader ? (*this)(leader->gap, leader->speed) : free();
  }

  [[nodiscard]] double speed() const { return speed_; }                    ///< [m/s]
  [[nodiscard]] double minimum_gap() const { return terms_.minimum_gap; }  ///< [m]

  /// See `idm_motion`.
  [[nodiscard]] LongitudinalMotion<double> motion(double gap, double leader_speed, double dt, double tolerance) const {
    return idm_motion(terms_, speed_, gap, leader_speed, dt, tolerance);
  }

 private:
  [[nodiscard]] double bounded(double a) const { return std::min(std::max(a, terms_.low), terms_.high); }

  IdmTerms<double> terms_;
  double speed_;
  double rest_;  ///< the acceleration on a free road, unbounded, as part of the maximum
};

/// What a driver follows: of all that is ahead what asks for the least acceleration.
struct Restriction {
  double gap = std::numeric_limits<double>::infinity();  ///< [m]
  double speed{};                                        ///< of the leader [m/s]
  double acceleration{};                                 ///< that IDM answers with [m/s^2]

  void add(IdmLaw const& law, double to_gap, double leader_speed) {
    double const a = law(to_gap, leader_speed);
    if (a < acceleration || (a == acceleration && to_gap < gap)) *this = {to_gap, leader_speed, a};
  }
};

}  // namespace cambium::detail
