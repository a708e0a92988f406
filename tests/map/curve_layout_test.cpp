#include "cambium/map/road/curve_layout.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <doctest/doctest.h>

#include "lanes_by_hand.hpp"

using namespace by_hand;
using geometry::pi;

namespace {

/// The largest gap [m] and turn [rad] between consecutive geometries.
std::pair<double, double> joints(std::vector<Geometry> const& line) {
  double gap = 0.0, turn = 0.0;
  for (std::size_t i = 1; i < line.size(); ++i) {
    auto const end = evaluate(line[i - 1], line[i - 1].length);
    gap = std::max(gap, std::hypot(end.x - line[i].x, end.y - line[i].y));
    turn = std::max(turn, std::abs(geometry::angle_difference(end.heading, line[i].heading)));
    CHECK(line[i].s == doctest::Approx(line[i - 1].s + line[i - 1].length).epsilon(1e-14));
  }
  return {gap, turn};
}

void check_ends(std::vector<Geometry> const& line, Pose const& from, Pose const& to) {
  auto const end = end_of(line);
  CHECK(std::hypot(line.front().x - from.x, line.front().y - from.y) < 1e-9);
  CHECK(std::abs(geometry::angle_difference(line.front().heading, from.heading)) < 1e-9);
  CHECK(std::hypot(end.x - to.x, end.y - to.y) < 2e-9);
  CHECK(std::abs(geometry::angle_difference(end.heading, to.heading)) < 1e-9);
}

double largest_curvature(std::vector<Geometry> const& line) {
  double largest = 0.0;
  for (auto const& g : line)
    for (int i = 0; i <= 100; ++i) largest = std::max(largest, std::abs(evaluate(g, g.length * i / 100).curvature));
  return largest;
}

double length_of(std::vector<Geometry> const& line) { return line.back().s + line.back().length; }

}  // namespace

TEST_CASE("pieces meet, whether they are laid out from their start or their end") {
  Numbers random{1};
  for (int i = 0; i < 50; ++i) {
    std::vector<CurvePiece> pieces;
    for (int k = 0; k < 10; ++k)
      pieces.push_back({random(1, 100), k % 3 == 0 ? 0.0 : random(-0.05, 0.05), random(-0.05, 0.05)});
    Pose const at{random(-1e3, 1e3), random(-1e3, 1e3), random(-3, 3)};
    auto const ahead = lay_from(at, pieces);
    auto const back = lay_to(end_of(ahead), pieces);
    for (auto const* line : {&ahead, &back}) {
      auto const [gap, turn] = joints(*line);
      CHECK(gap < 1e-9);
      CHECK(turn < 1e-12);
    }
    CHECK(std::hypot(back.front().x - at.x, back.front().y - at.y) < 1e-7);
  }
}

TEST_CASE("a connecting curve starts and ends as it is told to, without a kink") {
  Numbers random{2};
  int corners = 0, cubics = 0;
  for (int i = 0; i < 300; ++i) {
    Pose const from{random(-100, 100), random(-100, 100), random(-3, 3)};
    auto const p = geometry::to_map(from, {random(5, 40), random(-40, 40)});
    Pose const to{p.x(), p.y(), from.heading + random(-2.5, 2.5)};
    auto const line = connecting_curve(from, to);
    check_ends(line, from, to);
    auto const [gap, turn] = joints(line);
    CHECK(gap < 1e-9);
    CHECK(turn < 1e-12);
    CHECK(std::isfinite(largest_curvature(line)));
    CHECK(length_of(line) < 4.0 * std::hypot(p.x() - from.x, p.y() - from.y));
    (line.front().kind == GeometryKind::cubic ? cubics : corners) += 1;
  }
  CHECK(corners > 30);
  CHECK(cubics > 30);
}

