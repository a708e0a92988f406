#include "traffic.hpp"

CAMBIUM_INSTANTIATE_PLANNING(benchmark::TestedWorld, cambium::ContenderBehavior<benchmark::PolicyTree>);

benchmark::Contender benchmark::policy_tree(examples::ParameterFile& file) {
  return with_speed(file, PolicyTree{}, "policy_tree", [](PolicyTree& planner, double speed) {
    planner.actions.driver.law.desired_speed = planner.actions.macro.law.desired_speed = speed;
  });
}
