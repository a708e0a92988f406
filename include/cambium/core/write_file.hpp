#pragma once

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

#include "cambium/core/error.hpp"

namespace cambium::inline v0_1 {

namespace detail {

/// Opens a file in the mode of `fopen` and writes `text`. Returns the system's reason if that fails; `file_exists`
/// where the mode is "wbx", for new files, and there is one. Nothing half written is left of a new file.
[[nodiscard]] inline std::error_code write_text(std::filesystem::path const& path, char const* mode,
                                                std::string_view text) {
  auto const reason = [] {
    return errno == 0 ? std::make_error_code(std::errc::io_error) : std::error_code(errno, std::generic_category());
  };
  errno = 0;
  auto* const file = std::fopen(path.string().c_str(), mode);
  if (file == nullptr) return reason();
  std::error_code problem, none;
  if (std::fwrite(text.data(), 1, text.size(), file) != text.size()) problem = reason();
  if (std::fclose(file) != 0 && !problem) problem = reason();
  if (problem && std::string_view(mode) == "wbx") std::filesystem::remove(path, none);
  return problem;
}

/// The error of a file that cannot be written.
[[nodiscard]] inline Error cannot_write(std::filesystem::path const& path, std::error_code const& reason) {
  std::error_code none;
  bool const is_full = reason == std::errc::no_space_on_device || reason == std::errc::file_too_large;
  return Error(path.empty() ? "a file without a name" : path.string(), "cannot be written (" + reason.message() + ")",
               is_full ? "make room there, or write elsewhere"
               : std::filesystem::is_directory(path, none)
                   ? "name a file, not a folder"
                   : "name a file in a folder that exists and that you may write to");
}

}  // namespace detail

/// Writes `text` to `path` atomically: it writes a new file in the same folder and renames it, so readers never see
/// half a file, and a failure keeps the old one. Follows symbolic links; writes directly to anything that is not a
/// regular file, such as a pipe. Throws `Error` with the path and the system's reason.
inline void write_file(std::filesystem::path const& path, std::string_view text) {
  std::error_code none, problem;
  auto const target = std::filesystem::is_symlink(path, none) ? std::filesystem::weakly_canonical(path, none) : path;
  bool const is_special = std::filesystem::exists(target, none) && !std::filesystem::is_regular_file(target, none) &&
                          !std::filesystem::is_directory(target, none);
  if (path.empty()) {
    problem = std::make_error_code(std::errc::no_such_file_or_directory);
  } else if (is_special) {
    problem = detail::write_text(target, "wb", text);
  } else {
    std::filesystem::path part;
    for (int i = 0; i == 0 || problem == std::errc::file_exists; ++i) {
      part = target;
      part += ".part" + (i == 0 ? std::string() : std::to_string(i));
      problem = detail::write_text(part, "wbx", text);
    }
    if (!problem) {
      std::filesystem::rename(part, target, problem);
      if (problem) std::filesystem::remove(part, none);
    }
  }
  if (problem) throw detail::cannot_write(path, problem);
}

}  // namespace cambium::inline v0_1
