#pragma once

#include <limits>

namespace cambium {

/// Something ahead to which a car-following law responds: a road user, the end of the lane, the gap to open for a
/// vehicle that merges. It moves along the lane or stands.
struct Constraint {
  double gap = std::numeric_limits<double>::infinity();  ///< from the own front end [m]
  double speed = 0.0;                                    ///< along the lane [m/s]
  double acceleration = 0.0;                             ///< of a leader, if the law asks for it [m/s^2]
};

/// Keeps the strictest of a driver's constraints: the one to which the car-following law responds with the lowest
/// acceleration; among equals, the nearest. Without constraints the road is free. `Law` has `double
/// operator()(Constraint const&) const` [m/s^2] for the driver's speed, never higher behind a constraint than on a free
/// road.
template <class Law>
class Strictest {
 public:
  explicit Strictest(Law const& law) : law_(&law) {}

  void heed(Constraint const& other) {
    if (constraint_.gap < free_road) {  // a single constraint needs no comparison
      double const a = (*law_)(other);
      if (!(a < acceleration() || (a == acceleration() && other.gap < constraint_.gap))) return;
      acceleration_ = a;
    } else {
      acceleration_ = not_asked;  // that of the free road may have been asked for
    }
    constraint_ = other;
  }

  [[nodiscard]] Law const& law() const { return *law_; }
  [[nodiscard]] Constraint const& constraint() const { return constraint_; }

  /// The law's response [m/s^2].
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
