#pragma once

#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

namespace cambium::detail {

/// A list of any element type, as the sort sees it: comparing and swapping by index.
struct SortedList {
  void const* list;
  std::size_t size;
  bool (*is_earlier)(void const* list, std::size_t l, std::size_t r);
  void (*swap)(void const* list, std::size_t l, std::size_t r);
};

/// Sorts stably; returns whether the order changed. Compiled once for all element types, which saves compile time
/// where sorting is rare. O(n log n) comparisons, O(n) swaps, allocates n numbers.
bool stable_sort(SortedList const& sorted);

/// Sorts stably by `is_earlier(l, r)`; returns whether the order changed.
template <class Element, class Compare>
bool stable_sort_by(std::vector<Element>& elements, Compare const& is_earlier) {
  struct List {
    Element* elements;
    Compare const& is_earlier;
  } const list{elements.data(), is_earlier};
  auto const compare = [](void const* given, std::size_t l, std::size_t r) {
    auto const& at = *static_cast<List const*>(given);
    return static_cast<bool>(at.is_earlier(at.elements[l], at.elements[r]));
  };
  auto const exchange = [](void const* given, std::size_t l, std::size_t r) {
    auto const& at = *static_cast<List const*>(given);
    std::swap(at.elements[l], at.elements[r]);
  };
  return stable_sort({&list, elements.size(), compare, exchange});
}

/// Sorts stably by `key(element)`, a value or a pointer to a member; returns whether the order changed.
template <class Element, class Key>
bool stable_sort(std::vector<Element>& elements, Key const& key) {
  return stable_sort_by(
      elements, [&key](Element const& l, Element const& r) { return std::invoke(key, l) < std::invoke(key, r); });
}

}  // namespace cambium::detail

#ifndef CAMBIUM_COMPILED
#include "cambium/core/stable_sort_impl.hpp"
#endif
