#include "cambium/geometry/line.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <doctest/doctest.h>

#include "cambium/core/distributions.hpp"
#include "cambium/core/random.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/polygon.hpp"

using namespace cambium;
using namespace cambium::geometry;

namespace {

/// A road-like line: smooth headings that wander, samples 0.5 to 3 m apart.
std::vector<LineSample> random_samples(RandomStream& stream, int count) {
  std::vector<LineSample> samples{{Uniform{-50, 50}(stream), Uniform{-50, 50}(stream), Uniform{-pi, pi}(stream)}};
  double curvature = 0.0;
  for (int i = 1; i < count; ++i) {
    auto const& last = samples.back();
    double const step = Uniform{0.5, 3.0}(stream);
    curvature = std::clamp(curvature + Normal{0.0, 0.005}(stream), -0.03, 0.03);
    double const chord = last.heading + 0.5 * curvature * step;
    samples.push_back(
        {last.x + step * std::cos(chord), last.y + step * std::sin(chord), last.heading + curvature * step});
  }
  return samples;
}

double distance_to_line(Line const& line, Point const& p) {
  auto const points = line.points();
  double distance = 1e9;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    distance = std::min(distance, distance_to_segment(p, points[i], points[i + 1]));
  }
  return distance;
}

}  // namespace

TEST_CASE("the arc length is the sum of the chords, and the points come back") {
  std::vector<Point> const points{{0, 0}, {3, 4}, {3, 4}, {3, 10}, {5, 10}};
  Line const line = Line::from_points(points);
  CHECK(line.length() == doctest::Approx(13.0));
  CHECK(line.segments().size() == 3);
  auto const back = line.points();
  REQUIRE(back.size() == 4);
  CHECK((back[1] - Point{3, 4}).norm() < 1e-12);
  CHECK((back[3] - Point{5, 10}).norm() < 1e-12);
}

TEST_CASE("fewer than two distinct points, or one that is not finite, make no line") {
  CHECK_THROWS_AS(static_cast<void>(Line::from_points(std::vector<Point>{})), MapError);
  CHECK_THROWS_AS(static_cast<void>(Line::from_points(std::vector<Point>{{1, 1}, {1, 1}})), MapError);
  CHECK_THROWS_AS(static_cast<void>(Line::from_points(std::vector<Point>{{1, 1}, {std::nan(""), 1}})), MapError);
  CHECK_THROWS_AS(static_cast<void>(Line::from_samples(std::vector<LineSample>{{0, 0, 0}, {1, 0, std::nan("")}})),
                  MapError);
}

TEST_CASE("poses lie on the chords, and beyond the ends on their extension") {
  Line const line = Line::from_points(std::vector<Point>{{0, 0}, {10, 0}, {10, 5}});
  CHECK(line.pose(4.0) == Pose{4, 0, 0});
  CHECK(line.pose(12.0).x == doctest::Approx(10.0));
  CHECK(line.pose(12.0).y == doctest::Approx(2.0));
  CHECK(line.pose(12.0).heading == doctest::Approx(pi / 2));
  CHECK(line.pose(-3.0) == Pose{-3, 0, 0});
  CHECK(line.begin_pose() == Pose{0, 0, 0});
  CHECK(line.end_pose() == line.pose(15.0));
  CHECK(line.pose(20.0).y == doctest::Approx(10.0));
}

TEST_CASE("headings between samples are interpolated, along the line and across the wrap of angles") {
  Line const line = Line::from_samples(std::vector<LineSample>{{0, 0, 0.0}, {2, 0, 0.4}, {4, 0, 0.2}});
  CHECK(line.pose(1.0).heading == doctest::Approx(0.2));
  CHECK(line.pose(3.0).heading == doctest::Approx(0.3));
  CHECK(line.pose(-5.0).heading == 0.0);
  CHECK(line.pose(9.0).heading == doctest::Approx(0.2));
  CHECK(line.curvature(1.0) == doctest::Approx(0.2));
  CHECK(line.curvature(3.0) == doctest::Approx(-0.1));
  Line const wrapped = Line::from_samples(std::vector<LineSample>{{0, 0, 3.1}, {-1, 0, -3.1}});
  CHECK(wrapped.pose(0.5).heading == doctest::Approx(pi));
}

