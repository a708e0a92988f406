#pragma once

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <string>

#include "cambium/core/error.hpp"

namespace cambium::inline v0_1 {

/// What `read_file` takes for a file of its kind.
struct FileKind {
  std::size_t largest = std::size_t{512} << 20;  ///< most bytes that are read
  std::string expected{};                        ///< what to give: "give an OpenDRIVE file (.xodr)"
  std::string smaller{};                         ///< what to do with a larger one: "split the map"
};

/// Throws `Kind`, an `Error`, for more than `kind.largest` bytes of a file or a text that `name` names.
template <class Kind>
void require_readable(std::size_t bytes, std::string const& name, FileKind const& kind, char const* at_least = "") {
  if (bytes > kind.largest)
    throw Kind(name,
               "it has " + (at_least + std::to_string(bytes)) + " bytes, more than the " +
                   std::to_string(kind.largest) + " that are read",
               kind.smaller);
}

namespace detail {
/// File size [bytes]; 0 if unknown (pipes, folders).
[[nodiscard]] inline std::size_t size_of(std::ifstream& file) {
  auto const size = static_cast<std::streamoff>(file.seekg(0, std::ios::end).tellg());
  file.clear();
  file.seekg(0);
  file.clear();
  constexpr std::streamoff folder = std::streamoff{1} << 62;
  return size < 0 || size >= folder ? 0 : static_cast<std::size_t>(size);
}
}  // namespace detail

/// The bytes of a file. Throws `Kind`, an `Error`, where it cannot be read, is empty, or larger than `kind.largest`
/// (before memory is taken, where it tells its size).
template <class Kind>
[[nodiscard]] std::string read_file(std::string const& path, FileKind const& kind) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file)
    throw Kind(path.empty() ? "''" : path, std::string("the file cannot be opened (") + std::strerror(errno) + ")",
               "check the path");
  constexpr std::size_t chunk = std::size_t{1} << 20;  // [B]
  auto const size = detail::size_of(file);
  require_readable<Kind>(size, path, kind);
  errno = 0;
  std::string text;
  text.reserve(size + chunk);
  while (file) {
    require_readable<Kind>(text.size(), path, kind, "at least ");
    std::size_t const before = text.size();
    text.resize(before + chunk);
    file.read(text.data() + before, static_cast<std::streamsize>(chunk));
    text.resize(before + static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad()) throw Kind(path, errno == EISDIR ? "it is a folder" : "it cannot be read to its end", kind.expected);
  if (text.empty()) throw Kind(path, "it is empty", kind.expected);
  return text;
}

}  // namespace cambium::inline v0_1
