#include <cambium/cambium.hpp>
#include <doctest/doctest.h>

#include "../support/parameter_rows.hpp"

namespace cb = cambium;

TEST_CASE("defaults, units and ranges are those of the file beside") {
  using Set = cb::BehaviorSet<cb::MacroActions, cb::IdmClassic, cb::HeadwayHypotheses<cb::IdmClassic>, cb::IdmProposal,
                              cb::ConstantAcceleration>;
  using World = cb::World<Set, cb::InterpolateExecution, cb::SingleTrack>;
  support::check_parameter_rows<cb::Mcts<World>, cb::ProposalPlanner<World>, cb::PolicyTreePlanner<World>,
                                cb::FrenetPlanner<World>, cb::MctsOptions<>, cb::TreeSearchParameters,
                                cb::IterationBudget, cb::NoBudget, cb::TimeBudget, cb::Widening, cb::CostConstraint,
                                cb::Ucb1, cb::Ucb1Tuned, cb::Puct, cb::RegretMatching, cb::Exp3, cb::RandomRollout,
                                cb::PolicyRollout, cb::TruncatedRollout<cb::RandomRollout>, cb::NoRollout,
                                cb::TrafficReward, cb::BeliefParameters, cb::ProposalScoring, cb::IntentionPrior,
                                cb::PolicyWeights, cb::FrenetCosts, cb::FrenetLimits>("planner");
}
