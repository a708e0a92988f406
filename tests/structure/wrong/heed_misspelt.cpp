// expect: cambium::Driver<Law, Lateral, Heeds...>: each heed must have
struct Fog {
  static constexpr char const *name = "fog", *summary = "drives slowly in fog";
  static constexpr auto parameters() { return cambium::parameter_list(); }
  template <class View, class Limits>
  void heeds(View const&, Limits&, double) const {}
};
using Own = cambium::Driver<cambium::Idm, cambium::KeepLane, Fog>;
using Set = cambium::BehaviorSet<Own>;
void step(cambium::World<Set, cambium::InterpolateExecution, cambium::SingleTrack>& world) { (void)world.step(0.1); }
