#pragma once

#include <algorithm>
#include <cmath>

#include "cambium/core/parameters.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/angle.hpp"

namespace cambium::inline v0_1 {

/// A vector in the plane, over any scalar.
template <class Scalar>
struct PlaneVector {
  Scalar x{}, y{};

  friend PlaneVector operator+(PlaneVector const& a, PlaneVector const& b) { return {a.x + b.x, a.y + b.y}; }
  friend PlaneVector operator-(PlaneVector const& a, PlaneVector const& b) { return {a.x - b.x, a.y - b.y}; }
  friend PlaneVector operator*(Scalar const& s, PlaneVector const& a) { return {s * a.x, s * a.y}; }
  [[nodiscard]] friend Scalar dot(PlaneVector const& a, PlaneVector const& b) { return a.x * b.x + a.y * b.y; }
  [[nodiscard]] Scalar norm() const {
    using std::sqrt;
    return sqrt(x * x + y * y);
  }
};

/// The parameters of the social force model, with the values of Helbing and Molnár 1995, "Social force model for
/// pedestrian dynamics", Phys. Rev. E 51, 4282. In that paper pedestrians are points; the parameters of body contact
/// are those of Helbing, Farkas, Vicsek 2000, "Simulating dynamical features of escape panic", Nature 407, 487 (2000 N
/// for 80 kg, 0.08 m).
///
/// `relative_stride` measures the stride of another pedestrian relative to the own motion (Johansson, Helbing, Shukla
/// 2007, "Specification of the social force pedestrian model by evolutionary adjustment to video tracking data").
/// Without it the stride is measured over ground, as in 1995; then pedestrians behind push those ahead aside as
/// oncoming ones do, and a crowd that walks both ways forms no lanes of one direction.
struct SocialForceParameters {
  double desired_speed = 1.34;
  double relaxation_time = 0.5;
  double highest_speed_ratio = 1.3;
  double repulsion = 2.1;
  double repulsion_range = 0.3;
  double stride_time = 2.0;
  bool relative_stride = true;
  double border_repulsion = 10.0;
  double border_range = 0.2;
  double sight_angle = 200.0 * geometry::pi / 180.0;
  double weight_behind = 0.5;
  double contact_acceleration = 25.0;
  double contact_range = 0.08;
  double highest_acceleration = 10.0;

