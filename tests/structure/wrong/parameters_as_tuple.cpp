// expect: a struct's parameters() must return cambium::parameter_list(
struct Old {
  double x = 0.0;
  static constexpr char const* name = "old";
  static constexpr auto parameters() { return std::make_tuple(cambium::parameter("x", &Old::x, "m", {}, "old")); }
};

void f(Old const& old) { cambium::check_parameters(old, "old"); }
