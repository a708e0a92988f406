// expect: leave out a field, or name those of a Memory in another order
struct Memory {
  int steps = 0;
  short counted = 0;
  bool is_new = true;
  static constexpr char const* name = "memory";
  static constexpr auto parameters() {
    return cambium::parameter_list(
        cambium::parameter("steps", &Memory::steps, "-", cambium::Range{0, 1e9}, "so far"),
        cambium::parameter("counted", &Memory::counted, "-", cambium::Range{0, 1e4}, "turns"));
  }
  friend bool operator==(Memory const&, Memory const&) = default;
};
std::string save(WorldOf<Remembers<Memory>> const& world) { return cambium::to_snapshot({}, world); }
