#include "cambium/behavior/open_loop/external_input.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "cambium/core/portable_math.hpp"

#include "../world/fixtures.hpp"

using namespace fixtures;
using cb::ExternalInput;

namespace {

/// A wide road with room for steering.
std::shared_ptr<cb::Map const> field() { return straight_road(60, 400); }

cb::AgentId add(Sim& world, double speed, ExternalInput const& behavior = {}) {
  return world.add({.position = {150, -100}, .heading = 0.0, .speed = speed, .behavior = behavior});
}

}  // namespace

TEST_CASE("an input holds until the next one is set, and steers a circle") {
  Sim world(field());
  auto const id = add(world, 8.0);
  world.memory<ExternalInput>(id) = {0.0, 0.3};
  for (int i = 0; i < 20; ++i) REQUIRE(world.step(0.2));
  double const radius = 2.7 / std::tan(0.3), angle = 32.0 / radius;
  CHECK(world.state(id).x == doctest::Approx(150 + radius * std::sin(angle)).epsilon(1e-6));
  CHECK(world.state(id).y == doctest::Approx(-100 + radius * (1 - std::cos(angle))).epsilon(1e-6));
  CHECK(world.state(id).speed == 8.0);
  CHECK(world.record(id).action == cb::Action{0.0, 0.3});
  world.memory<ExternalInput>(id) = {};
  auto const heading = world.state(id).heading;
  REQUIRE(world.step(0.2));
  CHECK(world.state(id).heading == heading);
}

TEST_CASE("inputs beyond the vehicle's limits are reduced, and the action reports the reduced ones") {
  Sim world(field());
  auto const id = add(world, 10.0);
  cb::SingleTrack const model;
  auto const within_grip = [&] {
    double const v = world.state(id).speed;
    return cb::portable::atan(model.lateral_acceleration_limit * model.wheel_base / (v * v));
  };
  double steering = -within_grip();
  world.memory<ExternalInput>(id) = {100.0, -3.0};
  REQUIRE(world.step(0.1));
  CHECK(world.record(id).action == cb::Action{model.highest_acceleration, steering});
  CHECK(world.state(id).speed == doctest::Approx(10 + 0.1 * model.highest_acceleration));
  steering = within_grip();
  world.memory<ExternalInput>(id) = {-100.0, 3.0};
  REQUIRE(world.step(0.1));
  CHECK(world.record(id).action == cb::Action{model.lowest_acceleration, steering});
}

TEST_CASE("Euler and Runge-Kutta integration agree for short sub-steps and differ for long ones") {
  auto const end = [](ExternalInput const& behavior) {
    Sim world(field());
    auto const id = add(world, 8.0, behavior);
    world.memory<ExternalInput>(id) = {0.5, 0.2};
    for (int i = 0; i < 8; ++i) REQUIRE(world.step(0.5));
    return world.state(id);
  };
  auto const exact = end({.longest_substep = 0.01});
  auto const distance = [&](ExternalInput const& behavior) {
    auto const s = end(behavior);
    return std::hypot(s.x - exact.x, s.y - exact.y);
  };
  CHECK(distance({}) < 1e-4);
  CHECK(distance({.scheme = cb::InputScheme::euler, .longest_substep = 0.5}) > 1.0);
  CHECK(distance({.scheme = cb::InputScheme::euler, .longest_substep = 0.001}) < 0.02);
}

TEST_CASE("an input that is not a number fails this agent only, and names it") {
  Sim world(field());
  auto const id = add(world, 8.0);
  auto const other = world.add({.position = {50, -1.75}, .speed = 5});
  world.memory<ExternalInput>(id).acceleration = std::numeric_limits<double>::quiet_NaN();
  auto const result = world.step(0.2);
  CHECK(result.problem == cb::StepProblem::not_finite);
  CHECK(result.agent == id);
  CHECK(world.status(other) == cb::AgentStatus::driving);
}
