// expect: describe an enum by choice(name, field
enum class Mode { city, motorway };
struct Driver {
  Mode mode = Mode::city;

  static constexpr auto parameters() {
    return cambium::parameter_list(cambium::parameter("mode", &Driver::mode, "-", cambium::Range{0, 1}, "place"));
  }
};
constexpr auto list = Driver::parameters();
