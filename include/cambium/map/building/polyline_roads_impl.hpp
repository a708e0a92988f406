#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "cambium/core/error.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/geometry/line.hpp"
#include "cambium/map/building/detail/polyline_profiles.hpp"
#include "cambium/map/building/polyline_roads.hpp"
#include "cambium/map/road/curve_layout.hpp"

/// Roads from points, for planners that bring lanes of their own.

namespace cambium::inline v0_1::map {

namespace detail {
/// A road to be made of points, in messages.
[[nodiscard]] inline std::string name_of_road(std::string const& id, char const* otherwise) {
  return id.empty() ? otherwise : "road " + id;
}
}  // namespace detail

CAMBIUM_COLD RoadPlan lane_along(std::vector<Geometry> line, std::span<SideWidths const> widths, std::string id) {
  auto const where = detail::name_of_road(id, "polyline");
  if (widths.size() != 1 && widths.size() != line.size() + 1)
    throw MapError(
        where,
        "it has " + std::to_string(line.size()) + " geometries, but " + std::to_string(widths.size()) + " widths",
        "give one, or one at each end of a geometry");
  RoadPlan plan;
  plan.line = std::move(line);
  auto const stations = detail::stations_of(plan.line);
  std::vector<double> offsets, whole;
  for (std::size_t i = 0; i < widths.size(); ++i) {
    auto const& w = widths[i];
    if (!(w.left >= 0.0 && w.right >= 0.0 && w.left + w.right <= 1000.0))
      throw MapError(where,
                     "the widths at point " + std::to_string(i) + " are " + cambium::detail::rounded_text(w.left) +
                         " and " + cambium::detail::rounded_text(w.right) + " m, not numbers from 0, up to 1 km wide",
                     "give the distances to the borders in m");
    offsets.push_back(w.left);
    whole.push_back(w.left + w.right);
  }
  auto const profile = [&](std::vector<double> const& values) {
    return values.size() == 1 ? std::vector<CubicRecord>{{0.0, values.front(), 0.0, 0.0, 0.0}}
                              : detail::monotone_profile(stations, values);
  };
  plan.lane_offset = profile(offsets);
  plan.sections = {{.right = {{.widths = profile(whole)}}}};
  plan.id = std::move(id);
  return plan;
}

CAMBIUM_COLD RoadPlan lane_along(std::span<geometry::Point const> center, std::span<SideWidths const> widths,
                                 std::span<double const> headings, std::string id) {
  auto const where = detail::name_of_road(id, "polyline");
  if (widths.size() != 1 && widths.size() != center.size())
    throw MapError(
        where, "it has " + std::to_string(center.size()) + " points, but " + std::to_string(widths.size()) + " widths",
        "give one, or one per point");
  return lane_along(curve_through(center, headings, where), widths, std::move(id));
}

CAMBIUM_COLD RoadPlan lanes_between(std::span<std::vector<geometry::Point> const> borders, std::string id) {
  auto const where = detail::name_of_road(id, "polylines");
  auto const border = [&where](std::size_t number) { return where + ", border " + std::to_string(number); };
  if (borders.size() < 2) throw MapError(where, "there are fewer than two borders", "give at least two");
  RoadPlan plan;
  plan.line = curve_through(borders.front(), {}, border(0));
  std::vector<double> stations;
  for (auto const& g : plan.line) {
    auto const pieces = static_cast<int>(std::ceil(g.length / 2.0));
    for (int k = 0; k < pieces; ++k) stations.push_back(g.s + g.length * k / pieces);
  }
  stations.push_back(plan.line.back().s + plan.line.back().length);
  plan.sections.push_back({});
  ReferenceLine const reference(plan.line);
  std::vector<double> inner(stations.size(), 0.0);
  for (std::size_t lane = 1; lane < borders.size(); ++lane) {
    (void)curve_through(borders[lane], {}, border(lane));  // the same errors as for the leftmost
    std::vector<double> widths;
    for (std::size_t i = 0; i < stations.size(); ++i) {
      auto const p = reference.at(stations[i]);
      double const outer = detail::distance_to_the_right({p.x, p.y, p.heading}, borders[lane]);
      if (!(outer > inner[i] - 1e-6) || !std::isfinite(outer))
        throw MapError(border(lane),
                       "it does not pass within 100 m to the right of border " + std::to_string(lane - 1) + " at " +
                           cambium::detail::rounded_text(stations[i]) + " m",
                       "give borders from left to right, in travel direction");
      widths.push_back(std::max(0.0, outer - inner[i]));
      inner[i] = outer;
    }
    plan.sections.front().right.push_back({.widths = detail::monotone_profile(stations, widths)});
  }
  plan.id = std::move(id);
  return plan;
}

}  // namespace cambium::inline v0_1::map
