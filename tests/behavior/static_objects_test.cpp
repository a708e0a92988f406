// Every behaviour that follows a leader also stops for static objects and pedestrians.

#include <doctest/doctest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "cambium/map/road/curve_layout.hpp"

#include "lane_traffic_fixtures.hpp"

using namespace lane_traffic;

namespace {

using Rss = cb::RssConformant<cb::ConstantAcceleration>;
using Sim = Traffic<ALL_DRIVERS, Rss, cb::MacroActions, cb::Pedestrian>;

void put_box(Sim& world, double x, double right, double left) {
  world.add_object(cb::geometry::Polygon({{x, right}, {x + 2.0, right}, {x + 2.0, left}, {x, left}}));
}

/// Calls `f(world, id, x, seed, random)` for a driver at several speeds up to 16 m/s, far before x.
template <class F>
void for_each_start(Sim::Behavior const& driver, std::uint32_t purpose, double least_speed, F const& f) {
  auto const road = support::straight_road(1, 600.0);  // y from 0 to -3.5
  for (std::uint32_t seed = 0; seed < 12; ++seed) {
    CAPTURE(seed);
    cb::RandomStream random(seed, purpose, 0);
    Sim world(road, {.seed = seed});
    double const x = between(120, 220, random), speed = between(least_speed, 16, random);
    f(world, add(world, 1, between(5, 20, random), speed, driver), x, seed, random);
  }
}

/// A road with a lane for cars and one for bicycles, and the latter's id.
std::pair<std::shared_ptr<cb::Map const>, cb::LaneId> road_with_biking_lane() {
  auto const road = support::map_of({.id = "1",
                                     .line = cb::map::lay_from({}, {{300.0}}),
                                     .sections = {{.right = {{}, {.type = cb::map::LaneType::biking, .width = 2.0}}}}});
  auto const biking = std::find_if(road->lanes().begin(), road->lanes().end(),
                                   [](auto const& lane) { return lane.type == cb::map::LaneType::biking; });
  return {road, biking->id};
}

}  // namespace

TEST_CASE_TEMPLATE("every driver stops before a static object in its lane, even if it is only partly in the lane",
                   Driver, ALL_DRIVERS, Rss, cb::MacroActions) {
  for_each_start(Driver{}, 1, 3, [](Sim& world, cb::AgentId id, double x, std::uint32_t seed, auto&) {
    auto const kind = seed % 3;  // across the whole lane, from the right, from the left
    put_box(world, x, kind == 2 ? -1.0 : -4.5, kind == 1 ? -2.5 : 1.0);
    drive_safely(world, 300);
    CHECK(world.state(id).speed < 0.2);
    CHECK(world.state(id).x + 3.6 > x - 15.0);
    CHECK(world.state(id).x + 3.6 < x);
  });
}

TEST_CASE_TEMPLATE("every driver stops for a slow pedestrian in its lane, and drives on afterwards", Driver,
                   ALL_DRIVERS, Rss, cb::MacroActions) {
  for_each_start(Driver{}, 2, 5, [](Sim& world, cb::AgentId id, double x, auto, cb::RandomStream& random) {
    std::vector<cb::geometry::Point> const points{{x, 2.0}, {x, -9.0}};
    world.add({.position = {x, between(-2.0, -0.2, random)},
               .shape = cb::geometry::pedestrian(),
               .behavior = cb::Pedestrian{.social = {.desired_speed = 0.1}},
               .road = cb::map::build_free_corridor(world.map(), points)});
    bool has_stood = false;
    for (int i = 0; i < 600; ++i) {
      drive_safely(world, 1);
      has_stood = has_stood || world.state(id).speed < 0.5;
    }
    if (std::is_same_v<Driver, Rss>) return;  // its nominal behaviour keeps whatever speed it has
    CHECK(has_stood);
    CHECK(world.state(id).x > x + 5.0);
  });
}

TEST_CASE("drivers that may change lanes pass a static object in their own") {
  auto const road = support::straight_road(2, 900.0);
  for (auto const& driver : {Sim::Behavior(cb::Mobil{}), Sim::Behavior(cb::LaneChangeRuleBased{})})
    for (std::uint32_t seed = 0; seed < 10; ++seed) {
      CAPTURE(seed);
      cb::RandomStream random(seed, 3, 0);
      Sim world(road, {.seed = seed});
      int const lane = 1 + static_cast<int>(seed % 2);
      double const x = between(200, 300, random), y = lane == 1 ? 0.0 : -3.5;
      auto const id = add(world, lane, 10.0, between(8, 14, random), driver);
      put_box(world, x, y - 3.0, y - 0.5);
      drive_safely(world, 300);
      CHECK((world.status(id) != cb::AgentStatus::driving || world.state(id).x > x + 10.0));
    }
}

