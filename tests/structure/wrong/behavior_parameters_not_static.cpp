// expect: a behaviour's parameters would not be checked; write `static constexpr auto parameters()`
#include "cambium/behavior/behavior_set.hpp"

struct Mine {
  double speed = 1.0;
  auto parameters() const {
    return cambium::parameter_list(cambium::parameter("speed", &Mine::speed, "m/s", cambium::Range{0, 9}, "desired"));
  }

  template <class View>
  cambium::Plan<View> plan(View const&, cambium::NoMemory&, double) const {
    return {};
  }
};
cambium::BehaviorSet<Mine> set;
