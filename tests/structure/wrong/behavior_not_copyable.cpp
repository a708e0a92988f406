// expect: a behaviour must be a copyable struct
#include <memory>

#include <cambium/behavior/behavior_set.hpp>

struct Unique {
  std::unique_ptr<double> speed;
  template <class View>
  cambium::Plan<View> plan(View const&, cambium::NoMemory&, double) const {
    return {};
  }
};
cambium::BehaviorSet<Unique> set;
