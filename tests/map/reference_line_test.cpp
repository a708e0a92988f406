#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "cambium/map/opendrive/document.hpp"
#include "cambium/map/road/reference_line.hpp"

namespace {

using namespace cambium::map;

double angle_between(double a, double b) { return std::abs(std::remainder(a - b, 2.0 * std::numbers::pi)); }

Geometry spiral(double curvature_start, double curvature_end, double length) {
  return {0.0, 3.0, -2.0, 0.7, length, GeometryKind::spiral, curvature_start, curvature_end};
}

/// End of a spiral by Simpson's rule in long double: another rule, another precision, no shared code.
CurvePoint simpson_end(Geometry const& g, double to) {
  constexpr int steps = 20000;
  long double const h = static_cast<long double>(to) / steps;
  long double const rate = (static_cast<long double>(g.curvature_end) - g.curvature_start) / g.length;
  long double x = 0, y = 0;
  for (int i = 0; i <= steps; ++i) {
    long double const u = i * h;
    long double const angle = g.heading + u * (g.curvature_start + rate * u / 2);
    int const weight = i == 0 || i == steps ? 1 : i % 2 == 1 ? 4 : 2;
    x += weight * std::cos(angle);
    y += weight * std::sin(angle);
  }
  return {g.x + static_cast<double>(x * h / 3), g.y + static_cast<double>(y * h / 3), 0.0, 0.0, 0.0};
}

}  // namespace

TEST_CASE("spirals agree with an independent quadrature, however flat, tight or close to an arc they are") {
  std::vector<Geometry> const cases{spiral(0.0, 0.01, 100.0),       spiral(0.02, -0.02, 60.0),
                                    spiral(0.1, 0.1 + 1e-9, 100.0), spiral(0.005, 0.005, 500.0),
                                    spiral(1e-7, -1e-7, 1000.0),    spiral(0.0, 0.0, 1000.0),
                                    spiral(0.01, 0.0101, 1000.0),   spiral(-1e-12, 1e-12, 1000.0),
                                    spiral(0.5, -1.5, 20.0),        spiral(0.0, 1e-3, 1e-9)};
  for (Geometry const& g : cases)
    for (double const fraction : {0.0, 0.01, 0.3, 0.5, 0.99, 1.0, 1.01}) {
      double const ds = fraction * g.length;
      CurvePoint const p = evaluate(g, ds);
      CurvePoint const expected = simpson_end(g, ds);
      CAPTURE(g.curvature_start);
      CAPTURE(g.curvature_end);
      CAPTURE(ds);
      CHECK(std::hypot(p.x - expected.x, p.y - expected.y) < 1e-9);
      CHECK(p.heading == doctest::Approx(g.heading + 0.5 * ds * (g.curvature_start + p.curvature)).epsilon(1e-14));
    }
}

TEST_CASE("an arc is exact for every curvature, down to none") {
  for (double const k : {0.2, -0.2, 1e-3, 1e-5, 1e-6, -1e-7, 1e-9, 1e-300, 0.0}) {
    Geometry const arc{0.0, 5.0, 7.0, 0.3, 1000.0, GeometryKind::arc, k, k};
    CurvePoint const p = evaluate(arc, 1000.0);
    Geometry as_spiral = arc;
    as_spiral.kind = GeometryKind::spiral;
    CurvePoint const q = evaluate(as_spiral, 1000.0);
    CAPTURE(k);
    CHECK(std::hypot(p.x - q.x, p.y - q.y) < 1e-10);
    CHECK(p.heading == 0.3 + 1000.0 * k);
    CHECK(p.curvature == k);
  }
  CurvePoint const quarter = evaluate({0.0, 0.0, 0.0, 0.0, 100.0, GeometryKind::arc, 0.1, 0.1}, 5.0 * std::numbers::pi);
  CHECK(quarter.x == doctest::Approx(10.0).epsilon(1e-14));
  CHECK(quarter.y == doctest::Approx(10.0).epsilon(1e-14));
}

TEST_CASE("a geometry holds from its start up to the next, and the ends are extrapolated") {
  ReferenceLine const line({{10.0, 10.0, 0.0, 0.0, 5.0, GeometryKind::arc, 0.1, 0.1},
                            {0.0, 0.0, 0.0, 0.0, 10.0, GeometryKind::line, 0.0, 0.0}});
  CHECK(line.length() == 15.0);
  CHECK(line.at(9.999).curvature == 0.0);
  CHECK(line.at(10.0).curvature == 0.1);
  CHECK(line.at(-4.0).x == -4.0);
  CHECK(line.at(20.0).heading == doctest::Approx(1.0));
  CHECK(line.locate(-1.0) == 0);
  CHECK(line.locate(99.0) == 1);
}

TEST_CASE("the curvature is the heading's derivative, and the tangent the position's") {
  Geometry const g = spiral(0.03, -0.01, 80.0);
  double const h = 1e-4;
  for (double const ds : {0.0, 20.0, 60.0, 80.0}) {
    CurvePoint const before = evaluate(g, ds - h), at = evaluate(g, ds), behind = evaluate(g, ds + h);
    CHECK((behind.heading - before.heading) / (2 * h) == doctest::Approx(at.curvature).epsilon(1e-8));
    CHECK((behind.curvature - before.curvature) / (2 * h) == doctest::Approx(at.curvature_derivative).epsilon(1e-8));
    CHECK(angle_between(std::atan2(behind.y - before.y, behind.x - before.x), at.heading) < 1e-8);
  }
}

