// expect: leave out a field, or name those of a Memory in another order
struct Counts {
  double speed = 1.0;
  double forgotten = 2.0;
  static constexpr char const* name = "counts";
  static constexpr auto parameters() {
    return cambium::parameter_list(
        cambium::parameter("speed", &Counts::speed, "m/s", cambium::positive, "of those who count"));
  }
  template <class View>
  cambium::Plan<View> plan(View const&, cambium::NoMemory&, double) const {
    return {};
  }
};
std::string save(WorldOf<Counts> const& world) { return cambium::to_snapshot({}, world); }
