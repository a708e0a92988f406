// What an agent gets wrong about itself misleads it; it does not move it.

#include <doctest/doctest.h>

#include <vector>

#include "../world/fixtures.hpp"
#include "cambium/behavior/drivers.hpp"
#include "cambium/behavior/open_loop/static_trajectory.hpp"
#include "cambium/observer/delayed.hpp"
#include "cambium/observer/parametric.hpp"

using namespace fixtures;

namespace {

using Behaviors = cb::BehaviorSet<cb::ConstantAcceleration, cb::IdmLaneTracking, cb::StaticTrajectory>;
template <class Observer>
using World = cb::World<Behaviors, cb::InterpolateExecution, cb::SingleTrack, Observer>;

/// Where one is who drove from x = 100 m at 10 m/s for 10 s in steps of 0.1 s.
template <class Observer>
cb::State after_driving(Observer const& observer, typename World<Observer>::Behavior const& behavior) {
  World<Observer> world(straight_road(1, 1000.0), {.seed = 4});
  auto const id = world.add({.position = {100, -1.75}, .speed = 10.0, .behavior = behavior, .observer = observer});
  for (int i = 0; i < 100; ++i) {
    REQUIRE(world.step(0.1).failed == 0);
    REQUIRE(world.status(id) == cb::AgentStatus::driving);
  }
  return world.state(id);
}

void check_drove_on(cb::State const& state) {
  CHECK(state.x == doctest::Approx(200.0).epsilon(1e-9));
  CHECK(state.y == doctest::Approx(-1.75).epsilon(1e-9));
  CHECK(state.speed == doctest::Approx(10.0));
}

}  // namespace

TEST_CASE("an agent that sees itself late, or elsewhere, drives as far as its speed takes it, and stays on its line") {
  check_drove_on(after_driving(cb::DelayedObserver<3>{.own = 3}, cb::ConstantAcceleration{}));
  check_drove_on(after_driving(cb::ParametricObserver{.own = {.mean_along = 1.0}}, cb::ConstantAcceleration{}));
  check_drove_on(
      after_driving(cb::ParametricObserver{.own = {.along = 0.5, .across = 0.3}}, cb::ConstantAcceleration{}));
}

TEST_CASE("an agent that sees itself as it is drives like one with a perfect observer, bit by bit") {
  cb::IdmLaneTracking const driver{.law = {.desired_speed = 12.0}};
  CHECK(after_driving(cb::ParametricObserver{}, driver) == after_driving(cb::PerfectObserver{}, driver));
}

TEST_CASE("an agent that misjudges its speed keeps its true speed while it does not accelerate") {
  check_drove_on(after_driving(cb::ParametricObserver{.own = {.mean_speed = -2.0}}, cb::ConstantAcceleration{}));
}

TEST_CASE("an agent that steers by what it sees comes to where it believes its lane to be") {
  cb::ParametricObserver const observer{.own = {.mean_across = 0.4}};
  auto const state = after_driving(observer, cb::IdmLaneTracking{.law = {.desired_speed = 10.0}});
  CHECK(state.y == doctest::Approx(-1.75 - 0.4).epsilon(0.01));
  CHECK(state.heading == doctest::Approx(0.0).epsilon(0.01));
}

TEST_CASE("a recording is replayed where it was, whatever its agent believes") {
  std::vector<cb::State> states;
  for (int i = 0; i <= 120; ++i) states.push_back({0.1 * i, 100.0 + i, -1.75, 0.0, 10.0});
  check_drove_on(
      after_driving(cb::ParametricObserver{.own = {.mean_along = 1.0, .across = 0.3}}, cb::StaticTrajectory{states}));
}
