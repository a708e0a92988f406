// expect: a planner's PredictionWorld must be a cambium::World<BehaviorSet<...>, ...>
using Set = cambium::BehaviorSet<cambium::MacroActions, cambium::IdmClassic>;
cambium::Mcts<Set> planner;
