#include "cambium/core/portable_math.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <type_traits>

#include <doctest/doctest.h>

#include "cambium/core/distributions.hpp"
#include "cambium/core/random.hpp"

using namespace cambium;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity(), pi = 3.14159265358979323846;

/// The largest error of `f` in units in the last place, beside `exact` of long doubles, at random places from `low` to
/// `high`.
template <class F, class Exact>
double worst_of(F const& f, Exact const& exact, double low, double high) {
  RandomStream random(7, 0, 0);
  double worst = 0.0;
  for (int i = 0; i < 100'000; ++i) {
    double const x = Uniform{low, high}(random);
    long double const right = exact(static_cast<long double>(x));
    double const size = std::abs(static_cast<double>(right)), unit = std::nextafter(size, infinity) - size;
    worst = std::max(worst, static_cast<double>(std::abs(f(x) - right)) / unit);
  }
  return worst;
}

}  // namespace

TEST_CASE("sine and cosine agree with the long double library within 2.5e-16") {
  RandomStream stream(3, 0, 0);
  auto const worst_up_to = [&stream](double bound, int draws) {
    double worst = 0.0;
    for (int i = 0; i < draws; ++i) {
      double const x = Uniform{-bound, bound}(stream);
      auto const result = portable::sin_cos(x);
      auto const exact = static_cast<long double>(x);
      worst = std::max({worst, static_cast<double>(std::abs(result.sin - std::sin(exact))),
                        static_cast<double>(std::abs(result.cos - std::cos(exact)))});
    }
    return worst;
  };
  CHECK(worst_up_to(pi, 300000) < 2.5e-16);
  CHECK(worst_up_to(100.0, 300000) < 2.5e-16);
  CHECK(worst_up_to(1e5, 300000) < 2.5e-16);
  CHECK(worst_up_to(1e8, 10000) < 3e-16);
  CHECK(worst_up_to(1e15, 10000) < 3e-16);
}

TEST_CASE("the short series agree with the long double library up to a slight angle") {
  RandomStream stream(4, 0, 0);
  double sine = 0.0, cosine = 0.0, tangent = 0.0;
  auto const error = [](double value, long double exact) { return static_cast<double>(std::abs(value - exact)); };
  for (int i = 0; i < 300000; ++i) {
    double const x = i == 0 ? portable::slight_angle : Uniform{-portable::slight_angle, portable::slight_angle}(stream);
    auto const exact = static_cast<long double>(x);
    sine = std::max(sine, error(portable::sin_cos_slight(x).sin, std::sin(exact)));
    cosine = std::max(cosine, error(portable::sin_cos_slight(x).cos, std::cos(exact)));
    tangent = std::max(tangent, error(portable::tan_slight(x), std::tan(exact)));
  }
  CHECK(sine < 3e-17);
  CHECK(cosine < 2.5e-16);
  CHECK(tangent < 3e-17);
  CHECK(portable::sin_cos_often_slight(0.1).sin == portable::sin_cos_slight(0.1).sin);
  CHECK(portable::sin_cos_often_slight(2.0).sin == portable::sin_cos(2.0).sin);
}

TEST_CASE("sine and cosine are exact at zero and right at the quarter turns") {
  CHECK(portable::sin_cos(0.0).sin == 0.0);
  CHECK(portable::sin_cos(0.0).cos == 1.0);
  for (int quarter = -9; quarter <= 9; ++quarter) {
    double const x = quarter * pi / 2;
    CHECK(std::abs(portable::sin(x) - std::sin(x)) < 2e-16);
    CHECK(std::abs(portable::cos(x) - std::cos(x)) < 2e-16);
  }
  CHECK(std::isnan(portable::sin(std::numeric_limits<double>::quiet_NaN())));
  CHECK(std::isnan(portable::cos(infinity)));
}

TEST_CASE("the elementary functions are as accurate as they say") {
  auto const errors = [](auto const& f, auto const& exact, std::initializer_list<double> bounds) {
    double worst = 0.0;
    for (double const bound : bounds) worst = std::max(worst, worst_of(f, exact, -bound, bound));
    return worst;
  };
  CHECK(errors([](double x) { return portable::tan(x); }, [](long double x) { return std::tan(x); }, {0.125, 1.5}) <
        5.0);
  CHECK(errors([](double x) { return portable::atan(x); }, [](long double x) { return std::atan(x); },
               {0.125, 1.0, 50.0, 1e9}) < 3.0);
  CHECK(errors([](double x) { return portable::exp(x); }, [](long double x) { return std::exp(x); },
               {1.0, 3.0, 700.0}) < 2.0);
  CHECK(errors(portable::fused_exp, [](long double x) { return std::exp(x); }, {1.0, 3.0, 700.0}) < 2.0);
  for (double x = -700.0; x < 700.0; x += 0.37) {  // by instructions or by calls: the same bits
    double const e = portable::fused_exp(x);
    CHECK(e == portable::detail::exp_series(x));
    CHECK(portable::log(e) == portable::detail::log_series(e));
  }
  CHECK(errors(portable::tanh, [](long double x) { return std::tanh(x); }, {0.1, 1.0, 25.0}) < 4.0);
  for (double const side : {1e200, 3e-200})
    CHECK(errors([side](double x) { return portable::hypot(side, side * x); },
                 [side](long double x) { return std::hypot(side * 1.0L, side * static_cast<double>(x) * 1.0L); },
                 {1.0, 1e5}) < 2.0);
  for (double const side : {3.0, -0.5, 0.0}) {
    CHECK(errors([side](double x) { return portable::hypot(x, side); },
                 [side](long double x) { return std::hypot(x, static_cast<long double>(side)); },
                 {1.0, 1e5, 1e200}) < 2.0);
    CHECK(errors([side](double x) { return portable::atan2(x, side); },
                 [side](long double x) { return std::atan2(x, static_cast<long double>(side)); }, {1.0, 1e5}) < 4.0);
  }
  CHECK(worst_of([](double x) { return portable::log(x); }, [](long double x) { return std::log(x); }, 1e-9, 3.0) <
        2.0);
  CHECK(worst_of([](double x) { return portable::log(x); }, [](long double x) { return std::log(x); }, 1.0, 1e300) <
        2.0);
}

