#include "map_file.hpp"

#include <filesystem>
#include <iostream>
#include <vector>

#include "cambium/core/diagnostic.hpp"
#include "cambium/map/build/center_line_csv.hpp"
#include "cambium/map/build/map_builder.hpp"
#include "cambium/map/opendrive.hpp"

std::shared_ptr<cambium::Map const> examples::load_map(std::string const& file) {
  std::filesystem::path const path(file);
  if (path.extension() == ".csv") {
    cambium::MapBuilder builder(path.stem().string());
    builder.add_road(lane_along(cambium::map::load_center_line_csv(file)));
    return builder.build();
  }
  auto const loaded = cambium::load_opendrive(file);
  for (auto const& diagnostic : loaded.diagnostics)
    if (diagnostic.severity != cambium::Severity::info) std::cerr << to_string(diagnostic) << "\n";
  return loaded.map;
}
