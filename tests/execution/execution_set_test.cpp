#include "cambium/execution/execution_set.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>

#include "../support/allocations.hpp"
#include "../world/fixtures.hpp"
#include "cambium/execution/lqr.hpp"
#include "cambium/execution/stanley.hpp"

using namespace fixtures;

namespace {

using Set = cb::ExecutionSet<cb::InterpolateExecution, cb::StanleyExecution, cb::LqrExecution>;
template <class Execution>
using World = cb::World<cb::BehaviorSet<cb::IdmClassic>, Execution, cb::SingleTrack>;

cb::StanleyExecution noisy() {
  cb::StanleyExecution execution;
  execution.actuation = {.delay = 0.1, .acceleration_noise = {0.0, 0.3}, .steering_noise = {0.0, 0.01}};
  return execution;
}

template <class W>
cb::AgentId enter(W& world, double x, double speed, typename W::AgentSpec spec = {}) {
  spec.position = {x, -1.75};
  spec.speed = speed;
  return world.add(spec);
}

}  // namespace

TEST_CASE("agents of one world carry out their plans each in its own way") {
  World<Set> world(straight_road(1, 1000));
  auto const exact = enter(world, 300, 12, {.execution = cb::InterpolateExecution{}});
  auto const stanley = enter(world, 200, 12, {.execution = noisy()});
  auto const lqr = enter(world, 100, 12, {.execution = cb::LqrExecution{}});
  for (int i = 0; i < 50; ++i) REQUIRE(world.step(0.2));
  CHECK(world.state(exact).y == -1.75);
  CHECK(std::abs(world.state(lqr).y + 1.75) < 1e-6);
  CHECK(world.state(stanley).y != -1.75);
  CHECK(std::abs(world.state(stanley).y + 1.75) < 0.5);
}

TEST_CASE("errors of execution are the same in copies, and in a world set back") {
  World<cb::StanleyExecution> world(straight_road(1, 1000), {.seed = 5});
  enter(world, 100, 12, {.execution = noisy()});
  for (int i = 0; i < 10; ++i) REQUIRE(world.step(0.2));
  auto copy = world;
  auto const frame = world.frame();
  for (int i = 0; i < 20; ++i) REQUIRE(world.step(0.2));
  for (int i = 0; i < 20; ++i) REQUIRE(copy.step(0.2));
  CHECK(world.frame() == copy.frame());
  auto const end = world.frame();
  world.restore(frame);
  for (int i = 0; i < 20; ++i) REQUIRE(world.step(0.2));
  CHECK(world.frame() == end);
}

TEST_CASE("a frame has no room for the memory of an execution model without one") {
  using Plain = World<cb::InterpolateExecution>;
  static_assert(sizeof(Plain::Record) < sizeof(World<cb::StanleyExecution>::Record));
  struct Before {
    cb::State state;
    cb::map::LanePlace lane;
    cb::Action action;
    Plain::Behaviors::Memory memory;
    cb::AgentStatus status;
    std::uint8_t goals_passed;
    float acceleration;
  };
  CHECK(sizeof(Plain::Record) == sizeof(Before));
}

TEST_CASE("tracking controllers allocate nothing in a step") {
  World<Set> world(straight_road(1, 1000));
  enter(world, 200, 12, {.execution = noisy()});
  enter(world, 100, 12, {.execution = cb::LqrExecution{}});
  for (int i = 0; i < 5; ++i) REQUIRE(world.step(0.2));
  auto const before = support::allocations();
  for (int i = 0; i < 50; ++i) REQUIRE(world.step(0.2));
  CHECK(support::allocations() == before);
}
