#include "cambium/geometry/shape.hpp"

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "cambium/core/distributions.hpp"
#include "cambium/core/random.hpp"
#include "cambium/geometry/angle.hpp"

using namespace cambium;
using namespace cambium::geometry;

TEST_CASE("a car is 4.5 m by 1.8 m, with 0.9 m behind its rear axle") {
  CHECK(car() == Shape{});
  CHECK(car().length() == doctest::Approx(4.5));
  CHECK(car().width() == doctest::Approx(1.8));
  CHECK(car().rear == 0.9);
  CHECK(car().center_offset() == doctest::Approx(1.35));
  CHECK(car().center_offset_left() == 0.0);
  CHECK(car().radius() == doctest::Approx(0.5 * std::hypot(4.5, 1.8)));
}

TEST_CASE("all presets are valid, symmetric, and longer than wide") {
  for (auto const& shape : {car(), van(), truck(), articulated_truck(), bus(), motorcycle(), bicycle(), pedestrian()}) {
    CHECK_NOTHROW(check_parameters(shape));
    CHECK(shape.left == shape.right);
    CHECK(shape.length() >= shape.width());
  }
}

TEST_CASE("a shape with a negative or missing side is refused by name") {
  CHECK_THROWS_WITH_AS(check_parameters(Shape{.rear = -0.5}), "shape.rear: is -0.5 m; give a value in [0, 100] m",
                       ParameterError);
  CHECK_THROWS_AS(check_parameters(Shape{.left = std::nan("")}), ParameterError);
}

TEST_CASE("the extent along a direction is the position of the furthest corner") {
  RandomStream stream(1, 0, 0);
  for (int i = 0; i < 1000; ++i) {
    Uniform const side{0.0, 5.0};
    Shape const shape{side(stream), side(stream), side(stream), side(stream)};
    double const angle = Uniform{-pi, pi}(stream);
    double const c = std::cos(angle), s = std::sin(angle);
    double highest = -1e9, lowest = 1e9;
    for (double const x : {shape.front, -shape.rear}) {
      for (double const y : {shape.left, -shape.right}) {
        highest = std::max(highest, x * c - y * s);
        lowest = std::min(lowest, x * c - y * s);
      }
    }
    auto const extent = extent_along(shape, c, s);
    REQUIRE(extent.positive == doctest::Approx(highest));
    REQUIRE(extent.negative == doctest::Approx(-lowest));
  }
}
