#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cambium/map/opendrive/detail/attribute_writer.hpp"
#include "cambium/map/opendrive/lanes.hpp"

namespace cambium::inline v0_1::map::detail {

inline void write_cubic(XmlText& xml, std::string_view start, CubicRecord const& record) {
  write_number(xml, start, record.s);
  write_number(xml, "a", record.a);
  write_number(xml, "b", record.b);
  write_number(xml, "c", record.c);
  write_number(xml, "d", record.d);
}

inline void write_cubics(XmlText& xml, std::string_view name, std::string_view start,
                         std::vector<CubicRecord> const& records) {
  for (CubicRecord const& record : records) xml.element(name, [&] { write_cubic(xml, start, record); });
}

/// The attributes of a `speed`: in its own unit where that gives exactly the same limit again, else in m/s.
inline void write_limit(XmlText& xml, std::optional<double> const& limit, opendrive::SpeedUnit unit) {
  if (!limit) return xml.attribute("max", "undefined");
  if (std::isinf(*limit) && *limit > 0.0) return xml.attribute("max", "no limit");
  if (unit != opendrive::SpeedUnit::metres_per_second) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    double const value = *limit / in_metres_per_second(1.0, unit);
    double const below = std::nextafter(value, -infinity), above = std::nextafter(value, infinity);
    for (double const candidate : {std::round(value * 1e9) / 1e9, value, below, above, std::nextafter(below, -infinity),
                                   std::nextafter(above, infinity)}) {
      if (in_metres_per_second(candidate, unit) != *limit) continue;
      write_number(xml, "max", candidate);
      return xml.attribute("unit", word_of(unit));
    }
  }
  write_number(xml, "max", *limit);
  xml.attribute("unit", "m/s");
}

inline void write_lane_links(XmlText& xml, opendrive::LaneElement const& lane) {
  bool const needed = !lane.predecessors.empty() || !lane.successors.empty();
  write_container(xml, "link", lane.rest, needed, [&] {
    for (int const id : lane.predecessors) xml.element("predecessor", [&] { xml.attribute("id", std::to_string(id)); });
    for (int const id : lane.successors) xml.element("successor", [&] { xml.attribute("id", std::to_string(id)); });
  });
}

inline void write_lane(XmlText& xml, opendrive::LaneElement const& lane) {
  xml.element("lane", [&] {
    write_attributes(xml, lane);
    write_lane_links(xml, lane);
    write_cubics(xml, "border", "sOffset", lane.borders);
    write_cubics(xml, "width", "sOffset", lane.widths);
    write_leaves(xml, "roadMark", lane.road_marks);
    for (opendrive::SpeedRecord const& speed : lane.speeds)
      xml.element("speed", [&] {
        write_number(xml, "sOffset", speed.s);
        write_limit(xml, speed.limit, speed.unit);
      });
    write_leaves(xml, "height", lane.heights);
    write_rest(xml, lane.rest, {"link"});
  });
}

inline void write_lane_section(XmlText& xml, opendrive::LaneSection const& section) {
  auto const write_side = [&](std::string_view side, int sign) {
    auto const is_there = [sign](opendrive::LaneElement const& lane) { return (lane.id > 0) - (lane.id < 0) == sign; };
    bool const needed = std::any_of(section.lanes.begin(), section.lanes.end(), is_there);
    write_container(xml, side, section.rest, needed, [&] {
      for (opendrive::LaneElement const& lane : section.lanes)
        if (is_there(lane)) write_lane(xml, lane);
    });
  };
  xml.element("laneSection", [&] {
    write_attributes(xml, section);
    write_side("left", 1);
    write_side("center", 0);
    write_side("right", -1);
    write_rest(xml, section.rest, {"left", "center", "right"});
  });
}

}  // namespace cambium::inline v0_1::map::detail
