// expect: cambium::BehaviorSet<...>: each alternative must be a behaviour: a copyable struct with `template <class View> Plan<View> plan
#include <cambium/behavior/behavior_set.hpp>

struct Dreamer {
  double desired_speed = 10.0;
};
cambium::BehaviorSet<Dreamer> set;
