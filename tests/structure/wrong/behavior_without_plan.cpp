// expect: each alternative must be a behaviour, and this one has no function plan
struct Dreamer {
  double desired_speed = 10.0;
};
cambium::BehaviorSet<Dreamer> set;
