// expect: two numbers are no pose; give the heading too
bool is_still_there(cambium::Map const& map, cambium::map::LaneHit const& before, double x) {
  return map.nearest_lane({x, -1.75}, before).has_value();
}
