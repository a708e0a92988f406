#include "cambium/evaluation/goal_reached.hpp"

#include <doctest/doctest.h>

#include "../world/fixtures.hpp"

using namespace fixtures;

TEST_CASE("a goal is reached by the agent that has it, while it is there") {
  Sim world(straight_road(1, 300));
  auto const lane = world.map().find_lane("1", 0, -1);
  auto const ego = world.add({.position = {40, -1.75},
                              .speed = 10,
                              .behavior = cb::ConstantAcceleration{},
                              .goal = cb::ReachLane{lane, 50.0, 70.0}});
  auto const other = world.add({.position = {60, -1.75}, .speed = 10, .behavior = cb::ConstantAcceleration{}});
  cb::GoalReached const reached{ego};
  CHECK_FALSE(reached.evaluate(world).goal_reached);
  for (int i = 0; i < 10; ++i) REQUIRE(world.step(0.2));  // at 60 m
  CHECK(reached.evaluate(world).goal_reached);
  CHECK_FALSE(cb::GoalReached{other}.evaluate(world).goal_reached);
  for (int i = 0; i < 10; ++i) REQUIRE(world.step(0.2));  // at 80 m
  CHECK_FALSE(reached.evaluate(world).goal_reached);
}

TEST_CASE("the goal of an agent that is not there is an error") {
  Sim const world(straight_road(1, 100));
  CHECK_THROWS_AS((void)cb::GoalReached{static_cast<cb::AgentId>(5)}.evaluate(world), cb::WorldError);
}
