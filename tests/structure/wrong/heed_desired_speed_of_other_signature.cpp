// expect: cambium::Driver<Law, Lateral, Heeds...>: a heed's desired_speed must be
struct Fog {
  static constexpr char const *name = "fog", *summary = "drives slowly in fog";
  static constexpr auto parameters() { return cambium::parameter_list(); }
  template <class View>
  double desired_speed(View const&) const {
    return 5.0;
  }
  template <class View, class Limits>
  void heed(View const&, Limits&, double) const {}
};
void step(WorldOf<cambium::IdmClassic::Also<Fog>>& world) { (void)world.step(0.1); }
