#include "search.hpp"

benchmark::Driver benchmark::mcts_hypothesis(examples::ParameterFile& file) {
  return with_speed(file, search<cb::HeadwayHypotheses<cb::Intersection>>(), "mcts_hypothesis");
}
