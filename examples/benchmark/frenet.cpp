#include "cambium/planner/frenet/frenet_planner.hpp"

#include "traffic.hpp"

benchmark::Contender benchmark::frenet() {
  using Planner = cb::FrenetPlanner<Prediction<cb::ConstantAcceleration>>;
  return with_speed(Planner{}, "frenet", [](Planner& planner, double speed) { planner.desired_speed = speed; });
}
