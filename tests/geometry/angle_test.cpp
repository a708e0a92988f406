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
  CHECK(std::abs(normalize_angle(1e15) - std::atan2(std::sin(1e15), std::cos(1e15))) < 1e-15);
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
