#include "cambium/behavior/presets.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "lane_traffic_fixtures.hpp"

using namespace lane_traffic;

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

TEST_CASE("a cyclist close behind one that brakes stops, if its brakes suffice") {
  auto const road = support::straight_road(1, 400.0);
  auto const bicycle = cb::geometry::bicycle();
  double least = 1e9;
  for (double const dt : {0.05, 0.1, 0.2, 0.3, 0.5})
    for (std::uint32_t seed = 0; seed < 60; ++seed) {
      CAPTURE(dt);
      CAPTURE(seed);
      cb::RandomStream random(seed, 7, 0);
      double const speed = between(3.0, 8.0, random), others = std::min(8.0, speed + between(-1.0, 1.0, random));
      double const gap = between(0.5, 3.0, random), braking = between(1.0, 3.0, random);
      auto const dynamics = cb::presets::bicycle_dynamics();
      double const harder = -dynamics.lowest_acceleration - braking, closing = std::max(0.0, speed - others);
      if (closing * closing > 2.0 * harder * (gap - 0.1)) continue;
      Traffic<cb::IdmClassic, cb::ConstantAcceleration> world(road);
      auto const ahead = world.add({.position = {100, -1.75},
                                    .speed = others,
                                    .shape = bicycle,
                                    .behavior = cb::ConstantAcceleration{.acceleration = -braking},
                                    .dynamics = dynamics});
      auto const id =
          world.add({.position = {100 - bicycle.length() - gap, -1.75},
                     .speed = speed,
                     .shape = bicycle,
                     .behavior = cb::IdmClassic{.law = cb::presets::cyclist(), .jerk = seed % 2 ? 2.5 : 1e6},
                     .dynamics = dynamics});
      while (world.time() < 10.0) {
        drive_safely(world, 1, dt);
        least = std::min(least, world.state(ahead).x - world.state(id).x - bicycle.length());
      }
      CHECK(world.state(id).speed < 0.3);
    }
  CHECK(least < 0.6);  // some came close
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
  if constexpr (requires { hasty.nominal; })
    CHECK(cb::equal_parameters(hasty.nominal.law, presets::Temperament{.idm = presets::aggressive()}.idm));
  else
    CHECK(hasty.law.time_headway == presets::aggressive().time_headway);
  // On a motorway with a slow leader, the hastier one keeps less time headway.
  auto const headway = [](Driver const& driver) {
    Traffic<DRIVERS, cb::ConstantAcceleration> world(support::straight_road(1, 5000.0));
    world.add({.position = {100, -1.75}, .speed = 20.0, .behavior = cb::ConstantAcceleration{}});
    auto const id = world.add({.position = {20, -1.75}, .speed = 20.0, .behavior = driver});
    for (int k = 0; k < 600; ++k) REQUIRE(world.step(0.2));
    return world.observe(id).ahead()->gap / 20.0;
  };
  double const longest = headway(timid), middle = headway(normal), shortest = headway(hasty);
  CHECK(longest > middle + 0.2);
  CHECK(middle > shortest + 0.2);
}

TEST_CASE("temperaments have the numbers that their description derives from the literature") {
  auto const numbers = [](cb::Mobil const& d, cb::Intersection const& at) -> std::vector<double> {
    return {d.lateral.rule.politeness,
            d.lateral.rule.threshold,
            d.lateral.safe_deceleration,
            d.lateral.abort_deceleration,
            d.heed<cb::Bends>().lateral_acceleration,
            at.heed<cb::Signals>().safe_deceleration,
            d.lateral.keep.merging_headway,
            at.heed<cb::Signals>().late_at_red,
            at.heed<cb::SpeedLimit>().factor,
            at.heed<cb::Conflicts>().time_margin,
            at.heed<cb::Conflicts>().minor_road_margin,
            at.heed<cb::Signals>().reaction,
            at.heed<cb::Signals>().rolling_speed};
  };
  using namespace cb::presets;
  CHECK(numbers(timid<cb::Mobil>(), timid<cb::Intersection>()) ==
        std::vector{0.5, 0.3, 2.0, 2.5, 2.0, 4.0, 2.0, 0.0, 0.95, 2.0, 4.0, 0.8, 0.0});
  CHECK(numbers(normal<cb::Mobil>(), normal<cb::Intersection>()) ==
        std::vector{0.2, 0.2, 4.0, 4.5, 3.0, 3.6, 1.0, 0.0, 1.0, 0.5, 3.0, 0.8, 0.0});
  CHECK(numbers(aggressive<cb::Mobil>(), aggressive<cb::Intersection>()) ==
        std::vector{0.0, 0.1, 5.0, 5.5, 4.0, 2.0, 0.5, 1.0, 1.1, 0.3, 2.0, 0.8, 3.0});
  CHECK(timid<cb::Intersection>().law.time_headway == timid().time_headway);
  CHECK(timid<cb::IdmClassic>().law.exponent == timid().exponent);
}

