// expect: a planner's PredictionWorld has another execution model than the world that it plans in
#include <cambium/execution/interpolate.hpp>
#include <cambium/execution/lqr.hpp>
#include <cambium/planner/mcts/mcts.hpp>
#include <cambium/world/world.hpp>

using Set = cambium::BehaviorSet<cambium::MacroActions, cambium::IdmClassic>;
using Planner = cambium::Mcts<cambium::World<Set, cambium::LqrExecution, cambium::SingleTrack>>;
using Sim = cambium::World<cambium::BehaviorSet<Planner>, cambium::InterpolateExecution, cambium::SingleTrack>;
bool drive(Sim& world) { return world.step(0.2).valid(); }
