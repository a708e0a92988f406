#include "cambium/behavior/law/lane_reach.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "cambium/cambium.hpp"
#include "support/maps.hpp"

using namespace cambium;

TEST_CASE("a vehicle that is still to merge is in the path even behind an object that is passed") {
  using Sim = World<BehaviorSet<IdmClassic>, InterpolateExecution, SingleTrack>;
  auto const map = support::own_map("merging.xodr");
  int merging = 0;
  for (auto const& lane : map->lanes()) {
    if (!lane.drivable() || !lane.predecessors.empty()) continue;
    auto const route = map::straight_route(*map, lane.id);
    auto const road = map::build_road_corridor(*map, route);
    auto const& corridor = road->corridors[road->main];
    for (auto const& feeder : corridor.feeders) {
      if (!feeder.is_still_to_merge() || feeder.begin < 0.0) continue;
      double const s = feeder.begin - 30.0;
      if (s < 5.0) continue;
      auto const place = [&](double at, double lateral) {
        auto const pose = corridor.center.pose(at);
        return geometry::Point(pose.x - lateral * std::sin(pose.heading), pose.y + lateral * std::cos(pose.heading));
      };
      Sim world(map);
      auto const own = world.add(
          {.position = place(s, 0.0), .heading = corridor.center.pose(s).heading, .speed = 5, .route = route});
      auto const pose = map->lane(feeder.lane).path.pose(0.5 * map->lane(feeder.lane).length());
      auto const other = world.add({.position = pose.position(), .heading = pose.heading, .speed = 3});
      auto const expected = world.observe(own).ahead();
      if (!expected || expected->agent != other) continue;
      world.add_object(
          geometry::Polygon({place(s + 15, 0.5), place(s + 18, 0.5), place(s + 18, 1.5), place(s + 15, 1.5)}));
      auto const view = world.observe(own);
      REQUIRE(view.ahead());
      REQUIRE_FALSE(is_valid(view.ahead()->agent));
      auto const next = detail::next_in_way(view, -0.8, 0.1);
      REQUIRE(next);
      CHECK(next->agent == other);
      CHECK(next->gap == doctest::Approx(expected->gap).epsilon(0.01));
      CHECK(next->speed == doctest::Approx(expected->speed).epsilon(0.01));
      CHECK_FALSE(is_valid(detail::next_in_way(view, 0.8, 0.1)->agent));  // there the object is in the path
      ++merging;
    }
  }
  CHECK(merging > 0);
}
