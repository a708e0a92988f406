#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "cambium/core/macros.hpp"

/// Elementary functions of operations alone that IEEE 754 rounds correctly (additions, multiplications, divisions,
/// roots, remainders, explicit fused operations): the same bits with any standard library and any compiler that does
/// not contract multiplications and additions by itself. Maps are built and worlds step by these; only coordinates on
/// the globe are not. Errors are relative, in units in the last place; angles are in radians.
///
/// Random numbers take only `log`, `pow` and `fused_exp`, which use explicit fused operations only, so that contraction
/// cannot change them; they are long, and never inlined. With g++ and clang on x86-64 they take the processor's
/// instruction for these where it has one, also in programs that are compiled without. `exp` is faster than
/// `fused_exp`.
namespace cambium::inline v0_1::portable {

namespace detail {

inline constexpr double infinite = std::numeric_limits<double>::infinity();
inline constexpr double pi = 3.14159265358979323846, two_pi = 2.0 * pi;
inline constexpr double two_pi_rest = 2.4492935982947064e-16;  // 2 pi beyond `two_pi`

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

/// e^r - 1 for |r| <= 0.35: Taylor's series; the first omitted term is below 1e-17 of the result.
[[nodiscard]] inline double exp_minus_one_small(double r) {
  double const tail =
      polynomial(r, 1.0 / 2, 1.0 / 6, 1.0 / 24, 1.0 / 120, 1.0 / 720, 1.0 / 5040, 1.0 / 40320, 1.0 / 362880,
                 1.0 / 3628800, 1.0 / 39916800, 1.0 / 479001600, 1.0 / 6227020800, 1.0 / 87178291200);
  return r + r * r * tail;
}

/// x 2^k for |k| <= 1100, exact unless the result is subnormal or overflows.
[[nodiscard]] inline double scaled(double x, int k) {
  auto const power = [](int n) { return std::bit_cast<double>(static_cast<std::uint64_t>(n + 1023) << 52); };
  if (k > -1000 && k < 1000) [[likely]] {
    return x * power(k);
  }
  int const half = k / 2;
  return x * power(half) * power(k - half);
}

}  // namespace detail

/// Sine and cosine of one angle, see `sin_cos`.
struct SinCos {
  double sin, cos;
};

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

/// Tangent for |x| <= `slight_angle` only. The first omitted term is below 1e-17 of the result.
[[nodiscard]] inline double tan_slight(double x) {
  double const q = x * x;
  return x + x * (q * detail::polynomial(q, 1.0 / 3, 2.0 / 15, 17.0 / 315, 62.0 / 2835, 1382.0 / 155925,
                                         21844.0 / 6081075, 929569.0 / 638512875));
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

/// Sine and cosine, with an absolute error below 2.5e-16 for |x| <= 1e5, and 3e-16 up to 1e15; beyond that, those of
/// the remainder modulo 2 pi rounded to double. The sine of -0 is 0. Inline, without a call for |x| <= 1e5. NaN if `x`
/// is not finite.
[[nodiscard]] inline SinCos sin_cos(double x) {
  if (std::abs(x) <= 1e5) [[likely]] {
    return sin_cos_bounded(x);
  }
  double const rest = std::remainder(x, detail::two_pi), turns = (x - rest) / detail::two_pi;
  return sin_cos_bounded(std::abs(x) <= 1e15 ? rest - turns * detail::two_pi_rest : rest);
}

/// `sin_cos` of an angle that is usually slight, such as a heading error.
[[nodiscard]] inline SinCos sin_cos_often_slight(double x) {
  return std::abs(x) <= slight_angle ? sin_cos_slight(x) : sin_cos(x);
}

/// See `sin_cos`.
[[nodiscard]] inline double sin(double x) { return sin_cos(x).sin; }
/// See `sin_cos`.
[[nodiscard]] inline double cos(double x) { return sin_cos(x).cos; }
/// Error below 5 for |x| <= 1e5; beyond, that of the angle.
[[nodiscard]] inline double tan(double x) {
  if (std::abs(x) <= slight_angle) return tan_slight(x);
  auto const at = sin_cos(x);
  return at.sin / at.cos;
}

/// Arc tangent; error below 3. Short for |x| <= 1/8, which is the usual case in steering.
[[nodiscard]] inline double atan(double x) {
  constexpr double half_pi = 0.5 * detail::pi;
  // atan(c) for c = 0, 1/4, 1/2, 3/4, 1
  static constexpr double known[] = {0.0, 0.24497866312686415417, 0.46364760900080611621, 0.64350110879328438680,
                                     0.78539816339744830962};
  auto const series = [](double t) {  // for |t| <= 1/8
    double const q = t * t;
    return t * (1.0 - q * detail::polynomial(q, 1.0 / 3, -1.0 / 5, 1.0 / 7, -1.0 / 9, 1.0 / 11, -1.0 / 13, 1.0 / 15));
  };
  double const a = std::abs(x);
  if (a <= 0.125) [[likely]] {
    return series(x);
  }
  if (a != a) return x;
  bool const is_steep = a > 1.0;
  double const v = is_steep ? 1.0 / a : a;
  int const i = static_cast<int>(4.0 * v + 0.5);
  double const c = 0.25 * i, angle = known[i] + series((v - c) / (1.0 + v * c));
  return std::copysign(is_steep ? half_pi - angle : angle, x);
}

/// The angle of (x, y), in [-pi, pi]; error below 4.
[[nodiscard]] inline double atan2(double y, double x) {
  if (x != x || y != y) return x + y;
  if (y == 0.0) return std::signbit(x) ? std::copysign(detail::pi, y) : y;
  if (x == 0.0) return std::copysign(0.5 * detail::pi, y);
  if (std::abs(x) == detail::infinite && std::abs(y) == detail::infinite)
    return std::copysign(x > 0.0 ? 0.25 * detail::pi : 0.75 * detail::pi, y);
  double const angle = atan(std::abs(y / x));
  return std::copysign(x < 0.0 ? detail::pi - angle : angle, y);
}

/// Error below 2. Method: x = (k + j / 8) ln 2 + r; 2^(j/8) from a table, e^r as a power series.
[[nodiscard]] inline double exp(double x) {
  if (!(x > -746.0)) return x != x ? x : 0.0;
  if (!(x < 710.0)) return x != x ? x : detail::infinite;
  static constexpr double eighths[] = {1.0,
                                       0x1.172b83c7d517bp+0,
                                       0x1.306fe0a31b715p+0,
                                       0x1.4bfdad5362a27p+0,
                                       0x1.6a09e667f3bcdp+0,
                                       0x1.8ace5422aa0dbp+0,
                                       0x1.ae89f995ad3adp+0,
                                       0x1.d5818dcfba487p+0};
  constexpr double ln2_high = 0x1.62e42feep-1, ln2_low = 0x1.a39ef35793c76p-33;  // Cody, Waite 1980
  constexpr double inverse_ln2 = 0x1.71547652b82fep+0, shifter = 0x1.8p52;
  double const shifted = x * (8.0 * inverse_ln2) + shifter, count = shifted - shifter;
  double const r = (x - count * (ln2_high / 8.0)) - count * (ln2_low / 8.0);
  auto const n = static_cast<int>(count), k = n >> 3;
  double const series =
      detail::polynomial(r, 1.0 / 2, 1.0 / 6, 1.0 / 24, 1.0 / 120, 1.0 / 720, 1.0 / 5040, 1.0 / 40320);
  double const power = eighths[n & 7], result = power + power * (r + r * r * series);
  return detail::scaled(result, k);
}

/// c + d x + e x^2 + ... by Horner's rule with fused multiply-add.
template <class... Rest>
[[nodiscard]] inline double fused_polynomial(double x, double c, Rest... rest) {
  if constexpr (sizeof...(rest) == 0) {
    return c;
  } else {
    return std::fma(fused_polynomial(x, rest...), x, c);
  }
}

namespace detail {

/// See `fused_exp`.
[[nodiscard]] inline double exp_series(double x) {
  constexpr double ln2_high = 0x1.62e42fefa3800p-1, ln2_low = 0x1.ef35793c76730p-45;
  if (!(x > -746.0)) return x <= -746.0 ? 0.0 : x;  // NaN
  if (x > 710.0) return infinite;
  double const k = std::floor(std::fma(x, 0x1.71547652b82fep+0, 0.5));
  double const r = std::fma(-k, ln2_low, std::fma(-k, ln2_high, x));
  double const series =
      fused_polynomial(r, 1.0 / 2, 1.0 / 6, 1.0 / 24, 1.0 / 120, 1.0 / 720, 1.0 / 5040, 1.0 / 40320, 1.0 / 362880,
                       1.0 / 3628800, 1.0 / 39916800, 1.0 / 479001600, 1.0 / 6227020800);
  double const exp_r = 1.0 + std::fma(r * r, series, r);
  return scaled(exp_r, static_cast<int>(k));
}

/// See `log`; for normal numbers.
[[nodiscard]] inline double log_series(double x) {
  constexpr double ln2_high = 0x1.62e42fefa3800p-1;  // 45 bits: exact times any exponent
  constexpr double ln2_low = 0x1.ef35793c76730p-45;
  constexpr std::uint64_t sqrt_half = 0x3fe6a09e667f3bcdu;
  std::uint64_t const shifted = std::bit_cast<std::uint64_t>(x) - sqrt_half;
  double const exponent = static_cast<double>(static_cast<std::int64_t>(shifted) >> 52);
  double const m = std::bit_cast<double>((shifted & 0x000fffffffffffffu) + sqrt_half);
  double const f = (m - 1.0) / (m + 1.0);
  double const square = f * f;
  double const twice = 2.0 * f;
  double const series = fused_polynomial(square, 1.0 / 3, 1.0 / 5, 1.0 / 7, 1.0 / 9, 1.0 / 11, 1.0 / 13, 1.0 / 15,
                                         1.0 / 17, 1.0 / 19, 1.0 / 21, 1.0 / 23);
  double const log_m = std::fma(twice * square, series, twice);
  return std::fma(exponent, ln2_high, std::fma(exponent, ln2_low, log_m));
}

#if defined(__GNUC__) && defined(__x86_64__) && !defined(__FMA__)
#define CAMBIUM_DETAIL_FUSES_BY_CALLS
/// The same, bit by bit, by the instruction that most processors have for a fused operation.
[[gnu::target("fma"), gnu::flatten, gnu::noinline, nodiscard]] inline double exp_by_instruction(double x) {
  return exp_series(x);
}
[[gnu::target("fma"), gnu::flatten, gnu::noinline, nodiscard]] inline double log_by_instruction(double x) {
  return log_series(x);
}
#endif

}  // namespace detail

/// `exp` that no compiler contracts; error below 2, or one subnormal step.
/// Method: x = k ln 2 + r with r in [-ln(2)/2, ln(2)/2]; e^r as a power series.
CAMBIUM_NOINLINE [[nodiscard]] inline double fused_exp(double x) {
#ifdef CAMBIUM_DETAIL_FUSES_BY_CALLS
  if (__builtin_cpu_supports("fma")) return detail::exp_by_instruction(x);
#endif
  return detail::exp_series(x);
}

/// x^n with O(log n) multiplications.
[[nodiscard]] constexpr double integer_power(double x, unsigned n) {
  double result = 1.0;
  for (; n > 0; n /= 2, x *= x)
    if (n % 2 == 1) result *= x;
  return result;
}

/// Natural logarithm; error below 2. Method: x = m 2^e with m in [sqrt(1/2), sqrt(2)); ln m = 2 artanh(f),
/// f = (m - 1) / (m + 1), as a power series.
CAMBIUM_NOINLINE [[nodiscard]] inline double log(double x) {
  if (!(x >= std::numeric_limits<double>::min() && x < detail::infinite)) [[unlikely]] {
    if (x > 0.0) return x < detail::infinite ? log(x * 0x1p54) - 54.0 * 0x1.62e42fefa39efp-1 : x;
    return x == 0.0 ? -detail::infinite : std::numeric_limits<double>::quiet_NaN();
  }
#ifdef CAMBIUM_DETAIL_FUSES_BY_CALLS
  if (__builtin_cpu_supports("fma")) return detail::log_by_instruction(x);
#endif
  return detail::log_series(x);
}
#undef CAMBIUM_DETAIL_FUSES_BY_CALLS

/// x^y for x >= 0, NaN below. For y in [0, 4096), the integer part of y is computed by multiplication. The error grows
/// with |y|, and where y < 0 with |y ln x|; below 1e-13 for |y| <= 40 and x in [0.01, 100].
CAMBIUM_NOINLINE [[nodiscard]] inline double pow(double x, double y) {
  if (y == 0.0 || x == 1.0) return 1.0;
  if (!(x > 0.0))
    return x != 0.0 || y != y ? std::numeric_limits<double>::quiet_NaN() : y > 0.0 ? 0.0 : detail::infinite;
  if (!(y >= 0.0 && y < 4096.0)) return fused_exp(y * log(x));
  auto const whole = static_cast<unsigned>(y);
  double const rest = y - whole;
  return integer_power(x, whole) * (rest > 0.0 ? fused_exp(rest * log(x)) : 1.0);
}

/// Error below 4.
[[nodiscard]] inline double tanh(double x) {
  double const a = std::abs(x);
  if (!(a < 20.0)) return x != x ? x : std::copysign(1.0, x);
  double const e = 2.0 * a <= 0.34 ? detail::exp_minus_one_small(2.0 * a) : exp(2.0 * a) - 1.0;
  return std::copysign(e / (e + 2.0), x);
}

/// Error below 1, and below 2 where squares would overflow or underflow.
[[nodiscard]] inline double hypot(double x, double y) {
  double const a = std::abs(x), b = std::abs(y), large = a < b ? b : a, small = a < b ? a : b;
  if (a == detail::infinite || b == detail::infinite) return detail::infinite;
  if (large < 1e150 && large > 1e-140) return std::sqrt(large * large + small * small);
  if (large == 0.0 || large != large || small != small) return large + small;
  double const ratio = small / large;
  return large * std::sqrt(1.0 + ratio * ratio);
}

// The same for floats, in models whose scalar is a template parameter.
template <std::same_as<float> F>
[[nodiscard]] F sin(F x) {
  return static_cast<F>(sin(double{x}));
}
template <std::same_as<float> F>
[[nodiscard]] F cos(F x) {
  return static_cast<F>(cos(double{x}));
}
template <std::same_as<float> F>
[[nodiscard]] F tan(F x) {
  return static_cast<F>(tan(double{x}));
}
template <std::same_as<float> F>
[[nodiscard]] F atan(F x) {
  return static_cast<F>(atan(double{x}));
}
template <std::same_as<float> F>
[[nodiscard]] F exp(F x) {
  return static_cast<F>(exp(double{x}));
}
template <std::same_as<float> F>
[[nodiscard]] F pow(F x, F y) {
  return static_cast<F>(pow(double{x}, double{y}));
}

}  // namespace cambium::inline v0_1::portable