TEST_CASE("a pose found with a cursor is the one found by search, wherever the cursor was") {
  RandomStream stream(1, 0, 0);
  Line const line = Line::from_samples(random_samples(stream, 60));
  std::uint32_t cursor = 0;
  for (int i = 0; i < 2000; ++i) {
    double const s = Uniform{-5.0, line.length() + 5.0}(stream);
    if (i % 7 == 0) cursor = uniform_index(stream, 100);
    REQUIRE(line.pose(s, cursor) == line.pose(s));
    REQUIRE(cursor == line.find(s));
  }
}

TEST_CASE("a sample goes on from the last one where it is ahead, or a metre away") {
  Pose const last{5.0, 5.0, pi / 2};
  CHECK(goes_on(last, {5.0, 5.001, 0.0}));
  CHECK_FALSE(goes_on(last, {5.0, 5.0 + 1e-7, 0.0}));
  CHECK_FALSE(goes_on(last, {5.0, 4.5, 0.0}));
  CHECK_FALSE(goes_on(last, {5.9, 4.9, 0.0}));
  CHECK(goes_on(last, {5.0, 4.0, 0.0}));
}

TEST_CASE("the exact projection finds the nearest point of the line") {
  RandomStream stream(2, 0, 0);
  for (int world = 0; world < 50; ++world) {
    Line const line = Line::from_samples(random_samples(stream, 40));
    for (int i = 0; i < 100; ++i) {
      Point const p = line.pose(Uniform{0.0, line.length()}(stream)).position() +
                      Point{Uniform{-20, 20}(stream), Uniform{-20, 20}(stream)};
      auto const projection = line.project(p);
      if (projection.s < 0.0 || projection.s > line.length()) continue;  // on the extensions, see below
      REQUIRE(std::abs(projection.lateral) == doctest::Approx(distance_to_line(line, p)));
      REQUIRE((line.pose(projection.s).position() - p).norm() == doctest::Approx(std::abs(projection.lateral)));
    }
  }
}

TEST_CASE("points beyond the ends are projected on the extension of the last segments") {
  Line const line = Line::from_points(std::vector<Point>{{0, 0}, {10, 0}, {10, 5}});
  auto const before = line.project(Point{-2.0, 1.0});
  CHECK(before.s == doctest::Approx(-2.0));
  CHECK(before.lateral == doctest::Approx(1.0));
  auto const after = line.project(Point{11.0, 8.0});
  CHECK(after.s == doctest::Approx(18.0));
  CHECK(after.lateral == doctest::Approx(-1.0));
}

TEST_CASE("left of the line is positive, and the outside of a kink is as far as its vertex") {
  Line const line = Line::from_points(std::vector<Point>{{0, 0}, {10, 0}, {10, 10}});
  CHECK(line.project(Point{5.0, 1.0}).lateral == doctest::Approx(1.0));
  CHECK(line.project(Point{5.0, -1.0}).lateral == doctest::Approx(-1.0));
  auto const outside = line.project(Point{13.0, -4.0});
  CHECK(outside.s == doctest::Approx(10.0));
  CHECK(outside.lateral == doctest::Approx(-5.0));
}

TEST_CASE("near the line the warm projection equals the exact one, from any hint within some segments") {
  RandomStream stream(3, 0, 0);
  for (int world = 0; world < 50; ++world) {
    Line const line = Line::from_samples(random_samples(stream, 60));
    for (int i = 0; i < 200; ++i) {
      double const s = Uniform{-4.0, line.length() + 4.0}(stream);
      Pose const at = line.pose(s);
      Point const p = to_map(at, {0.0, Uniform{-8.0, 8.0}(stream)});
      auto const exact = line.project(p);
      int const last = static_cast<int>(line.segments().size()) - 1;
      int const offset = static_cast<int>(uniform_index(stream, 11)) - 5;
      int const hint = std::clamp(static_cast<int>(exact.segment) + offset, 0, last);
      auto const warm = line.project(p, static_cast<std::uint32_t>(hint));
      REQUIRE(warm.s == doctest::Approx(exact.s).epsilon(1e-12));
      REQUIRE(warm.lateral == doctest::Approx(exact.lateral).epsilon(1e-12));
    }
  }
}

TEST_CASE("a line made again from its samples is the same") {
  RandomStream stream(4, 0, 0);
  Line const line = Line::from_samples(random_samples(stream, 50));
  Line const again = Line::from_samples(line.samples());
  CHECK(again.length() == doctest::Approx(line.length()).epsilon(1e-12));
  for (double s = 0.0; s < line.length(); s += 1.7) {
    auto const a = line.pose(s), b = again.pose(s);
    REQUIRE((a.position() - b.position()).norm() < 1e-9);
    REQUIRE(std::abs(a.heading - b.heading) < 1e-9);
  }
}
