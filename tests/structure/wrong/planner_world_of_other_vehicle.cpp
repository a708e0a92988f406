// expect: a planner's PredictionWorld has another vehicle model than the world that it plans in
#include <cambium/dynamics/triple_integrator.hpp>
#include <cambium/execution/interpolate.hpp>
#include <cambium/planner/mcts/mcts.hpp>
#include <cambium/world/world.hpp>

using Set = cambium::BehaviorSet<cambium::MacroActions, cambium::IdmClassic>;
using Planner = cambium::Mcts<cambium::World<Set, cambium::InterpolateExecution, cambium::TripleIntegrator>>;
using Sim = cambium::World<cambium::BehaviorSet<Planner>, cambium::InterpolateExecution, cambium::SingleTrack>;
bool drive(Sim& world) { return world.step(0.2).valid(); }
