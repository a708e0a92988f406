// expect: describe Reward's parameters, as cambium::TrafficReward does
// also: cambium::TreeSearch<Domain>: Domain must be a game
#include <cambium/execution/interpolate.hpp>
#include <cambium/planner/mcts/mcts.hpp>
#include <cambium/world/world.hpp>

struct Fast {
  template <class World>
  cambium::Judgement judge(World const& world, cambium::Slot slot, double dt) const {
    return {.reward = world.frame().agents[slot].state.speed * dt};
  }
};
using Predicted = cambium::World<cambium::BehaviorSet<cambium::MacroActions, cambium::IdmClassic>,
                                 cambium::InterpolateExecution, cambium::SingleTrack>;
cambium::Mcts<Predicted, cambium::MacroActions, Fast>::Workspace workspace;
