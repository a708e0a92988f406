#include <algorithm>

#include <vector>

#include <doctest/doctest.h>

#include "cambium/core/distributions.hpp"
#include "cambium/core/random.hpp"
#include "cambium/map/road/cubic.hpp"

using cambium::map::BeforeFirst;
using cambium::map::CubicProfile;
using cambium::map::CubicRecord;

TEST_CASE("a record's value and derivatives are those of its polynomial") {
  CubicRecord const record{10.0, 1.0, 2.0, 3.0, 4.0};
  CHECK(record.value(12.0) == 1.0 + 4.0 + 12.0 + 32.0);
  CHECK(record.derivative(12.0) == 2.0 + 12.0 + 48.0);
  CHECK(record.second_derivative(12.0) == 6.0 + 48.0);
}

TEST_CASE("a record holds from its start up to the next one, which wins at its own start") {
  CubicProfile const profile({{0.0, 1.0}, {5.0, 2.0, 1.0}, {8.0, 4.0}});
  CHECK(profile.value(4.999) == 1.0);
  CHECK(profile.value(5.0) == 2.0);
  CHECK(profile.derivative(5.0) == 1.0);
  CHECK(profile.value(7.0) == 4.0);
  CHECK(profile.value(8.0) == 4.0);
  CHECK(profile.derivative(8.0) == 0.0);
  CHECK(profile.value(1e6) == 4.0);
}

TEST_CASE("of records with the same start the later one wins, in whatever order the others come") {
  CubicProfile const profile({{6.0, 9.0}, {2.0, 1.0}, {2.0, 5.0}, {0.0, 3.0}});
  CHECK(profile.value(2.0) == 5.0);
  CHECK(profile.value(1.0) == 3.0);
  CHECK(profile.value(6.0) == 9.0);
  CHECK(profile.records().size() == 4);
  CHECK(profile.records()[1].a == 1.0);
}

TEST_CASE("before the first record a profile is 0 or holds the first value") {
  std::vector<CubicRecord> const records{{3.0, 2.0, 1.0, 1.0, 1.0}};
  CHECK(CubicProfile(records).value(2.9) == 0.0);
  CHECK(CubicProfile(records, BeforeFirst::hold).value(2.9) == 2.0);
  CHECK(CubicProfile(records, BeforeFirst::hold).derivative(2.9) == 0.0);
  CHECK(CubicProfile(records, BeforeFirst::hold).second_derivative(2.9) == 0.0);
  CHECK(CubicProfile(records).find(2.9) == nullptr);
}

TEST_CASE("a profile without records is 0") {
  CubicProfile const profile({}, BeforeFirst::hold);
  CHECK(profile.empty());
  CHECK(profile.value(1.0) == 0.0);
  CHECK(profile.derivative(1.0) == 0.0);
}

TEST_CASE("the extremes of a cubic are those of fine sampling") {
  cambium::RandomStream random(1, 0, 0);
  cambium::Uniform const coefficient{-1.0, 1.0};
  for (int k = 0; k < 2000; ++k) {
    bool const is_square = k % 3 == 0, is_linear = k % 7 == 0;
    CubicRecord const record{coefficient(random), coefficient(random), coefficient(random),
                             is_linear ? 0.0 : coefficient(random), is_linear || is_square ? 0.0 : coefficient(random)};
    double const from = record.s, to = from + 3.0 * cambium::uniform01(random);
    auto const [low, high] = extremes(record, from, to);
    double lowest = record.value(from), highest = lowest;
    for (int i = 0; i <= 1000; ++i) {
      double const value = record.value(from + (to - from) * i / 1000);
      lowest = std::min(lowest, value);
      highest = std::max(highest, value);
    }
    REQUIRE(low <= lowest + 1e-12);
    REQUIRE(high >= highest - 1e-12);
    REQUIRE(low > lowest - 1e-4);
    REQUIRE(high < highest + 1e-4);
  }
}