TEST_CASE("a right-angled corner is a spiral, an arc and a spiral, with a line before where that way is longer") {
  auto const corner = connecting_curve({0, 0, 0}, {20, 20, 0.5 * pi});
  REQUIRE(corner.size() == 3);
  CHECK(corner[0].kind == GeometryKind::spiral);
  CHECK(corner[1].kind == GeometryKind::arc);
  CHECK(corner[2].curvature_end == 0.0);
  CHECK(1.0 / largest_curvature(corner) > 0.7 * 20.0);
  auto const longer = connecting_curve({0, 0, 0}, {30, -20, -0.5 * pi});
  REQUIRE(longer.size() == 4);
  CHECK(longer[0].kind == GeometryKind::line);
  CHECK(longer[0].length == doctest::Approx(10.0));
  CHECK(connecting_curve({0, 0, 0}, {30, 0, 0}).front().kind == GeometryKind::line);
}

TEST_CASE("the curve that turns back is nearly a half circle") {
  auto const line = connecting_curve({0, 0, 0}, {0, 40, geometry::pi});
  CHECK(length_of(line) == doctest::Approx(20.0 * geometry::pi).epsilon(0.03));
  CHECK(largest_curvature(line) < 1.4 / 20);
}

TEST_CASE("a curve through points of a circle is that circle, nearly") {
  std::vector<Point> points;
  for (int i = 0; i <= 40; ++i) points.emplace_back(20 * std::cos(0.05 * i), 20 * std::sin(0.05 * i));
  auto const line = curve_through(points);
  auto const [gap, turn] = joints(line);
  CHECK(gap < 1e-9);
  CHECK(turn < 1e-9);
  double off = 0.0;
  for (auto const& g : line)
    for (int i = 0; i <= 20; ++i) {
      auto const p = evaluate(g, g.length * i / 20);
      off = std::max(off, std::abs(std::hypot(p.x, p.y) - 20.0));
    }
  CHECK(off < 1e-4);
  CHECK(largest_curvature(line) < 1.01 / 20);
  CHECK(length_of(line) == doctest::Approx(40.0).epsilon(1e-6));
}

TEST_CASE("a curve through points passes through each of them, and takes the headings that it is given") {
  Numbers random{3};
  std::vector<Point> points;
  std::vector<double> headings;
  for (int i = 0; i < 30; ++i) {
    points.emplace_back(10.0 * i + random(-2, 2), random(-5, 5));
    headings.push_back(random(-0.5, 0.5));
  }
  auto const line = curve_through(points, headings);
  REQUIRE(line.size() + 1 == points.size());
  for (std::size_t i = 0; i < line.size(); ++i) {
    CHECK((Point(line[i].x, line[i].y) - points[i]).norm() < 1e-9);
    CHECK(line[i].heading == doctest::Approx(headings[i]));
  }
  check_ends(line, {points[0].x(), points[0].y(), headings[0]}, {points[29].x(), points[29].y(), headings[29]});
}

TEST_CASE("parameters that form no curve are refused") {
  double const nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  for (double const bad : {nan, infinity, -1.0, 0.0, 1e7}) CHECK_THROWS_AS(lay_from({}, {{bad}}), MapError);
  for (double const bad : {nan, infinity, 1e3}) CHECK_THROWS_AS(lay_to({}, {{10.0, bad, 0.0}}), MapError);
  for (double const bad : {nan, infinity, 1e9}) CHECK_THROWS_AS(lay_from({bad, 0, 0}, {{1.0}}), MapError);
  CHECK_THROWS_AS(connecting_curve({0, 0, nan}, {1, 1, 0}), MapError);
  CHECK_THROWS_AS(connecting_curve({0, 0, 0}, {0, 0, 1}), MapError);
  for (auto const& points :
       {std::vector<Point>{}, {{0, 0}}, {{0, 0}, {0, 0}}, {{0, 0}, {nan, 0}}, {{0, 0}, {5, 0}, {5, 1e-5}}})
    CHECK_THROWS_AS(curve_through(points), MapError);
  std::vector<Point> const two{{0, 0}, {5, 0}};
  CHECK_THROWS_AS(curve_through(two, std::vector<double>{0.0}), MapError);
  CHECK_THROWS_AS(curve_through(two, std::vector<double>{0.0, nan}), MapError);
}
