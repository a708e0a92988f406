#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "cambium/behavior/idm.hpp"
#include "cambium/behavior/view.hpp"

namespace cambium::detail {

/// IDM with all that depends on its parameters alone taken out; agrees with `idm_acceleration` but for rounding.
class IdmLaw {
 public:
  template <HasIdmParameters P>
  explicit IdmLaw(P const& p) : IdmLaw(p, p.desired_speed) {}

  template <HasIdmParameters P>
  IdmLaw(P const& p, double desired_speed)
      : inverse_desired_speed_(1.0 / desired_speed),
        headway_(p.time_headway),
        closing_(0.5 / std::sqrt(p.maximum_acceleration * p.comfortable_deceleration)),
        minimum_gap_(p.minimum_gap),
        maximum_(p.maximum_acceleration),
        low_(p.lowest_acceleration),
        high_(p.highest_acceleration),
        exponent_(p.exponent) {}

  /// [m/s^2], on a free road.
  [[nodiscard]] double free(double speed) const {
    return bounded(maximum_ * (1.0 - idm_power(speed * inverse_desired_speed_, exponent_)));
  }

  /// [m/s^2], behind a leader.
  [[nodiscard]] double operator()(double speed, double gap, double leader_speed) const {
    if (!(gap > 0.0)) return low_;
    double const dynamic = speed * (headway_ + (speed - leader_speed) * closing_);
    double const closeness = (minimum_gap_ + std::max(0.0, dynamic)) / gap;
    double const free = idm_power(speed * inverse_desired_speed_, exponent_);
    return bounded(maximum_ * (1.0 - free - closeness * closeness));
  }

  [[nodiscard]] double operator()(double speed, std::optional<Neighbor> const& leader) const {
    return leader ? (*this)(speed, leader->gap, leader->speed) : free(speed);
  }

  [[nodiscard]] double minimum_gap() const { return minimum_gap_; }  ///< [m]

 private:
  [[nodiscard]] double bounded(double a) const { return std::min(std::max(a, low_), high_); }

  double inverse_desired_speed_, headway_, closing_, minimum_gap_, maximum_, low_, high_, exponent_;
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
