#include "cambium/map/building/detail/section_sampler.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <tuple>

#include <doctest/doctest.h>

#include "cambium/map/road/curve_layout.hpp"
#include "corpus_maps.hpp"
#include "../support/maps.hpp"
#include "../support/scale.hpp"

namespace {

namespace cb = cambium;
using cb::geometry::Point;
using cb::map::Lane;
using cb::map::Map;

/// The worst deviations of sampled lanes from exact ones.
struct Deviation {
  double path = 0.0, border = 0.0, heading = 0.0;
  int places = 0;
};

double distance(cb::geometry::Line const& line, Point const& p, double near) {
  auto const foot = line.project(p, line.find(near));
  return std::abs(foot.lateral);
}

/// Looks at a lane's path and borders in so many places between its vertices.
void add_deviation(Map const& map, Lane const& lane, Deviation& worst, int places = 3) {
  auto const& road = map.road(lane.road);
  for (std::uint32_t i = 0; i < lane.path.segments().size(); ++i)
    for (int k = 0; k < places; ++k) {
      double const u = places == 3 ? 0.2 + 0.3 * k : (k + 0.5) / places;
      auto const& g = lane.path.segments()[i];
      double const s = g.s + u * g.length, station = lane.station_at(s, i);
      auto const exact = lane_point(road, station, lane.number);
      REQUIRE(exact.has_value());
      if (exact->width < 0.0) continue;  // the sampled lane takes 0 there, and the ones outside of it follow
      Point const center(exact->center.x, exact->center.y);
      double const off = distance(lane.path, center, s);
      worst.path = std::max(worst.path, off);
      std::uint32_t cursor = i;
      double const heading = lane.path.pose(s, cursor).heading + (lane.along_road ? 0.0 : cb::geometry::pi);
      if (std::abs(lane.stations[i + 1] - lane.stations[i]) > 2e-3)  // a shorter one may stand for a kink or a jump
        worst.heading =
            std::max(worst.heading, std::abs(cb::geometry::angle_difference(heading, exact->center.heading)));
      for (double const t : {exact->inner_t, exact->outer_t}) {
        auto const p = offset_point(exact->reference, {t, 0.0, 0.0});
        if (lane.left.empty() || lane.right.empty()) continue;
        worst.border = std::max(worst.border, std::min(std::abs(lane.left.project(Point(p.x, p.y)).lateral),
                                                       std::abs(lane.right.project(Point(p.x, p.y)).lateral)));
      }
      ++worst.places;
    }
}

}  // namespace

TEST_CASE("sampled lanes keep within the tolerances between their vertices on every map of the corpus") {
  for_each_corpus_map([](auto const& file, Map const& map) {
    if (file.stem() == "SingleRoadNegativeWidth") return;  // widths below 0 count as 0
    Deviation worst;
    for (auto const& lane : map.lanes())
      if (!is_valid(lane.merges_into)) add_deviation(map, lane, worst);
    MESSAGE(file.stem().string() << ": " << worst.places << " places, path " << worst.path << " m, border "
                                 << worst.border << " m, heading " << worst.heading << " rad");
    CHECK(worst.path <= 0.01);
    CHECK(worst.border <= 0.01);
    CHECK(worst.heading <= 0.5 * cb::geometry::pi / 180);
    CHECK(worst.places > 0);
  });
}

TEST_CASE("a road that winds keeps its whole length, however often it comes round") {
  double const step = 14.95 / support::runs(65);
  for (double const radius : {3.0, 25.0, 60.0})
    for (double turns = 0.25; turns <= 15.01; turns += step) {
      double const length = 2.0 * cb::geometry::pi * radius * turns;
      auto const map = support::map_of({.id = "1",
                                        .line = cb::map::lay_from({}, {{length, 1.0 / radius, 1.0 / radius}}),
                                        .sections = {{.right = {{.width = 2.0}}}}});
      REQUIRE(map->lanes().size() == 1);
      CHECK(map->lanes()[0].length() == doctest::Approx(length * (radius + 1.0) / radius).epsilon(2e-3));
    }
}

TEST_CASE("a step in the file is a step in the sampled lanes, and at the same place") {
  auto const map = support::map_of(
      {.id = "1",
       .line = cb::map::lay_from({}, {{100.0}}),
       .sections = {{.right = {{.widths = {{0.0, 3.0, 0.0, 0.0, 0.0}, {50.0, 4.0, 0.0, 0.0, 0.0}}}, {}}}},
       .lane_offset = {{0.0, 0.0, 0.0, 0.0, 0.0}, {70.0, 0.05, 0.0, 0.0, 0.0}}});
  for (auto const& [s, width, y] : {std::tuple(40.0, 3.0, -1.5),
                                    {49.9, 3.0, -1.5},
                                    {50.1, 4.0, -2.0},
                                    {69.9, 4.0, -2.0},
                                    {70.1, 4.0, -1.95},
                                    {90.0, 4.0, -1.95}}) {
    auto const& at = map->lane(map->find_lane("1", s, -1));
    auto const widths = at.widths_at(at.position_at(s));
    CAPTURE(s);
    CHECK(std::abs(widths.left + widths.right - width) < 1e-9);
    CHECK(std::abs(at.path.pose(at.position_at(s)).y - y) < 1e-9);
  }
}

TEST_CASE("a gentle S is sampled within the tolerance wherever its inflection lies and however long it is") {
  for (double const length : {20.0, 40.0, 100.0, 300.0, 1000.0, 3000.0})
    for (double const inflection : {0.125, 0.25, 0.375, 0.5, 0.75})
      for (double const turn : {0.002, 0.0056, 0.02}) {
        // k s (s - middle) (s - 2 middle), with the slope `turn` at its begin.
        double const middle = inflection * length, k = turn / (2.0 * middle * middle), b = turn, c = -3.0 * k * middle;
        cb::map::RoadPlan wound, bent;
        wound.id = bent.id = "1";
        wound.line = cb::map::lay_from({}, {{length}});
        wound.sections = bent.sections = {{.right = cb::map::equal_lanes(1)}};
        wound.lane_offset = {{0.0, 0.0, b, c, k}};
        auto const curve = std::make_shared<cb::map::ParametricCubic const>(
            cb::map::ParametricCubic::Coefficients{0.0, 1.0, 0.0, 0.0},
            cb::map::ParametricCubic::Coefficients{0.0, b, c, k}, length);
        bent.line = {{.length = length, .kind = cb::map::GeometryKind::cubic, .cubic = curve}};
        CAPTURE(length);
        CAPTURE(inflection);
        CAPTURE(turn);
        for (auto const* road : {&wound, &bent}) {
          auto const map = support::map_of(*road);
          Deviation worst;
          add_deviation(*map, map->lanes()[0], worst, 40);
          CHECK(worst.path <= 0.01);
          CHECK(worst.border <= 0.01);
          CHECK(worst.heading <= 0.5 * cb::geometry::pi / 180);
        }
      }
}
