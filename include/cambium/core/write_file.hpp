#pragma once

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

#include "cambium/core/error.hpp"

namespace cambium {

/// Writes `text` to `path` atomically: it writes a new file in the same folder and renames it, so readers never see
/// half a file, and a failure keeps the old one. Follows symbolic links; writes directly to anything that is not a
/// regular file, such as a pipe. Throws `Error` with the path and the system's reason.
inline void write_file(std::filesystem::path const& path, std::string_view text) {
  std::error_code none;
  auto const fail = [&path, &none](std::error_code const& reason) {
    bool const is_full = reason == std::errc::no_space_on_device || reason == std::errc::file_too_large;
    throw Error(path.string(), "cannot be written (" + reason.message() + ")",
                is_full ? "make room there, or write elsewhere"
                : std::filesystem::is_directory(path, none)
                    ? "name a file, not a folder"
                    : "name a file in a folder that exists and that you may write to");
  };
  auto const target = std::filesystem::is_symlink(path, none) ? std::filesystem::weakly_canonical(path, none) : path;
  bool const is_special = std::filesystem::exists(target, none) && !std::filesystem::is_regular_file(target, none) &&
                          !std::filesystem::is_directory(target, none);
  std::filesystem::path part = target;
  for (int i = 0; !is_special && (i == 0 || std::filesystem::exists(part, none)); ++i) {
    part = target;
    part += ".part" + (i == 0 ? std::string() : std::to_string(i));
  }
  errno = 0;
  std::ofstream file(part, std::ios::binary | std::ios::trunc);
  auto const reason = [] {
    return errno == 0 ? std::make_error_code(std::errc::io_error) : std::error_code(errno, std::generic_category());
  };
  if (!file) fail(reason());
  file.write(text.data(), static_cast<std::streamsize>(text.size()));
  file.close();
  std::error_code problem;
  if (!file)
    problem = reason();
  else if (!is_special)
    std::filesystem::rename(part, target, problem);
  if (!problem) return;
  if (!is_special) std::filesystem::remove(part, none);
  fail(problem);
}

}  // namespace cambium
