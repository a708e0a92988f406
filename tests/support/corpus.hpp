#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include <doctest/doctest.h>

/// Where the tests find maps: the project's own, and the public ones of the corpus (which may be absent).
namespace corpus {

/// The corpus' folder: CAMBIUM_CORPUS, else `shared` beside the checkout; nothing where neither is there.
inline std::optional<std::filesystem::path> root() {
  if (char const* const set = std::getenv("CAMBIUM_CORPUS"); set != nullptr && *set != '\0') return set;
  auto const beside = std::filesystem::path(CAMBIUM_SOURCE_DIR) / ".." / "shared";
  if (std::filesystem::exists(beside / "opendrive")) return beside;
  return std::nullopt;
}

/// A file or folder of the corpus, such as "opendrive/Town04.xodr". Where there is no corpus, says that the test is
/// skipped and returns nothing; where there is one, but without that file, ends the test as failed.
inline std::optional<std::filesystem::path> find(std::string const& name) {
  auto const folder = root();
  if (!folder) {
    MESSAGE("skipped: there is no corpus with " << name << "; CAMBIUM_CORPUS is not set");
    return std::nullopt;
  }
  auto const file = *folder / name;
  if (!std::filesystem::exists(file)) FAIL("the corpus in " << folder->string() << " has no " << name);
  return file;
}

/// The .xodr files of a folder in the order of their names; empty when it is not there.
inline std::vector<std::filesystem::path> maps(std::filesystem::path const& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code absent;
  for (auto const& entry : std::filesystem::directory_iterator(folder, absent))
    if (entry.path().extension() == ".xodr") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

inline std::string read(std::filesystem::path const& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The cells of a comma-separated table, line by line, without the heading.
inline std::vector<std::vector<std::string>> table(std::filesystem::path const& path) {
  std::vector<std::vector<std::string>> rows;
  std::ifstream in(path);
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    std::vector<std::string>& row = rows.emplace_back();
    for (std::size_t begin = 0; begin <= line.size();) {
      std::size_t const end = std::min(line.find(',', begin), line.size());
      row.push_back(line.substr(begin, end - begin));
      begin = end + 1;
    }
  }
  return rows;
}

}  // namespace corpus
