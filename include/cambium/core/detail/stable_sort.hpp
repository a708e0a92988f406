#pragma once

#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

namespace cambium::detail {

/// The places of `count` elements in order, where `is_earlier(elements, l, r)` compares those at l and r; equal ones
/// keep their order. Empty where they are in order already. One sort for all types: what is sorted rarely need not be
/// compiled quick to run.
[[nodiscard]] std::vector<std::size_t> sorted_places(std::size_t count,
                                                     bool (*is_earlier)(void const*, std::size_t, std::size_t),
                                                     void const* elements);

/// Sorts by `is_earlier(l, r)`, equal elements keep their order; true when they were not sorted before.
template <class Element, class Compare>
bool stable_sort_by(std::vector<Element>& elements, Compare const& is_earlier) {
  struct Sorted {
    std::vector<Element> const& elements;
    Compare const& is_earlier;
  } const all{elements, is_earlier};
  auto const places = sorted_places(
      elements.size(),
      [](void const* sorted, std::size_t l, std::size_t r) {
        auto const& s = *static_cast<Sorted const*>(sorted);
        return static_cast<bool>(s.is_earlier(s.elements[l], s.elements[r]));
      },
      &all);
  if (places.empty()) return false;
  std::vector<Element> sorted;
  sorted.reserve(elements.size());
  for (std::size_t const i : places) sorted.push_back(std::move(elements[i]));
  elements = std::move(sorted);
  return true;
}

/// The same by `key(element)`, which gives a value.
template <class Element, class Key>
bool stable_sort(std::vector<Element>& elements, Key const& key) {
  return stable_sort_by(
      elements, [&key](Element const& l, Element const& r) { return std::invoke(key, l) < std::invoke(key, r); });
}

}  // namespace cambium::detail

#ifndef CAMBIUM_COMPILED
#include "cambium/core/detail/stable_sort_impl.hpp"
#endif
