// expect: no matching function for call to
#include <cambium/map/corridor/build_corridor.hpp>

auto corridor(cambium::Map const& map) { return cambium::map::build_road_corridor(map, {10, -1.75}, {500, -1.75}); }
