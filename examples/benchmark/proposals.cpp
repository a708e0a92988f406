#include "cambium/planner/policy/proposal_planner.hpp"

#include "traffic.hpp"

benchmark::Contender benchmark::proposals() {
  using Planner = cb::ProposalPlanner<Prediction<cb::IdmProposal, cb::ConstantAcceleration>>;
  return with_speed(Planner{}, "proposals",
                    [](Planner& planner, double speed) { planner.driver.driver.desired_speed = speed; });
}
