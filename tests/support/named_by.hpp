#pragma once

#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "cambium/core/diagnostic.hpp"

namespace support {

/// Pairs of lanelets, either way round, that findings are about: the one that a finding belongs to and each whose
/// number stands in its sentence behind "lanelet", "successor", "predecessor" or "neighbour"; the first one twice
/// without any.
inline std::set<std::pair<std::string, std::string>> named_by(std::vector<cambium::Diagnostic> const& diagnostics) {
  auto const numbers = [](std::string const& text) {
    std::set<std::string> const kinds{"lanelet", "successor", "predecessor", "neighbour"};
    std::vector<std::string> found;
    std::istringstream words(text);
    for (std::string before, word; words >> word; before = word)
      if (auto const id = word.substr(0, word.find_first_not_of("0123456789")); kinds.contains(before) && !id.empty())
        found.push_back(id);
    return found;
  };
  std::set<std::pair<std::string, std::string>> pairs;
  for (auto const& found : diagnostics) {
    auto const own = numbers(found.ids);
    auto others = numbers(found.sentence);
    if (others.empty()) others = own;
    for (auto const& a : own)
      for (auto const& b : others) pairs.insert({{a, b}, {b, a}});
  }
  return pairs;
}

}  // namespace support
