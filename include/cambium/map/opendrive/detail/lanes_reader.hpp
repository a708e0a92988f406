#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cambium/core/stable_sort.hpp"
#include "cambium/map/detail/move_records.hpp"
#include "cambium/map/opendrive/detail/attribute_reader.hpp"
#include "cambium/map/opendrive/detail/xml_context.hpp"
#include "cambium/map/opendrive/document.hpp"

namespace cambium::inline v0_1::map::detail {

/// Sorts records by `key` (a member), and reports where the file has them in another order.
template <class Record, class Key>
void sort_records(XmlContext& context, pugi::xml_node parent, std::vector<Record>& records, Key key, char const* what) {
  if (records.size() > 1 && cambium::detail::stable_sort(records, key))
    context.report(Severity::warning, parent, std::string(what) + " are not in the order of s; they were sorted");
}

/// A cubic record, whose element may have one attribute `beside` it: without a good start or with a bad coefficient it
/// is left out, a missing coefficient counts as 0.
[[nodiscard]] inline std::optional<CubicRecord> read_cubic(XmlContext& context, pugi::xml_node node, char const* start,
                                                           std::string_view beside = {}) {
  CubicRecord record;
  bool good = true;
  report_content(context, node);
  // One walk over the attributes instead of five searches: these records are most of a file.
  bool has_start = false;
  for (pugi::xml_attribute attribute = node.first_attribute(); attribute; attribute = attribute.next_attribute()) {
    std::string_view const name = attribute.name();
    bool const is_start = name == start;
    if (!is_start && (name.size() != 1 || name[0] < 'a' || name[0] > 'd')) {
      if (name != beside) lose_attribute(context, node, attribute);
      continue;
    }
    std::optional<double> const value = parse_number<double>(attribute.value());
    double* const coefficients[] = {&record.a, &record.b, &record.c, &record.d};
    if (!value) {
      context.report(
          Severity::warning, node,
          std::string(name) + "=\"" + attribute.value() + "\" is not a finite number; the record was left out");
      good = false;
    } else if (is_start) {
      record.s = *value;
      has_start = true;
    } else {
      *coefficients[name[0] - 'a'] = *value;
    }
  }
  if (good && !has_start)
    context.report(Severity::warning, node, "attribute " + std::string(start) + " is missing; the record was left out");
  return good && has_start ? std::optional(record) : std::nullopt;
}

/// Appends the record if it is usable.
inline void append_cubic(XmlContext& context, pugi::xml_node node, char const* start,
                         std::vector<CubicRecord>& records) {
  if (std::optional<CubicRecord> const record = read_cubic(context, node, start)) records.push_back(*record);
}

/// The speed limit of a `speed` element into a record that has `limit` and `unit`.
template <class Record>
void read_speed(XmlContext& context, pugi::xml_node node, Record& record) {
  std::string_view const text = trimmed(node.attribute("max").value());
  std::string_view const unit = trimmed(node.attribute("unit").value());
  if (text == "no limit") record.limit = std::numeric_limits<double>::infinity();
  if (text == "no limit" || text == "undefined") return;
  std::optional<double> const value = context.number<double>(node, "max");
  if (!value) return;
  if (*value < 0.0) return context.report(Severity::warning, node, "the speed limit is negative; no limit was read");
  auto const known = enumerator_of<opendrive::SpeedUnit>(unit.empty() ? "m/s" : unit);
  if (!known)
    return context.report(Severity::warning, node,
                          "unit \"" + std::string(unit) + "\" is not one of m/s, km/h, mph; no limit was read");
  record.unit = *known;
  record.limit = in_metres_per_second(*value, *known);
}

/// A speed record, left out where its place is bad.
inline void append_lane_speed(XmlContext& context, pugi::xml_node node, std::vector<opendrive::SpeedRecord>& records) {
  report_others(context, node, {"sOffset", "max", "unit"});
  opendrive::SpeedRecord record;
  if (pugi::xml_attribute const place = node.attribute("sOffset")) {
    std::optional<double> const s = context.number<double>(node, place);
    if (!s) return context.report(Severity::warning, node, "it was left out, see the previous finding");
    record.s = *s;
  }
  read_speed(context, node, record);
  records.push_back(record);
}

inline void read_lane_links(XmlContext& context, pugi::xml_node node, opendrive::LaneElement& lane) {
  pugi::xml_node const container = find_only_child(context, node, "link");
  read_container(context, container, lane.rest, [&](pugi::xml_node child, std::string_view name) {
    if (name != "predecessor" && name != "successor") return false;
    report_others(context, child, {"id"});
    if (std::optional<int> const id = context.number<int>(child, "id"))
      (name == "successor" ? lane.successors : lane.predecessors).push_back(*id);
    return true;
  });
}

inline void read_lane_children(XmlContext& context, pugi::xml_node node, opendrive::LaneElement& lane) {
  for_each_child(node, [&](pugi::xml_node child, std::string_view name) {
    if (name == "width") return append_cubic(context, child, "sOffset", lane.widths);
    if (name == "border") return append_cubic(context, child, "sOffset", lane.borders);
    if (name == "roadMark") return append_leaf(context, child, lane.road_marks);
    if (name == "height") return append_leaf(context, child, lane.heights);
    if (name == "speed") return append_lane_speed(context, child, lane.speeds);
    if (name != "link") keep_element(context, child, lane.rest);
  });
  sort_records(context, node, lane.widths, &CubicRecord::s, "width records");
  sort_records(context, node, lane.borders, &CubicRecord::s, "border records");
  sort_records(context, node, lane.road_marks, &opendrive::RoadMark::s_offset, "road marks");
  sort_records(context, node, lane.speeds, &opendrive::SpeedRecord::s, "speed records");
  sort_records(context, node, lane.heights, &opendrive::HeightRecord::s_offset, "height records");
}

inline void check_lane_width(XmlContext& context, pugi::xml_node node, opendrive::LaneElement const& lane) {
  if (lane.id == 0) return;
  if (lane.widths.empty() && lane.borders.empty())
    context.report(Severity::warning, node, "the lane has neither width nor border; its width counts as 0");
  if (!lane.widths.empty() && !lane.borders.empty())
    context.report(Severity::info, node, "the lane has widths and borders; the widths count");
  if (!lane.widths.empty() && lane.widths.front().s > 0.0)
    context.report(Severity::warning, node,
                   "the first width record starts after the section's start; its first value also counts before it");
}

/// False when the lane's id is unusable.
[[nodiscard]] inline bool read_lane(XmlContext& context, pugi::xml_node node, opendrive::LaneElement& lane) {
  if (!read_attributes(context, node, lane)) {
    context.report(Severity::warning, node, "the lane was left out because it has no usable id");
    return false;
  }
  context.lane = lane.id;
  pugi::xml_attribute const type = node.attribute("type");
  if (lane.type == LaneType::none && lane.id != 0 && *type.value() == '\0')
    context.report(Severity::warning, node, "attribute type is missing; none is assumed");
  if (lane.type == LaneType::other)
    context.report(Severity::info, node,
                   "lane type \"" + std::string(type.value()) + "\" is unknown; nobody will drive there");
  read_lane_links(context, node, lane);
  read_lane_children(context, node, lane);
  check_lane_width(context, node, lane);
  context.lane.reset();
  return true;
}

/// Puts the lanes in order from left to right, adds a missing lane 0, and reports double ids (the first counts) and
/// gaps.
inline void order_lanes(XmlContext& context, pugi::xml_node node, opendrive::LaneSection& section) {
  std::vector<opendrive::LaneElement>& lanes = section.lanes;
  auto const from_left = [](opendrive::LaneElement const& lane) { return -static_cast<long long>(lane.id); };
  cambium::detail::stable_sort(lanes, from_left);
  auto const is_double = [&](opendrive::LaneElement const& before, opendrive::LaneElement const& lane) {
    if (before.id != lane.id) return false;
    context.report(Severity::warning, lane.line, "lane",
                   "lane id " + std::to_string(lane.id) + " occurs twice; the second one was left out");
    return true;
  };
  lanes.erase(std::unique(lanes.begin(), lanes.end(), is_double), lanes.end());
  if (!section.find(0)) {
    context.report(Severity::warning, node, "the section has no lane 0; an empty one was added");
    opendrive::LaneElement centre;
    centre.line = section.line;
    lanes.push_back(std::move(centre));
    cambium::detail::stable_sort(lanes, from_left);
  }
  for (std::size_t i = 1; i < lanes.size(); ++i)
    if (from_left(lanes[i]) - from_left(lanes[i - 1]) > 1)
      context.report(Severity::warning, lanes[i].line, "lane",
                     "there is no lane between " + std::to_string(lanes[i - 1].id) + " and " +
                         std::to_string(lanes[i].id) + "; the two count as neighbours");
}

inline void read_side(XmlContext& context, pugi::xml_node node, std::string_view side,
                      opendrive::LaneSection& section) {
  int const sign = side == "left" ? 1 : side == "right" ? -1 : 0;
  read_container(context, node, section.rest, [&](pugi::xml_node child, std::string_view name) {
    if (name != "lane") return false;
    opendrive::LaneElement& lane = section.lanes.emplace_back();
    if (!read_lane(context, child, lane))
      section.lanes.pop_back();
    else if ((lane.id > 0) - (lane.id < 0) != sign)
      context.report(
          Severity::warning, child,
          "lane " + std::to_string(lane.id) + " is written as " + std::string(side) + "; its id's sign counts");
    return true;
  });
}

/// False when the section's start is unusable.
[[nodiscard]] inline bool read_lane_section(XmlContext& context, pugi::xml_node node, opendrive::LaneSection& section) {
  if (!read_attributes(context, node, section)) {
    context.report(Severity::warning, node, "the lane section was left out because its s is unusable");
    return false;
  }
  std::size_t count = 0;
  for_each_child(node, [&](pugi::xml_node side, std::string_view) {
    for (pugi::xml_node lane = side.first_child(); lane; lane = lane.next_sibling()) ++count;
  });
  section.lanes.reserve(count);
  for (std::string_view const side : {"left", "center", "right"})
    for_each_child(node, side, [&](pugi::xml_node child) { read_side(context, child, side, section); });
  for_each_child(node, [&](pugi::xml_node child, std::string_view name) {
    if (name != "left" && name != "center" && name != "right") keep_element(context, child, section.rest);
  });
  order_lanes(context, node, section);
  return true;
}

/// Gives a section that speaks for one side only the other side's lanes, as they go on from the section before; it then
/// speaks for both.
inline void complete_single_sides(std::vector<opendrive::LaneSection>& sections) {
  for (std::size_t k = 1; k < sections.size(); ++k) {
    opendrive::LaneSection& section = sections[k];
    if (!section.single_side) continue;
    section.single_side = false;
    double const shift = section.s - sections[k - 1].s;
    for (int const side : {1, -1}) {
      auto const is_there = [side](opendrive::LaneElement const& lane) { return lane.id * side > 0; };
      if (std::any_of(section.lanes.begin(), section.lanes.end(), is_there)) continue;
      for (opendrive::LaneElement& before : sections[k - 1].lanes) {
        if (!is_there(before)) continue;
        opendrive::LaneElement lane = before;
        move_records(lane, shift);
        before.successors = lane.predecessors = {lane.id};
        section.lanes.push_back(std::move(lane));
      }
    }
    cambium::detail::stable_sort(section.lanes,
                                 [](opendrive::LaneElement const& lane) { return -static_cast<long long>(lane.id); });
  }
}

}  // namespace cambium::inline v0_1::map::detail
