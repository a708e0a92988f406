#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "cambium/execution/interpolate.hpp"
#include "cambium/planner.hpp"
#include "cambium/world/world.hpp"
#include "support/maps.hpp"

/// The planners, one world for those that compare candidates, and roads to drive on.
namespace planner_fixtures {

using namespace cambium;

using PredictionWorld =
    World<BehaviorSet<MacroActions, IdmProposal, IdmClassic, HeadwayHypotheses<IdmClassic>, ConstantAcceleration>,
          InterpolateExecution, SingleTrack>;
using Learning = Mcts<PredictionWorld, MacroActions, TrafficReward, HeadwayHypotheses<IdmClassic>>;
using Proposal = ProposalPlanner<PredictionWorld>;
using PolicyTree = PolicyTreePlanner<PredictionWorld>;
using Frenet = FrenetPlanner<PredictionWorld>;
using CandidateSim = World<BehaviorSet<Proposal, PolicyTree, Frenet, IdmClassic, ConstantAcceleration>,
                           InterpolateExecution, SingleTrack>;

inline constexpr AgentId ego{0};

/// A road of `lanes` lanes with ego, agent 0, in the right one.
template <class Planner>
CandidateSim road(int lanes, double speed, Planner const& planner, double curvature = 0.0) {
  CandidateSim world(support::straight_road(lanes, 600.0, curvature));
  auto const start = world.map().lane(world.map().find_lane("1", 40.0, -lanes)).path.pose(40.0);
  world.add({.position = start.position(), .heading = start.heading, .speed = speed, .behavior = planner});
  return world;
}

/// A rectangle of 4 m from `x` on, in the lane whose middle is at `y`: from `right` to `left` relative to it.
inline geometry::Polygon obstacle(double x, double y, double right = -1.75, double left = 1.75) {
  return geometry::Polygon({{x, y + right}, {x + 4, y + right}, {x + 4, y + left}, {x, y + left}});
}

/// Steps the world for a while and checks that no agent fails, and that ego touches nothing and stays on the road.
template <class World>
void drive(World& world, int steps, double dt = 0.2) {
  for (int i = 0; i < steps; ++i) {
    CHECK(world.step(dt).failed == 0);
    REQUIRE_FALSE(Collision{}(world, world.slot_of(ego)));
    REQUIRE_FALSE(OffRoad{}(world, world.slot_of(ego)));
  }
}

/// What the planner thinks in ego's place.
template <class Planner, class World>
auto report_of(Planner const& planner, World world, typename Planner::Memory const& memory = {}) {
  typename Planner::Workspace workspace;
  return planner.think(world.observe(ego), memory, workspace);
}

/// The time step of its predictions [s].
template <class Planner>
double step_of(Planner const& planner) {
  if constexpr (requires { planner.options; })
    return planner.options.step;
  else
    return planner.step;
}

/// Puts an agent elsewhere: `change(state)` changes its state.
template <class World, class Change>
void put(World& world, AgentId id, Change const& change) {
  auto state = world.state(id);
  change(state);
  world.set_state(id, state);
}

/// Ego drives behind a slow vehicle in the right one of two lanes. Its goal is the middle of the left lane, where four
/// other vehicles drive.
template <class World, class Planner>
World lane_change(std::uint64_t seed, Planner const& planner) {
  auto const map = support::straight_road(2, 600.0);
  World world(map, {.seed = seed});
  auto const left = map->nearest_lane({20, -1.75, 0})->lane;
  world.add({.position = {60, -5.25},
             .speed = 12,
             .behavior = planner,
             .goal = LaneLimits{.lane = left, .left = 0.5, .right = 0.5, .heading_error = 0.08}});
  for (int i = 0; i < 4; ++i)
    world.add({.position = {20.0 + 28.0 * i + 3.0 * static_cast<double>(seed), -1.75},
               .speed = 12.5,
               .behavior = IdmClassic{.law = {.desired_speed = 14.0}}});
  world.add({.position = {95.0, -5.25}, .speed = 9, .behavior = IdmClassic{.law = {.desired_speed = 9.0}}});
  return world;
}

}  // namespace planner_fixtures
