// expect: a number needs a unit and a range
struct Driver {
  double speed = 15.0;

  static constexpr auto parameters() {
    return cambium::parameter_list(cambium::parameter("speed", &Driver::speed, "on a free road"));
  }
};
constexpr auto list = Driver::parameters();
