#include "cambium/geometry/collision.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

// Without Boost's rescaling to integers: plain doubles, and less to compile.
#define BOOST_GEOMETRY_NO_ROBUSTNESS
#include <boost/geometry/algorithms/area.hpp>
#include <boost/geometry/algorithms/covered_by.hpp>
#include <boost/geometry/algorithms/intersects.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>
#include <boost/geometry/geometries/segment.hpp>
#include <boost/geometry/strategies/strategies.hpp>
#include <doctest/doctest.h>

#include "cambium/core/distributions.hpp"
#include "cambium/core/random.hpp"
#include "cambium/geometry/angle.hpp"

using namespace cambium;
using namespace cambium::geometry;

namespace {

namespace bg = boost::geometry;
using BoostPoint = bg::model::d2::point_xy<double>;
using BoostPolygon = bg::model::polygon<BoostPoint, false>;

template <class Points>
BoostPolygon to_boost(Points const& points) {
  BoostPolygon polygon;
  for (auto const& p : points) bg::append(polygon.outer(), BoostPoint(p.x(), p.y()));
  bg::append(polygon.outer(), BoostPoint(points[0].x(), points[0].y()));
  return polygon;
}
BoostPolygon to_boost(Polygon const& polygon) { return to_boost(polygon.points()); }
BoostPolygon to_boost(OrientedBox const& box) { return to_boost(box.corners()); }

/// Do the borders cross? Edge by edge: Boost's algorithms on whole borders take long to compile.
bool borders_cross(BoostPolygon const& a, BoostPolygon const& b) {
  using Segment = bg::model::segment<BoostPoint>;
  for (std::size_t i = 0; i + 1 < a.outer().size(); ++i) {
    for (std::size_t j = 0; j + 1 < b.outer().size(); ++j) {
      if (bg::intersects(Segment(a.outer()[i], a.outer()[i + 1]), Segment(b.outer()[j], b.outer()[j + 1]))) return true;
    }
  }
  return false;
}

std::vector<Point> border_points(Polygon const& polygon, double spacing) {
  std::vector<Point> points;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    auto const [a, b] = polygon.edge(i);
    int const count = static_cast<int>((b - a).norm() / spacing) + 1;
    for (int k = 0; k < count; ++k) points.push_back(a + (b - a) * (double(k) / count));
  }
  return points;
}

Pose random_pose(RandomStream& stream, double range) {
  return {Uniform{-range, range}(stream), Uniform{-range, range}(stream), Uniform{-pi, pi}(stream)};
}

OrientedBox random_box(RandomStream& stream, double range) {
  Uniform const side{0.1, 4.0};
  return box_of({side(stream), side(stream), side(stream), side(stream)}, random_pose(stream, range));
}

/// A star: simple, seldom convex.
Polygon random_polygon(RandomStream& stream, double range) {
  Pose const center = random_pose(stream, range);
  auto const corners = 3 + uniform_index(stream, 9);
  std::vector<Point> points;
  for (std::uint32_t i = 0; i < corners; ++i) {
    double const angle = 2.0 * pi * (i + Uniform{0.0, 0.9}(stream)) / corners;
    points.push_back(to_map(center, Uniform{0.5, 6.0}(stream)*Point{std::cos(angle), std::sin(angle)}));
  }
  return Polygon(points);
}

}  // namespace

TEST_CASE("two rectangles, a rectangle and a polygon, and two polygons intersect exactly when Boost.Geometry says so") {
  RandomStream stream(1, 0, 0);
  auto const share_of_hits = [&stream](int pairs, auto const& make_a, auto const& make_b, double range) {
    int hits = 0;
    for (int i = 0; i < pairs; ++i) {
      auto const a = make_a(stream, range);
      auto const b = make_b(stream, range);
      bool const expected = bg::intersects(to_boost(a), to_boost(b));
      REQUIRE(intersects(a, b) == expected);
      REQUIRE(intersects(b, a) == expected);
      hits += expected;
    }
    return static_cast<double>(hits) / pairs;
  };
  for (double const share :
       {share_of_hits(20000, random_box, random_box, 5.0), share_of_hits(10000, random_box, random_polygon, 7.0),
        share_of_hits(10000, random_polygon, random_polygon, 7.0)}) {
    CHECK(share > 0.2);
    CHECK(share < 0.8);
  }
}

TEST_CASE("a polygon contains a rectangle exactly when Boost.Geometry says so") {
  RandomStream stream(4, 0, 0);
  int inside = 0;
  for (int i = 0; i < 20000; ++i) {
    auto const polygon = random_polygon(stream, 0.5);
    Uniform const side{0.1, 1.0};
    auto const box = box_of({side(stream), side(stream), side(stream), side(stream)}, random_pose(stream, 2.0));
    auto const twin = to_boost(polygon), box_twin = to_boost(box);
    bool const expected = bg::covered_by(box_twin.outer()[0], twin) && !borders_cross(box_twin, twin);
    REQUIRE(contains(polygon, box) == expected);
    inside += expected;
  }
  CHECK(inside > 2000);
}

