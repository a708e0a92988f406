// expect: a search by priors (cambium::Puct) needs a reward with
#include <cambium/execution/interpolate.hpp>
#include <cambium/planner/mcts/mcts_single_agent.hpp>
#include <cambium/planner/search/puct.hpp>
#include <cambium/world/world.hpp>

using Predicted = cambium::World<cambium::BehaviorSet<cambium::MacroActions, cambium::IdmClassic>,
                                 cambium::InterpolateExecution, cambium::SingleTrack>;
cambium::MctsSingleAgent<Predicted, cambium::MacroActions, cambium::TrafficReward, cambium::IdmClassic,
                         cambium::MctsOptions<cambium::Puct>>::Workspace workspace;
