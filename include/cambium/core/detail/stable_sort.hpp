#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

namespace cambium::detail {

/// Sorts by `key(element)`, elements of equal key keep their order; true when they were not sorted before. `key` gives
/// a value. (std::stable_sort of libstdc++ 12 does not compile without warnings in clang 19.)
template <class Element, class Key>
bool stable_sort(std::vector<Element>& elements, Key const& key) {
  auto const earlier = [&key](Element const& l, Element const& r) { return std::invoke(key, l) < std::invoke(key, r); };
  if (std::is_sorted(elements.begin(), elements.end(), earlier)) return false;
  std::vector<std::size_t> order(elements.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t l, std::size_t r) {
    if (earlier(elements[l], elements[r])) return true;
    return !earlier(elements[r], elements[l]) && l < r;
  });
  std::vector<Element> sorted;
  sorted.reserve(elements.size());
  for (std::size_t const i : order) sorted.push_back(std::move(elements[i]));
  elements = std::move(sorted);
  return true;
}

}  // namespace cambium::detail
