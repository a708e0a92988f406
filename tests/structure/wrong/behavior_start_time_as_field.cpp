// expect: a behaviour's start_time would be ignored; write `double start_time() const`
struct Mine : Idle {
  double start_time = 3.0;
};
cambium::BehaviorSet<Mine> set;
