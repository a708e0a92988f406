#include "cambium/behavior/open_loop/constant_acceleration.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "cambium/behavior/law/braking.hpp"

#include "../world/fixtures.hpp"

using namespace fixtures;

TEST_CASE("a constant acceleration moves as in the closed form") {
  for (double const a : {-2.0, 0.0, 1.5})
    for (double const dt : {0.1, 0.2, 2.0}) {
      auto const motion = cb::ConstantAcceleration{.acceleration = a}.motion(10.0, dt);
      CHECK(motion.distance == doctest::Approx(10 * dt + a * dt * dt / 2));
      CHECK(motion.speed == doctest::Approx(10 + a * dt));
    }
}

TEST_CASE("a braking vehicle stops after v^2 / 2a and stands from then on") {
  cb::ConstantAcceleration const braking{.acceleration = -4.0};
  auto const motion = braking.motion(10.0, 60.0);
  CHECK(motion.distance == doctest::Approx(12.5));
  CHECK(motion.speed == 0.0);
  CHECK(braking.motion(0.0, 5.0).distance == 0.0);
  CHECK(braking.motion(0.0, 5.0).speed == 0.0);
}

TEST_CASE("acceleration ends at the highest speed; a faster vehicle keeps its speed") {
  cb::ConstantAcceleration const model{.acceleration = 2.0, .highest_speed = 20.0};
  auto const motion = model.motion(16.0, 5.0);  // 2 s to 20 m/s
  CHECK(motion.speed == 20.0);
  CHECK(motion.distance == doctest::Approx(36.0 + 60.0));
  CHECK(model.motion(30.0, 5.0).speed == 30.0);
  CHECK(model.motion(30.0, 5.0).distance == doctest::Approx(150.0));
}

TEST_CASE("two halves of a step equal the whole step, also across kinks") {
  for (double const a : {-3.0, -0.4, 0.0, 0.9, 4.0})
    for (double const speed : {0.0, 0.5, 9.0, 19.5, 25.0}) {
      cb::ConstantAcceleration const model{.acceleration = a, .highest_speed = 20.0};
      auto const whole = model.motion(speed, 4.0), first = model.motion(speed, 2.0),
                 second = model.motion(first.speed, 2.0);
      CHECK(first.distance + second.distance == doctest::Approx(whole.distance));
      CHECK(second.speed == doctest::Approx(whole.speed));
      CHECK(whole.distance >= 0.0);
    }
}

TEST_CASE("the time to cover a distance is that after which a constant acceleration has covered it") {
  for (double const distance : {0.5, 10.0, 200.0})
    for (double const speed : {0.0, 7.0, 20.0})
      for (double const a : {0.8, 3.0}) {
        double const time = cb::time_to_cover(distance, speed, a, 20.0);
        cb::ConstantAcceleration const model{.acceleration = a, .highest_speed = 20.0};
        CHECK(model.motion(speed, time).distance == doctest::Approx(distance));
      }
  CHECK(cb::time_to_cover(0.0, 0.0, 1.0, 20.0) == 0.0);
  CHECK(cb::time_to_cover(50.0, 25.0, 1.0, 20.0) == doctest::Approx(2.0));
  CHECK(std::isinf(cb::time_to_cover(50.0, 0.0, 0.0, 20.0)));
}

TEST_CASE(
    "in a world a vehicle drives the computed distance along its lane, ignores others and reports its acceleration") {
  Sim world(straight_road(1, 400, 0.005));
  auto const id =
      world.add({.position = {5, -1.75}, .speed = 10, .behavior = cb::ConstantAcceleration{.acceleration = 1.0}});
  auto const other = world.add({.position = {30, -1.3}, .behavior = cb::ConstantAcceleration{}});
  double const start = world.record(id).lane.s, lateral = world.record(id).lane.lateral;
  for (int i = 0; i < 30; ++i) {
    REQUIRE(world.step(0.2));
    CHECK(world.record(id).action.acceleration == doctest::Approx(1.0));
  }
  CHECK(world.record(id).lane.s - start == doctest::Approx(60 + 18).epsilon(1e-6));
  CHECK(world.record(id).lane.lateral == doctest::Approx(lateral));
  CHECK(world.state(id).speed == doctest::Approx(16.0));
  CHECK(world.state(other).x == 30.0);
}

TEST_CASE("a deceleration that stops within the step is reported as the average over the step") {
  Sim world(straight_road(1, 400));
  auto const id =
      world.add({.position = {5, -1.75}, .speed = 1.0, .behavior = cb::ConstantAcceleration{.acceleration = -4.0}});
  REQUIRE(world.step(0.5));
  CHECK(world.state(id).speed == 0.0);
  CHECK(world.state(id).x == doctest::Approx(5.125));
  CHECK(world.record(id).action.acceleration == doctest::Approx(-2.0));
}

TEST_CASE("a vehicle ends the lane change that its heading shows, and keeps its offset if it is aligned") {
  for (double const heading : {0.05, -0.05, 0.0}) {
    CAPTURE(heading);
    Sim world(straight_road(3, 800.0));
    double const y = -5.25 + (heading > 0.0 ? 1.3 : heading < 0.0 ? -1.3 : 0.4);
    auto const id =
        world.add({.position = {50, y}, .heading = heading, .speed = 15, .behavior = cb::ConstantAcceleration{}});
    for (int i = 0; i < 40; ++i) REQUIRE(world.step(0.2));
    double const end = heading > 0.0 ? -1.75 : heading < 0.0 ? -8.75 : y;
    CHECK(world.state(id).y == doctest::Approx(end).epsilon(0.02));
    CHECK(world.state(id).heading == doctest::Approx(0.0).epsilon(1e-3).scale(1.0));
    CHECK(world.state(id).speed == 15.0);
  }
}
