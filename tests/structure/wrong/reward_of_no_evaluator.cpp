// expect: cambium::Terms<Evaluators...>: each must have `template <class World> auto operator()(World&, Slot) const`
struct Mood {
  static constexpr char const* name = "mood";
  static constexpr auto parameters() { return cambium::parameter_list(); }
};

auto judge(Sim& world) { return cambium::Reward<Mood>{}.judge(world, cambium::Slot{}, 0.2); }
