// expect: a behaviour's parameters would not be checked; write `static constexpr auto parameters()`
struct Mine : Idle {
  double speed = 1.0;
  auto parameters() const {
    return cambium::parameter_list(cambium::parameter("speed", &Mine::speed, "m/s", cambium::Range{0, 9}, "desired"));
  }
};
cambium::BehaviorSet<Mine> set;
