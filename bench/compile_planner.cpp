// A tree search over predicted worlds, and a world that it drives in, for bench/run compile.

#include <cambium/execution/interpolate.hpp>
#include <cambium/planner/mcts_single_agent.hpp>
#include <cambium/world/world.hpp>

namespace cb = cambium;

using Predicted =
    cb::World<cb::BehaviorSet<cb::MacroActions, cb::IdmClassic>, cb::InterpolateExecution, cb::SingleTrack>;
using Planner = cb::MctsSingleAgent<Predicted>;
using World = cb::World<cb::BehaviorSet<Planner, cb::IdmClassic>, cb::InterpolateExecution, cb::SingleTrack>;

bool drive(World& world) { return static_cast<bool>(world.step(0.2)); }
