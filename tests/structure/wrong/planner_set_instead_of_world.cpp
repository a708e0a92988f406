// expect: a planner's PredictionWorld must be a cambium::World<BehaviorSet<...>, ...>
#include <cambium/execution/interpolate.hpp>
#include <cambium/planner/mcts/mcts.hpp>
#include <cambium/world/world.hpp>

using Set = cambium::BehaviorSet<cambium::MacroActions, cambium::IdmClassic>;
cambium::Mcts<Set> planner;
