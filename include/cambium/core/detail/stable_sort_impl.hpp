#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "cambium/core/detail/stable_sort.hpp"
#include "cambium/core/macros.hpp"

namespace cambium::detail {

// (std::stable_sort of libstdc++ 12 does not compile without warnings in clang 19.)
CAMBIUM_COLD std::vector<std::size_t> sorted_places(std::size_t count,
                                                    bool (*is_earlier)(void const*, std::size_t, std::size_t),
                                                    void const* elements) {
  std::size_t in_order = 1;
  while (in_order < count && !is_earlier(elements, in_order, in_order - 1)) ++in_order;
  if (in_order >= count) return {};
  std::vector<std::size_t> places(count);
  for (std::size_t i = 0; i < count; ++i) places[i] = i;
  std::sort(places.begin(), places.end(), [&](std::size_t l, std::size_t r) {
    if (is_earlier(elements, l, r)) return true;
    return !is_earlier(elements, r, l) && l < r;
  });
  return places;
}

}  // namespace cambium::detail
