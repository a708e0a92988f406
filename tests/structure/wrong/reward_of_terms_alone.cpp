// expect: cambium::Mcts<PredictionWorld, Actions, Reward>: Terms alone know no collision and no goal
// also: cambium::TreeSearch<Domain>: Domain must be a game
#include <cambium/evaluation/driving.hpp>
#include <cambium/execution/interpolate.hpp>
#include <cambium/planner/mcts/mcts.hpp>
#include <cambium/world/world.hpp>

using Predicted = cambium::World<cambium::BehaviorSet<cambium::MacroActions, cambium::IdmClassic>,
                                 cambium::InterpolateExecution, cambium::SingleTrack>;
cambium::Mcts<Predicted, cambium::MacroActions, cambium::Terms<cambium::Progress>>::Workspace workspace;
