// expect: cambium: a snapshot holds only models and memories that describe their fields
struct Memory {
  int steps = 0;
  static constexpr char const* name = "memory";
  static constexpr auto parameters() {
    return cambium::parameter_list(cambium::parameter("steps", &Memory::steps, "-", cambium::Range{0, 1e9}, "so far"));
  }
  friend bool operator==(Memory const&, Memory const&) = default;
};
std::string save(WorldOf<Undescribed<Memory>> const& world) { return cambium::to_snapshot({}, world); }
