// expect: cambium::Driver<Law, Lateral, Heeds...>: a heed must take the Limits, and its Memory, by reference
struct Wall {
  static constexpr char const *name = "wall", *summary = "stops before a wall";
  static constexpr auto parameters() { return cambium::parameter_list(); }
  template <class View, class Limits>
  void heed(View const&, Limits limits, double) const {
    limits.heed({10.0, 0.0});
  }
};
void step(WorldOf<cambium::IdmClassic::Also<Wall>>& world) { (void)world.step(0.1); }
