// expect: cambium: a snapshot holds only models and memories that describe their fields
// also: a field must be a number
std::string save(BlurredSim const& world) { return cambium::to_snapshot({}, world); }
