// expect: cambium::Evaluators<...>: each must have a Result and `template <class World> Result evaluate(World const&) const`
#include <cambium/evaluation/evaluators.hpp>

struct World {};
struct Mood {
  struct Result {
    bool good = true;
  };
  template <class W>
  bool evaluate(W const&) const {
    return true;
  }
};
auto const result = cambium::Evaluators(Mood{}).evaluate(World{});
