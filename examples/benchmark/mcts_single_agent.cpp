#include "search.hpp"

benchmark::Driver benchmark::mcts_single_agent(examples::ParameterFile& file) {
  return with_speed(file, search<cb::Intersection>(), "mcts_single_agent");
}
