// expect: a search by priors (cambium::Puct) needs a reward with
#include <cambium/execution/interpolate.hpp>
#include <cambium/planner/mcts/mcts.hpp>
#include <cambium/planner/search/puct.hpp>
#include <cambium/world/world.hpp>

using Predicted = cambium::World<cambium::BehaviorSet<cambium::MacroActions, cambium::IdmClassic>,
                                 cambium::InterpolateExecution, cambium::SingleTrack>;
cambium::Mcts<Predicted, cambium::MacroActions, cambium::TrafficReward, cambium::IdmClassic,
                         cambium::MctsOptions<cambium::Puct>>::Workspace workspace;
