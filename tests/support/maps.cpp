#include "maps.hpp"

#include <cstddef>
#include <utility>

#include "cambium/map/map_builder.hpp"
#include "cambium/map/opendrive.hpp"
#include "corpus.hpp"

namespace support {

std::shared_ptr<cambium::Map const> map_of(cambium::map::RoadPlan road) {
  cambium::MapBuilder builder;
  builder.add_road(std::move(road));
  return builder.build();
}

std::shared_ptr<cambium::Map const> straight_road(int lanes, double length, double curvature) {
  return map_of({.id = "1",
                 .line = cambium::map::lay_from({}, {{length, curvature, curvature}}),
                 .sections = {{.right = cambium::map::equal_lanes(static_cast<std::size_t>(lanes))}}});
}

std::shared_ptr<cambium::Map const> two_way_road(double length) {
  auto const lane = cambium::map::equal_lanes(1);
  return map_of(
      {.id = "1", .line = cambium::map::lay_from({}, {{length}}), .sections = {{.left = lane, .right = lane}}});
}

std::shared_ptr<cambium::Map const> own_map(std::string const& name) {
  return cambium::load_opendrive(CAMBIUM_SOURCE_DIR "/maps/" + name).map;
}

std::shared_ptr<cambium::Map const> corpus_map(std::string const& name) {
  auto const file = corpus::find("opendrive/" + name);
  return file ? cambium::load_opendrive(file->string()).map : nullptr;
}

Loaded load_opendrive(std::string const& path, cambium::MapOptions const& options) {
  auto [map, diagnostics] = cambium::load_opendrive(path, options);
  return {std::move(map), std::move(diagnostics)};
}

Loaded parse_opendrive(std::string_view text, cambium::MapOptions const& options, std::string const& file) {
  auto [map, diagnostics] = cambium::parse_opendrive(text, options, file);
  return {std::move(map), std::move(diagnostics)};
}

cambium::map::OpenDriveDocument read_opendrive_document(std::string_view text, std::string file,
                                                        std::vector<cambium::Diagnostic>& diagnostics) {
  return cambium::map::read_opendrive_document(text, std::move(file), diagnostics);
}

cambium::map::OpenDriveDocument load_opendrive_document(std::string const& path,
                                                        std::vector<cambium::Diagnostic>& diagnostics) {
  return cambium::map::load_opendrive_document(path, diagnostics);
}

std::shared_ptr<cambium::Map const> build_map(cambium::map::OpenDriveDocument const& document,
                                              cambium::MapOptions const& options, std::string file,
                                              std::vector<cambium::Diagnostic>& diagnostics) {
  return cambium::map::build_map(document, options, std::move(file), diagnostics);
}

}  // namespace support
