#include "cambium/behavior/law/lane_reach.hpp"

#include <doctest/doctest.h>

#include "lane_traffic_fixtures.hpp"

using namespace lane_traffic;

TEST_CASE("a vehicle that is still to merge is in the path even behind an object that is passed") {
  MergingRoad const merge;
  Traffic<cb::IdmClassic> world(merge.site.map);
  auto const own = merge.add(world, merge.through, 80.0, {.speed = 5}),
             other = merge.add(world, merge.ramp, 30.0, {.speed = 3});
  auto const expected = world.observe(own).ahead();
  REQUIRE(expected);
  REQUIRE(expected->agent == other);
  auto const way = merge.corridor(merge.through).center;
  auto const place = [&](double ahead, double lateral) {
    return cb::geometry::to_map(way.pose(merge.through.merge_at - 80.0 + ahead), {0.0, lateral});
  };
  world.add_object(cb::geometry::Polygon({place(15, 0.5), place(18, 0.5), place(18, 1.5), place(15, 1.5)}));
  auto const view = world.observe(own);
  REQUIRE(view.ahead());
  REQUIRE_FALSE(cb::is_valid(view.ahead()->agent));
  auto const next = cb::detail::next_in_way(view, -0.8, 0.1);
  REQUIRE(next);
  CHECK(next->agent == other);
  CHECK(next->gap == doctest::Approx(expected->gap).epsilon(0.01));
  CHECK(next->speed == doctest::Approx(expected->speed).epsilon(0.01));
  CHECK_FALSE(cb::is_valid(cb::detail::next_in_way(view, 0.8, 0.1)->agent));  // there the object is in the path
}
