#include "cambium/planner/policy/policy_tree_planner.hpp"

#include "traffic.hpp"

benchmark::Driver benchmark::policy_tree(examples::ParameterFile& file) {
  using Planner = cb::PolicyTreePlanner<Prediction<cb::DriverActions<cb::Intersection>, cb::Intersection>>;
  return with_speed(file, Planner{}, "policy_tree", [](Planner& planner, double speed) {
    planner.actions.driver.idm.desired_speed = planner.actions.macro.idm.desired_speed = speed;
  });
}
