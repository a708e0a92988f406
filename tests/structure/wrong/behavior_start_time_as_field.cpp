// expect: a behaviour's start_time would be ignored; write `double start_time() const`
#include "cambium/behavior/behavior_set.hpp"

struct Mine {
  double start_time = 3.0;

  template <class View>
  cambium::Plan<View> plan(View const&, cambium::NoMemory&, double) const {
    return {};
  }
};
cambium::BehaviorSet<Mine> set;
