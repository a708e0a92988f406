#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "cambium/benchmark/result_store.hpp"

/// What a benchmark has left on the disk.
namespace stored {

inline std::vector<cambium::ResultRow> rows_of(cambium::ResultStore& store) {
  std::vector<cambium::ResultRow> rows;
  store.for_each([&](cambium::ResultRow const& row) { rows.push_back(row); });
  return rows;
}

/// The rows but for their times, one a line.
inline std::string results_of(cambium::ResultStore& store) {
  std::string text;
  for (auto const& row : rows_of(store))
    text += row.key.behavior + " " + std::to_string(row.key.scenario) + " " + std::to_string(row.seed) + " " +
            to_string(row.result) + "\n";
  return text;
}

inline std::string results_in(std::filesystem::path const& file) {
  auto store = cambium::ResultStore::existing(file);
  return results_of(store);
}

/// Names of the files of a folder; none if it is not there.
inline std::vector<std::string> files_in(std::filesystem::path const& folder) {
  std::vector<std::string> names;
  std::error_code none;
  for (auto const& entry : std::filesystem::directory_iterator(folder, none))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace stored
