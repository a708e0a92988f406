// expect: describe Reward's parameters, as cambium::TrafficReward does
// also: cambium::TreeSearch<Domain>: Domain must be a game
struct Fast {
  template <class World>
  cambium::Judgement judge(World const& world, cambium::Slot slot, double dt) const {
    return {.reward = world.frame().agents[slot].state.speed * dt};
  }
};
cambium::Mcts<Predicted, cambium::MacroActions, Fast>::Workspace workspace;
