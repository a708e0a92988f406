#include "cambium/planner/mcts/mcts.hpp"

#include "traffic.hpp"

benchmark::Contender benchmark::mcts_hypothesis(examples::ParameterFile& file) {
  using Planner =
      cb::Mcts<Prediction<cb::MacroActions, cb::IdmHypotheses>, cb::MacroActions, cb::TrafficReward, cb::IdmHypotheses>;
  Planner planner;
  planner.options.budget.iterations = 150;
  planner.reward.speed_deviation = -1.0;  // else nothing moves it before the goal is near
  return with_speed(file, planner, "mcts_hypothesis",
                    [](Planner& own, double speed) { own.reward.desired_speed = speed; });
}
