#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <numeric>
#include <vector>

#include "cambium/core/macros.hpp"
#include "cambium/core/stable_sort.hpp"

namespace cambium::inline v0_1::detail {

// std::stable_sort of libstdc++ 12 causes warnings in clang 19, hence std::sort of indices with ties broken by index.
CAMBIUM_COLD std::vector<std::size_t> stable_order(
    std::size_t size, std::function<bool(std::size_t l, std::size_t r)> const& is_earlier) {
  std::size_t in_order = 1;
  while (in_order < size && !is_earlier(in_order, in_order - 1)) ++in_order;
  if (in_order >= size) return {};
  std::vector<std::size_t> order(size);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t l, std::size_t r) { return is_earlier(l, r) || (!is_earlier(r, l) && l < r); });
  return order;
}

}  // namespace cambium::inline v0_1::detail
