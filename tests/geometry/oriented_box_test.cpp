#include "cambium/geometry/oriented_box.hpp"

#include <doctest/doctest.h>

#include "cambium/core/distributions.hpp"
#include "cambium/core/random.hpp"
#include "cambium/geometry/angle.hpp"

using namespace cambium;
using namespace cambium::geometry;

TEST_CASE("the corners of a shape's rectangle are the shape's corners, turned with the pose") {
  RandomStream stream(1, 0, 0);
  for (int i = 0; i < 1000; ++i) {
    Uniform const side{0.0, 5.0}, coordinate{-100.0, 100.0};
    Shape const shape{side(stream), side(stream), side(stream), side(stream)};
    Pose const pose{coordinate(stream), coordinate(stream), Uniform{-10.0, 10.0}(stream)};
    auto const corners = box_of(shape, pose).corners();
    Point const local[] = {
        {shape.front, shape.left}, {-shape.rear, shape.left}, {-shape.rear, -shape.right}, {shape.front, -shape.right}};
    for (std::size_t k = 0; k < 4; ++k) REQUIRE((corners[k] - to_map(pose, local[k])).norm() < 1e-12);
  }
}

TEST_CASE("a car heading north has its front in the north") {
  auto const box = box_of(car(), State{.x = 10.0, .y = 20.0, .heading = pi / 2});
  CHECK(box.x == doctest::Approx(10.0));
  CHECK(box.y == doctest::Approx(21.35));
  auto const around = box.bounding_box();
  CHECK(around.min_x == doctest::Approx(9.1));
  CHECK(around.max_x == doctest::Approx(10.9));
  CHECK(around.min_y == doctest::Approx(19.1));
  CHECK(around.max_y == doctest::Approx(23.6));
}

TEST_CASE("the bounding box is the smallest one around the corners") {
  RandomStream stream(2, 0, 0);
  for (int i = 0; i < 1000; ++i) {
    auto const box = box_of(truck(), Pose{1.0, 2.0, Uniform{-pi, pi}(stream)});
    auto const around = box.bounding_box(), expected = box_around(box.corners());
    REQUIRE(expected.grown(1e-9).contains(around));
    REQUIRE(around.grown(1e-9).contains(expected));
  }
}

TEST_CASE("a rectangle contains what its own frame says it contains") {
  RandomStream stream(3, 0, 0);
  int inside = 0;
  for (int i = 0; i < 1000; ++i) {
    Pose const pose{5.0, -3.0, Uniform{-pi, pi}(stream)};
    Point const local{Uniform{-6.0, 6.0}(stream), Uniform{-2.0, 2.0}(stream)};
    bool const expected = local.x() <= 3.6 && local.x() >= -0.9 && std::abs(local.y()) <= 0.9;
    REQUIRE(box_of(car(), pose).contains(to_map(pose, local)) == expected);
    inside += expected;
  }
  CHECK(inside > 50);
}

TEST_CASE("axis-parallel boxes count their borders") {
  Box const box{0.0, 0.0, 2.0, 1.0};
  CHECK(box.contains(Point{2.0, 1.0}));
  CHECK(!box.contains(Point{2.1, 1.0}));
  CHECK(box.intersects(Box{2.0, 1.0, 3.0, 3.0}));
  CHECK(!box.intersects(Box{2.1, 0.0, 3.0, 3.0}));
  CHECK(box.contains(Box{0.0, 0.5, 1.0, 1.0}));
  CHECK(!box.contains(Box{0.0, 0.5, 1.0, 1.5}));
  CHECK(Box{1.0, 2.0, 5.0, 8.0}.center() == Point{3.0, 5.0});
}
