#include "cambium/planner/frenet/frenet_planner.hpp"

#include "traffic.hpp"

benchmark::Driver benchmark::frenet(examples::ParameterFile& file) {
  using Planner = cb::FrenetPlanner<Prediction<cb::ConstantAcceleration>>;
  return with_speed(file, Planner{}, "frenet", [](Planner& planner, double speed) { planner.desired_speed = speed; });
}