  static constexpr char const* name = "social_force";
  static constexpr char const* summary =
      "v' = (v_desired e - v) / tau - grad V0 exp(-b / sigma) for each other - grad U0 exp(-r / R) for each border, "
      "reduced for sources behind; bodies do not touch";
  static constexpr char const* source =
      "Helbing, Molnár 1995, eq. 1 to 11; relative stride: Johansson, Helbing, Shukla 2007; contact: Helbing, Farkas, "
      "Vicsek 2000";
  static constexpr auto parameters() {
    using P = SocialForceParameters;
    return parameter_list(
        parameter("desired_speed", &P::desired_speed, "m/s", Range{0.1, 20},
                  "on a free way; in the paper normally distributed with a standard deviation of 0.26 m/s"),
        parameter("relaxation_time", &P::relaxation_time, "s", Range{0.01, 100},
                  "tau: of the approach to the desired speed"),
        parameter("highest_speed_ratio", &P::highest_speed_ratio, "-", Range{1, 10},
                  "highest speed relative to the desired one"),
        parameter("repulsion", &P::repulsion, "m^2/s^2", Range{0, 1000}, "V0: potential at another pedestrian"),
        parameter("repulsion_range", &P::repulsion_range, "m", Range{0.01, 100}, "sigma: of that potential"),
        parameter("stride_time", &P::stride_time, "s", Range{0, 100},
                  "duration of the other's stride that is kept clear"),
        parameter("relative_stride", &P::relative_stride,
                  "the stride is measured relative to the own motion, not over ground"),
        parameter("border_repulsion", &P::border_repulsion, "m^2/s^2", Range{0, 1000}, "U0: potential at a border"),
        parameter("border_range", &P::border_range, "m", Range{0.01, 100}, "R: of that potential"),
        parameter("sight_angle", &P::sight_angle, "rad", Range{0, 2 * geometry::pi},
                  "2 phi: others within it count fully"),
        parameter("weight_behind", &P::weight_behind, "-", Range{0, 1}, "c: of others outside it"),
        parameter("contact_acceleration", &P::contact_acceleration, "m/s^2", Range{0, 1000},
                  "A / m: where bodies touch"),
        parameter("contact_range", &P::contact_range, "m", Range{0.001, 10},
                  "B: distance over which it falls to 1 / e"),
        parameter("highest_acceleration", &P::highest_acceleration, "m/s^2", Range{0.1, 1000},
                  "of all others and borders together"));
  }
};

/// Repulsion [m/s^2] of a pedestrian by another (Helbing and Molnár 1995, eqs. 3 and 4): the negative gradient of V0
/// exp(-b / sigma), where b is the semi-minor axis of the ellipse whose foci are the other's present position and its
/// position one stride later. `apart` [m]: from the other to the pedestrian; `stride` [m]: the other's way in
/// `stride_time`. Zero where the direction is undefined, at the foci and on the line between them.
template <class Scalar>
[[nodiscard]] PlaneVector<Scalar> social_repulsion(SocialForceParameters const& p, PlaneVector<Scalar> const& apart,
                                                   PlaneVector<Scalar> const& stride) {
  using portable::exp;
  using std::sqrt;
  auto const later = apart - stride;
  Scalar const now = apart.norm(), then = later.norm(), sum = now + then;
  Scalar const square = sum * sum - dot(stride, stride);
  if (!(now > 1e-9) || !(then > 1e-9) || !(square > 1e-9)) return {};
  Scalar const b = Scalar(0.5) * sqrt(square);
  Scalar const size =
      Scalar(p.repulsion / p.repulsion_range) * exp(Scalar(-1.0 / p.repulsion_range) * b) * sum / (Scalar(4.0) * b);
  return size * ((Scalar(1.0) / now) * apart + (Scalar(1.0) / then) * later);
}

/// Size [m/s^2] of the repulsion by a border at `distance` [m] (eq. 5): U0 / R exp(-distance / R); constant behind it.
template <class Scalar>
[[nodiscard]] Scalar border_repulsion(SocialForceParameters const& p, Scalar const& distance) {
  using portable::exp;
  using std::max;
  return Scalar(p.border_repulsion / p.border_range) * exp(Scalar(-1.0 / p.border_range) * max(Scalar(0.0), distance));
}

/// Size [m/s^2] of the repulsion between bodies whose surfaces are `distance` [m] apart (Helbing, Farkas, Vicsek 2000);
/// constant where they overlap, 0 beyond 20 times the range.
template <class Scalar>
[[nodiscard]] Scalar contact_repulsion(SocialForceParameters const& p, Scalar const& distance) {
  using portable::exp;
  using std::max;
  if (distance > Scalar(20.0 * p.contact_range)) return Scalar(0.0);  // 2e-9 of it
  return Scalar(p.contact_acceleration) * exp(Scalar(-1.0 / p.contact_range) * max(Scalar(0.0), distance));
}

/// Weight of a force for a pedestrian that wants to go towards `ahead` (eq. 8): 1 if the force's source is in sight,
/// otherwise `weight_behind`. Both vectors have any length. `sight_cosine`: cosine of half the `sight_angle`.
template <class Scalar>
[[nodiscard]] Scalar sight_weight(SocialForceParameters const& p, double sight_cosine, PlaneVector<Scalar> const& ahead,
                                  PlaneVector<Scalar> const& force) {
  bool const seen = -dot(ahead, force) >= Scalar(sight_cosine) * ahead.norm() * force.norm();
  return seen ? Scalar(1.0) : Scalar(p.weight_behind);
}

/// Velocity [m/s] after `h` [s] of a pedestrian that desires velocity `desired` and is pushed by `force` [m/s^2] (eqs.
/// 2 and 11): exact for a constant force, and at most `highest_speed_ratio` times the desired speed.
[[nodiscard]] inline PlaneVector<double> social_velocity(SocialForceParameters const& p,
                                                         PlaneVector<double> const& velocity,
                                                         PlaneVector<double> const& desired,
                                                         PlaneVector<double> const& force, double h) {
  double const stays = portable::exp(-h / p.relaxation_time);
  auto const goal = desired + p.relaxation_time * force;
  auto const next = goal + stays * (velocity - goal);
  double const speed = next.norm(), highest = p.highest_speed_ratio * p.desired_speed;
  return speed > highest ? (highest / speed) * next : next;
}

}  // namespace cambium::inline v0_1
