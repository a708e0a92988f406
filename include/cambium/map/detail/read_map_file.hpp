#pragma once

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <string>

#include "cambium/core/error.hpp"
#include "cambium/map/opendrive/reading_limits.hpp"

namespace cambium::map::detail {

/// How many bytes the file says that it has; 0 where it does not, as pipes, or is a folder.
[[nodiscard]] inline std::size_t size_of(std::ifstream& file) {
  auto const size = static_cast<std::streamoff>(file.seekg(0, std::ios::end).tellg());
  file.clear();
  file.seekg(0);
  file.clear();
  constexpr std::streamoff folder = std::streamoff{1} << 62;
  return size < 0 || size >= folder ? 0 : static_cast<std::size_t>(size);
}

/// Throws `MapError` for more than `largest_map_file` bytes, of a file or a text that `name` names.
inline void require_readable(std::size_t bytes, std::string const& name, char const* at_least = "") {
  if (bytes > largest_map_file)
    throw MapError(name,
                   "it has " + (at_least + std::to_string(bytes)) + " bytes, more than the " +
                       std::to_string(largest_map_file) + " that are read",
                   "split the map, or remove what is not needed");
}

/// The bytes of a file. Throws `MapError` where it cannot be read, is empty, or larger than `largest_map_file` (before
/// memory is taken, where it tells its size); `expected` says what to give: "give an OpenDRIVE file (.xodr)".
[[nodiscard]] inline std::string read_map_file(std::string const& path, std::string const& expected) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file)
    throw MapError(path.empty() ? "''" : path, std::string("the file cannot be opened (") + std::strerror(errno) + ")",
                   "check the path");
  constexpr std::size_t chunk = std::size_t{1} << 20;  // [B]
  auto const size = size_of(file);
  require_readable(size, path);
  errno = 0;
  std::string text;
  text.reserve(size + chunk);
  while (file) {
    require_readable(text.size(), path, "at least ");
    std::size_t const before = text.size();
    text.resize(before + chunk);
    file.read(text.data() + before, static_cast<std::streamsize>(chunk));
    text.resize(before + static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad()) throw MapError(path, errno == EISDIR ? "it is a folder" : "it cannot be read to its end", expected);
  if (text.empty()) throw MapError(path, "it is empty", expected);
  return text;
}

}  // namespace cambium::map::detail
