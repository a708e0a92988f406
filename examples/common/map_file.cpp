#include "map_file.hpp"

#include <filesystem>
#include <iostream>
#include <system_error>
#include <vector>

#include "cambium/core/diagnostic.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/map/building/center_line_csv.hpp"
#include "cambium/map/building/map_builder.hpp"
#include "cambium/map/lanelet/lanelet2.hpp"
#include "cambium/map/opendrive.hpp"
#include "cambium/scenario/dataset/common_road.hpp"

std::shared_ptr<cambium::Map const> examples::load_map(std::string const& file,
                                                       std::optional<cambium::map::Lanelet2Origin> const& origin) {
  std::filesystem::path const path(file);
  if (std::error_code none; std::filesystem::is_directory(path, none))
    throw cambium::MapError(file, "it is a folder", "give a map in it: a file that ends in .xodr, .osm, .xml or .csv");
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
    auto const loaded = cambium::map::load_lanelet2(file, origin);
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

std::optional<cambium::map::Lanelet2Origin> examples::origin_of(std::vector<double> const& words,
                                                                std::string const& file) {
  if (words.empty()) return std::nullopt;
  if (std::filesystem::path(file).extension() != ".osm")
    throw cambium::Error("--origin", "only Lanelet2 maps have an origin",
                         "leave it out, or give a map that ends in .osm");
  cambium::map::Lanelet2Origin const origin{.latitude = words[0], .longitude = words[1]};
  cambium::check_parameters(origin, "--origin");
  return origin;
}
