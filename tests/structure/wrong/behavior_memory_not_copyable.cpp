// expect: a behaviour's Memory must be copyable and default constructible
#include <memory>

#include <cambium/behavior/behavior_set.hpp>

struct Hoarder {
  struct Memory {
    std::unique_ptr<double> since;
  };
  template <class View>
  cambium::Plan<View> plan(View const&, Memory&, double) const {
    return {};
  }
};
cambium::BehaviorSet<Hoarder> set;
