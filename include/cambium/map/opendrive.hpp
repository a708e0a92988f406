#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "cambium/core/diagnostic.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/opendrive/document.hpp"

#ifdef CAMBIUM_COMPILED_WITHOUT_READER
#error "cambium::compiled has no OpenDRIVE reader because CMake did not find pugixml: install it (libpugixml-dev)"
#endif

namespace cambium::inline v0_1::map {

/// A map read from a file, and the findings about it.
struct LoadedMap {
  std::shared_ptr<Map const> map;
  std::vector<Diagnostic> diagnostics;
};

/// The map of an OpenDRIVE text; `file` names it in messages. Throws `MapError` (file, line, what, remedy) where it is
/// not XML, has no usable road, or is beyond the limits in reading_limits.hpp; everything else that is odd becomes a
/// diagnostic. Throws `ParameterError` for options out of range.
[[nodiscard]] LoadedMap parse_opendrive(std::string_view text, MapOptions const& options = {},
                                        std::string const& file = "text");

/// The map of an OpenDRIVE file (.xodr). Throws as `parse_opendrive`, and `MapError` where the file cannot be
/// read.
[[nodiscard]] LoadedMap load_opendrive(std::string const& path, MapOptions const& options = {});

/// All that an OpenDRIVE file says (signals, objects and user data too), to look at, change, write again, or make a map
/// of with `build_map`. Throws `MapError` as `load_opendrive`.
[[nodiscard]] OpenDriveDocument load_opendrive_document(std::string const& path, std::vector<Diagnostic>& diagnostics);

}  // namespace cambium::inline v0_1::map

namespace cambium::inline v0_1 {
using map::load_opendrive;
using map::LoadedMap;
using map::parse_opendrive;
}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/map/opendrive_impl.hpp"
#endif
