// expect: no matching function for call to

auto corridor(cambium::Map const& map) { return cambium::map::build_road_corridor(map, {10, -1.75}, {500, -1.75}); }