TEST_CASE("neighbour queries find objects on bicycle lanes and free ways, too") {
  auto const [road, biking] = road_with_biking_lane();
  Sim world(road);
  auto const start = road->lane(biking).path.pose(10.0).position();
  auto const cyclist = world.add({.position = start,
                                  .speed = 4,
                                  .shape = cb::geometry::bicycle(),
                                  .behavior = cb::IdmClassic{.law = {.desired_speed = 5}},
                                  .route = cb::map::straight_route(*road, biking)});
  std::vector<cb::geometry::Point> const points{{0, 20}, {100, 20}};
  auto const way = cb::map::build_free_corridor(*road, points);
  auto const behind = world.add({.position = {10, 20}, .speed = 1, .behavior = cb::IdmClassic{}, .road = way});
  auto const ahead = world.add({.position = {30, 19.9}, .speed = 1, .behavior = cb::IdmClassic{}, .road = way});
  CHECK(world.observe(behind).ahead()->agent == ahead);
  CHECK(world.observe(ahead).behind()->agent == behind);
  CHECK_FALSE(world.observe(cyclist).ahead());
  auto const on_bike_lane = world.add_object(cb::geometry::Polygon({{80, -5.0}, {82, -5.0}, {82, -4.0}, {80, -4.0}}));
  auto const on_way = world.add_object(cb::geometry::Polygon({{60, 15}, {62, 15}, {62, 25}, {60, 25}}));
  REQUIRE(world.observe(cyclist).ahead());
  CHECK(world.observe(cyclist).ahead()->object == on_bike_lane);
  CHECK(world.observe(ahead).ahead()->object == on_way);
  CHECK(world.observe(ahead).ahead()->gap == doctest::Approx(30 - 3.6).epsilon(0.01));
  std::vector<cb::geometry::Point> const other{{0, 22}, {100, 22}};  // added after the object
  auto const late = world.add(
      {.position = {10, 22}, .behavior = cb::IdmClassic{}, .road = cb::map::build_free_corridor(*road, other)});
  REQUIRE(world.observe(late).ahead());
  CHECK(world.observe(late).ahead()->object == on_way);
  drive_safely(world, 300);
  CHECK(world.state(cyclist).speed < 0.1);
  CHECK(world.state(ahead).speed < 0.1);
}

TEST_CASE("a cyclist that extends over its lane's border is in the way of vehicles in the next lane") {
  auto const [road, biking] = road_with_biking_lane();
  Sim world(road);
  auto const cyclist = world.add({.position = {60, -4.5},
                                  .speed = 4,
                                  .shape = cb::geometry::bicycle(),
                                  .behavior = cb::IdmClassic{},
                                  .route = cb::map::straight_route(*road, biking)});
  auto const car = world.add({.position = {20, -1.75}, .speed = 4, .behavior = cb::IdmClassic{}});
  CHECK_FALSE(world.observe(car).ahead());
  world.set_state(cyclist, {.x = 60, .y = -3.7, .speed = 4});
  REQUIRE(world.observe(car).ahead());
  CHECK(world.observe(car).ahead()->agent == cyclist);
  CHECK(world.observe(car).ahead()->gap == doctest::Approx(40 - 3.6 - 0.35));
  CHECK(world.observe(car).ahead()->speed == doctest::Approx(4.0));
  CHECK_FALSE(world.observe(cyclist).behind());  // its own lane is empty
}

TEST_CASE("invalid ways are errors, and goals on free ways work") {
  auto const road = support::straight_road(1, 600.0);
  Sim world(road);
  std::vector<cb::geometry::Point> const points{{0, 20}, {100, 20}};
  auto const way = cb::map::build_free_corridor(*road, points);
  CHECK_THROWS_AS(world.add({.position = {50, 60}, .behavior = cb::IdmClassic{}, .road = way}), cb::WorldError);
  auto const lanes = cb::map::build_road_corridor(*road, cb::map::straight_route(*road, road->lanes()[0].id));
  CHECK_THROWS_AS(world.add({.position = {50, 20}, .behavior = cb::IdmClassic{}, .road = lanes}), cb::WorldError);
  auto const id = world.add({.position = {10, 20},
                             .speed = 5,
                             .behavior = cb::IdmClassic{},
                             .goal = cb::ReachPolygon{cb::geometry::Polygon({{40, 10}, {60, 10}, {60, 30}, {40, 30}})},
                             .road = way});
  CHECK_FALSE(world.reached_goal(id));
  for (int i = 0; i < 40 && !world.reached_goal(id); ++i) REQUIRE(world.step(0.2));
  CHECK(world.reached_goal(id));
  CHECK_FALSE(cb::is_valid(world.lane_of(id)));
  CHECK(world.situation(id).lane_position == doctest::Approx(world.state(id).x));
}
