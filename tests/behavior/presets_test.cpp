#include "cambium/behavior/presets.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "../support/maps.hpp"
#include "cambium/cambium.hpp"

namespace cb = cambium;

TEST_CASE("presets of pedestrians and cyclists are valid; a cyclist brakes no harder than its bicycle can") {
  using namespace cb::presets;
  CHECK_NOTHROW(cb::check_parameters(cyclist()));
  CHECK_NOTHROW(cb::check_parameters(bicycle_dynamics()));
  CHECK_NOTHROW(cb::check_parameters(pedestrian_dynamics()));
  CHECK(cyclist().lowest_acceleration >= bicycle_dynamics().lowest_acceleration);
  CHECK(cyclist().maximum_acceleration <= bicycle_dynamics().highest_acceleration);
  // The bicycle has some reserve beyond what the cyclist uses, but no motor.
  CHECK(bicycle_dynamics().highest_acceleration <= 2.0 * cyclist().maximum_acceleration);
  CHECK(pedestrian_dynamics().highest_speed > 1.3 * 1.34);
  auto const bicycle = cb::geometry::bicycle();
  CHECK(bicycle_dynamics().wheel_base < bicycle.length());
  CHECK(bicycle.front - bicycle_dynamics().wheel_base == doctest::Approx(bicycle.rear));  // wheels of equal size
}

TEST_CASE("presets of drivers are valid and drive as their names say") {
  using namespace cb::presets;
  for (auto const& preset : all) CHECK_NOTHROW(cb::check_parameters(preset.parameters));
  double const gap = 40.0, speed = 25.0, leader = 24.0;
  double const hasty = cb::idm_acceleration(aggressive(), speed, gap, leader),
               usual = cb::idm_acceleration(kesting_2010_car(), speed, gap, leader),
               careful = cb::idm_acceleration(timid(), speed, gap, leader);
  CHECK(hasty > usual);
  CHECK(usual > careful);
  // Treiber, Hennecke, Helbing 2000: static capacity of about 1700 to 2000 vehicles per hour for vehicles 5 m long.
  double capacity = 0.0;
  for (double v = 1.0; v < 33.0; v += 0.1)
    capacity = std::max(capacity, 3600 * v / (5.0 + cb::idm_equilibrium_gap(treiber_2000(), v)));
  CHECK(capacity > 1600.0);
  CHECK(capacity < 2000.0);
}

#define DRIVERS                                                                                                     \
  cb::IdmClassic, cb::AdaptiveCruiseControl, cb::IdmLaneTracking, cb::Mobil, cb::LaneChangeRuleBased, cb::ZipMerge, \
      cb::Intersection, cb::HumanDriver<cb::Mobil>

TEST_CASE_TEMPLATE("a temperament makes a whole driver, whatever the model", Driver, DRIVERS) {
  namespace presets = cb::presets;
  Driver const timid = presets::timid<Driver>(), normal = presets::normal<Driver>(),
               hasty = presets::aggressive<Driver>();
  for (auto const& driver : {timid, normal, hasty}) CHECK_NOTHROW(cb::check_parameters(driver));
  auto const rules = [](auto const& d) -> cb::RoadRules const& {
    if constexpr (requires { d.nominal; })
      return d.nominal.rules;
    else
      return d.rules;
  };
  CHECK(rules(timid).lateral_acceleration < rules(normal).lateral_acceleration);
  CHECK(rules(hasty).lateral_acceleration > rules(normal).lateral_acceleration);
  CHECK(rules(hasty).late_at_red > 0.0);
  // On a motorway with a slow leader, the hastier one keeps less time headway.
  auto const headway = [](Driver const& driver) {
    cb::World<cb::BehaviorSet<DRIVERS, cb::ConstantAcceleration>, cb::InterpolateExecution, cb::SingleTrack> world(
        support::straight_road(1, 5000.0));
    world.add({.position = {100, -1.75}, .speed = 20.0, .behavior = cb::ConstantAcceleration{}});
    auto const id = world.add({.position = {20, -1.75}, .speed = 20.0, .behavior = driver});
    for (int k = 0; k < 600; ++k) REQUIRE(world.step(0.2));
    return world.observe(id).ahead()->gap / 20.0;
  };
  double const longest = headway(timid), middle = headway(normal), shortest = headway(hasty);
  CHECK(longest > middle + 0.2);
  CHECK(middle > shortest + 0.2);
}

TEST_CASE("an aggressive driver changes lanes for less, and drives faster than the limit") {
  namespace presets = cb::presets;
  CHECK(presets::aggressive<cb::Mobil>().politeness < presets::timid<cb::Mobil>().politeness);
  CHECK(presets::aggressive<cb::Mobil>().changing.safe_deceleration >
        presets::timid<cb::Mobil>().changing.safe_deceleration);
  auto const speed = [](cb::IdmClassic driver) {
    driver.rules.obey_speed_limits = true;
    auto const map = support::own_map("intersection_4way.xodr");
    cb::World<cb::BehaviorSet<cb::IdmClassic>, cb::InterpolateExecution, cb::SingleTrack> world(map);
    auto const lane = map->find_lane("1", 50.0, -2);
    auto const pose = map->lane(lane).path.pose(1.0);
    auto const id =
        world.add({.position = pose.position(), .heading = pose.heading, .speed = 13.9, .behavior = driver});
    for (int k = 0; k < 12; ++k) REQUIRE(world.step(0.2));
    return world.state(id).speed / map->lane(lane).speed_limit_at(0.0);
  };
  CHECK(speed(presets::timid<cb::IdmClassic>()) < 0.99);
  CHECK(speed(presets::aggressive<cb::IdmClassic>()) > 1.01);
  CHECK(speed(presets::normal<cb::IdmClassic>()) == doctest::Approx(1.0).epsilon(0.01));
}
