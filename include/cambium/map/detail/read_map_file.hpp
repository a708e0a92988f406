#pragma once

#include <cstddef>
#include <string>

#include "cambium/core/error.hpp"
#include "cambium/core/read_file.hpp"
#include "cambium/map/opendrive/reading_limits.hpp"

namespace cambium::inline v0_1::map::detail {

/// `expected` says what to give: "give an OpenDRIVE file (.xodr)".
[[nodiscard]] inline FileKind map_file(std::string const& expected = {}) {
  return {largest_map_file, expected, "split the map, or remove what is not needed"};
}

/// Throws `MapError` for more than `largest_map_file` bytes, of a file or a text that `name` names.
inline void require_readable(std::size_t bytes, std::string const& name) {
  cambium::require_readable<MapError>(bytes, name, map_file());
}

/// The bytes of a file. Throws `MapError` as `read_file`.
[[nodiscard]] inline std::string read_map_file(std::string const& path, std::string const& expected) {
  return read_file<MapError>(path, map_file(expected));
}

}  // namespace cambium::inline v0_1::map::detail
