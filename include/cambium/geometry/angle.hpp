#pragma once

#include <cmath>

#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/pose.hpp"

namespace cambium::inline v0_1::geometry {

/// pi, rounded to double.
inline constexpr double pi = 3.14159265358979323846;

/// The same direction in (-pi, pi]; -pi becomes pi. An angle already in that range is returned unchanged, to the bit.
/// Reduces by the exact pi: the absolute error is below 1e-15 for |angle| <= 1e15. NaN if `angle` is not finite.
[[nodiscard]] inline double normalize_angle(double angle) {
  if (angle > -pi && angle <= pi) [[likely]] {
    return angle;
  }
  if (!(std::abs(angle) <= 1e5)) {
    auto const [sin, cos] = portable::sin_cos(angle);
    double const wrapped = portable::atan2(sin, cos);
    return wrapped <= -pi ? pi : wrapped;
  }
  auto const [rest, count] = portable::detail::reduce_by_quarter_turns(angle);
  constexpr double half_pi = pi / 2;
  auto const quarter = static_cast<double>(((count + 1) & 3) - 1);  // -1, 0, 1 or 2
  double const wrapped = rest + quarter * half_pi;
  return wrapped > pi ? wrapped - 2.0 * pi : wrapped;
}

/// The turn from direction `b` to direction `a`: `a - b` in (-pi, pi], positive if `a` lies counter-clockwise of `b`.
[[nodiscard]] inline double angle_difference(double a, double b) { return normalize_angle(a - b); }

}  // namespace cambium::inline v0_1::geometry
