#pragma once

#include <limits>

namespace cambium {

/// What bounds how a driver goes on: something ahead of it that goes along its lane, or stands. A leader, the end of
/// the lane, a stop line, a place to give way at.
struct Constraint {
  double gap = std::numeric_limits<double>::infinity();  ///< from the own front end to it [m]
  double speed = 0.0;                                    ///< along the lane [m/s]
  double acceleration = 0.0;                             ///< of a leader, where a law asks for it [m/s^2]
};

/// The strictest of a driver's constraints: that which its car-following law answers with the lowest acceleration; of
/// equals the nearest. Without any the road is free. `Law`: `double operator()(Constraint const&) const` [m/s^2], for
/// the driver's speed, no higher behind a constraint than on a free road.
template <class Law>
class Strictest {
 public:
  explicit Strictest(Law const& law) : law_(&law) {}

  void heed(Constraint const& other) {
    if (constraint_.gap < free_road) {  // a single one is not asked about
      double const a = (*law_)(other);
      if (!(a < acceleration() || (a == acceleration() && other.gap < constraint_.gap))) return;
      acceleration_ = a;
    }
    constraint_ = other;
  }

  [[nodiscard]] Constraint const& constraint() const { return constraint_; }

  /// What the law answers it with [m/s^2].
  [[nodiscard]] double acceleration() {
    if (acceleration_ == not_asked) acceleration_ = (*law_)(constraint_);
    return acceleration_;
  }

 private:
  static constexpr double free_road = std::numeric_limits<double>::infinity(), not_asked = free_road;

  Law const* law_;
  Constraint constraint_;
  double acceleration_ = not_asked;
};

}  // namespace cambium
