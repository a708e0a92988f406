#include <cambium/benchmark/statistics.hpp>
#include <cambium/core/distributions.hpp>
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

using namespace cambium;

namespace {

/// The mice of Efron and Tibshirani 1993, table 2.1: survival times under treatment [days].
std::vector<double> const mice{94, 197, 16, 38, 99, 141, 23};

/// Calls `f(resample)` for all n^n resamples of `values`.
template <class F>
void for_all_resamples(std::vector<double> const& values, F const& f) {
  auto const n = values.size();
  std::vector<std::size_t> digits(n, 0);
  std::vector<double> sample(n);
  for (bool more = true; more;) {
    for (std::size_t i = 0; i < n; ++i) sample[i] = values[digits[i]];
    f(sample);
    std::size_t i = 0;
    while (i < n && ++digits[i] == n) digits[i++] = 0;
    more = i < n;
  }
}

/// Student's t of the hypothesis that the mean is `middle`; infinite without scatter.
double t_of(std::vector<double> const& values, double middle) {
  detail::Moments const moments(values);
  auto const n = static_cast<double>(values.size());
  return (moments.mean - middle) / std::sqrt(moments.square / (n - 1) / n);
}

/// About `value`, with a relative tolerance. (By default, doctest adds an absolute one.)
doctest::Approx within(double value, double tolerance) { return doctest::Approx(value).epsilon(tolerance).scale(0.0); }

double binomial(int n, int k) {
  double result = 1.0;
  for (int i = 1; i <= k; ++i) result = result * (n - k + i) / i;
  return result;
}

}  // namespace

TEST_CASE("a Wilson interval holds exactly the shares that the score test does not reject") {
  for (unsigned n : {1u, 5u, 40u, 1000u})
    for (unsigned count = 0; count <= n; count += 1 + n / 7) {
      auto const [low, high] = wilson_interval(count, n);
      double const share = count / double(n);
      for (double const end : {low, high}) {
        if (end <= 0.0 || end >= 1.0) continue;
        CHECK(std::abs(share - end) / std::sqrt(end * (1 - end) / n) == within(normal_975, 1e-9));
      }
      CHECK(low <= share);
      CHECK(share <= high);
    }
  CHECK(wilson_interval(0, 20).low == 0.0);
  CHECK(wilson_interval(20, 20).high == 1.0);
  CHECK(wilson_interval(0, 0) == Interval{0.0, 1.0});
  CHECK(std::abs(wilson_interval(81, 263).low - 0.2553) < 1e-4);  // Newcombe 1998, table I, method 3
}

TEST_CASE("the bootstrap interval is that of all resamples") {
  for (auto const& values : {mice, std::vector<double>{1, 2, 4, 8, 16, 32, 256}}) {
    std::vector<double> means;
    for_all_resamples(values, [&](auto const& sample) { means.push_back(mean_of(sample)); });
    std::sort(means.begin(), means.end());
    double const mean = mean_of(values);
    double scatter = 0.0, below = 0.0;
    for (double const m : means) {
      scatter += (m - mean) * (m - mean);
      below += m < mean ? 1.0 : m == mean ? 0.5 : 0.0;
    }
    auto const all = static_cast<double>(means.size());
    if (values == mice) {  // Efron and Tibshirani, table 2.2, B = inf
      CHECK(mean == within(86.86, 1e-4));
      CHECK(std::sqrt(scatter / all) == within(23.36, 1e-3));
    }
    // BCa as the book writes it, with the acceleration by leaving out one value at a time.
    double square = 0.0, cube = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      auto rest = values;
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
      double const d = mean - mean_of(rest);
      square += d * d;
      cube += d * d * d;
    }
    double const acceleration = cube / (6 * std::pow(square, 1.5)), bias = detail::normal_quantile(below / all);
    auto const share = [&](double z) {
      return 0.5 * std::erfc(-(bias + (bias + z) / (1 - acceleration * (bias + z))) / std::sqrt(2.0));
    };
    auto const quantile = [&](double p) { return means[static_cast<std::size_t>(p * all)]; };
    auto const [low, high] = bootstrap_interval(values, 200'000);
    CHECK(low == within(quantile(share(-1.96)), 0.02));
    CHECK(high == within(quantile(share(1.96)), 0.02));
    CHECK(bootstrap_interval(values) == bootstrap_interval(values));
  }
}

TEST_CASE("a bootstrap interval of nothing, one value or equal values says so") {
  CHECK(std::isinf(bootstrap_interval({}).high));
  CHECK(std::isinf(bootstrap_interval(std::vector{3.0}).low));
  CHECK(bootstrap_interval(std::vector{0.1, 0.1, 0.1}) == Interval{0.1, 0.1});
}

