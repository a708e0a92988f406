#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "cambium/core/diagnostic.hpp"
#include "cambium/map/curve_layout.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/opendrive_document.hpp"
#include "cambium/map/road_plan.hpp"

/// Maps for tests, built in one translation unit so that the others need not compile what builds them.
namespace support {

/// A road "1" from the origin along +x with `lanes` lanes of 3.5 m to the right of the reference line.
std::shared_ptr<cambium::Map const> straight_road(int lanes = 2, double length = 1000.0, double curvature = 0.0);

/// The same with one lane in each direction, the axis between them.
std::shared_ptr<cambium::Map const> two_way_road(double length);

/// The project's own map of that file name.
std::shared_ptr<cambium::Map const> own_map(std::string const& name);

/// The map of one road.
std::shared_ptr<cambium::Map const> map_of(cambium::map::RoadPlan road);

/// The map of an OpenDRIVE file of the corpus; null where there is no corpus (see `corpus::find`).
std::shared_ptr<cambium::Map const> corpus_map(std::string const& name);

/// The library's functions of these names.
struct Loaded {
  std::shared_ptr<cambium::Map const> map;
  std::vector<cambium::Diagnostic> diagnostics;
};
Loaded load_opendrive(std::string const& path, cambium::MapOptions const& options = {});
Loaded parse_opendrive(std::string_view text, cambium::MapOptions const& options = {},
                       std::string const& file = "text");
cambium::map::OpenDriveDocument read_opendrive_document(std::string_view text, std::string file,
                                                        std::vector<cambium::Diagnostic>& diagnostics);
cambium::map::OpenDriveDocument load_opendrive_document(std::string const& path,
                                                        std::vector<cambium::Diagnostic>& diagnostics);
std::shared_ptr<cambium::Map const> build_map(cambium::map::OpenDriveDocument const& document,
                                              cambium::MapOptions const& options, std::string file,
                                              std::vector<cambium::Diagnostic>& diagnostics);

}  // namespace support
