// expect: cambium::Terms<Evaluators...>: each must have `template <class World> auto operator()(World&, Slot) const`
#include "cambium/execution/interpolate.hpp"
#include "cambium/planner/mcts/mcts.hpp"
#include "cambium/world/world.hpp"

struct Mood {
  static constexpr char const* name = "mood";
  static constexpr auto parameters() { return cambium::parameter_list(); }
};
using World =
    cambium::World<cambium::BehaviorSet<cambium::IdmClassic>, cambium::InterpolateExecution, cambium::SingleTrack>;

auto judge(World& world) { return cambium::Reward<Mood>{}.judge(world, cambium::Slot{}, 0.2); }
