// Makes the map, and says how far the other translation unit drives on it.

#include <cambium/map/opendrive.hpp>

#include <iostream>

double drive(std::shared_ptr<cambium::Map const> const& map);

int main() {
  double const way = drive(cambium::load_opendrive(CAMBIUM_SOURCE_DIR "/maps/merging.xodr").map);
  std::cout << "drove " << way << " m\n";
  return way > 90.0 && way < 300.0 ? 0 : 1;
}
