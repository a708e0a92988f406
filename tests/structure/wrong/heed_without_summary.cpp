// expect: cambium::Driver<Law, Lateral, Heeds...>: each heed must be
struct Fog {
  static constexpr char const* name = "fog";
  static constexpr auto parameters() { return cambium::parameter_list(); }
  template <class View, class Limits>
  void heed(View const&, Limits&, double) const {}
};
void step(WorldOf<cambium::IdmClassic::Also<Fog>>& world) { (void)world.step(0.1); }
