#include "search.hpp"

benchmark::Driver benchmark::mcts_cooperative(examples::ParameterFile& file) {
  auto planner = search<cb::Intersection>();
  planner.most_agents = 4;
  return with_speed(file, planner, "mcts_cooperative");
}
