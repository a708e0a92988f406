// expect: cambium::ChangeLanes<Rule>: the rule must be
struct Overtake {
  static constexpr char const* name = "overtake";
  static constexpr auto parameters() { return cambium::parameter_list(); }
  template <class Choice>
  bool operator()(Choice const& now) const {
    return now.may_change;
  }
};
void step(WorldOf<cambium::Driver<cambium::Idm, cambium::ChangeLanes<Overtake>>>& world) { (void)world.step(0.1); }
