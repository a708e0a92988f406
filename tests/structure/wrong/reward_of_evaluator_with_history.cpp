// expect: this evaluator needs a history, and predictions keep none
#include <cambium/evaluation/driving.hpp>
#include <cambium/planner/mcts/traffic_reward.hpp>

cambium::Reward<cambium::Jerk> reward;
