#pragma once

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "cambium/core/parameters.hpp"
#include "text.hpp"

namespace support {

/// A line for each parameter of the structs: "struct | key | default | unit | range".
template <class... Described>
std::string parameter_rows() {
  std::string rows;
  auto const add = [&](std::string const& name, std::string const& table) {
    auto const lines = split(table, '\n');
    for (std::size_t i = 2; i < lines.size(); ++i) {
      auto const cells = split(lines[i], '|');
      std::string row = name + ' ';
      for (std::size_t cell = 1; cell < 5; ++cell) row += '|' + cells.at(cell);
      rows += row.substr(0, row.find_last_not_of(' ') + 1) + '\n';
    }
  };
  (add(Described::name, cambium::describe_parameters<Described>()), ...);
  return rows;
}

/// Holds the rows to those of the file tests/<room>/parameters.txt.
template <class... Described>
void check_parameter_rows(std::string const& room) {
  auto const rows = parameter_rows<Described...>();
  auto const file = std::filesystem::path(CAMBIUM_SOURCE_DIR) / "tests" / room / "parameters.txt";
  if (rows == content_of(file)) return;
  auto const now = std::filesystem::path(CAMBIUM_BUILD_DIR) / (room + "_parameters.txt");
  std::ofstream(now, std::ios::binary) << rows;
  FAIL_CHECK("defaults, units or ranges have changed. If they are meant to be so: cp " << now.string() << " "
                                                                                       << file.string());
}

}  // namespace support
