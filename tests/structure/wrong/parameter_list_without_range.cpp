// expect: a number needs a unit and a range
struct Driver {
  std::vector<std::vector<double>> speeds;

  static constexpr auto parameters() {
    return cambium::parameter_list(cambium::parameter("speeds", &Driver::speeds, "on free roads"));
  }
};
constexpr auto list = Driver::parameters();
