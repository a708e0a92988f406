#include "search.hpp"

benchmark::Contender benchmark::mcts_single_agent() {
  return with_speed(search<cb::Intersection>(), "mcts_single_agent");
}
