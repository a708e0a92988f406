// expect: two numbers are no pose; give the heading too
bool is_on_lane(cambium::Map const& map) { return map.nearest_lane({10, -1.75}).has_value(); }
