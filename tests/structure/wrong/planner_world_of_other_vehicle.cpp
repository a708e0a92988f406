// expect: a planner's PredictionWorld has another vehicle model than the world that it plans in
using Set = cambium::BehaviorSet<cambium::MacroActions, cambium::IdmClassic>;
using Planner = cambium::Mcts<cambium::World<Set, cambium::InterpolateExecution, cambium::TripleIntegrator>>;
bool drive(WorldOf<Planner>& world) { return world.step(0.2).valid(); }
