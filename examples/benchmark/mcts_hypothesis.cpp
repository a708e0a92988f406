#include "search.hpp"

benchmark::Contender benchmark::mcts_hypothesis() {
  return with_speed(search<cb::IdmHypotheses>(), "mcts_hypothesis");
}
