#include "cambium/map/lanes/road_lanes.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <string>

#include <doctest/doctest.h>

#include "cambium/map/corridor/build_corridor.hpp"
#include "../support/maps.hpp"
#include "road_text.hpp"

namespace cb = cambium;
using cb::geometry::Point;
using cb::geometry::Pose;
using cb::map::LaneHit;

TEST_CASE("of two roads that cross, a point has a place on both, the nearer centre first") {
  auto const map = support::corpus_map("Town04.xodr");
  if (!map) return;
  std::size_t several = 0, all = 0, exact_ones = 0;
  for (auto const& lane : map->lanes()) {
    auto const p = lane.path.pose(0.5 * lane.length()).position();
    auto const places = cb::map::road_places(*map, p);
    for (auto const& place : places) {
      auto const exact = lane_point(map->road(place.road), place.s, place.number);
      REQUIRE(exact.has_value());
      auto const again = point_at(map->road(place.road), place.s, place.t);
      double const off = std::hypot(again.x - p.x(), again.y - p.y());
      CHECK(off < 2e-3);  // at gaps of the reference line
      exact_ones += off < 1e-5;
      ++all;
      CHECK(std::abs(std::abs(place.t - exact->t) - place.distance) < 1e-9);
    }
    CHECK(std::is_sorted(places.begin(), places.end(),
                         [](auto const& a, auto const& b) { return a.distance < b.distance; }));
    several += places.size() > 1;
  }
  CHECK(several > 100);
  CHECK(all - exact_ones < all / 50);
}

TEST_CASE("something that is driven along its lanes is followed, and lost as little as it is found anew") {
  auto const map = support::corpus_map("Town04.xodr");
  if (!map) return;
  std::mt19937 random(3);
  int steps = 0, same = 0;
  for (int k = 0; k < 50; ++k) {
    auto const& start = map->lanes()[random() % map->lanes().size()];
    if (!start.drivable()) continue;
    auto const road = cb::map::build_road_corridor(*map, cb::map::straight_route(*map, start.id, 300.0));
    auto const& corridor = road->corridors[road->main];
    std::optional<LaneHit> hit;
    for (double s = 0.05; s < corridor.length(); s += 0.5, ++steps) {
      Pose const pose = corridor.center.pose(s);
      hit = hit ? map->nearest_lane(pose, *hit) : map->nearest_lane(pose);
      REQUIRE(hit.has_value());
      CHECK(hit->distance <= 0.05);
      auto const& lane = map->lane(hit->lane);
      CHECK((lane.path.pose(hit->s).position() - pose.position()).norm() ==
            doctest::Approx(std::abs(hit->lateral)).epsilon(1e-6));
      same += hit->lane == corridor.pieces[corridor.piece_at(s, {})].lane;
    }
  }
  CHECK(steps > 5000);
  CHECK(same > 0.9 * steps);
}

TEST_CASE("a station beside a lane's path position is right to the sampling's tolerance") {
  for (auto const* name : {"Town04.xodr", "positive18.xodr", "velodrome.xodr"}) {
    auto const map = support::corpus_map(name);
    if (!map) return;
    for (auto const& lane : map->lanes())
      for (double const u : {0.0, 0.13, 0.5, 0.77, 1.0}) {
        double const s = u * lane.length();
        auto const at = lane.path.pose(s);
        auto const exact = project(map->road(lane.road).reference_line, at.position(), lane.station_at(s));
        CHECK(std::abs(lane.station_at(s) - exact.s) < 0.1);
      }
  }
}

TEST_CASE("a lane is asked for by its id where its section reaches, its end included") {
  auto const map = support::own_map("lane_drop.xodr");
  for (auto const& lane : map->lanes()) {
    for (double const u : {0.0, 0.3, 1.0}) {
      double const s = lane.road_begin + u * (lane.road_end - lane.road_begin);
      auto const p = lane_point(*map, lane.id, s);
      REQUIRE(p.has_value());
      Point const center(p->center.x, p->center.y);
      if (!is_valid(lane.merges_into)) CHECK((lane.path.pose(lane.position_at(s)).position() - center).norm() < 0.02);
    }
    CHECK_FALSE(lane_point(*map, lane.id, lane.road_begin - 0.01));
    CHECK_FALSE(lane_point(*map, lane.id, lane.road_end + 0.01));
    CHECK_FALSE(lane_point(*map, lane.id, std::nan("")));
  }
}

TEST_CASE("a point on the outer side of a kink has its place at the kink") {
  auto text = road_text::file({{.sections = {{.lanes = {{-1}, {-2}}}}}});
  std::string const line = R"(length="100"><line/></geometry>)";
  text.replace(text.find(line), line.size(), R"(length="50"><line/></geometry>
    <geometry s="50" x="50" y="0" hdg="0.2" length="50"><line/></geometry>)");
  auto const map = road_text::load(text).map;
  Point const outside(50.0 + 2.0 * std::sin(0.1), -2.0 * std::cos(0.1));
  auto const places = cb::map::road_places(*map, outside);
  REQUIRE(places.size() == 1);
  CHECK(places[0].number == -1);
  CHECK(places[0].s == doctest::Approx(50.0));
  CHECK(places[0].t == doctest::Approx(-2.0));
  CHECK(cb::map::road_places(*map, Point(-0.5, -2.0)).empty());
  CHECK(cb::map::road_places(*map, Point(0.0, -2.0)).size() == 1);
}
