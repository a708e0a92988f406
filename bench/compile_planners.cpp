// All four families of planners in one translation unit, each thinking and driving, for bench/run compile.

#include <cambium/cambium.hpp>

namespace cb = cambium;

using Predicted =
    cb::World<cb::BehaviorSet<cb::MacroActions, cb::IdmProposal, cb::IdmClassic, cb::ConstantAcceleration>,
              cb::InterpolateExecution, cb::SingleTrack>;
using Search = cb::Mcts<Predicted>;
using PolicyTree = cb::PolicyTreePlanner<Predicted>;
using Proposal = cb::ProposalPlanner<Predicted>;
using Frenet = cb::FrenetPlanner<Predicted>;
using World = Predicted::WithBehaviors<cb::BehaviorSet<Search, PolicyTree, Proposal, Frenet, cb::IdmClassic>>;

template <class Planner>
std::size_t think(World& world, cb::AgentId ego, Planner const& planner) {
  typename Planner::Workspace workspace;
  typename Planner::Memory memory;
  return planner.think(world.observe(ego), memory, workspace).course.size();
}

std::size_t think(World& world, cb::AgentId ego) {
  return think(world, ego, Search{}) + think(world, ego, PolicyTree{}) + think(world, ego, Proposal{}) +
         think(world, ego, Frenet{});
}

bool drive(World& world) { return static_cast<bool>(world.step(0.2)); }
