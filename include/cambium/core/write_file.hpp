#pragma once

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

#include "cambium/core/error.hpp"

namespace cambium {

/// Writes `text` to `path` by way of a new file beside it, so that a reader never meets half a file and a failure
/// leaves what was there; follows links, and writes straight into what is no regular file. Throws `Error` naming the
/// path and the system's reason.
inline void write_file(std::filesystem::path const& path, std::string_view text) {
  auto const fail = [&path](std::string const& reason) {
    throw Error(path.string(), "cannot be written (" + reason + ")",
                "name a file in a folder that exists and that you may write to");
  };
  std::error_code none;
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
  if (!file) fail(errno == 0 ? "not opened" : std::generic_category().message(errno));
  file.write(text.data(), static_cast<std::streamsize>(text.size()));
  file.close();
  std::error_code problem;
  if (!file)
    problem = errno == 0 ? std::make_error_code(std::errc::io_error) : std::error_code(errno, std::generic_category());
  else if (!is_special)
    std::filesystem::rename(part, target, problem);
  if (!problem) return;
  if (!is_special) std::filesystem::remove(part, none);
  fail(problem.message());
}

}  // namespace cambium
