// expect: cambium::BehaviorSet<...>: each alternative must be a behaviour: a copyable struct with `template <class View> Plan<View> plan
#include <cambium/behavior/behavior_set.hpp>

// A trajectory is not yet a plan.
struct Hasty {
  template <class View>
  cambium::Trajectory<typename View::State> plan(View const& view, cambium::NoMemory&, double) const {
    return {view.state()};
  }
};
cambium::BehaviorSet<Hasty> set;
