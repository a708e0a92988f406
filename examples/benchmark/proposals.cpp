#include "traffic.hpp"

CAMBIUM_INSTANTIATE_PLANNING(benchmark::TestedWorld, cambium::ContenderBehavior<benchmark::Proposals>);

benchmark::Contender benchmark::proposals(examples::ParameterFile& file) {
  return with_speed(file, Proposals{}, "proposals",
                    [](Proposals& planner, double speed) { planner.driver.law.desired_speed = speed; });
}
