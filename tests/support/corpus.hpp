#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "skipped.hpp"
#include "text.hpp"

/// Where the tests find maps: the project's own, and the public ones of the corpus (which may be absent).
namespace corpus {

/// The corpus' folder: CAMBIUM_CORPUS, else `shared` beside the checkout; where that is not there, nothing, and the
/// test counts as skipped.
inline std::optional<std::filesystem::path> root() {
  char const* const set = std::getenv("CAMBIUM_CORPUS");
  bool const is_set = set != nullptr && *set != '\0';
  std::filesystem::path const folder = is_set ? set : std::filesystem::path(CAMBIUM_SOURCE_DIR) / ".." / "shared";
  if (std::filesystem::exists(folder / "opendrive")) return folder;
  support::skip(is_set ? "no corpus where CAMBIUM_CORPUS says it is, in " + folder.string()
                       : "no corpus: set CAMBIUM_CORPUS");
  return std::nullopt;
}

/// A file or folder of the corpus, such as "opendrive/Town04.xodr". Nothing where there is no corpus, as `root`; where
/// there is one, but without that file, the test ends as failed.
inline std::optional<std::filesystem::path> find(std::string const& name) {
  auto const folder = root();
  if (!folder) return std::nullopt;
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

/// The project's own maps, and those of the corpus where it is there.
inline std::vector<std::filesystem::path> all_maps() {
  auto files = maps(std::filesystem::path(CAMBIUM_SOURCE_DIR) / "maps");
  if (auto const folder = find("opendrive"))
    for (auto& file : maps(*folder)) files.push_back(std::move(file));
  return files;
}

/// The project's own maps, and of the corpus, where it is there, those of these names.
inline std::vector<std::filesystem::path> some_maps(std::initializer_list<char const*> names) {
  auto files = maps(std::filesystem::path(CAMBIUM_SOURCE_DIR) / "maps");
  for (auto const* name : names)
    if (auto const file = find("opendrive/" + std::string(name) + ".xodr")) files.push_back(*file);
  return files;
}

inline std::string read(std::filesystem::path const& path) { return support::content_of(path); }

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
