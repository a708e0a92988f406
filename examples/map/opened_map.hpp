#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cambium/core/diagnostic.hpp"
#include "cambium/map/building/build_map.hpp"
#include "cambium/map/building/center_line_csv.hpp"
#include "cambium/map/building/map_builder.hpp"
#include "cambium/map/lanelet/lanelet2.hpp"
#include "cambium/map/opendrive.hpp"
#include "cambium/map/opendrive/document.hpp"
#include "cambium/scenario/dataset/common_road.hpp"

namespace map_example {

/// A map file: its content, the map built from it, and the diagnostics.
struct OpenedMap {
  cambium::map::OpenDriveDocument document{};  ///< without roads where the file has lanelets
  std::string lanelets{};                      ///< what a file with lanelets is
  std::shared_ptr<cambium::Map const> map{};
  std::vector<cambium::Diagnostic> diagnostics{};
};

/// Reads an OpenDRIVE file, a Lanelet2 map (.osm), a CommonRoad scenario (.xml), or a centre line from a table (.csv),
/// which becomes a road of one lane. `origin` is that of a Lanelet2 map. Throws `cambium::MapError`.
inline OpenedMap open_map(std::string const& file, cambium::MapOptions const& options,
                          std::optional<cambium::map::Lanelet2Origin> const& origin = {}) {
  OpenedMap opened;
  std::filesystem::path const path(file);
  if (path.extension() == ".osm") {
    auto loaded = cambium::map::load_lanelet2(file, origin, options);
    return {.lanelets = "Lanelet2, " + std::to_string(loaded.lanes.size()) + " lanelets",
            .map = std::move(loaded.map),
            .diagnostics = std::move(loaded.diagnostics)};
  }
  if (path.extension() == ".xml") {
    auto loaded = cambium::load_common_road(file, options);
    if (!loaded.map) throw cambium::MapError(file, "it has no lanelets", "give a CommonRoad scenario with lanelets");
    return {.lanelets = "CommonRoad \"" + loaded.name + "\", " + std::to_string(loaded.lanes.size()) + " lanelets",
            .map = std::move(loaded.map),
            .diagnostics = std::move(loaded.diagnostics)};
  }
  if (path.extension() == ".csv") {
    cambium::MapBuilder builder(path.stem().string());
    builder.add_road(lane_along(cambium::map::load_center_line_csv(file)));
    opened.document = builder.document();
  } else {
    opened.document = cambium::map::load_opendrive_document(file, opened.diagnostics);
  }
  opened.map = cambium::map::build_map(opened.document, options, file, opened.diagnostics);
  return opened;
}

}  // namespace map_example
