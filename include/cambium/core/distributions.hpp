#pragma once

#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>

#include "cambium/core/error.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/portable_math.hpp"

// The same stream gives the same bits on every platform with IEEE doubles (no -ffast-math). Two rules make this so:
//   - The code uses only +, -, *, /, sqrt and fma, which are correctly rounded everywhere (but fma of MinGW before
//     version 11), and `log`, `pow` and `fused_exp` of portable_math.hpp, which keep these rules, too.
//   - No product feeds an addition outside std::fma, so compilers find nothing to contract into fused operations.
//
// Draws never throw. To check parameters, call `check_parameters(distribution)` once, outside the step path; it throws
// `ParameterError`.

namespace cambium::inline v0_1 {

/// A source of 64 uniform random bits: `RandomStream` or a 64-bit standard engine.
template <class Stream>
concept BitStream = requires(Stream stream) {
  { stream() } -> std::same_as<std::uint64_t>;
  requires Stream::min()
  == 0 && Stream::max() == std::numeric_limits<std::uint64_t>::max();
};

/// A uniform number in [0, 1), a multiple of 2^-53.
template <BitStream Stream>
[[nodiscard]] constexpr double uniform01(Stream& stream) {
  return static_cast<double>(stream() >> 11) * 0x1p-53;
}

/// A uniform number in (0, 1): never an end.
template <BitStream Stream>
[[nodiscard]] constexpr double open_uniform01(Stream& stream) {
  return (static_cast<double>(stream() >> 12) + 0.5) * 0x1p-52;  // exact
}

/// A uniform integer in [0, n) without bias (Lemire 2019, "Fast random integer generation in an interval"). `n` > 0.
/// Takes one draw; needs another with a probability below n / 2^32.
template <BitStream Stream>
[[nodiscard]] constexpr std::uint32_t uniform_index(Stream& stream, std::uint32_t n) {
  CAMBIUM_ASSERT(n > 0, "uniform_index: n must be positive");
  std::uint64_t product = (stream() >> 32) * n;
  if (static_cast<std::uint32_t>(product) < n) {
    std::uint32_t const threshold = (0u - n) % n;
    while (static_cast<std::uint32_t>(product) < threshold) product = (stream() >> 32) * n;
  }
  return static_cast<std::uint32_t>(product >> 32);
}

namespace detail {

/// The tails of `normal_quantile`: near (probabilities down to about 1e-11) and far.
[[nodiscard]] inline double normal_quantile_near(double r) {
  return portable::fused_polynomial(r, 1.42343711074968357734e0, 4.63033784615654529590e0, 5.76949722146069140550e0,
                                    3.64784832476320460504e0, 1.27045825245236838258e0, 2.41780725177450611770e-1,
                                    2.27238449892691845833e-2, 7.74545014278341407640e-4) /
         portable::fused_polynomial(r, 1.0, 2.05319162663775882187e0, 1.67638483018380384940e0,
                                    6.89767334985100004550e-1, 1.48103976427480074590e-1, 1.51986665636164571966e-2,
                                    5.47593808499534494600e-4, 1.05075007164441684324e-9);
}
[[nodiscard]] inline double normal_quantile_far(double r) {
  return portable::fused_polynomial(r, 6.65790464350110377720e0, 5.46378491116411436990e0, 1.78482653991729133580e0,
                                    2.96560571828504891230e-1, 2.65321895265761230930e-2, 1.24266094738807843860e-3,
                                    2.71155556874348757815e-5, 2.01033439929228813265e-7) /
         portable::fused_polynomial(r, 1.0, 5.99832206555887937690e-1, 1.36929880922735805310e-1,
                                    1.48753612908506148525e-2, 7.86869131145613259100e-4, 1.84631831751005468180e-5,
                                    1.42151175831644588870e-7, 2.04426310338993978564e-15);
}

/// Quantile (inverse distribution function) of the standard normal distribution for p in (0, 1), relative error 1e-16
/// (Wichura 1988, algorithm AS 241, PPND16).
[[nodiscard]] inline double normal_quantile(double p) {
  double const q = p - 0.5;
  if (std::abs(q) <= 0.425) {
    double const r = std::fma(-q, q, 0.180625);
    return q * (portable::fused_polynomial(r, 3.3871328727963666080e0, 1.3314166789178437745e2, 1.9715909503065514427e3,
                                           1.3731693765509461125e4, 4.5921953931549871457e4, 6.7265770927008700853e4,
                                           3.3430575583588128105e4, 2.5090809287301226727e3) /
                portable::fused_polynomial(r, 1.0, 4.2313330701600911252e1, 6.8718700749205790830e2,
                                           5.3941960214247511077e3, 2.1213794301586595867e4, 3.9307895800092710610e4,
                                           2.8729085735721942674e4, 5.2264952788528545610e3));
  }
  double const r = std::sqrt(-portable::log(q < 0.0 ? p : 1.0 - p));
  double const magnitude = r <= 5.0 ? normal_quantile_near(r - 1.6) : normal_quantile_far(r - 5.0);
  return q < 0.0 ? -magnitude : magnitude;
}

/// Probability that a standard normal number is below `z`, absolute error 1e-15 (Hart et al. 1968, algorithm 5666; West
/// 2005, "Better approximations to cumulative normal functions").
[[nodiscard]] inline double normal_probability(double z) {
  double const x = std::abs(z);
  if (x > 37.0) return z < 0.0 ? 0.0 : 1.0;
  double below = portable::fused_exp(-0.5 * x * x);  // -x
  if (x < 7.07106781186547) {
    below = below *
            portable::fused_polynomial(x, 220.206867912376, 221.213596169931, 112.079291497871, 33.912866078383,
                                       6.37396220353165, 0.700383064443688, 3.52624965998911e-2) /
            portable::fused_polynomial(x, 440.413735824752, 793.826512519948, 637.333633378831, 296.564248779674,
                                       86.7807322029461, 16.064177579207, 1.75566716318264, 8.83883476483184e-2);
  } else {
    below /= (x + 1.0 / (x + 2.0 / (x + 3.0 / (x + 4.0 / (x + 0.65))))) * 2.506628274631;
  }
  return z < 0.0 ? below : 1.0 - below;
}

}  // namespace detail

/// Uniform distribution on [low, high]; the upper end occurs only by rounding.
struct Uniform {
  double low = 0.0;
  double high = 1.0;

