#include "cambium/map/road/station_offset.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include "corpus_maps.hpp"
#include "../support/maps.hpp"

namespace {

namespace cb = cambium;
using cb::geometry::Point;
using cb::map::Geometry;
using cb::map::GeometryKind;
using cb::map::ReferenceLine;

/// The nearest of many points of the line.
double distance_by_search(ReferenceLine const& line, Point const& p, double step) {
  double best = std::numeric_limits<double>::infinity();
  auto const count = static_cast<int>(line.length() / step) + 1;
  for (int i = 0; i <= count; ++i) {
    auto const at = line.at(line.length() * i / count);
    best = std::min(best, std::hypot(p.x() - at.x, p.y() - at.y));
  }
  return best;
}

ReferenceLine winding() {
  std::vector<Geometry> geometries;
  Geometry g{0.0, 10.0, -5.0, 0.3, 40.0, GeometryKind::line};
  double const curvatures[] = {0.0, 0.0, 0.05, 0.05, -0.02, -0.1, -0.1, 0.0};
  for (int i = 0; i < 7; ++i) {
    g.curvature_start = curvatures[i];
    g.curvature_end = curvatures[i + 1];
    g.kind = g.curvature_start != g.curvature_end ? GeometryKind::spiral
             : g.curvature_start != 0.0           ? GeometryKind::arc
                                                  : GeometryKind::line;
    geometries.push_back(g);
    auto const end = evaluate(g, g.length);
    g = {g.s + g.length, end.x, end.y, end.heading, i % 2 == 0 ? 25.0 : 1e-9, GeometryKind::line};
  }
  return ReferenceLine(geometries);
}

}  // namespace

TEST_CASE("a point that was laid beside a reference line comes back with its station and offset") {
  auto const line = winding();
  for (double s = 0.0; s <= line.length(); s += 0.37)
    for (double const t : {-6.0, -0.5, 0.0, 1e-6, 7.5}) {
      auto const r = line.at(s);
      Point const p(r.x - t * std::sin(r.heading), r.y + t * std::cos(r.heading));
      CAPTURE(s);
      CAPTURE(t);
      for (double const hint : {s, s + 0.5, s - 0.5}) {
        auto const foot = project(line, p, hint);
        CHECK(std::abs(foot.s - s) < 1e-8);
        CHECK(std::abs(foot.t - t) < 1e-8);
      }
      auto const nearest = project(line, p);
      CHECK(nearest.distance <= std::abs(t) + 1e-9);
    }
}

TEST_CASE("the nearest point of a reference line is found on every map of the corpus") {
  std::mt19937 random(7);
  for_each_corpus_map([&random](auto const&, cb::Map const& map) {
    for (int i = 0; i < 20; ++i) {
      auto const& road = map.roads()[random() % map.roads().size()];
      auto const& line = road.reference_line;
      auto const between = [&](double low, double high) {
        return low + (high - low) * static_cast<double>(random() % 1001) / 1000.0;
      };
      auto const at = line.at(between(0.0, line.length()));
      Point const p(at.x + between(-25.0, 25.0), at.y + between(-25.0, 25.0));
      double const step = std::max(0.02, line.length() / 20000);
      double const expected = distance_by_search(line, p, step);
      auto const found = project(line, p);
      CAPTURE(road.name);
      CHECK(found.distance <= expected + 1e-9);
      CHECK(found.distance >= expected - step);
      auto const foot = line.at(found.s);
      CHECK(std::abs(std::hypot(p.x() - foot.x, p.y() - foot.y) - found.distance) < 0.02);  // at gaps of the line
    }
  });
}

TEST_CASE("the foot point of a point beyond the end is the end, and that beside a kink the kink") {
  ReferenceLine const bend({{0.0, 0.0, 0.0, 0.0, 10.0}, {10.0, 10.0, 0.0, 0.5 * cb::geometry::pi, 10.0}});
  auto const before = project(bend, Point(-3.0, 4.0), 2.0);
  CHECK(before.s == 0.0);
  CHECK(before.distance == doctest::Approx(5.0));
  auto const behind = project(bend, Point(11.0, 12.0), 2.0);
  CHECK(behind.s == 20.0);
  CHECK(behind.t == doctest::Approx(-1.0));
  for (double const hint : {0.0, 5.0, 10.0, 15.0, 20.0, 1e9, -1e9}) {
    auto const kink = project(bend, Point(13.0, -4.0), hint);
    CHECK(kink.s == 10.0);
    CHECK(kink.distance == doctest::Approx(5.0));
  }
}

TEST_CASE("a line of three thousand geometries is crossed from end to end") {
  std::vector<Geometry> pieces;
  for (int i = 0; i < 3000; ++i) pieces.push_back({i * 0.5, i * 0.5, 0.0, 0.0, 0.5});
  CHECK(project(ReferenceLine(pieces), Point(1400.25, 3.0), 0.0).s == doctest::Approx(1400.25));
}
