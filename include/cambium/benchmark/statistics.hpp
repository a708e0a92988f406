#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include "cambium/core/distributions.hpp"
#include "cambium/core/random.hpp"

/// How sure a benchmark's figures are. The bootstrap draws from a stream with a fixed seed: the same values give the
/// same result.
namespace cambium::inline v0_1 {

/// A confidence interval.
struct Interval {
  double low = 0.0, high = 0.0;

  friend bool operator==(Interval const&, Interval const&) = default;
};

/// Standard normal quantile of 97.5 %: all intervals here are 95 % intervals.
inline constexpr double normal_975 = 1.959963984540054;

/// 95 % interval of a share, from `count` successes in `total` trials (Wilson 1927; Newcombe 1998, method 3). Without
/// trials, [0, 1].
[[nodiscard]] inline Interval wilson_interval(std::uint64_t count, std::uint64_t total) {
  if (total == 0) return {0.0, 1.0};
  constexpr double z = normal_975;
  auto const n = static_cast<double>(total);
  double const p = static_cast<double>(count) / n;
  double const middle = (p + z * z / (2 * n)) / (1 + z * z / n);
  double const half = z / (1 + z * z / n) * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n));
  return {count == 0 ? 0.0 : std::max(0.0, middle - half), count == total ? 1.0 : std::min(1.0, middle + half)};
}

