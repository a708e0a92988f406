#include "cambium/map/corridor/free_corridor.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "cambium/map/corridor/lane_place.hpp"

#include "../support/maps.hpp"

namespace cb = cambium;
using cb::geometry::Point;

namespace {

std::shared_ptr<cb::map::RoadCorridor const> build(cb::Map const& map, std::vector<Point> const& points,
                                                   cb::map::FreeCorridorOptions const& options = {}) {
  return cb::map::build_free_corridor(map, points, options);
}

}  // namespace

TEST_CASE("a way across a road knows the lanes that it crosses, and how far back their traffic comes") {
  auto const map = support::straight_road(2, 600.0);  // from y = 0 to y = -7
  auto const road = build(*map, {{320, 5}, {320, -10}}, {.width = 3.0, .view = 150.0});
  auto const& way = road->corridors.at(0);
  REQUIRE(way.crossings.size() == 2);
  double border = 5.0;
  for (auto const& crossing : way.crossings) {
    CHECK(crossing.begin == doctest::Approx(border).epsilon(0.03));
    CHECK(crossing.end == doctest::Approx(border + 3.5).epsilon(0.03));
    auto const& lane = map->lane(crossing.lane);
    CHECK(lane.drivable());
    CHECK(crossing.lane_begin == doctest::Approx(318.5));
    CHECK(crossing.lane_end == doctest::Approx(321.5));
    REQUIRE(crossing.ways.size() == 1);
    CHECK(crossing.ways[0].index_end == doctest::Approx(lane.index_begin + lane.length()));
    CHECK(crossing.ways[0].begin == doctest::Approx(crossing.lane_begin - 150.0));
    CHECK(crossing.ways[0].index_begin == doctest::Approx(lane.index_begin + crossing.ways[0].begin));
    border += 3.5;
  }
  CHECK(build(*map, {{0, 20}, {100, 30}})->corridors[0].crossings.empty());
  auto const oblique = build(*map, {{300, 5}, {330, -10}})->corridors[0].crossings;
  REQUIRE(oblique.size() == 2);
  CHECK(oblique[0].end - oblique[0].begin == doctest::Approx(3.5 * std::sqrt(5.0)).epsilon(0.02));
  // There and back: each lane twice.
  CHECK(build(*map, {{320, 5}, {320, -10}, {330, -10}, {330, 5}})->corridors[0].crossings.size() == 4);
}

TEST_CASE("rounded corners are bends") {
  auto const map = support::straight_road(1, 100.0);
  auto const road = build(*map, {{0, 50}, {20, 50}, {20, 80}}, {.width = 9.0});  // rounded by 5 m
  auto const& way = road->corridors[0];
  REQUIRE(way.bends.size() >= 1);
  CHECK(1.0 / way.sharpest_bend > 3.5);
  CHECK(1.0 / way.sharpest_bend < 6.0);
  CHECK(way.bends.front().begin == doctest::Approx(15.0).epsilon(0.2));
  CHECK(build(*map, {{0, 50}, {20, 50}})->corridors[0].sharpest_bend == 0.0);
}

TEST_CASE("corners are rounded, and the way stays near its points") {
  auto const map = support::straight_road(1, 100.0);
  for (double const turn : {0.1, 0.5, 1.5, 2.5, 3.0, -1.0, -2.9}) {
    CAPTURE(turn);
    std::vector<Point> const points{{0, 50}, {20, 50}, {20 + 15 * std::cos(turn), 50 + 15 * std::sin(turn)}};
    auto const road = build(*map, points);
    auto const& way = road->corridors[0].center;
    auto const sharp = cb::geometry::Line::from_points(points);
    CHECK((way.points().front() - points.front()).norm() < 1e-9);
    CHECK((way.points().back() - points.back()).norm() < 1e-9);
    for (auto const& p : way.points()) CHECK(std::abs(sharp.project(p).lateral) < 1.6);
    double all = 0.0;
    for (std::size_t i = 1; i < way.segments().size(); ++i) {
      double const step = way.segments()[i].heading - way.segments()[i - 1].heading;
      CHECK(std::abs(step) < 0.25);
      all += step;
    }
    CHECK(all == doctest::Approx(turn));
    CHECK(road->corridors[0].width_at(20.0) == doctest::Approx(2.0));
  }
}

TEST_CASE("points that form no way are refused") {
  auto const map = support::straight_road(1, 100.0);
  double const nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(build(*map, {}), cb::MapError);
  CHECK_THROWS_AS(build(*map, {{1, 1}, {1, 1}}), cb::MapError);
  CHECK_THROWS_AS(build(*map, {{1, 1}, {nan, 1}}), cb::MapError);
  CHECK_THROWS_AS(build(*map, {{0, 0}, {1e7, 0}}), cb::MapError);
  CHECK_THROWS_AS(build(*map, {{0, 0}, {10, 0}}, {.width = 0.0}), cb::MapError);
  CHECK_THROWS_AS(build(*map, {{0, 0}, {10, 0}}, {.width = nan}), cb::MapError);
  CHECK_THROWS_AS(build(*map, {{0, 0}, {10, 0}}, {.view = -1.0}), cb::MapError);
  CHECK_THROWS_AS(build(*map, {{0, 0}, {10, 0}}, {.type = cb::map::LaneType::driving}), cb::MapError);
  CHECK_NOTHROW(build(*map, {{0, 0}, {10, 0}, {0, 0}, {10, 0}}));  // back the same way
}
