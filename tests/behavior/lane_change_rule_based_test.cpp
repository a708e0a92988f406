#include "cambium/behavior/drivers.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "lane_traffic_fixtures.hpp"

using namespace lane_traffic;

namespace {

using Sim = Traffic<cb::LaneChangeRuleBased, cb::ConstantAcceleration, cb::BasicMobil<cb::FreeSpace>>;

cb::LaneChangeRuleBased roomy(double desired_speed) { return {.law = {.desired_speed = desired_speed}}; }

/// A user's own condition: never to the left.
struct NeverLeft {
  static constexpr auto parameters() { return cb::parameter_list(); }

  template <class View>
  [[nodiscard]] bool operator()(View const&, cb::LaneOption const& option) const {
    return !option.left;
  }
};

}  // namespace

TEST_CASE("a rule-based driver changes to the lane of three with the most space") {
  for (bool const left_is_free : {true, false}) {
    Sim world(support::straight_road(3, 2000.0));
    add(world, 2, 250.0, 10.0, cb::ConstantAcceleration{});
    add(world, left_is_free ? 3 : 1, 280.0, 10.0, cb::ConstantAcceleration{});
    auto const driver = add(world, 2, 200.0, 14.0, roomy(20.0));
    for (int k = 0; k < 60; ++k) REQUIRE(world.step(0.2));
    CHECK(index_of(world.record(driver).lane.corridor) == (left_is_free ? 0 : 2));
  }
}

TEST_CASE("a little more space is not worth a change") {
  for (double const more : {5.0, 20.0}) {
    Sim world(support::straight_road(2, 2000.0));
    add(world, 1, 240.0, 14.0, cb::ConstantAcceleration{});
    add(world, 2, 240.0 + more, 14.0, cb::ConstantAcceleration{});
    auto const driver = add(world, 1, 200.0, 14.0, roomy(14.0));
    REQUIRE(world.step(0.2));
    CHECK(world.memory<cb::LaneChangeRuleBased>(driver).lateral.change.active() == (more > 10.0));
  }
}

TEST_CASE("MOBIL changes only if its filters permit it, the library's and the user's") {
  auto const changes = [](auto driver, int lane) {
    using Driver = decltype(driver);
    Traffic<Driver, cb::ConstantAcceleration> world(support::straight_road(3, 2000.0));
    driver.law.desired_speed = 20.0;
    add(world, lane, 250.0, 8.0, cb::ConstantAcceleration{});
    auto const id = add(world, lane, 200.0, 14.0, driver);
    auto const free_lane = lane == 1 ? 2 : lane - 1;
    add(world, free_lane, 180.0, 14.0, cb::ConstantAcceleration{});
    if (lane == 2) add(world, 3, 205.0, 14.0, cb::ConstantAcceleration{});
    REQUIRE(world.step(0.2));
    return world.template memory<Driver>(id).lateral.change.active();
  };
  CHECK(changes(cb::Mobil{}, 1));
  CHECK(changes(cb::BasicMobil<cb::FreeSpace>{}, 1));
  cb::BasicMobil<cb::FreeSpace> wary;
  wary.lateral.rule.filters.first.rear = 20.0;
  CHECK(!changes(wary, 1));
  CHECK(changes(cb::Mobil{}, 2));
  CHECK(!changes(cb::BasicMobil<cb::FreeSpace, NeverLeft>{}, 2));
  CHECK(changes(cb::BasicMobil<cb::RemainingLength, NeverLeft>{}, 1));
  CHECK_NOTHROW(cb::check_parameters(wary));
  wary.lateral.rule.filters.first.rear = -1.0;
  CHECK_THROWS_AS(cb::check_parameters(wary), cb::ParameterError);
}

TEST_CASE("a lane is long enough if exactly the least length remains, and too short below that") {
  Sim world(support::own_map("lane_drop.xodr"));
  auto const id = add(world, 3, 100.0, 14.0, roomy(20.0));
  auto const view = world.observe(id);
  cb::LaneOption const option{view.place(), false, {}, {}};
  double const remaining = cb::lane_end(view, option.place.corridor, option.place.piece) - option.place.s;
  REQUIRE(std::isfinite(remaining));
  auto const permits = [&](double least) { return cb::RemainingLength{least}(view, option); };
  CHECK(permits(remaining));
  CHECK(!permits(std::nextafter(remaining, 1e9)));
}

TEST_CASE("MOBIL changes into a lane only if its speed limit is high enough") {
  using Limited = cb::BasicMobil<cb::SpeedLimitAtLeast>;
  auto const road = support::map_of({.id = "1",
                                     .line = cb::map::lay_from({}, {{1000.0}}),
                                     .sections = {{.right = cb::map::equal_lanes(2)}},
                                     .speed_limit = 20.0});
  for (double const least : {15.0, 25.0}) {
    Limited driver;
    driver.lateral.rule.filters.first.speed = least;
    Traffic<Limited, cb::ConstantAcceleration> world(road);
    add(world, 1, 250.0, 8.0, cb::ConstantAcceleration{});
    auto const id = add(world, 1, 200.0, 14.0, driver);
    REQUIRE(world.step(0.2));
    CHECK(world.memory<Limited>(id).lateral.change.active() == (least < 20.0));
  }
}
