#include "search.hpp"

CAMBIUM_INSTANTIATE_PLANNING(benchmark::TestedWorld, cambium::ContenderBehavior<benchmark::Expecting>);

benchmark::Contender benchmark::mcts_single_agent(examples::ParameterFile& file) {
  return with_speed(file, search<cb::UrbanDriver>(), "mcts_single_agent");
}

benchmark::Contender benchmark::mcts_cooperative(examples::ParameterFile& file) {
  auto planner = search<cb::UrbanDriver>();
  planner.most_agents = 4;
  return with_speed(file, planner, "mcts_cooperative");
}
