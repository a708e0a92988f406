// expect: cambium::ProposalPlanner<PredictionWorld>: the behaviour set of PredictionWorld must contain cambium::IdmProposal
#include <cambium/execution/interpolate.hpp>
#include <cambium/planner/policy/proposal_planner.hpp>
#include <cambium/world/world.hpp>

using Predicted = cambium::World<cambium::BehaviorSet<cambium::ConstantAcceleration>, cambium::InterpolateExecution,
                                 cambium::SingleTrack>;
cambium::ProposalPlanner<Predicted> planner;
