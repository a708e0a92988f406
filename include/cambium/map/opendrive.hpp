#pragma once

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "cambium/core/diagnostic.hpp"
#include "cambium/map/build_map.hpp"
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

namespace detail {

/// The bytes of a file. Throws `MapError` where it cannot be read, is empty, or beyond any map.
[[nodiscard]] inline std::string read_map_file(std::string const& path) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file)
    throw MapError(path, std::string("the file cannot be opened (") + std::strerror(errno) + ")", "check the path");
  constexpr std::size_t largest = std::size_t{1} << 30, chunk = std::size_t{1} << 20;  // [B]: beyond any map
  std::string text;
  while (file) {
    if (text.size() > largest) throw MapError(path, "it is larger than 1 GiB", "give an OpenDRIVE file (.xodr)");
    std::size_t const before = text.size();
    text.resize(before + chunk);
    file.read(text.data() + before, static_cast<std::streamsize>(chunk));
    text.resize(before + static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad() || text.empty())  // a folder opens, but cannot be read
    throw MapError(path, "it is empty or cannot be read as a file", "give an OpenDRIVE file (.xodr)");
  return text;
}

}  // namespace detail

/// The map of an OpenDRIVE file (.xodr). Throws `MapError` as `parse_opendrive`, and where the file cannot be read.
[[nodiscard]] inline LoadedMap load_opendrive(std::string const& path, MapOptions const& options = {}) {
  return parse_opendrive(detail::read_map_file(path), options, path);
}

/// All that an OpenDRIVE file says (signals, objects and user data too), to look at, change, write again, or make a map
/// of with `build_map`. Throws `MapError` as `load_opendrive`.
[[nodiscard]] inline OpenDriveDocument load_opendrive_document(std::string const& path,
                                                               std::vector<Diagnostic>& diagnostics) {
  return read_opendrive_document(detail::read_map_file(path), path, diagnostics);
}

}  // namespace cambium::map

namespace cambium {
using map::load_opendrive;
using map::LoadedMap;
using map::parse_opendrive;
}  // namespace cambium
