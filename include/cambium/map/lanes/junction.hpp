#pragma once

#include <optional>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/geometry/polygon.hpp"
#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/map.hpp"

namespace cambium::inline v0_1::map {

/// Where two lanes of a junction come so close that vehicles on them cannot be side by side (see `Overlap`).
struct ConflictArea {
  LaneId first = none<LaneId>, second = none<LaneId>;  ///< first < second
  OverlapKind kind = OverlapKind::crossing;
  PathStretch on_first, on_second;  ///< along their paths [m]
  /// Convex hull of the ground that both lanes cover on these stretches; nothing where the lanes themselves keep apart.
  std::optional<geometry::Polygon> area;
};

/// The convex hull of all lanes of the junction's connecting roads: holds every point of their borders and paths.
/// Nothing for a junction without connecting roads (direct and virtual ones). Throws `MapError` for an id that the map
/// does not have. O(n log n) for n border points.
[[nodiscard]] inline std::optional<geometry::Polygon> junction_area(Map const& map, JunctionId id) {
  return map.queries().junction_area(map, id);
}

/// The places where lanes of the junction's connecting roads cross, merge or part, sorted by lanes, then by their order
/// along the first. None for a junction without connecting roads. Throws `MapError` for an id that the map does not
/// have. O(m n) for each of two overlapping stretches of m and n vertices.
[[nodiscard]] inline std::vector<ConflictArea> conflict_areas(Map const& map, JunctionId id) {
  return map.queries().conflict_areas(map, id);
}

}  // namespace cambium::inline v0_1::map
