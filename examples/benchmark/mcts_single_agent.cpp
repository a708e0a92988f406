#include "search.hpp"

benchmark::Contender benchmark::mcts_single_agent(examples::ParameterFile& file) {
  return with_speed(file, search<cb::Intersection>(), "mcts_single_agent");
}
