#pragma once

#include <string>
#include <vector>

namespace cambium::inline v0_1 {

/// A table of text. The first column names the rows.
struct Table {
  std::string set{};  ///< what it is about; empty of comparisons
  std::string title{};
  std::vector<std::string> head{};
  std::vector<std::vector<std::string>> rows{};
  std::string note{};
};

/// A table for a terminal. Control characters are escaped.
[[nodiscard]] std::string text_of(Table const& table);

/// A table for LaTeX with the package booktabs; special characters are escaped.
[[nodiscard]] std::string latex_of(Table const& table);

}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/benchmark/table_impl.hpp"
#endif
