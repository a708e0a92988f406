#pragma once

#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

namespace cambium::detail {

/// A list of whatever type, as a sort sees it.
struct SortedList {
  void const* list;
  std::size_t size;
  bool (*is_earlier)(void const* list, std::size_t l, std::size_t r);
  void (*swap)(void const* list, std::size_t l, std::size_t r);
};

/// Sorts, equal elements keep their order; true when they were not sorted before. One sort for all types: what is
/// sorted rarely need not be compiled quick to run. O(n log n) comparisons, O(n) swaps, allocates n numbers.
bool stable_sort(SortedList const& sorted);

/// Sorts by `is_earlier(l, r)`, equal elements keep their order; true when they were not sorted before.
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

/// The same by `key(element)`, which gives a value.
template <class Element, class Key>
bool stable_sort(std::vector<Element>& elements, Key const& key) {
  return stable_sort_by(
      elements, [&key](Element const& l, Element const& r) { return std::invoke(key, l) < std::invoke(key, r); });
}

}  // namespace cambium::detail

#ifndef CAMBIUM_COMPILED
#include "cambium/core/stable_sort_impl.hpp"
#endif