TEST_CASE("advancing along a geometry, forwards or back, gives the same points as asking for each") {
  for (Geometry const& g :
       {spiral(0.0, 0.01, 100.0), Geometry{0.0, 90.0, 50.0, 1.2, 50.0, GeometryKind::arc, 0.01, 0.01},
        Geometry{150.0, 70.0, 90.0, 1.7, 70.0, GeometryKind::spiral, 0.01, -0.02}})
    for (double const step : {0.1, 7.3, -61.0}) {
      double s = step > 0.0 ? g.s : g.s + 300.0;
      CurvePoint p = evaluate(g, s - g.s);
      for (int i = 0; i < 300 && s > g.s - 10.0 && s < g.s + 310.0; ++i, s += step) {
        p = advance(g, p, i == 0 ? s : s - step, s);
        CurvePoint const q = evaluate(g, s - g.s);
        CAPTURE(s);
        CHECK(std::hypot(p.x - q.x, p.y - q.y) < 1e-11);
        CHECK(p.heading == q.heading);
        CHECK(p.curvature == q.curvature);
      }
    }
}

TEST_CASE("the header's offset translates first and then rotates about the map's origin") {
  opendrive::RoadElement road;
  road.geometries = {{0.0, 1.0, 0.0, 0.0, 10.0, GeometryKind::line, 0.0, 0.0}};
  ReferenceLine const line = make_reference_line(road, {2.0, 1.0, 0.0, std::numbers::pi / 2.0});
  CHECK(line.at(0.0).x == doctest::Approx(-1.0));
  CHECK(line.at(0.0).y == doctest::Approx(3.0));
  CHECK(line.at(10.0).x == doctest::Approx(-1.0));
  CHECK(line.at(10.0).y == doctest::Approx(13.0));
  CHECK(line.at(10.0).heading == doctest::Approx(std::numbers::pi / 2.0));
}

namespace {

/// Arc length of a cubic up to a parameter, by many small chords.
double chords(ParametricCubic const& c, double to, int count) {
  auto const value = [](ParametricCubic::Coefficients const& k, double p) {
    return k[0] + p * (k[1] + p * (k[2] + p * k[3]));
  };
  long double sum = 0.0;
  for (int i = 0; i < count; ++i) {
    double const p = to * i / count, q = to * (i + 1) / count;
    sum += std::hypot(value(c.u(), q) - value(c.u(), p), value(c.v(), q) - value(c.v(), p));
  }
  return static_cast<double>(sum);
}

}  // namespace

TEST_CASE("a parametric cubic is asked by arc length, wherever its parameter runs") {
  std::vector<ParametricCubic> const curves{{{0, 1, 0, 0}, {0, 0, 0.01, -1e-4}, 50.0},
                                            {{0, 60, -10, 5}, {0, 0, 30, -10}, 1.0},
                                            {{1, 3, 20, 30}, {-2, 1, 5, -40}, 1.0},  // far from arc length
                                            ParametricCubic::along_u({0, 0.2, 0.01, -2e-4}, 40.0)};
  for (auto const& c : curves) {
    REQUIRE(c.is_regular());
    CHECK(c.length() == doctest::Approx(chords(c, c.end(), 200000)).epsilon(1e-9));
    double const h = 1e-4 * c.length();
    for (double const fraction : {0.01, 0.2, 0.5, 0.77, 0.99}) {
      double const s = fraction * c.length();
      auto const before = c.at(s - h), at = c.at(s), behind = c.at(s + h);
      CHECK(std::hypot(behind.x - before.x, behind.y - before.y) == doctest::Approx(2 * h).epsilon(1e-5));
      CHECK((behind.heading - before.heading) / (2 * h) == doctest::Approx(at.curvature).epsilon(1e-4));
      CHECK((behind.curvature - before.curvature) / (2 * h) == doctest::Approx(at.curvature_derivative).epsilon(1e-3));
      CHECK(std::abs(
                std::remainder(std::atan2(behind.y - before.y, behind.x - before.x) - c.start_direction() - at.heading,
                               2 * std::numbers::pi)) < 1e-5);
    }
    auto const end = c.at(c.length()), beyond = c.at(c.length() + 2.0);
    CHECK(std::hypot(beyond.x - end.x, beyond.y - end.y) == doctest::Approx(2.0));
    CHECK(beyond.heading == end.heading);
    CHECK(beyond.curvature == 0.0);
  }
  CHECK(curves.back().length() == doctest::Approx(40.0).epsilon(1e-12));
}

TEST_CASE("cubics without a length, with a cusp or with numbers beyond all range are known") {
  CHECK_FALSE(ParametricCubic({0, 0, 0, 0}, {0, 0, 0, 0}, 1.0).is_regular());
  CHECK_FALSE(ParametricCubic({0, 0, 1, 0}, {0, 0, 0, 1}, 1.0).is_regular());
  CHECK_FALSE(ParametricCubic({0, 1, 0, 0}, {0, 0, 0, 1e300}, 10.0).is_regular());
}
