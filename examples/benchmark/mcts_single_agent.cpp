#include "cambium/planner/mcts/mcts.hpp"

#include "traffic.hpp"

benchmark::Contender benchmark::mcts_single_agent(examples::ParameterFile& file) {
  using Planner =
      cb::Mcts<Prediction<cb::MacroActions, cb::IdmClassic>, cb::MacroActions, cb::TrafficReward, cb::IdmClassic>;
  Planner planner;
  planner.options.budget.iterations = 150;
  planner.reward.speed_deviation = -1.0;  // else nothing moves it before the goal is near
  return with_speed(file, planner, "mcts_single_agent",
                    [](Planner& own, double speed) { own.reward.desired_speed = speed; });
}
