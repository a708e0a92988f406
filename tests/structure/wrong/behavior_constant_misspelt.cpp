// expect: what a behaviour says to worlds is `static constexpr bool looks_beside`, looks_around or heeds_conflicts
#include "cambium/behavior/behavior_set.hpp"

struct Mine {
  static constexpr bool looks_besides = true;

  template <class View>
  cambium::Plan<View> plan(View const&, cambium::NoMemory&, double) const {
    return {};
  }
};
cambium::BehaviorSet<Mine> set;
