#include "map_file.hpp"

#include <filesystem>
#include <iostream>

#include "cambium/map/build_map.hpp"
#include "cambium/map/center_line_csv.hpp"
#include "cambium/map/map_builder.hpp"
#include "cambium/map/opendrive.hpp"

examples::OpenedMap examples::open_map(std::string const& file, cambium::MapOptions const& options) {
  OpenedMap opened;
  std::filesystem::path const path(file);
  if (path.extension() == ".csv") {
    cambium::map::MapBuilder builder(path.stem().string());
    builder.add_road(lane_along(cambium::map::load_center_line_csv(file)));
    opened.document = builder.document();
  } else {
    opened.document = cambium::map::load_opendrive_document(file, opened.diagnostics);
  }
  opened.map = cambium::map::build_map(opened.document, options, file, opened.diagnostics);
  return opened;
}

std::shared_ptr<cambium::Map const> examples::load_map(std::string const& file) {
  auto opened = open_map(file);
  for (auto const& diagnostic : opened.diagnostics)
    if (diagnostic.severity != cambium::Severity::info) std::cerr << to_string(diagnostic) << "\n";
  return opened.map;
}
