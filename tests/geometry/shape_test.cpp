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

TEST_CASE("the presets are valid, symmetric, and of the size that their comments state") {
  struct Size {
    Shape shape;
    double length, width, rear;
  };
  for (auto const& [shape, length, width, rear] :
       {Size{car(), 4.5, 1.8, 0.9}, Size{van(), 6.0, 2.0, 1.3}, Size{truck(), 10.0, 2.55, 2.8},
        Size{articulated_truck(), 16.5, 2.55, 4.0}, Size{bus(), 12.0, 2.55, 3.4}, Size{motorcycle(), 2.2, 0.8, 0.35},
        Size{bicycle(), 1.8, 0.65, 0.35}, Size{pedestrian(), 0.6, 0.6, 0.3}}) {
    CHECK_NOTHROW(check_parameters(shape));
    CHECK(shape.left == shape.right);
    CHECK(shape.length() == doctest::Approx(length));
    CHECK(shape.width() == doctest::Approx(width));
    CHECK(shape.rear == rear);
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