TEST_CASE("the logarithm is accurate near 0, where the tails of distributions are drawn") {
  RandomStream random(1, 0, 0);
  double worst = 0.0;
  for (int i = 0; i < 100'000; ++i) {
    double const x = std::exp(Uniform{-740.0, 0.0}(random));
    long double const right = std::log(static_cast<long double>(x));
    worst = std::max(worst, static_cast<double>(std::abs((portable::log(x) - right) / right)));
  }
  CHECK(worst < 4.4e-16);
}

TEST_CASE("powers are exact where the exponent is whole and the power fits, else close") {
  for (unsigned n = 0; n <= 15; ++n) {
    CHECK(portable::integer_power(11.0, n) == std::pow(11.0, n));
    CHECK(portable::pow(11.0, n) == std::pow(11.0, n));
  }
  for (double x = 0.01; x < 100.0; x *= 1.3)
    for (double const y : {0.1, 0.5, 2.5, 3.7, 40.3, -0.7, -3.0, -40.3}) {
      double const right = std::pow(x, y);
      CHECK(std::abs(portable::pow(x, y) - right) <= 1e-13 * right);
    }
}

TEST_CASE("the elementary functions do as those of the standard library at the ends of their ranges") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), tiny = std::numeric_limits<double>::denorm_min(),
                   huge = std::numeric_limits<double>::max();
  auto const same = [](double value, double right, double share = 4e-16) {
    if (std::isnan(right)) return std::isnan(value);
    if (std::signbit(value) != std::signbit(right)) return false;
    if (std::isinf(right)) return value == right;
    return value == right ||
           std::abs(value - right) <= std::max(share * std::abs(right), std::numeric_limits<double>::denorm_min());
  };
  for (double const x : {0.0, -0.0, 1.0, -1.0, 0.125, 744.0, -744.0, 1e5, 1e15, tiny, -tiny, 1e-300, 1e-310, huge,
                         -huge, infinity, -infinity, nan}) {
    CAPTURE(x);
    CHECK(same(portable::atan(x), std::atan(x)));
    CHECK(same(portable::tanh(x), std::tanh(x)));
    CHECK(same(portable::exp(x), std::exp(x)));
    CHECK(same(portable::fused_exp(x), std::exp(x)));
    CHECK(same(portable::log(x), std::log(x)));
    if (!(std::abs(x) > 1e5) || !std::isfinite(x)) {
      CHECK(same(portable::sin(x) + 0.0, std::sin(x) + 0.0));
      CHECK(same(portable::cos(x), std::cos(x)));
      CHECK(same(portable::tan(x), std::tan(x)));
    }
    for (double const y : {0.0, -0.0, 1.0, -1.0, 0.5, tiny, 1e-200, huge, infinity, -infinity, nan}) {
      CAPTURE(y);
      CHECK(same(portable::atan2(x, y), std::atan2(x, y)));
      CHECK(same(portable::hypot(x, y), std::hypot(x, y)));
      if (x >= 0.0 && !std::signbit(x)) CHECK(same(portable::pow(x, y), std::pow(x, y), 1e-12));
    }
  }
  CHECK(std::isnan(portable::pow(-2.0, 0.5)));
  CHECK(std::isnan(portable::pow(nan, 0.5)));
  CHECK(std::isnan(portable::hypot(nan, 1.0)));
  CHECK(std::isnan(portable::hypot(1.0, nan)));
  CHECK(portable::hypot(3.0 * tiny, 4.0 * tiny) == 5.0 * tiny);
  CHECK(portable::exp(710.0) == infinity);
  CHECK(portable::exp(-1e9) == 0.0);
  for (double const x : {1e17, 1e300}) {  // the angle means nothing, but it is one
    auto const [sin, cos] = portable::sin_cos(x);
    CHECK(std::abs(sin * sin + cos * cos - 1.0) < 1e-15);
  }
}

TEST_CASE("floats give floats") {
  static_assert(std::is_same_v<decltype(portable::sin(1.0f)), float>);
  for (float const x : {0.1f, 1.0f, -2.5f}) {
    CHECK(portable::sin(x) == doctest::Approx(std::sin(x)).epsilon(1e-7));
    CHECK(portable::cos(x) == doctest::Approx(std::cos(x)).epsilon(1e-7));
    CHECK(portable::tan(x) == doctest::Approx(std::tan(x)).epsilon(1e-6));
    CHECK(portable::atan(x) == doctest::Approx(std::atan(x)).epsilon(1e-7));
    CHECK(portable::exp(x) == doctest::Approx(std::exp(x)).epsilon(1e-7));
    CHECK(portable::pow(x * x, 1.5f) == doctest::Approx(std::pow(x * x, 1.5f)).epsilon(1e-6));
  }
}
