#include "cambium/geometry/angle.hpp"

#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "cambium/core/distributions.hpp"
#include "cambium/core/random.hpp"

using namespace cambium;
using namespace cambium::geometry;

TEST_CASE("an angle in (-pi, pi] is left as it is, to the bit") {
  RandomStream stream(1, 0, 0);
  for (int i = 0; i < 10000; ++i) {
    double const angle = Uniform{-pi, pi}(stream);
    REQUIRE(normalize_angle(angle) == angle);
  }
  CHECK(normalize_angle(pi) == pi);
  CHECK(normalize_angle(-pi) == pi);
  CHECK(normalize_angle(0.0) == 0.0);
}

TEST_CASE("whole turns are taken off without a loss") {
  RandomStream stream(2, 0, 0);
  double worst = 0.0;
  for (int i = 0; i < 100000; ++i) {
    double const angle = Uniform{-1e5, 1e5}(stream);
    double const normalised = normalize_angle(angle);
    REQUIRE(normalised > -pi);
    REQUIRE(normalised <= pi);
    constexpr long double two_pi = 6.283185307179586476925286766559006L;
    long double const exact = std::remainder(static_cast<long double>(angle), two_pi);
    double const error = static_cast<double>(std::abs(normalised - exact));
    worst = std::max(worst, std::min(error, std::abs(error - 2.0 * pi)));
  }
  CHECK(worst < 2e-15);
  CHECK(normalize_angle(3.0 * pi) == doctest::Approx(pi));
  CHECK(normalize_angle(1e15) == doctest::Approx(std::atan2(std::sin(1e15), std::cos(1e15))));
  CHECK(std::isnan(normalize_angle(std::numeric_limits<double>::infinity())));
  CHECK(std::isnan(normalize_angle(std::numeric_limits<double>::quiet_NaN())));
}

TEST_CASE("the difference of two angles is the short way round, positive to the left") {
  CHECK(angle_difference(0.3, 0.1) == doctest::Approx(0.2));
  CHECK(angle_difference(-3.0, 3.0) == doctest::Approx(2.0 * pi - 6.0));
  CHECK(angle_difference(3.0, -3.0) == doctest::Approx(6.0 - 2.0 * pi));
  CHECK(angle_difference(0.0, pi) == pi);
  CHECK(angle_difference(pi, 0.0) == pi);
}

TEST_CASE("sine and cosine agree with the long double library within 2.5e-16") {
  RandomStream stream(3, 0, 0);
  auto const worst_up_to = [&stream](double bound, int draws) {
    double worst = 0.0;
    for (int i = 0; i < draws; ++i) {
      double const x = Uniform{-bound, bound}(stream);
      auto const result = sin_cos(x);
      auto const exact = static_cast<long double>(x);
      worst = std::max({worst, static_cast<double>(std::abs(result.sin - std::sin(exact))),
                        static_cast<double>(std::abs(result.cos - std::cos(exact)))});
    }
    return worst;
  };
  CHECK(worst_up_to(pi, 300000) < 2.5e-16);
  CHECK(worst_up_to(100.0, 300000) < 2.5e-16);
  CHECK(worst_up_to(1e5, 300000) < 2.5e-16);
  CHECK(worst_up_to(1e8, 1000) < 2.5e-16);
}

TEST_CASE("the short series agree with the long double library up to a slight angle") {
  RandomStream stream(4, 0, 0);
  double sine = 0.0, cosine = 0.0, tangent = 0.0, inverse = 0.0;
  auto const error = [](double value, long double exact) { return static_cast<double>(std::abs(value - exact)); };
  for (int i = 0; i < 300000; ++i) {
    double const x = i == 0 ? slight_angle : Uniform{-slight_angle, slight_angle}(stream);
    auto const exact = static_cast<long double>(x);
    sine = std::max(sine, error(sin_cos_slight(x).sin, std::sin(exact)));
    cosine = std::max(cosine, error(sin_cos_slight(x).cos, std::cos(exact)));
    tangent = std::max(tangent, error(tangent_slight(x), std::tan(exact)));
    inverse = std::max(inverse, error(arc_tangent(x), std::atan(exact)));
  }
  CHECK(sine < 3e-17);
  CHECK(cosine < 2.5e-16);
  CHECK(tangent < 3e-17);
  CHECK(inverse < 5e-17);
  for (double const t : {0.2, -1.0, 3.0, 1e9}) CHECK(arc_tangent(t) == doctest::Approx(std::atan(t)).epsilon(1e-15));
}

TEST_CASE("sine and cosine are exact at zero and right at the quarter turns") {
  CHECK(sin_cos(0.0).sin == 0.0);
  CHECK(sin_cos(0.0).cos == 1.0);
  for (int quarter = -9; quarter <= 9; ++quarter) {
    double const x = quarter * pi / 2;
    CHECK(std::abs(sin_cos(x).sin - std::sin(x)) < 2e-16);
    CHECK(std::abs(sin_cos(x).cos - std::cos(x)) < 2e-16);
  }
  CHECK(std::isnan(sin_cos(std::numeric_limits<double>::quiet_NaN()).sin));
  CHECK(std::isnan(sin_cos(std::numeric_limits<double>::infinity()).cos));
}
