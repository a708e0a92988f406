#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "cambium/geometry/angle.hpp"
#include "cambium/map/building/detail/road_links.hpp"
#include "cambium/map/opendrive/document.hpp"

/// Documents that say the same in another way: mirrored, moved, with roads written from their other end.
namespace transformed {

using namespace cambium::map;

inline std::vector<CubicRecord> negated(std::vector<CubicRecord> records) {
  for (auto& r : records) r = {r.s, -r.a, -r.b, -r.c, -r.d};
  return records;
}

inline void negate(std::vector<int>& ids) {
  for (int& id : ids) id = -id;
}

/// Lanes in their order from left to right again, once their ids have changed sign.
inline void negate_lanes(opendrive::LaneSection& section) {
  for (auto& lane : section.lanes) {
    lane.id = -lane.id;
    for (auto& mark : lane.road_marks) {
      if (mark.lane_change == opendrive::LaneChangePermission::increase)
        mark.lane_change = opendrive::LaneChangePermission::decrease;
      else if (mark.lane_change == opendrive::LaneChangePermission::decrease)
        mark.lane_change = opendrive::LaneChangePermission::increase;
    }
    lane.borders = negated(lane.borders);
  }
  std::reverse(section.lanes.begin(), section.lanes.end());
}

inline Geometry mirrored(Geometry g) {
  g.y = -g.y;
  g.heading = -g.heading;
  g.curvature_start = -g.curvature_start;
  g.curvature_end = -g.curvature_end;
  if (g.cubic) {
    auto v = g.cubic->v();
    for (auto& c : v) c = -c;
    g.cubic = std::make_shared<ParametricCubic const>(g.cubic->u(), v, g.cubic->end());
  }
  return g;
}

/// Seen in a mirror that lies along the x axis: right-hand traffic becomes left-hand traffic.
inline OpenDriveDocument mirrored(OpenDriveDocument document) {
  document.header.offset.y = -document.header.offset.y;
  document.header.offset.heading = -document.header.offset.heading;
  for (auto& road : document.roads) {
    road.rule = road.rule == opendrive::DrivingSide::right_hand ? opendrive::DrivingSide::left_hand
                                                                : opendrive::DrivingSide::right_hand;
    for (auto& g : road.geometries) g = mirrored(g);
    road.lane_offset = negated(road.lane_offset);
    for (auto& section : road.lane_sections) {
      for (auto& lane : section.lanes) {
        negate(lane.predecessors);
        negate(lane.successors);
      }
      negate_lanes(section);
    }
  }
  for (auto& junction : document.junctions)
    for (auto& connection : junction.connections)
      for (auto& link : connection.lane_links) link = {-link.from, -link.to};
  return document;
}

/// Turned by `heading` about the origin of the map frame, then moved by `x`, `y`, by the header's offset alone.
inline OpenDriveDocument moved(OpenDriveDocument document, double x, double y, double heading) {
  auto& offset = document.header.offset;
  offset.heading += heading;
  double const c = std::cos(offset.heading), s = std::sin(offset.heading);
  offset.x += c * x + s * y;
  offset.y += -s * x + c * y;
  return document;
}

/// The records on [`begin`, `end`] as functions of the distance from `end`; `hold`: the first one's start counts
/// before.
inline std::vector<CubicRecord> reversed(std::vector<CubicRecord> records, double begin, double end, bool hold) {
  if (!records.empty() && records.front().s > begin)
    records.insert(records.begin(), {begin, hold ? records.front().a : 0.0, 0.0, 0.0, 0.0});
  std::vector<CubicRecord> result;
  for (std::size_t i = records.size(); i-- > 0;) {
    auto const& r = records[i];
    double const from = std::max(r.s, begin), to = i + 1 < records.size() ? std::min(records[i + 1].s, end) : end;
    if (to > from) result.push_back({end - to, r.value(to), -r.derivative(to), 0.5 * r.second_derivative(to), -r.d});
  }
  return result;
}

inline Geometry reversed(Geometry g, double road_length) {
  CurvePoint const end = evaluate(g, g.length);
  g.x = end.x;
  g.y = end.y;
  g.heading = end.heading + cambium::geometry::pi;
  std::swap(g.curvature_start, g.curvature_end);
  g.curvature_start = -g.curvature_start;
  g.curvature_end = -g.curvature_end;
  g.s = road_length - g.s - g.length;
  return g;
}

inline void reverse(opendrive::RoadElement& road) {
  double const length = road.geometry_length();
  for (auto& g : road.geometries) g = reversed(g, length);
  std::reverse(road.geometries.begin(), road.geometries.end());
  std::reverse(road.geometry_lines.begin(), road.geometry_lines.end());
  road.lane_offset = negated(reversed(road.lane_offset, 0.0, length, false));
  road.elevation = reversed(road.elevation, 0.0, length, false);
  double end = length;
  for (auto section = road.lane_sections.rbegin(); section != road.lane_sections.rend(); ++section) {
    double const begin = section->s, extent = end - begin;
    for (auto& lane : section->lanes) {
      lane.widths = reversed(lane.widths, 0.0, extent, true);
      lane.borders = reversed(lane.borders, 0.0, extent, true);
      std::swap(lane.predecessors, lane.successors);
    }
    section->s = length - end;
    negate_lanes(*section);
    end = begin;
  }
  std::reverse(road.lane_sections.begin(), road.lane_sections.end());
  std::swap(road.predecessor, road.successor);
}

/// These roads written from their other end; lanes are driven as before. Not for roads with cubic geometries.
inline OpenDriveDocument with_reversed_roads(OpenDriveDocument document, std::set<std::string> const& ids) {
  auto const flip = [&](opendrive::ContactPoint& end, std::string const& road) {
    if (!ids.contains(road) || end == opendrive::ContactPoint::none) return;
    end = end == opendrive::ContactPoint::start ? opendrive::ContactPoint::end : opendrive::ContactPoint::start;
  };
  for (auto& road : document.roads) {
    // Lane links across the road's ends name the other road's lanes, those inside its own.
    bool const own = ids.contains(road.id);
    auto const turned = [&](std::optional<opendrive::RoadLink> const& link) {
      return link && link->element_type == opendrive::ElementType::road && ids.contains(link->id);
    };
    bool const before = turned(road.predecessor), behind = turned(road.successor);
    for (std::size_t k = 0; k < road.lane_sections.size(); ++k)
      for (auto& lane : road.lane_sections[k].lanes) {
        if (k == 0 ? before : own) negate(lane.predecessors);
        if (k + 1 == road.lane_sections.size() ? behind : own) negate(lane.successors);
      }
    for (auto* link : {&road.predecessor, &road.successor})
      if (*link && (*link)->element_type == opendrive::ElementType::road) flip((*link)->contact_point, (*link)->id);
    if (own) reverse(road);
  }
  for (auto& junction : document.junctions)
    for (auto& connection : junction.connections) {
      std::string const& entered = connection.entered_road();
      flip(connection.contact_point, entered);
      for (auto& link : connection.lane_links) {
        if (ids.contains(connection.incoming_road)) link.from = -link.from;
        if (ids.contains(entered)) link.to = -link.to;
      }
    }
  return document;
}

}  // namespace transformed
