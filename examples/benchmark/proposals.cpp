#include "cambium/planner/policy/proposal_planner.hpp"

#include "traffic.hpp"

benchmark::Driver benchmark::proposals(examples::ParameterFile& file) {
  using Planner = cb::ProposalPlanner<Prediction<cb::IdmProposal, cb::ConstantAcceleration>>;
  return with_speed(file, Planner{}, "proposals",
                    [](Planner& planner, double speed) { planner.driver.driver.desired_speed = speed; });
}
