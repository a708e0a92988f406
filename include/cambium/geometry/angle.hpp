#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "cambium/geometry/pose.hpp"

namespace cambium::geometry {

/// pi, rounded to double.
inline constexpr double pi = 3.14159265358979323846;

namespace detail {

/// An angle split into the nearest number of quarter turns and the rest, in [-pi/4, pi/4] up to rounding.
struct QuarterTurns {
  double rest;
  std::int64_t count;
};

/// Splits `x`, |x| <= 1e5, into quarter turns and rest. pi/2 is held in parts of 33 bits, so that their products with
/// the count are exact (Cody, Waite 1980).
[[nodiscard]] inline QuarterTurns reduce_by_quarter_turns(double x) {
  constexpr double two_over_pi = 0x1.45f306dc9c883p-1;
  constexpr double part_1 = 0x1.921fb544p+0, part_2 = 0x1.0b4611a6p-34, part_3 = 0x1.3198a2e037073p-69;
  constexpr double shifter = 0x1.8p52;  // adding it rounds to the nearest integer, which appears in the low bits
  double const shifted = x * two_over_pi + shifter;
  double const count = shifted - shifter;
  auto const bits = std::bit_cast<std::int64_t>(shifted) - std::bit_cast<std::int64_t>(shifter);
  return {((x - count * part_1) - count * part_2) - count * part_3, bits};
}

}  // namespace detail

/// Sine and cosine of one angle, see `sin_cos`.
struct SinCos {
  double sin, cos;
};

namespace detail {

/// c[0] + c[1] x + c[2] x^2 + ... by Estrin's scheme (1960): evaluates in pairs, so that few operations depend on each
/// other.
template <std::size_t n>
[[nodiscard]] constexpr double polynomial(double x, std::array<double, n> const& c) {
  if constexpr (n == 1) {
    return c[0];
  } else {
    return [&]<std::size_t... i>(std::index_sequence<i...>) {
      std::array<double, (n + 1) / 2> pairs{(c[2 * i] + c[2 * i + 1] * x)...};
      if constexpr (n % 2 != 0) pairs.back() = c.back();
      return polynomial(x * x, pairs);
    }
    (std::make_index_sequence<n / 2>{});
  }
}

/// The same with the coefficients as arguments.
template <class... Rest>
[[nodiscard]] constexpr double polynomial(double x, double c, Rest... rest) {
  return polynomial(x, std::array{c, rest...});
}

}  // namespace detail

/// Like `sin_cos`, but for |x| <= pi/4 only, without branches and library calls.
[[nodiscard]] inline SinCos sin_cos_small(double x) {
  // Taylor series; the first omitted term is below 5e-17 on [-pi/4, pi/4].
  double const q = x * x;
  double const sine_series = detail::polynomial(q, -1.0 / 6, 1.0 / 120, -1.0 / 5040, 1.0 / 362880, -1.0 / 39916800,
                                                1.0 / 6227020800, -1.0 / 1307674368000);
  double const cosine_series = detail::polynomial(q, 1.0 / 24, -1.0 / 720, 1.0 / 40320, -1.0 / 3628800, 1.0 / 479001600,
                                                  -1.0 / 87178291200, 1.0 / 20922789888000);
  return {x + x * (q * sine_series), 1.0 - (0.5 * q - q * q * cosine_series)};
}

/// Up to this angle [rad], shorter series suffice.
inline constexpr double slight_angle = 0.125;

/// Like `sin_cos`, but for |x| <= `slight_angle` only.
[[nodiscard]] inline SinCos sin_cos_slight(double x) {
  double const q = x * x;
  double const sine_series = detail::polynomial(q, -1.0 / 6, 1.0 / 120, -1.0 / 5040, 1.0 / 362880);
  double const cosine_series = detail::polynomial(q, 1.0 / 24, -1.0 / 720, 1.0 / 40320, -1.0 / 3628800);
  return {x + x * (q * sine_series), 1.0 - (0.5 * q - q * q * cosine_series)};
}

/// Tangent of x for |x| <= `slight_angle` only. The first omitted term is below 1e-17 of the result.
[[nodiscard]] inline double tangent_slight(double x) {
  double const q = x * x;
  return x + x * (q * detail::polynomial(q, 1.0 / 3, 2.0 / 15, 17.0 / 315, 62.0 / 2835, 1382.0 / 155925,
                                         21844.0 / 6081075, 929569.0 / 638512875));
}

/// Arc tangent; inline for small arguments, which are the usual case in steering.
[[nodiscard]] inline double arc_tangent(double t) {
  if (!(std::abs(t) <= 0.125)) return std::atan(t);
  double const q = t * t;
  return t * (1.0 - q * detail::polynomial(q, 1.0 / 3, -1.0 / 5, 1.0 / 7, -1.0 / 9, 1.0 / 11, -1.0 / 13, 1.0 / 15));
}

/// Like `sin_cos`, but for |x| <= 1e5 only, without branches and library calls, so that compilers vectorise loops over
/// it.
[[nodiscard]] inline SinCos sin_cos_bounded(double x) {
  auto const [rest, count] = detail::reduce_by_quarter_turns(x);
  auto const [sine, cosine] = sin_cos_small(rest);
  // Quarter turn 1 maps (sin, cos) to (cos, -sin), 2 to (-sin, -cos), 3 to (-cos, sin). Done with bit masks, because a
  // branch on the quadrant would be hard to predict.
  auto const sine_bits = std::bit_cast<std::uint64_t>(sine), cosine_bits = std::bit_cast<std::uint64_t>(cosine);
  auto const turns = static_cast<std::uint64_t>(count);
  std::uint64_t const swapped = (sine_bits ^ cosine_bits) & (0 - (turns & 1));
  std::uint64_t const sign_of_sin = (turns & 2) << 62, sign_of_cos = ((turns + 1) & 2) << 62;
  return {std::bit_cast<double>(sine_bits ^ swapped ^ sign_of_sin),
          std::bit_cast<double>(cosine_bits ^ swapped ^ sign_of_cos)};
}

/// Sine and cosine of `x` [rad]. For |x| <= 1e5 the absolute error is below 2.5e-16, and it is inline and faster than
/// two calls of the standard library; larger values go to the standard library. NaN if `x` is not finite.
[[nodiscard]] inline SinCos sin_cos(double x) {
  if (std::abs(x) <= 1e5) [[likely]] {
    return sin_cos_bounded(x);
  }
  return {std::sin(x), std::cos(x)};
}

/// `sin_cos` of an angle that is usually slight, such as a heading error.
[[nodiscard]] inline SinCos sin_cos_often_slight(double x) {
  return std::abs(x) <= slight_angle ? sin_cos_slight(x) : sin_cos(x);
}

/// The same direction in (-pi, pi]; -pi becomes pi. An angle already in that range is returned unchanged, to the bit.
/// Reduces by the exact pi: the absolute error is below 1e-15 for |angle| <= 1e5; beyond, it is that of the standard
/// library's sine. NaN if `angle` is not finite.
[[nodiscard]] inline double normalize_angle(double angle) {
  if (angle > -pi && angle <= pi) [[likely]] {
    return angle;
  }
  if (!(std::abs(angle) <= 1e5)) {
    double const wrapped = std::atan2(std::sin(angle), std::cos(angle));
    return wrapped <= -pi ? pi : wrapped;
  }
  auto const [rest, count] = detail::reduce_by_quarter_turns(angle);
  constexpr double half_pi = pi / 2;
  auto const quarter = static_cast<double>(((count + 1) & 3) - 1);  // -1, 0, 1 or 2
  double const wrapped = rest + quarter * half_pi;
  return wrapped > pi ? wrapped - 2.0 * pi : (wrapped <= -pi ? pi : wrapped);
}

/// The turn from direction `b` to direction `a`: `a - b` in (-pi, pi], positive if `a` lies counter-clockwise of `b`.
[[nodiscard]] inline double angle_difference(double a, double b) { return normalize_angle(a - b); }

}  // namespace cambium::geometry
