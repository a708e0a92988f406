// expect: a behaviour's plan must return cambium::Plan<View>
// A trajectory is not yet a plan.
struct Hasty {
  template <class View>
  cambium::Trajectory<typename View::State> plan(View const& view, cambium::NoMemory&, double) const {
    return {view.state()};
  }
};
cambium::BehaviorSet<Hasty> set;
