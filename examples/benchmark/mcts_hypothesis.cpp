#include "search.hpp"

CAMBIUM_INSTANTIATE_PLANNING(benchmark::TestedWorld, cambium::ContenderBehavior<benchmark::Learning>);

benchmark::Contender benchmark::mcts_hypothesis(examples::ParameterFile& file) {
  return with_speed(file, search<cb::HeadwayHypotheses<cb::UrbanDriver>>(), "mcts_hypothesis");
}