  static constexpr char const* name = "uniform";
  static constexpr char const* summary = "every value between two ends is equally likely";
  static constexpr char const* source = "-";
  static constexpr auto parameters() {
    return parameter_list(parameter("low", &Uniform::low, "-", any_finite, "Lower end."),
                          parameter("high", &Uniform::high, "-", any_finite, "Upper end, not below the lower one."));
  }
  /// Throws `ParameterError` unless `low` <= `high` with a finite difference; called by `check_parameters`.
  void check(std::string const& where) const {
    if (low <= high && std::isfinite(high - low)) return;
    if (low <= high) throw ParameterError(where, "is wider than the range of doubles", "bring the two ends closer");
    throw ParameterError(where, "has high = " + detail::number_text(high) + " below low = " + detail::number_text(low),
                         "swap the two ends");
  }

  template <BitStream Stream>
  [[nodiscard]] double operator()(Stream& stream) const {
    return std::fma(high - low, uniform01(stream), low);
  }
};

/// Normal (Gaussian) distribution by inversion: takes one draw, and a larger random number never gives a smaller value.
struct Normal {
  double mean = 0.0;
  double deviation = 1.0;

  static constexpr char const* name = "normal";
  static constexpr char const* summary = "Gaussian with mean and standard deviation; sampled by inversion";
  static constexpr char const* source = "-";
  static constexpr auto parameters() {
    return parameter_list(parameter("mean", &Normal::mean, "-", any_finite, "Mean."),
                          parameter("deviation", &Normal::deviation, "-", non_negative, "Standard deviation."));
  }

  template <BitStream Stream>
  [[nodiscard]] double operator()(Stream& stream) const {
    return std::fma(deviation, detail::normal_quantile(open_uniform01(stream)), mean);
  }
};

/// Exponential distribution: the time until the next event of a Poisson process.
struct Exponential {
  double rate = 1.0;

  static constexpr char const* name = "exponential";
  static constexpr auto parameters() {
    return parameter_list(
        parameter("rate", &Exponential::rate, "-", positive, "Mean number of events per unit; 1 / mean."));
  }

  template <BitStream Stream>
  [[nodiscard]] double operator()(Stream& stream) const {
    return (0.0 - portable::log(1.0 - uniform01(stream))) / rate;
  }
};

/// An index in [0, weights.size()) with probability proportional to its weight. Weights: finite, not negative, at least
/// one positive (asserted). O(number of weights); stores nothing.
template <BitStream Stream>
[[nodiscard]] std::size_t discrete_index(Stream& stream, std::span<double const> weights) {
  double total = 0.0;
  for (double const weight : weights) total += weight;
  CAMBIUM_ASSERT(total > 0.0, "discrete_index: at least one weight must be positive");
  double const target = uniform01(stream) * total;
  double sum = 0.0;
  std::size_t last = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (!(weights[i] > 0.0)) continue;
    last = i;
    sum += weights[i];
    if (target < sum) break;
  }
  return last;
}

}  // namespace cambium::inline v0_1
