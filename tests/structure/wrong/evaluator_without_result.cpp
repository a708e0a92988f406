// expect: cambium::Evaluators<...>: each must have a Result and `template <class World> Result evaluate(World const&) const`
#include <cambium/evaluation/evaluators.hpp>

struct World {};
struct Mood {
  template <class W>
  bool evaluate(W const&) const {
    return true;
  }
};
auto const result = cambium::Evaluators(cambium::StepCount{}, Mood{}).evaluate(World{});
