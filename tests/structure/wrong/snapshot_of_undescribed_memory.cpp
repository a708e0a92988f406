// expect: cambium: a snapshot holds only models and memories that describe their fields
struct Memory {
  int steps = 0;
  friend bool operator==(Memory const&, Memory const&) = default;
};
std::string save(WorldOf<Remembers<Memory>> const& world) { return cambium::to_snapshot({}, world); }
