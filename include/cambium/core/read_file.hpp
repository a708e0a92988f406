#pragma once

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include "cambium/core/error.hpp"

namespace cambium {

/// The bytes of a file. Throws `Error` if it cannot be opened or read, is empty, or has more than `most` bytes;
/// `expected` says what to give: "give a scenario file (.json)".
[[nodiscard]] inline std::string read_file(std::filesystem::path const& path, std::string const& expected,
                                           std::size_t most = std::size_t{1} << 31) {
  auto const name = path.empty() ? std::string("''") : path.string();
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file)
    throw Error(name, std::string("the file cannot be opened (") + std::strerror(errno) + ")", "check the path");
  constexpr std::size_t chunk = std::size_t{1} << 20;  // [B]
  errno = 0;
  std::string text;
  while (file) {
    std::size_t const before = text.size();
    if (before > most) throw Error(name, "it has more than " + std::to_string(most) + " bytes", expected);
    text.resize(before + chunk);
    file.read(text.data() + before, static_cast<std::streamsize>(chunk));
    text.resize(before + static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad()) throw Error(name, errno == EISDIR ? "it is a folder" : "it cannot be read to its end", expected);
  if (text.empty()) throw Error(name, "it is empty", expected);
  return text;
}

}  // namespace cambium