TEST_CASE("McNemar's exact test counts all ways to toss the pairs that differ") {
  CHECK(mcnemar_p(0, 0) == 1.0);
  CHECK(mcnemar_p(5, 5) == 1.0);
  for (int n = 1; n <= 12; ++n)
    for (int first = 0; first <= n; ++first) {
      double as_far = 0.0;
      for (int k = 0; k <= n; ++k)
        if (std::abs(2 * k - n) >= std::abs(2 * first - n)) as_far += binomial(n, k);
      CHECK(mcnemar_p(static_cast<unsigned>(first), static_cast<unsigned>(n - first)) ==
            within(as_far / std::ldexp(1.0, n), 1e-9));
    }
  // Agresti 2002, table 10.1 (approval of the prime minister): 150 and 86 changed their minds; Fay 2010.
  CHECK(mcnemar_p(86, 150) == within(3.716e-5, 1e-3));
  CHECK(mcnemar_p(150, 86) == mcnemar_p(86, 150));
  // Large numbers: the normal approximation with continuity correction.
  double const z = (std::abs(50'500.0 - 49'500.0) - 1) / std::sqrt(100'000.0);
  CHECK(mcnemar_p(50'500, 49'500) == within(std::erfc(z / std::sqrt(2.0)), 1e-3));
}

TEST_CASE("the paired bootstrap is that of all resamples") {
  // Efron and Tibshirani 1993, section 16.4: whether the mice's mean is 129; t = -1.67, one-sided p about 0.1. And two
  // clearer cases.
  for (double const middle : {129.0, 20.0, 0.0}) {
    std::vector<double> differences;
    for (double const days : mice) differences.push_back(days - middle);
    double const t = t_of(differences, 0.0), mean = mean_of(differences);
    double below = 0.0, as_far = 0.0, all = 0.0;
    for_all_resamples(differences, [&](auto const& sample) {
      double const other = t_of(sample, mean);
      below += other <= t;
      as_far += !std::isfinite(other) || std::abs(other) >= std::abs(t);
      all += 1.0;
    });
    if (middle == 129.0) {
      CHECK(t == within(-1.67, 2e-3));
      CHECK(below / all == within(0.10, 0.1));
    }
    double const p = paired_bootstrap_p(differences, 100'000);
    CHECK(p == within(as_far / all, 0.2));  // it ends after 100 exceedances: good to 10 %
    CHECK(p == paired_bootstrap_p(differences, 200'000));
  }
}

TEST_CASE("the paired bootstrap finds differences, does not mind the direction, and asks for more than a few pairs") {
  CHECK(paired_bootstrap_p({}) == 1.0);
  CHECK(paired_bootstrap_p(std::vector<double>(50, 0.0)) == 1.0);
  CHECK(paired_bootstrap_p(std::vector{0.3, 0.3, 0.3}) == 0.25);
  CHECK(paired_bootstrap_p(std::vector{0.30, 0.31, 0.32, 0.33}) == 0.125);
  CHECK(paired_bootstrap_p(std::vector{0.3}) == 1.0);
  CHECK(paired_bootstrap_p(std::vector<double>(50, 0.3)) == 1e-4);
  std::vector<double> clear;
  for (int i = 0; i < 60; ++i) clear.push_back(i % 3 - 0.5);
  auto reverse = clear;
  for (double& d : reverse) d = -d;
  CHECK(paired_bootstrap_p(clear) < 1e-3);
  CHECK(paired_bootstrap_p(reverse) == paired_bootstrap_p(clear));
}

TEST_CASE("Holm's p values reject what closed testing by Bonferroni rejects") {
  // Adjusted p of a hypothesis: the largest Bonferroni p over all sets of hypotheses that hold it.
  for (std::uint32_t trial = 0; trial < 200; ++trial) {
    RandomStream stream(13, trial, 0);
    std::vector<double> p(1 + uniform_index(stream, 7));
    for (double& value : p) value = 0.2 * uniform01(stream) * uniform01(stream);
    if (p.size() > 2) p[1] = p[2];
    std::vector<double> expected(p.size(), 0.0);
    for (std::uint32_t set = 1; set < (1u << p.size()); ++set) {
      double least = 1.0, members = 0.0;
      for (std::size_t i = 0; i < p.size(); ++i)
        if ((set >> i & 1u) != 0) {
          least = std::min(least, p[i]);
          members += 1.0;
        }
      for (std::size_t i = 0; i < p.size(); ++i)
        if ((set >> i & 1u) != 0) expected[i] = std::max(expected[i], std::min(1.0, members * least));
    }
    auto const adjusted = holm(p);
    for (std::size_t i = 0; i < p.size(); ++i) CHECK(adjusted[i] == within(expected[i], 1e-9));
  }
  CHECK(holm({}).empty());
}
