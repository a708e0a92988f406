#pragma once

#include <span>
#include <string>
#include <vector>

#include "cambium/geometry/pose.hpp"
#include "cambium/map/building/road_plan.hpp"
#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/road/reference_line.hpp"

namespace cambium::inline v0_1::map {

/// A road with one lane, -1, along the points of its centre line (`curve_through`: it passes through them without
/// kinks). `widths`: the distances from there to the lane's borders [m], one for all points or one a point, smooth
/// between them. (A lane's path is the middle between its borders: not `center` where the distances differ;
/// `lane_along` of a `CenterLine` keeps it there.) `id`: the road's, by which errors name it. Throws `MapError` as
/// `curve_through`, and for widths that are negative or not as many as needed.
[[nodiscard]] RoadPlan lane_along(std::span<geometry::Point const> center, std::span<SideWidths const> widths,
                                  std::span<double const> headings = {}, std::string id = {});

/// The same along a line that is laid out already, with one width or one at each end of its geometries.
[[nodiscard]] RoadPlan lane_along(std::vector<Geometry> line, std::span<SideWidths const> widths, std::string id = {});

/// A road with the lanes -1, -2, ... between `borders`: polylines in travel direction from left to right, one more than
/// there are lanes. The leftmost border becomes the reference line (`curve_through`), the others are met exactly every
/// 2 m and smoothly between, where they have no corners within a centimetre; they need not begin and end side by side
/// with the leftmost one, whose ends are the road's. `id`: the road's, by which errors name it. Throws `MapError` as
/// `curve_through`, with the border counted from 0, and where a border is not to the right of the one before.
[[nodiscard]] RoadPlan lanes_between(std::span<std::vector<geometry::Point> const> borders, std::string id = {});

}  // namespace cambium::inline v0_1::map

#ifndef CAMBIUM_COMPILED
#include "cambium/map/building/polyline_roads_impl.hpp"
#endif
