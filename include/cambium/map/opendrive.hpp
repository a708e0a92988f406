#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "cambium/core/diagnostic.hpp"
#include "cambium/map/build_map.hpp"
#include "cambium/map/detail/read_map_file.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/opendrive_reader.hpp"

namespace cambium::map {

/// A map that was read, and what was odd about it.
struct LoadedMap {
  std::shared_ptr<Map const> map;
  std::vector<Diagnostic> diagnostics;
};

/// The map of an OpenDRIVE text; `file` names it in messages. Throws `MapError` (file, line, what, remedy) where it is
/// not XML or has no usable road; everything else that is odd becomes a diagnostic.
[[nodiscard]] inline LoadedMap parse_opendrive(std::string_view text, MapOptions const& options = {},
                                               std::string const& file = "text") {
  LoadedMap result;
  auto const document = read_opendrive_document(text, file, result.diagnostics);
  result.map = build_map(document, options, file, result.diagnostics);
  return result;
}

/// The map of an OpenDRIVE file (.xodr). Throws `MapError` as `parse_opendrive`, and where the file cannot be read.
[[nodiscard]] inline LoadedMap load_opendrive(std::string const& path, MapOptions const& options = {}) {
  return parse_opendrive(detail::read_map_file(path, "give an OpenDRIVE file (.xodr)"), options, path);
}

/// All that an OpenDRIVE file says (signals, objects and user data too), to look at, change, write again, or make a map
/// of with `build_map`. Throws `MapError` as `load_opendrive`.
[[nodiscard]] inline OpenDriveDocument load_opendrive_document(std::string const& path,
                                                               std::vector<Diagnostic>& diagnostics) {
  return read_opendrive_document(detail::read_map_file(path, "give an OpenDRIVE file (.xodr)"), path, diagnostics);
}

}  // namespace cambium::map

namespace cambium {
using map::load_opendrive;
using map::LoadedMap;
using map::parse_opendrive;
}  // namespace cambium
