#pragma once

#include <cmath>
#include <cstddef>
#include <string>

#include "cambium/map/map.hpp"

/// What no map may have, whatever file it was made of.
namespace map_faults {

inline bool is_finite(cambium::geometry::Line const& line) {
  for (auto const& g : line.segments())
    if (!std::isfinite(g.s + g.x + g.y + g.ux + g.uy + g.length + g.heading + g.curvature) || !(g.length > 0))
      return false;
  return std::isfinite(line.length());
}

/// What is wrong with a lane; empty where nothing is.
inline std::string fault_of(cambium::map::Lane const& lane, std::size_t lanes) {
  if (!is_finite(lane.path) || !is_finite(lane.left) || !is_finite(lane.right)) return "a line is not finite";
  if (!(lane.length() > 0)) return "no length";
  for (auto const& w : lane.widths)
    if (!std::isfinite(w.left) || !std::isfinite(w.right)) return "a width is not finite";
  for (double const s : lane.stations)
    if (!(s >= lane.road_begin && s <= lane.road_end)) return "a station is outside of the section";
  auto const vertices = lane.path.segments().size() + 1;
  if (lane.widths.size() != vertices || lane.stations.size() != vertices) return "widths or stations are missing";
  if (!std::isfinite(lane.index_begin + lane.merge_begin)) return "a number is not finite";
  for (auto const& step : lane.speed_limits)
    if (!std::isfinite(step.begin) || !(step.limit > 0)) return "a speed limit is none";
  for (auto const* changes : {&lane.left_changes, &lane.right_changes})
    for (auto const& stretch : *changes)
      if (!std::isfinite(stretch.begin + stretch.end)) return "a lane change is not finite";
  for (auto const& o : lane.overlaps)
    if (!std::isfinite(o.begin + o.end + o.other_begin + o.other_end)) return "an overlap is not finite";
  for (auto const* links : {&lane.successors, &lane.predecessors})
    for (auto const id : *links)
      if (index_of(id) >= lanes) return "a link leads out of the map";
  return "";
}

/// What is wrong with a road's exact geometry at a few stations of each section; empty where nothing is.
inline std::string fault_of(cambium::map::Road const& road) {
  if (!(std::isfinite(road.length) && road.length > 0)) return "no length";
  for (auto const& section : road.sections) {
    if (!std::isfinite(section.begin + section.end)) return "a section has no place";
    for (double const u : {0.0, 0.3, 1.0}) {
      double const s = section.begin + u * (section.end - section.begin);
      auto const p = road.reference_line.at(s);
      if (!std::isfinite(p.x + p.y + p.heading + p.curvature)) return "a reference point is not finite";
      if (!std::isfinite(road.elevation.value(s) + road.lane_offset.value(s))) return "a profile is not finite";
      for (auto const& lane : section.lanes)
        if (auto const at = lane_point(road, s, lane.number);
            at && !std::isfinite(at->center.x + at->center.y + at->width))
          return "lane " + std::to_string(lane.number) + " has a point that is not finite";
    }
  }
  return "";
}

/// The first road or lane of which something is not a finite number, missing or leads out of the map, and what it is;
/// empty where there is none.
inline std::string first_fault(cambium::Map const& map) {
  for (auto const& road : map.roads())
    if (auto const fault = fault_of(road); !fault.empty()) return "road " + road.name + ": " + fault;
  for (auto const& lane : map.lanes())
    if (auto const fault = fault_of(lane, map.lanes().size()); !fault.empty())
      return map.describe(lane.id) + ": " + fault;
  return "";
}

}  // namespace map_faults
