// expect: a behaviour's plan must be const: what it remembers is its Memory
struct Counting {
  int calls = 0;
  template <class View>
  cambium::Plan<View> plan(View const&, cambium::NoMemory&, double) {
    ++calls;
    return {};
  }
};
cambium::BehaviorSet<Counting> set;
