#pragma once

#include <cstddef>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace cambium::inline v0_1::map::detail {

/// Indices of a document's elements by their ids. The ids must outlive it.
using IdPlaces = std::unordered_map<std::string_view, std::size_t>;

template <class Element>
[[nodiscard]] IdPlaces places_of(std::vector<Element> const& elements) {
  IdPlaces places;
  for (std::size_t i = 0; i < elements.size(); ++i) places.emplace(elements[i].id, i);
  return places;
}

}  // namespace cambium::inline v0_1::map::detail
