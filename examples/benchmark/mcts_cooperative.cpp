#include "search.hpp"

benchmark::Contender benchmark::mcts_cooperative() {
  auto planner = search<cb::Intersection>();
  planner.most_agents = 4;
  return with_speed(planner, "mcts_cooperative");
}
