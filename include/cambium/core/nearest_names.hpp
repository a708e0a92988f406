#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cambium/core/text.hpp"

namespace cambium::inline v0_1::detail {

/// The members `name` of a list's elements.
template <class List>
[[nodiscard]] std::vector<std::string> names_of(List const& list) {
  std::vector<std::string> names;
  for (auto const& one : list) names.emplace_back(one.name);
  return names;
}

/// Edit distance: the number of letters to change, add or remove (Levenshtein 1966).
[[nodiscard]] inline std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      auto const changed = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({changed, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

/// The names that a mistyped `word` may stand for, nearest first, at most three.
[[nodiscard]] inline std::vector<std::string> nearest_names(std::string_view word,
                                                            std::vector<std::string> const& names) {
  std::vector<std::pair<std::size_t, std::string>> found;
  for (auto const& name : names) {
    auto const far = edit_distance(word, name);
    bool const begins = word.size() > 3 && name.starts_with(word);
    bool const is_near = far < word.size() && far <= std::max<std::size_t>(1, word.size() / 3);
    if (begins || is_near) found.emplace_back(begins ? 0 : far, name);
  }
  std::sort(found.begin(), found.end());
  found.resize(std::min<std::size_t>(found.size(), 3));
  std::vector<std::string> nearest;
  for (auto& [far, name] : found) nearest.push_back(std::move(name));
  return nearest;
}

/// A remedy for a mistyped `word`: "is it speed or speeds?", or "give one of a, b, c" if nothing is near.
[[nodiscard]] inline std::string suggestion(std::string_view word, std::vector<std::string> const& names) {
  if (names.empty()) return "there are none";
  auto const near = nearest_names(word, names);
  return near.empty() ? "give one of " + joined(names, ", ") : "is it " + joined(near, " or ") + "?";
}

}  // namespace cambium::inline v0_1::detail
