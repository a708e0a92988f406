#pragma once

#include <cstddef>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/stable_sort.hpp"
#include "cambium/geometry/box.hpp"
#include "cambium/geometry/convex_hull.hpp"
#include "cambium/geometry/polygon.hpp"
#include "cambium/map/corridor/lane_area.hpp"
#include "cambium/map/lanes/junction.hpp"
#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/lanes/right_of_way.hpp"
#include "cambium/map/map.hpp"

namespace cambium::inline v0_1::map::detail {

/// `points`' convex hull as a polygon; nothing where it has no area.
[[nodiscard]] inline std::optional<geometry::Polygon> hull_polygon(std::vector<geometry::Point> points) {
  auto const hull = geometry::convex_hull(std::move(points));
  if (!(geometry::twice_area(hull) > 1e-8)) return std::nullopt;
  return geometry::Polygon(hull, "convex hull");
}

/// A convex piece of a lane's ground.
struct GroundPiece {
  std::vector<geometry::Point> corners;
  geometry::Box box;
};

/// The ground of a lane on a stretch of its path: a convex piece between each two cross-sections.
[[nodiscard]] inline std::vector<GroundPiece> ground_pieces(Lane const& lane, PathStretch const& stretch) {
  auto const sections = strip_sections(lane.path, lane.widths, stretch, 0.0);
  std::vector<GroundPiece> pieces;
  for (std::size_t i = 0; i + 1 < sections.size(); ++i) {
    auto const &a = sections[i], &b = sections[i + 1];
    auto corners = geometry::convex_hull({a.left, a.right, b.left, b.right});
    if (corners.size() < 3) continue;
    auto const box = geometry::box_around(corners);
    pieces.push_back({std::move(corners), box});
  }
  return pieces;
}

/// Convex hull of the ground that two stretches of lanes have in common.
[[nodiscard]] inline std::optional<geometry::Polygon> common_ground(Lane const& a, PathStretch const& on_a,
                                                                    Lane const& b, PathStretch const& on_b) {
  auto const of_a = ground_pieces(a, on_a), of_b = ground_pieces(b, on_b);
  std::vector<geometry::Point> points;
  for (auto const& p : of_a)
    for (auto const& q : of_b) {
      if (!p.box.intersects(q.box)) continue;
      auto const common = geometry::convex_intersection(p.corners, q.corners);
      points.insert(points.end(), common.begin(), common.end());
    }
  return hull_polygon(std::move(points));
}

inline void check_junction(Map const& map, JunctionId id) {
  if (index_of(id) >= map.junctions().size())
    throw MapError("junction " + to_string(id), "the map has no junction of that id",
                   "see Map::junctions for those it has");
}

/// See `map::junction_area`.
[[nodiscard]] inline std::optional<geometry::Polygon> junction_area(Map const& map, JunctionId id) {
  check_junction(map, id);
  std::vector<geometry::Point> points;
  for (auto const lane : map.junction(id).lanes)
    for (auto const* line : {&map.lane(lane).path, &map.lane(lane).left, &map.lane(lane).right}) {
      auto const vertices = line->points();
      points.insert(points.end(), vertices.begin(), vertices.end());
    }
  return hull_polygon(std::move(points));
}

/// See `map::conflict_areas`.
[[nodiscard]] inline std::vector<ConflictArea> conflict_areas(Map const& map, JunctionId id) {
  check_junction(map, id);
  std::vector<ConflictArea> conflicts;
  for (auto const first : map.junction(id).lanes)
    for (auto const& overlap : map.lane(first).overlaps) {
      auto const& other = map.lane(overlap.other);
      if (!(first < overlap.other) || map.road(other.road).junction != id) continue;
      ConflictArea conflict{first,
                            overlap.other,
                            overlap.kind,
                            {overlap.begin, overlap.end},
                            {overlap.other_begin, overlap.other_end},
                            std::nullopt};
      conflict.area = common_ground(map.lane(first), conflict.on_first, other, conflict.on_second);
      conflicts.push_back(std::move(conflict));
    }
  cambium::detail::stable_sort(conflicts,
                               [](ConflictArea const& c) { return std::tuple(c.first, c.second, c.on_first.begin); });
  return conflicts;
}

}  // namespace cambium::inline v0_1::map::detail
