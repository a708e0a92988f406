#include "map_file.hpp"

#include <iostream>

#include "cambium/map/opendrive.hpp"

std::shared_ptr<cambium::Map const> examples::load_map(std::string const& file) {
  auto const loaded = cambium::load_opendrive(file);
  for (auto const& diagnostic : loaded.diagnostics)
    if (diagnostic.severity != cambium::Severity::info) std::cerr << to_string(diagnostic) << "\n";
  return loaded.map;
}
