// expect: describe an enum by choice(name, field
enum class Mode : std::uint32_t { city, motorway };
struct Driver {
  Mode mode = Mode::city;

  static constexpr auto parameters() {
    return cambium::parameter_list(cambium::parameter("mode", &Driver::mode, "where it drives"));
  }
};
constexpr auto list = Driver::parameters();
