#pragma once

#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

namespace cambium::inline v0_1::detail {

/// The elements of a list, by their numbers, in the order that a stable sort gives them; empty if they have it already.
/// Compiled once for all element types, which saves compile time where sorting is rare.
[[nodiscard]] std::vector<std::size_t> stable_order(
    std::size_t size, std::function<bool(std::size_t l, std::size_t r)> const& is_earlier);

/// Sorts stably by `is_earlier(l, r)`; returns whether the order changed. O(n log n) comparisons, O(n) moves.
template <class Element, class Compare>
bool stable_sort_by(std::vector<Element>& elements, Compare const& is_earlier) {
  auto const order = stable_order(elements.size(), [&](std::size_t l, std::size_t r) {
    return static_cast<bool>(is_earlier(elements[l], elements[r]));
  });
  if (order.empty()) return false;
  std::vector<Element> sorted;
  sorted.reserve(order.size());
  for (auto const i : order) sorted.push_back(std::move(elements[i]));
  elements = std::move(sorted);
  return true;
}

/// Sorts stably by `key(element)`, a value or a pointer to a member; returns whether the order changed.
template <class Element, class Key>
bool stable_sort(std::vector<Element>& elements, Key const& key) {
  return stable_sort_by(
      elements, [&key](Element const& l, Element const& r) { return std::invoke(key, l) < std::invoke(key, r); });
}

}  // namespace cambium::inline v0_1::detail

#ifndef CAMBIUM_COMPILED
#include "cambium/core/stable_sort_impl.hpp"
#endif
