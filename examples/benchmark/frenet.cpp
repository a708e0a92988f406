#include "traffic.hpp"

CAMBIUM_INSTANTIATE_PLANNING(benchmark::TestedWorld, cambium::ContenderBehavior<benchmark::Frenet>);

benchmark::Contender benchmark::frenet(examples::ParameterFile& file) {
  return with_speed(file, Frenet{}, "frenet", [](Frenet& planner, double speed) { planner.desired_speed = speed; });
}
