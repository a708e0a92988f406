#pragma once

#include <span>
#include <vector>

#include "cambium/geometry/polygon.hpp"
#include "cambium/geometry/pose.hpp"

namespace cambium::inline v0_1::geometry {

/// A connected area with holes.
struct Area {
  Polygon outer;
  std::vector<Polygon> holes;

  /// True inside and on the border. O(n).
  [[nodiscard]] bool contains(Point const& p) const {
    if (!outer.contains(p)) return false;
    for (auto const& hole : holes)
      if (hole.contains(p) && hole.distance_to_border(p) > 0.0) return false;
    return true;
  }
};

/// The union of polygons as connected areas with holes (by Boost.Geometry). O(n log n) for n corners if only a bounded
/// number of polygons overlap anywhere.
[[nodiscard]] std::vector<Area> union_of(std::span<Polygon const> polygons);

}  // namespace cambium::inline v0_1::geometry

#ifndef CAMBIUM_COMPILED
#include "cambium/geometry/polygon_union_impl.hpp"
#endif