TEST_CASE("area and points of a polygon are those of Boost.Geometry") {
  RandomStream stream(5, 0, 0);
  for (int i = 0; i < 5000; ++i) {
    auto const polygon = random_polygon(stream, 3.0);
    auto const twin = to_boost(polygon);
    REQUIRE(polygon.area() == doctest::Approx(bg::area(twin)));
    REQUIRE(polygon.is_simple());
    Pose const p = random_pose(stream, 6.0);
    REQUIRE(polygon.contains(p.position()) == bg::covered_by(BoostPoint(p.x, p.y), twin));
  }
}

TEST_CASE("distances and nearest points are those of the nearest of many points of the border") {
  RandomStream stream(6, 0, 0);
  constexpr double spacing = 0.01;
  // The nearest border point is at most half the spacing from a sample.
  auto const near = [](double distance, double sampled) {
    return distance <= sampled + 1e-9 && sampled - distance <= spacing;
  };
  for (int i = 0; i < 300; ++i) {
    auto const a = random_box(stream, 10.0), b = random_box(stream, 10.0);
    auto const polygon = random_polygon(stream, 10.0);
    Point const p = random_pose(stream, 10.0).position();
    double to_box = 1e9, to_polygon = 1e9, between = 1e9;
    for (auto const& q : border_points(polygon_of(b), spacing)) {
      to_box = std::min(to_box, (q - p).norm());
      between = std::min(between, distance(a, q));
    }
    for (auto const& q : border_points(polygon, spacing)) to_polygon = std::min(to_polygon, (q - p).norm());
    REQUIRE(near(distance(b, p), b.contains(p) ? 0.0 : to_box));
    REQUIRE(near(distance(polygon, p), polygon.contains(p) ? 0.0 : to_polygon));
    REQUIRE(near(polygon.distance_to_border(p), to_polygon));
    REQUIRE(near(distance(a, b), intersects(a, b) ? 0.0 : between));
    REQUIRE(distance(a, b) == doctest::Approx(distance(b, a)));
    // A nearest point is on the shape, and as far as the distance says.
    Point const in_box = nearest_point(b, p), on_border = nearest_border_point(polygon, p);
    REQUIRE((in_box - p).norm() == doctest::Approx(distance(b, p)).epsilon(1e-9));
    REQUIRE(distance(b, in_box) < 1e-12);
    REQUIRE((on_border - p).norm() == doctest::Approx(polygon.distance_to_border(p)).epsilon(1e-9));
    REQUIRE(polygon.distance_to_border(on_border) < 1e-12);
    REQUIRE(nearest_point(polygon, p) == (polygon.contains(p) ? p : on_border));
  }
}

TEST_CASE("touching counts as intersecting") {
  OrientedBox const box{0.0, 0.0, 2.0, 1.0, 1.0, 0.0};
  CHECK(intersects(box, OrientedBox{4.0, 0.0, 2.0, 1.0, 1.0, 0.0}));
  CHECK(!intersects(box, OrientedBox{4.0 + 1e-12, 0.0, 2.0, 1.0, 1.0, 0.0}));
  CHECK(intersects(box, OrientedBox{4.0, 2.0, 2.0, 1.0, -1.0, 0.0}));
  CHECK(intersects(box, OrientedBox{3.0, 0.0, 2.0, 1.0, 0.0, 1.0}));
  CHECK(intersects(box, polygon_of(OrientedBox{4.0, 2.0, 2.0, 1.0, 1.0, 0.0})));
  CHECK(intersects(polygon_of(box), polygon_of(OrientedBox{4.0, 2.0, 2.0, 1.0, 1.0, 0.0})));
  CHECK(contains(polygon_of(box), box));
}

TEST_CASE("one region inside another intersects it, though their borders are apart") {
  OrientedBox const small{0.0, 0.0, 0.5, 0.5, 1.0, 0.0}, large{0.0, 0.0, 5.0, 5.0, 0.6, 0.8};
  CHECK(intersects(small, large));
  CHECK(intersects(small, polygon_of(large)));
  CHECK(intersects(large, polygon_of(small)));
  CHECK(intersects(polygon_of(small), polygon_of(large)));
  CHECK(intersects(polygon_of(large), polygon_of(small)));
  CHECK(contains(polygon_of(large), small));
  CHECK(!contains(polygon_of(small), large));
}

TEST_CASE("a rectangle over the notch of a polygon is not contained, with all its corners inside") {
  std::vector<Point> const notched{{0, 0}, {10, 0}, {10, 4}, {5.1, 4}, {5, 1}, {4.9, 4}, {0, 4}};
  OrientedBox const box{5.0, 2.0, 4.0, 1.5, 1.0, 0.0};
  Polygon const polygon(notched);
  for (auto const& corner : box.corners()) CHECK(polygon.contains(corner));
  CHECK(!contains(polygon, box));
}

TEST_CASE("the rectangles of two cars on one lane collide when the gap is gone") {
  Pose const follower{0.0, 0.0, 0.3};
  auto const at = [&](double ahead) {
    Point const p = to_map(follower, {ahead, 0.0});
    return box_of(car(), Pose{p.x(), p.y(), follower.heading});
  };
  CHECK(!intersects(box_of(car(), follower), at(4.5 + 1e-9)));
  CHECK(intersects(box_of(car(), follower), at(4.5 - 1e-9)));
}
