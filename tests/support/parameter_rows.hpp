#pragma once

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

}  // namespace support
