#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "cambium/geometry/polygon.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/map.hpp"
#include "cambium/world/roster.hpp"
#include "cambium/world/static_object.hpp"
#include "cambium/world/traffic_index.hpp"

namespace cambium::inline v0_1::detail {

/// Points along a polygon's outline, its corners among them, at most `spacing` [m] apart.
[[nodiscard]] inline std::vector<geometry::Point> points_around(geometry::Polygon const& outline, double spacing) {
  std::vector<geometry::Point> points;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    auto const [a, b] = outline.edge(i);
    int const parts = std::max(1, static_cast<int>(std::ceil((b - a).norm() / spacing)));
    for (int k = 0; k < parts; ++k) points.emplace_back(a + (b - a) * (static_cast<double>(k) / parts));
  }
  return points;
}

/// The stretch of a lane that an object covers [m].
struct ObjectStretch {
  double begin = std::numeric_limits<double>::infinity(), end = -std::numeric_limits<double>::infinity();

  void add(double s) {
    begin = std::min(begin, s);
    end = std::max(end, s);
  }

  /// Adds index entries for the stretch on a lane whose coordinates begin at `index`. Long stretches are split into
  /// parts of at most 10 m, because the index sorts entries by their middle and searches only a limited reach around
  /// it.
  void enter(double index, StaticObject const& object, Slot slot, std::vector<TrafficEntry>& entries) const {
    if (!(begin <= end)) return;
    int const parts = std::max(1, static_cast<int>(std::ceil((end - begin) / 10.0)));
    double const half = (end - begin) / (2 * parts);
    for (int k = 0; k < parts; ++k)
      entries.push_back(
          {index + begin + (2 * k + 1) * half, half, half, 0.0, slot, static_cast<std::uint32_t>(object.id)});
  }
};

/// Adds index entries for a static object on a free corridor, if it lies there. `slot`: its index in the list of
/// objects.
inline void enter_object(map::LaneCorridor const& way, StaticObject const& object, Slot slot,
                         std::vector<TrafficEntry>& entries) {
  ObjectStretch stretch;
  for (auto const& p : points_around(object.outline, 0.1)) {
    auto const foot = way.center.project(p);
    auto const sides = way.widths_at(foot.s, foot.segment);
    if (foot.lateral <= sides.left && -foot.lateral <= sides.right && foot.s >= 0.0 && foot.s <= way.length())
      stretch.add(foot.s);
  }
  for (double s = 0.0; s <= way.length(); s += 0.5)  // an outline wider than the corridor
    if (object.outline.contains(way.center.pose(s).position())) stretch.add(s);
  stretch.enter(way.pieces.front().index_offset, object, slot, entries);
}

/// Index entries of a static object, for each lane and free corridor that it lies on. `slot`: its index in the list of
/// objects.
[[nodiscard]] inline std::vector<TrafficEntry> object_entries(Map const& map, std::span<FreeRoad const> free_roads,
                                                              StaticObject const& object, Slot slot) {
  std::vector<ObjectStretch> stretches(map.lanes().size());
  for (auto const& p : points_around(object.outline, 0.1))
    for (auto const& hit : map.lanes_near(p, 0.0)) stretches[index_of(hit.lane)].add(hit.s);
  for (auto const& lane : map.lanes()) {  // lane ends inside the outline
    if (lane.path.empty()) continue;
    for (double const s : {0.0, lane.length()})
      if (object.outline.contains(lane.path.pose(s).position())) stretches[index_of(lane.id)].add(s);
  }
  std::vector<TrafficEntry> entries;
  for (auto const& lane : map.lanes()) stretches[index_of(lane.id)].enter(lane.index_begin, object, slot, entries);
  for (auto const& road : free_roads) enter_object(road.numbered->corridors.front(), object, slot, entries);
  return entries;
}

}  // namespace cambium::inline v0_1::detail
