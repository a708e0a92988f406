// expect: a behaviour's plan must take (View const& view, Memory& memory, double dt)
// It names a Memory, and takes none.
struct Confused {
  struct Memory {
    double since = 0.0;
  };
  template <class View>
  cambium::Plan<View> plan(View const&, cambium::NoMemory&, double) const {
    return {};
  }
};
cambium::BehaviorSet<Confused> set;
