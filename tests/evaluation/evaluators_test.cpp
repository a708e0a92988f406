#include "cambium/evaluation/evaluators.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "../world/fixtures.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/evaluation/drivable_area.hpp"
#include "cambium/evaluation/goal_reached.hpp"

using namespace fixtures;

TEST_CASE("steps are counted, and time is up from the limit on") {
  Sim world(straight_road(1, 100));
  cb::StepCount const limited{3}, unlimited{};
  for (std::uint64_t step = 0; step < 6; ++step) {
    CHECK(limited.evaluate(world).steps == step);
    CHECK(limited.evaluate(world).timed_out == (step >= 3));
    CHECK_FALSE(unlimited.evaluate(world).timed_out);
    REQUIRE(world.step(0.2));
  }
}

namespace {

/// A criterion of a user's own.
struct SlowestSpeed {
  struct Result {
    double slowest = 1e9;
  };
  template <class World>
  [[nodiscard]] Result evaluate(World const& world) const {
    Result result;
    for (auto const& record : world.frame().agents) result.slowest = std::min(result.slowest, record.state.speed);
    return result;
  }
};

}  // namespace

TEST_CASE("several evaluators give one struct whose fields are named as in each") {
  Sim world(straight_road(2, 300));
  auto const lane = world.map().find_lane("1", 0, -1);
  auto const ego = world.add({.position = {40, -1.75},
                              .speed = 10,
                              .behavior = cb::ConstantAcceleration{},
                              .goal = cb::ReachLane{lane, 55.0}});
  auto const other = world.add({.position = {70, -1.75}, .speed = 2, .behavior = cb::ConstantAcceleration{}});
  cb::Evaluators const judge(cb::CollisionAny{}, cb::CollisionEgo{ego}, cb::GoalReached{ego}, cb::DrivableArea{ego},
                             cb::StepCount{20}, SlowestSpeed{});
  int collisions = 0, goals = 0, time_outs = 0;
  for (int i = 0; i < 30; ++i) {
    REQUIRE(world.step(0.2));
    auto const all = judge.evaluate(world);
    auto const any = cb::CollisionAny{}.evaluate(world);
    CHECK(all.any_collision == any.any_collision);
    CHECK(all.collision_first == any.collision_first);
    CHECK(all.collision_second == any.collision_second);
    CHECK(all.ego_collision == cb::CollisionEgo{ego}.evaluate(world).ego_collision);
    CHECK(all.ego_collision_with == (all.ego_collision ? other : cb::none<cb::AgentId>));
    CHECK(all.goal_reached == cb::GoalReached{ego}.evaluate(world).goal_reached);
    CHECK_FALSE(all.off_road);
    CHECK(all.steps == world.frame().step);
    CHECK(all.timed_out == (world.frame().step >= 20));
    CHECK(all.slowest == doctest::Approx(2.0));
    collisions += all.any_collision;
    goals += all.goal_reached;
    time_outs += all.timed_out;
  }
  CHECK(collisions > 0);
  CHECK(collisions < 30);
  CHECK(goals > 0);
  CHECK(goals < 30);
  CHECK(time_outs == 11);
}

TEST_CASE("evaluators are a value, one of them alone is enough, and they nest") {
  Sim world(straight_road(1, 100));
  auto const ego = world.add({.position = {20, -1.75}});
  world.add({.position = {22, -1.75}});
  cb::Evaluators const alone{cb::CollisionEgo{ego}};
  auto const copy = alone;
  CHECK(copy.evaluate(world).ego_collision);
  cb::Evaluators<cb::Evaluators<cb::CollisionEgo>, cb::StepCount> const nested(alone, cb::StepCount{1});
  CHECK(nested.evaluate(world).ego_collision);
  CHECK_FALSE(nested.evaluate(world).timed_out);
}
