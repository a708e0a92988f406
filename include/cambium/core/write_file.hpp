#pragma once

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

#include "cambium/core/error.hpp"

namespace cambium {

/// Writes `text` to `path` by way of `path` + ".part" in the same folder, so that a reader never meets half a file and
/// a failure leaves what was there. Throws `Error` naming the path and the system's reason.
inline void write_file(std::filesystem::path const& path, std::string_view text) {
  auto const fail = [&path](std::string const& reason) {
    throw Error(path.string(), "cannot be written (" + reason + ")",
                "name a file in a folder that exists and that you may write to");
  };
  std::filesystem::path part = path;
  part += ".part";
  errno = 0;
  std::ofstream file(part, std::ios::binary | std::ios::trunc);
  if (!file) fail(errno == 0 ? "not opened" : std::generic_category().message(errno));
  file.write(text.data(), static_cast<std::streamsize>(text.size()));
  file.close();
  std::error_code problem;
  if (!file)
    problem = errno == 0 ? std::make_error_code(std::errc::io_error) : std::error_code(errno, std::generic_category());
  else
    std::filesystem::rename(part, path, problem);
  if (!problem) return;
  std::error_code ignored;
  std::filesystem::remove(part, ignored);
  fail(problem.message());
}

}  // namespace cambium
