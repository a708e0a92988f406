#include "cambium/geometry/polygon.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <doctest/doctest.h>

#include "cambium/core/distributions.hpp"
#include "cambium/core/random.hpp"
#include "cambium/geometry/angle.hpp"

using namespace cambium;
using namespace cambium::geometry;

namespace {

using Points = std::vector<Point>;

/// An L of area 3: the unit squares at (0, 0), (1, 0) and (0, 1).
Points const ell{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};

}  // namespace

TEST_CASE("a polygon has the same area and corners whichever way round it was given") {
  Points clockwise(ell.rbegin(), ell.rend());
  CHECK(Polygon(ell).area() == doctest::Approx(3.0));
  CHECK(Polygon(clockwise).area() == doctest::Approx(3.0));
  Polygon const polygon(clockwise);
  for (std::size_t i = 0; i < polygon.size(); ++i) CHECK((polygon.points()[i] - ell[i]).norm() == 0.0);
  CHECK(Polygon(clockwise).bounding_box() == Box{0, 0, 2, 2});
}

TEST_CASE("a polygon can be written out corner by corner") {
  CHECK(Polygon({{0, 0}, {4, 0}, {4, 2}}).area() == doctest::Approx(4.0));
  CHECK_THROWS_AS(Polygon({{0, 0}, {4, 0}}), Error);
}

TEST_CASE("repeated corners and the closing one are dropped") {
  Points points{{0, 0}, {0, 0}, {1, 0}, {1, 1}, {1, 1}, {0, 0}};
  CHECK(Polygon(points).size() == 3);
}

TEST_CASE("points that form no polygon are refused with its name") {
  CHECK_THROWS_WITH_AS(Polygon(Points{{0, 0}, {1, 0}, {0, 0}}, "goal of agent 3"),
                       "goal of agent 3: has 2 distinct points; give at least three corners", Error);
  CHECK_THROWS_AS(Polygon(Points{}), Error);
  CHECK_THROWS_AS(Polygon(Points{{0, 0}, {1, 0}, {2, 0}}), Error);
  CHECK_THROWS_AS(Polygon(Points{{0, 0}, {1, 0}, {0, std::nan("")}}), Error);
  CHECK_THROWS_AS(Polygon(Points{{0, 0}, {1, 0}, {0, std::numeric_limits<double>::infinity()}}), Error);
}

TEST_CASE("inside, border and corners are contained, the notch is not") {
  Polygon const polygon(ell);
  for (auto const& p :
       Points{{0.5, 0.5}, {1.5, 0.5}, {0.5, 1.5}, {1, 0}, {0, 1}, {2, 0.5}, {1, 1}, {1, 1.5}, {0, 0}, {2, 1}}) {
    CHECK(polygon.contains(p));
  }
  for (auto const& p : Points{{1.5, 1.5}, {-0.1, 1}, {2.1, 0}, {1.001, 1.001}, {3, 1}, {-1, 1}, {-1, 2}, {-1, 0}}) {
    CHECK(!polygon.contains(p));
  }
}

TEST_CASE("convexity is seen") {
  CHECK(!Polygon(ell).is_convex());
  CHECK(!Polygon().is_convex());
  CHECK(Polygon(Points{{0, 0}, {1, 0}, {2, 0}, {2, 1}}).is_convex());
  CHECK(polygon_of(box_of(car(), Pose{3, 4, 1.1})).is_convex());
}

TEST_CASE("crossings and spikes make a polygon not simple") {
  CHECK(Polygon(ell).is_simple());
  CHECK(Polygon(Points{{0, 0}, {1, 0}, {0, 1}}).is_simple());
  CHECK(!Polygon(Points{{0, 0}, {2, 2}, {2, 0}, {0, 1}}).is_simple());
  CHECK(!Polygon(Points{{0, 0}, {2, 0}, {3, 0}, {2, 0}, {2, 2}}).is_simple());
  CHECK(!Polygon(Points{{0, 0}, {2, 0}, {2, 2}, {1, 0}, {0, 2}}).is_simple());
}

TEST_CASE("the polygon of a rectangle has its area and its corners") {
  auto const box = box_of(truck(), Pose{100.0, -50.0, 2.0});
  CHECK(polygon_of(box).area() == doctest::Approx(10.0 * 2.55));
  CHECK(polygon_of(box).contains(box.center()));
}

TEST_CASE("a transformed polygon keeps area and shape, and holds the transformed points") {
  RandomStream stream(1, 0, 0);
  Polygon const polygon(ell);
  for (int i = 0; i < 200; ++i) {
    Pose const frame{Uniform{-100, 100}(stream), Uniform{-100, 100}(stream), Uniform{-pi, pi}(stream)};
    Point const p{Uniform{-1, 3}(stream), Uniform{-1, 3}(stream)};
    Polygon const moved = polygon.transformed(frame);
    REQUIRE(moved.contains(to_map(frame, p)) == polygon.contains(p));
    REQUIRE(Polygon(moved.points()).area() == doctest::Approx(3.0));
    REQUIRE(moved.bounding_box().contains(Polygon(moved.points()).bounding_box()));
  }
}

TEST_CASE("the distance to the border is the distance to the nearest edge") {
  Polygon const polygon(ell);
  CHECK(polygon.distance_to_border(Point{0.5, 0.25}) == doctest::Approx(0.25));
  CHECK(polygon.distance_to_border(Point{3.0, 0.5}) == doctest::Approx(1.0));
  CHECK(polygon.distance_to_border(Point{-3.0, -4.0}) == doctest::Approx(5.0));
  CHECK(polygon.distance_to_border(Point{0.0, 1.0}) == 0.0);
}
