#include "cambium/planner/mcts.hpp"

#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>

#include "cambium/execution/interpolate.hpp"
#include "cambium/world/world.hpp"
#include "support/allocations.hpp"
#include "support/maps.hpp"

using namespace cambium;

namespace {

using PredictionSet = BehaviorSet<MacroActions, IdmClassic, ConstantAcceleration>;
using PredictionWorld = World<PredictionSet, InterpolateExecution, SingleTrack>;
using Planner = MctsSingleAgent<PredictionWorld>;
using Sim = World<BehaviorSet<Planner, IdmClassic, ConstantAcceleration>, InterpolateExecution, SingleTrack>;

}  // namespace

TEST_CASE("a search in traffic changes into a gap in the other lane") {
  int reached = 0, collisions = 0;
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    auto const map = support::straight_road(2, 600.0);
    Sim world(map, {.seed = seed});
    Planner planner;
    planner.options.budget.iterations = 1000;
    planner.options.rollout.hold = 5;
    auto const left = map->nearest_lane({20, -1.75, 0})->lane;
    auto const ego = world.add({.position = {60, -5.25},
                                .speed = 12,
                                .behavior = planner,
                                .goal = LaneLimits{.lane = left, .left = 0.5, .right = 0.5, .heading_error = 0.08},
                                .id = AgentId{0}});
    for (int i = 0; i < 4; ++i)
      world.add({.position = {20.0 + 28.0 * i + 3.0 * static_cast<double>(seed), -1.75},
                 .speed = 12.5,
                 .behavior = IdmClassic{.desired_speed = 14.0}});
    world.add({.position = {95.0, -5.25}, .speed = 9, .behavior = IdmClassic{.desired_speed = 9.0}});
    for (int step = 0; step < 60 && !world.reached_goal(ego); ++step) {
      auto const result = world.step(0.2);
      REQUIRE(result.failed == 0);
      collisions += CollisionEgo{ego}.evaluate(world).ego_collision ? 1 : 0;
    }
    reached += world.reached_goal(ego) ? 1 : 0;
  }
  CHECK(reached == 5);
  CHECK(collisions == 0);
}
