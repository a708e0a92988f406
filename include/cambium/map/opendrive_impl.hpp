#pragma once

#include <utility>

#include "cambium/core/macros.hpp"
#include "cambium/map/building/build_map.hpp"
#include "cambium/map/detail/read_map_file.hpp"
#include "cambium/map/opendrive.hpp"
#include "cambium/map/opendrive/reader.hpp"

namespace cambium::inline v0_1::map {

CAMBIUM_COLD LoadedMap parse_opendrive(std::string_view text, MapOptions const& options, std::string const& file) {
  LoadedMap result;
  auto document = read_opendrive_document(text, file, result.diagnostics);
  result.map = build_map(std::move(document), options, file, result.diagnostics);
  return result;
}

CAMBIUM_COLD LoadedMap load_opendrive(std::string const& path, MapOptions const& options) {
  return parse_opendrive(detail::read_map_file(path, "give an OpenDRIVE file (.xodr)"), options, path);
}

CAMBIUM_COLD OpenDriveDocument load_opendrive_document(std::string const& path, std::vector<Diagnostic>& diagnostics) {
  return read_opendrive_document(detail::read_map_file(path, "give an OpenDRIVE file (.xodr)"), path, diagnostics);
}

}  // namespace cambium::inline v0_1::map
