#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "cambium/behavior/idm.hpp"
#include "cambium/behavior/view.hpp"

namespace cambium::detail {

/// A driver's car following; agrees with `idm_acceleration` but for rounding.
class IdmLaw {
 public:
  template <HasIdmParameters P>
  explicit IdmLaw(P const& p) : terms_(p) {}

  template <HasIdmParameters P>
  IdmLaw(P const& p, double desired_speed) : terms_(p, desired_speed) {}

  /// [m/s^2], on a free road.
  [[nodiscard]] double free(double speed) const {
    return bounded(terms_.maximum * (1.0 - idm_power(speed * terms_.inverse_desired_speed, terms_.exponent)));
  }

  /// [m/s^2], behind a leader.
  [[nodiscard]] double operator()(double speed, double gap, double leader_speed) const {
    if (!(gap > 0.0)) return terms_.low;
    double const dynamic = speed * (terms_.headway + (speed - leader_speed) * terms_.closing);
    double const closeness = (terms_.minimum_gap + std::max(0.0, dynamic)) / gap;
    double const free = idm_power(speed * terms_.inverse_desired_speed, terms_.exponent);
    return bounded(terms_.maximum * (1.0 - free - closeness * closeness));
  }

  [[nodiscard]] double operator()(double speed, std::optional<Neighbor> const& leader) const {
    return leader ? (*this)(speed, leader->gap, leader->speed) : free(speed);
  }

  [[nodiscard]] double minimum_gap() const { return terms_.minimum_gap; }  ///< [m]
  [[nodiscard]] IdmTerms<double> const& terms() const { return terms_; }

 private:
  [[nodiscard]] double bounded(double a) const { return std::min(std::max(a, terms_.low), terms_.high); }

  IdmTerms<double> terms_;
};

/// What a driver follows: of all that is ahead what asks for the least acceleration.
struct Restriction {
  double gap = std::numeric_limits<double>::infinity();  ///< [m]
  double speed{};                                        ///< of the leader [m/s]
  double acceleration{};                                 ///< that IDM answers with [m/s^2]

  void add(IdmLaw const& law, double own_speed, double to_gap, double leader_speed) {
    double const a = law(own_speed, to_gap, leader_speed);
    if (a < acceleration || (a == acceleration && to_gap < gap)) *this = {to_gap, leader_speed, a};
  }
};

}  // namespace cambium::detail
