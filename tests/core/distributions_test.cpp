#include "cambium/core/distributions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <doctest/doctest.h>

#include "cambium/core/distribution.hpp"
#include "cambium/core/random.hpp"

using namespace cambium;

namespace {

constexpr int many = 1000000;
double const not_a_number = std::numeric_limits<double>::quiet_NaN();
double const infinity = std::numeric_limits<double>::infinity();

struct Moments {
  double mean, variance, skewness, kurtosis;
};

/// Central moments of `many` draws.
template <class Distribution>
Moments moments_of(Distribution const& draw, std::uint64_t seed) {
  RandomStream stream(seed, 0, 0);
  std::vector<double> values(many);
  double mean = 0.0;
  for (auto& value : values) {
    value = draw(stream);
    mean += value / many;
  }
  double m2 = 0.0, m3 = 0.0, m4 = 0.0;
  for (double const value : values) {
    double const d = value - mean;
    m2 += d * d / many;
    m3 += d * d * d / many;
    m4 += d * d * d * d / many;
  }
  return {mean, m2, m3 / std::pow(m2, 1.5), m4 / (m2 * m2)};
}

/// Kolmogorov-Smirnov statistic times sqrt(n) against an exact distribution function; above 1.95 with probability
/// 0.001.
template <class Distribution, class Cdf>
double kolmogorov_smirnov(Distribution const& draw, Cdf const& cdf, std::uint64_t seed) {
  constexpr int n = 100000;
  RandomStream stream(seed, 1, 0);
  std::vector<double> values(n);
  for (auto& value : values) value = draw(stream);
  std::sort(values.begin(), values.end());
  double largest = 0.0;
  for (int i = 0; i < n; ++i) {
    double const exact = cdf(values[static_cast<std::size_t>(i)]);
    largest = std::max({largest, exact - i / double{n}, (i + 1) / double{n} - exact});
  }
  return largest * std::sqrt(double{n});
}

double normal_cdf(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

/// A stream of one value, for the ends of the range.
struct Constant {
  std::uint64_t value;
  static constexpr std::uint64_t min() { return 0; }
  static constexpr std::uint64_t max() { return ~std::uint64_t{0}; }
  std::uint64_t operator()() const { return value; }
};

}  // namespace

TEST_CASE("the normal quantile inverts the exact distribution function") {
  // Values of the algorithm's paper (Wichura 1988, section 4).
  CHECK(detail::normal_quantile(0.25) == doctest::Approx(-0.6744897501960817).epsilon(1e-15));
  CHECK(detail::normal_quantile(0.001) == doctest::Approx(-3.090232306167814).epsilon(1e-15));
  CHECK(detail::normal_quantile(1e-20) == doctest::Approx(-9.262340089798408).epsilon(1e-15));
  CHECK(detail::normal_quantile(0.5) == 0.0);
  for (double x = -8.0; x < 8.0; x += 0.001) {
    double const p = normal_cdf(x < 0.0 ? x : -x);
    double const back = detail::normal_quantile(p);
    REQUIRE(std::abs(back + std::abs(x)) < 2e-14);
  }
}

TEST_CASE("draws have the moments and the distribution function of their distribution") {
  double const n = many;
  auto const check = [](auto const& draw, std::uint64_t seed, Moments const& exact, Moments const& error,
                        auto const& cdf) {
    CAPTURE(seed);
    auto const m = moments_of(draw, seed);
    CHECK(std::abs(m.mean - exact.mean) < 4.0 * error.mean);
    CHECK(std::abs(m.variance - exact.variance) < 4.0 * error.variance);
    CHECK(std::abs(m.skewness - exact.skewness) < 4.0 * error.skewness);
    CHECK(std::abs(m.kurtosis - exact.kurtosis) < 4.0 * error.kurtosis);
    CHECK(kolmogorov_smirnov(draw, cdf, seed + 1) < 1.95);
  };
  double const variance = 16.0 / 12.0;
  check(Uniform{-1.0, 3.0}, 11, {1.0, variance, 0.0, 1.8},
        {std::sqrt(variance / n), variance * std::sqrt(0.8 / n), std::sqrt(6.0 / n), std::sqrt(24.0 / n)},
        [](double x) { return (x + 1.0) / 4.0; });
  check(Normal{2.0, 3.0}, 21, {2.0, 9.0, 0.0, 3.0},
        {3.0 / std::sqrt(n), 9.0 * std::sqrt(2.0 / n), std::sqrt(6.0 / n), std::sqrt(24.0 / n)},
        [](double x) { return normal_cdf((x - 2.0) / 3.0); });
  // Standard errors of the third and fourth standardised moment of 10^6 draws, from 300 repetitions: 0.0085 and 0.091.
  check(Exponential{0.5}, 31, {2.0, 4.0, 2.0, 9.0}, {2.0 / std::sqrt(n), 4.0 * std::sqrt(8.0 / n), 0.0085, 0.091},
        [](double x) { return 1.0 - std::exp(-0.5 * x); });
}

TEST_CASE("draws are finite at the ends of the bit range") {
  Constant zeros{0}, ones{~std::uint64_t{0}};
  CHECK(uniform01(zeros) == 0.0);
  CHECK(uniform01(ones) < 1.0);
  CHECK(Exponential{1.0}(zeros) == 0.0);
  CHECK(Exponential{1.0}(ones) == doctest::Approx(53.0 * std::log(2.0)));
  CHECK(Normal{}(zeros) == -Normal{}(ones));
  CHECK(Normal{}(ones) == doctest::Approx(8.2095).epsilon(1e-4));
  CHECK(Uniform{2.0, 2.0}(ones) == 2.0);
}

TEST_CASE("a uniform index is unbiased for any n") {
  for (std::uint32_t const n : {1u, 2u, 3u, 7u, 100u}) {
    RandomStream stream(41, n, 0);
    std::vector<int> counts(n, 0);
    constexpr int draws = 200000;
    for (int i = 0; i < draws; ++i) ++counts[uniform_index(stream, n)];
    double const mean = draws / static_cast<double>(n);
    double chi_squared = 0.0;
    for (int const count : counts) chi_squared += (count - mean) * (count - mean) / mean;
    CHECK(std::abs(chi_squared - (n - 1.0)) <= 4.0 * std::sqrt(2.0 * (n - 1.0)));
  }
  // With n = 3/4 of 2^32, scaling without rejection would give the multiples of 3 half of the draws.
  RandomStream stream(42, 0, 0);
  int multiples = 0;
  for (int i = 0; i < 100000; ++i) multiples += uniform_index(stream, 3u << 30) % 3 == 0;
  CHECK(std::abs(multiples - 33333.3) < 4.0 * std::sqrt(1e5 * 2.0 / 9.0));
}

TEST_CASE("a discrete choice follows its weights and never takes a weight of zero") {
  std::array<double, 5> const weights{0.0, 1.0, 2.0, 0.0, 5.0};
  std::array<int, 5> counts{};
  RandomStream stream(51, 0, 0);
  constexpr int draws = 200000;
  for (int i = 0; i < draws; ++i) ++counts[discrete_index(stream, weights)];
  CHECK(counts[0] == 0);
  CHECK(counts[3] == 0);
  for (std::size_t i = 0; i < 5; ++i) {
    double const p = weights[i] / 8.0;
    CHECK(std::abs(counts[i] - draws * p) <= 4.0 * std::sqrt(draws * p * (1.0 - p)));
  }
  Constant ones{~std::uint64_t{0}};
  std::array<double, 3> const trailing_zero{0.1, 0.2, 0.0};
  CHECK(discrete_index(ones, trailing_zero) == 1);
}

TEST_CASE("bad parameters are refused before the first draw, with the key, the value and the range") {
  CHECK_NOTHROW(check_parameters(Normal{1.0, 0.0}));
  CHECK_THROWS_WITH_AS(check_parameters(Normal{0.0, -1.0}, "noise.json"),
                       "noise.json: normal.deviation: is -1; give a value in [0, inf)", ParameterError);
  CHECK_THROWS_AS(check_parameters(Normal{not_a_number, 1.0}), ParameterError);
  CHECK_THROWS_AS(check_parameters(Normal{0.0, infinity}), ParameterError);
  CHECK_THROWS_AS(check_parameters(Exponential{0.0}), ParameterError);
  CHECK_THROWS_AS(check_parameters(Uniform{0.0, infinity}), ParameterError);
  CHECK_THROWS_AS(check_parameters(Uniform{-1.5e308, 1.5e308}), ParameterError);
  CHECK_THROWS_WITH_AS(check_parameters(Uniform{3.0, 1.0}), "uniform: has high = 1 below low = 3; swap the two ends",
                       ParameterError);
}

TEST_CASE("draws are the same bits on every platform, compiler and optimisation level") {
  RandomStream stream(42, 3, 17);
  double uniform = 0.0, normal = 0.0, exponential = 0.0, truncated = 0.0, tail = 0.0;
  for (int i = 0; i < 100000; ++i) {  // a sum changes with the last bit of any of them
    uniform += Uniform{-1.0, 3.0}(stream);
    normal += Normal{2.0, 3.0}(stream);
    exponential += Exponential{0.7}(stream);
  }
  for (int i = 0; i < 10000; ++i) {
    truncated += TruncatedNormal{34.0, 7.0, 24.0, 56.0}(stream);
    tail += TruncatedNormal{0.0, 1.0, 7.0, 9.0}(stream);
  }
  CHECK(uniform == 0x1.8777a039ee46bp+16);
  CHECK(normal == 0x1.895de5e5b0003p+17);
  CHECK(exponential == 0x1.17182d4a136e9p+17);
  CHECK(truncated == 0x1.55a55e0d060ebp+18);
  CHECK(tail == 0x1.16d7505d78d6p+16);
}

TEST_CASE("a truncated normal distribution is the normal one between its bounds") {
  auto const below = [](double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); };
  for (double z = -39.0; z < 9.0; z += 0.0137) {
    CAPTURE(z);
    CHECK(std::abs(detail::normal_probability(z) - below(z)) < 1e-15);
    if (z < 0.0 && z > -37.0) CHECK(detail::normal_probability(z) == doctest::Approx(below(z)).epsilon(1e-8));
  }
  for (TruncatedNormal const drawn :
       {TruncatedNormal{34.0, 7.0, 24.0, 56.0}, TruncatedNormal{1.0, 0.5, 2.0, 2.2},
        TruncatedNormal{-1.0, 3.0, -infinity, 0.5}, TruncatedNormal{0.0, 1.0, -9.0, -8.0}}) {
    auto const at = [&](double x) { return below((x - drawn.mean) / drawn.deviation); };
    CHECK(kolmogorov_smirnov(
              drawn, [&](double x) { return (at(x) - at(drawn.low)) / (at(drawn.high) - at(drawn.low)); }, 5) < 1.95);
  }
  RandomStream stream(1, 2, 3), same(1, 2, 3);
  CHECK(TruncatedNormal{3.0, 2.0}(stream) == doctest::Approx(Normal{3.0, 2.0}(same)).epsilon(1e-12));
  CHECK(TruncatedNormal{3.0, 0.0, 3.0, 3.0}(stream) == 3.0);
  CHECK(TruncatedNormal{3.0, 0.0, 1.0, 2.0}(stream) == 2.0);
  for (double const low : {2.0, 6.0, 8.0, 20.0}) {
    CAPTURE(low);
    double last = low;
    for (std::uint64_t bits : {0ull, 1ull << 62, 1ull << 63, ~0ull - (1ull << 50), ~0ull - (1ull << 14), ~0ull}) {
      Constant one{bits}, other{~bits};
      double const x = TruncatedNormal{0.0, 1.0, low, infinity}(one);
      CHECK(x >= last);
      CHECK(x == -TruncatedNormal{0.0, 1.0, -infinity, -low}(other));
      last = x;
    }
    CHECK(last > low);
  }
  CHECK(TruncatedNormal{3.0, 1.0, 90.0, 91.0}(stream) == 90.0);
  CHECK(TruncatedNormal{3.0, 1.0, -91.0, -90.0}(stream) == -90.0);
  CHECK_THROWS_AS(check_parameters(TruncatedNormal{.low = 2.0, .high = 1.0}), ParameterError);
}
