#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "cambium/core/macros.hpp"
#include "cambium/core/stable_sort.hpp"

namespace cambium::detail {

// std::stable_sort of libstdc++ 12 causes warnings in clang 19, hence std::sort of indices with ties broken by index.
CAMBIUM_COLD bool stable_sort(SortedList const& sorted) {
  auto const is_earlier = [&](std::size_t l, std::size_t r) { return sorted.is_earlier(sorted.list, l, r); };
  std::size_t in_order = 1;
  while (in_order < sorted.size && !is_earlier(in_order, in_order - 1)) ++in_order;
  if (in_order >= sorted.size) return false;
  std::vector<std::size_t> places(sorted.size);  // places[i]: old index of the element that belongs at i
  for (std::size_t i = 0; i < sorted.size; ++i) places[i] = i;
  std::sort(places.begin(), places.end(),
            [&](std::size_t l, std::size_t r) { return is_earlier(l, r) || (!is_earlier(r, l) && l < r); });
  for (std::size_t i = 0; i < sorted.size; ++i) {  // follow each cycle of the permutation once
    auto at = i;
    while (places[at] != i) {
      auto const from = places[at];
      sorted.swap(sorted.list, at, from);
      places[at] = at;
      at = from;
    }
    places[at] = at;
  }
  return true;
}

}  // namespace cambium::detail
