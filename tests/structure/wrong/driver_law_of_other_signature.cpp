// expect: cambium::Driver<Law, Lateral, Heeds...>: the law must be
struct Slow {
  double desired_speed = 15, time_headway = 1, minimum_gap = 2;
  double maximum_acceleration = 1, comfortable_deceleration = 2, lowest_acceleration = -8;
  static constexpr char const* name = "slow";
  static constexpr auto parameters() { return cambium::parameter_list(); }
  double acceleration(double speed) const { return 1.0 - speed / desired_speed; }
};
void step(WorldOf<cambium::BasicUrbanDriver<Slow>>& world) { (void)world.step(0.1); }
