#pragma once

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <string>

#include "cambium/core/error.hpp"

namespace cambium::map::detail {

/// The bytes of a file. Throws `MapError` where it cannot be read, is empty, or beyond any map; `expected` says what to
/// give: "give an OpenDRIVE file (.xodr)".
[[nodiscard]] inline std::string read_map_file(std::string const& path, std::string const& expected) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file)
    throw MapError(path, std::string("the file cannot be opened (") + std::strerror(errno) + ")", "check the path");
  constexpr std::size_t largest = std::size_t{1} << 30, chunk = std::size_t{1} << 20;  // [B]: beyond any map
  std::string text;
  while (file) {
    if (text.size() > largest) throw MapError(path, "it is larger than 1 GiB", expected);
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