TEST_CASE("an aggressive driver drives faster than the limit, a timid one slower") {
  namespace presets = cb::presets;
  using Lawful = cb::IdmClassic::Also<cb::SpeedLimit>;
  auto const speed = [](Lawful const& driver) {
    auto const map = support::own_map("intersection_4way.xodr");
    Traffic<Lawful> world(map);
    auto const& lane = map->lane(map->find_lane("1", 50.0, -2));
    auto const id = enter(world, lane, 1.0, {.speed = 13.9, .behavior = driver});
    for (int k = 0; k < 12; ++k) REQUIRE(world.step(0.2));
    return world.state(id).speed / lane.speed_limit_at(0.0);
  };
  CHECK(speed(presets::timid<Lawful>()) < 0.99);
  CHECK(speed(presets::aggressive<Lawful>()) > 1.01);
  CHECK(speed(presets::normal<Lawful>()) == doctest::Approx(1.0).epsilon(0.01));
}

TEST_CASE("the same stream gives the same people, and those who are fast are so at any limit") {
  auto const cars = cb::presets::town_cars();
  constexpr int count = 4000;
  cb::RandomStream random(1, 0, 0), again(1, 0, 0), draws(1, 0, 0);
  int faster = 0, pairs = 0;
  double headway = 0.0;
  cb::presets::Temperament last;
  for (int i = 0; i < count; ++i) {
    auto const one = cars.draw(random), same = cars.draw(again);
    CHECK(one.idm.time_headway == same.idm.time_headway);
    CHECK(one.signal_braking == same.signal_braking);
    pairs += one.idm.desired_speed > last.idm.desired_speed && one.speed_factor != last.speed_factor;
    faster += one.idm.desired_speed > last.idm.desired_speed && one.speed_factor > last.speed_factor;
    headway += one.idm.time_headway / count;
    last = one;
  }
  CHECK(faster >= pairs - 1);  // the first one is compared with nobody
  CHECK(pairs > count / 3);
  CHECK(headway == doctest::Approx(1.32).epsilon(0.03));
  for (int i = 0; i < 14 * count; ++i) (void)cb::uniform01(draws);
  CHECK(draws() == random());
}

TEST_CASE("a population that no driver can be drawn from says what is wrong when it is drawn from") {
  using cb::TruncatedNormal, cb::Uniform;
  struct Wrong {
    cb::Distribution drawn;
    char const* sentence;
  };
  for (auto const& [drawn, sentence] :
       {Wrong{TruncatedNormal{std::numeric_limits<double>::quiet_NaN(), 1.0, 0.0, 2.0}, "mean: is nan"},
        Wrong{TruncatedNormal{1.0, 1.0, 2.0, 1.0}, "its low is above its high"},
        Wrong{TruncatedNormal{1.0, -1.0, 0.0, 2.0}, "deviation: is -1"}, Wrong{Uniform{2.0, 1.0}, "below low"},
        Wrong{Uniform{-3.0, 1.0}, "draws down to -3 s; keep it in [0, 20] s"},
        Wrong{TruncatedNormal{1.0, 1.0}, "draws down to -inf s"}}) {
    auto people = cb::presets::town_cars();
    people.time_headway = drawn;
    cb::RandomStream random(1, 0, 0);
    CHECK_THROWS_WITH_AS((void)people.draw(random), doctest::Contains("population.time_headway"), cb::ParameterError);
    CHECK_THROWS_WITH_AS((void)people.draw(random), doctest::Contains(sentence), cb::ParameterError);
  }
}
