// expect: cambium::MctsWorkspace<Domain, Options>: Options must be cambium::MctsOptions<Selection, Rollout, Budget>
#include <cambium/execution/interpolate.hpp>
#include <cambium/planner/mcts/mcts.hpp>
#include <cambium/world/world.hpp>

using Predicted = cambium::World<cambium::BehaviorSet<cambium::MacroActions, cambium::IdmClassic>,
                                 cambium::InterpolateExecution, cambium::SingleTrack>;
// A selection where the options belong.
cambium::Mcts<Predicted, cambium::MacroActions, cambium::TrafficReward, cambium::IdmClassic,
                         cambium::Ucb1>::Workspace workspace;