/// The mean; NaN of no values.
[[nodiscard]] inline double mean_of(std::span<double const> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

namespace detail {

/// Sums of the deviations from the mean, and of their squares and cubes.
struct Moments {
  double mean = 0.0, square = 0.0, cube = 0.0;

  explicit Moments(std::span<double const> values) : mean(mean_of(values)) {
    for (double const value : values) {
      double const d = value - mean;
      square += d * d;
      cube += d * d * d;
    }
  }
};

/// Calls `f(value)` for `values.size()` values drawn with replacement. Two indices a draw; their bias is below n /
/// 2^32.
template <class F>
void resample(std::span<double const> values, RandomStream& stream, F const& f) {
  std::uint64_t const n = values.size();
  for (std::uint64_t i = 0; i < n; i += 2) {
    auto const bits = stream();
    f(values[(bits >> 32) * n >> 32]);
    if (i + 1 < n) f(values[(bits & 0xffffffffu) * n >> 32]);
  }
}

/// Relative tolerance at which sums in another order count as equal: equal means of counts are to be found equal.
inline constexpr double rounding = 1e-9;

[[nodiscard]] inline double normal_distribution_function(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

}  // namespace detail

/// 95 % interval of the mean: bias-corrected and accelerated bootstrap (BCa; Efron 1987; Efron and Tibshirani 1993,
/// eqs. 14.9, 14.10, 14.14 and 14.15). All values must be finite. Of fewer than two values, (-inf, inf): they do not
/// say how far they scatter. O(resamples × values).
[[nodiscard]] inline Interval bootstrap_interval(std::span<double const> values, std::size_t resamples = 1999) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (values.size() < 2) return {-infinity, infinity};
  detail::Moments const moments(values);
  if (std::all_of(values.begin(), values.end(), [&](double value) { return value == values.front(); }))
    return {values.front(), values.front()};
  std::vector<double> means(resamples);
  RandomStream stream(0x626f6f7473747261u, 0, 0);
  double const tie = detail::rounding * std::sqrt(moments.square);
  double below = 0.0;
  for (double& mean : means) {
    double sum = 0.0;
    detail::resample(values, stream, [&](double value) { sum += value - moments.mean; });
    mean = moments.mean + sum / static_cast<double>(values.size());
    below += sum < -tie ? 1.0 : sum <= tie ? 0.5 : 0.0;
  }
  std::sort(means.begin(), means.end());
  auto const b = static_cast<double>(resamples);
  double const bias = detail::normal_quantile(std::clamp(below / b, 0.5 / b, 1 - 0.5 / b));
  double const acceleration = moments.cube / (6.0 * std::pow(moments.square, 1.5));  // of a mean, by the jackknife
  auto const end = [&](double z) {
    double const share = detail::normal_distribution_function(bias + (bias + z) / (1 - acceleration * (bias + z)));
    auto const place = std::clamp(std::floor(share * (b + 1)), 1.0, b);
    return means[static_cast<std::size_t>(place) - 1];
  };
  return {end(-normal_975), end(normal_975)};
}

/// Two-sided p value of McNemar's exact test (McNemar 1947; binomial form as in Fay 2010): whether two shares differ,
/// measured on the same scenarios. `only_first`: number of scenarios in which the first succeeds and the second does
/// not; `only_second`: the reverse. O(the smaller of them).
[[nodiscard]] inline double mcnemar_p(std::uint64_t only_first, std::uint64_t only_second) {
  auto const n = static_cast<double>(only_first + only_second);
  auto const few = static_cast<double>(std::min(only_first, only_second));
  double logarithm = -n * std::log(2.0);
  for (double i = 1; i <= few; ++i) logarithm += std::log((n - few + i) / i);
  double term = std::exp(logarithm), tail = 0.0;
  for (double k = few; k >= 0.0 && term > 1e-17 * tail; --k) {
    tail += term;
    term *= k / (n - k + 1);
  }
  return std::min(1.0, 2.0 * tail);
}

/// Two-sided p value of the hypothesis that the mean of paired differences is 0: bootstrap of Student's t on the
/// centred differences (Efron and Tibshirani 1993, algorithm 16.2). Ends early where p is large (Besag and Clifford
/// 1991, 100 exceedances), so only small p values cost `resamples`; none is below 1 / (resamples + 1). Nor is one below
/// 2^(1-k) where k differences are not 0, the least that a test of signs gives: few pairs prove nothing.
/// O(resamples × differences).
[[nodiscard]] inline double paired_bootstrap_p(std::span<double const> differences, std::size_t resamples = 9999) {
  auto const some = std::count_if(differences.begin(), differences.end(), [](double d) { return d != 0.0; });
  if (some == 0) return 1.0;
  double const least = std::ldexp(1.0, 1 - static_cast<int>(std::min<std::ptrdiff_t>(some, 1000)));
  detail::Moments const moments(differences);
  auto const n = static_cast<double>(differences.size());
  double const floor = std::max(least, 1.0 / static_cast<double>(resamples + 1));
  if (std::sqrt(moments.square / n) <= detail::rounding * std::abs(moments.mean)) return floor;  // all are equal
  RandomStream stream(0x7061697265640000u, 0, 0);
  constexpr std::size_t enough = 100;
  std::size_t exceeding = 0, drawn = 0;
  while (drawn < resamples && exceeding < enough) {
    double sum = 0.0, squares = 0.0;
    detail::resample(differences, stream, [&](double difference) {
      double const d = difference - moments.mean;
      sum += d;
      squares += d * d;
    });
    // |t*| >= |t| without a division; a resample without scatter counts against the difference.
    double const scatter = std::max(0.0, squares - sum * sum / n);
    exceeding += std::abs(sum / n) * std::sqrt(moments.square) >=
                 (1 - detail::rounding) * std::abs(moments.mean) * std::sqrt(scatter);
    ++drawn;
  }
  double const p = exceeding == enough ? static_cast<double>(enough) / static_cast<double>(drawn)
                                       : static_cast<double>(exceeding + 1) / static_cast<double>(resamples + 1);
  return std::max(p, floor);
}

/// p values adjusted for their number (Holm 1979): rejecting those below a level errs in even one with at most that
/// probability, however the tests depend on each other. O(n log n).
[[nodiscard]] inline std::vector<double> holm(std::span<double const> p) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return p[a] < p[b]; });
  std::vector<double> adjusted(p.size());
  double least = 0.0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    least = std::max(least, std::min(1.0, static_cast<double>(p.size() - i) * p[order[i]]));
    adjusted[order[i]] = least;
  }
  return adjusted;
}

}  // namespace cambium::inline v0_1
