// expect: a behaviour's plan must take (View const& view, Memory& memory, double dt)
struct Forgetful {
  template <class View>
  cambium::Plan<View> plan(View const&, double) const {
    return {};
  }
};
cambium::BehaviorSet<Forgetful> set;
