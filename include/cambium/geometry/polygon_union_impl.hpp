#pragma once

#include <cstddef>
#include <utility>

#include "cambium/core/macros.hpp"
#include "cambium/geometry/detail/boost_polygon.hpp"
#include "cambium/geometry/polygon_union.hpp"

namespace cambium::inline v0_1::geometry {

CAMBIUM_COLD std::vector<Area> union_of(std::span<Polygon const> polygons) {
  std::vector<detail::BoostArea> parts;
  for (auto const& polygon : polygons) parts.push_back({detail::to_boost(polygon)});
  for (; parts.size() > 1;) {  // in pairs, so that most unions have few corners
    std::vector<detail::BoostArea> joined((parts.size() + 1) / 2);
    for (std::size_t i = 0; i < parts.size(); i += 2) {
      if (i + 1 < parts.size())
        boost::geometry::union_(parts[i], parts[i + 1], joined[i / 2]);
      else
        joined[i / 2] = std::move(parts[i]);
    }
    parts = std::move(joined);
  }
  std::vector<Area> areas;
  if (parts.empty()) return areas;
  for (auto const& part : parts.front()) {
    std::vector<Polygon> outer, holes;
    detail::add_ring(part.outer(), outer);
    if (outer.empty()) continue;
    for (auto const& ring : part.inners()) detail::add_ring(ring, holes);
    areas.push_back({std::move(outer.front()), std::move(holes)});
  }
  return areas;
}

}  // namespace cambium::inline v0_1::geometry
