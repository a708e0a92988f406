#include "map_file.hpp"

#include <filesystem>
#include <iostream>
#include <vector>

#include "cambium/core/diagnostic.hpp"
#include "cambium/map/building/center_line_csv.hpp"
#include "cambium/map/building/map_builder.hpp"
#include "cambium/map/lanelet/lanelet2.hpp"
#include "cambium/map/opendrive.hpp"
#include "cambium/scenario/dataset/common_road.hpp"

std::shared_ptr<cambium::Map const> examples::load_map(std::string const& file) {
  std::filesystem::path const path(file);
  if (path.extension() == ".csv") {
    cambium::MapBuilder builder(path.stem().string());
    builder.add_road(lane_along(cambium::map::load_center_line_csv(file)));
    return builder.build();
  }
  auto const warn = [](std::vector<cambium::Diagnostic> const& diagnostics) {
    for (auto const& diagnostic : diagnostics)
      if (diagnostic.severity != cambium::Severity::info) std::cerr << to_string(diagnostic) << "\n";
  };
  if (path.extension() == ".osm") {
    auto const loaded = cambium::load_lanelet2(file);
    warn(loaded.diagnostics);
    return loaded.map;
  }
  if (path.extension() == ".xml") {
    auto const loaded = cambium::load_common_road(file);
    warn(loaded.diagnostics);
    if (!loaded.map) throw cambium::MapError(file, "it has no lanelets", "give a CommonRoad scenario with lanelets");
    return loaded.map;
  }
  auto const loaded = cambium::load_opendrive(file);
  warn(loaded.diagnostics);
  return loaded.map;
}
