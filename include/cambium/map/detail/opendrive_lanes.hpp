#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cambium/map/detail/stable_sort.hpp"
#include "cambium/map/detail/xml_context.hpp"
#include "cambium/map/opendrive_document.hpp"

namespace cambium::map::detail {

/// Sorts by `key` (a member) and reports when the file's order was another one.
template <class Record, class Key>
void sort_records(XmlContext& context, pugi::xml_node parent, std::vector<Record>& records, Key key, char const* what) {
  if (stable_sort(records, key))
    context.report(Severity::warning, parent, std::string(what) + " are not in the order of s; they were sorted");
}

/// A cubic record: without a good start or with a bad coefficient it is left out, a missing coefficient counts as 0.
[[nodiscard]] inline std::optional<CubicRecord> read_cubic(XmlContext& context, pugi::xml_node node,
                                                           char const* start) {
  CubicRecord record;
  bool good = true;
  // One walk over the attributes instead of five searches: these records are most of a file.
  bool has_start = false;
  for (pugi::xml_attribute attribute = node.first_attribute(); attribute; attribute = attribute.next_attribute()) {
    std::string_view const name = attribute.name();
    bool const is_start = name == start;
    if (!is_start && (name.size() != 1 || name[0] < 'a' || name[0] > 'd')) continue;
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

/// All `name` children of `parent` as sorted cubic records.
[[nodiscard]] inline std::vector<CubicRecord> read_cubics(XmlContext& context, pugi::xml_node parent, char const* name,
                                                          char const* start) {
  std::vector<CubicRecord> records;
  for_each_child(parent, name, [&](pugi::xml_node node) {
    if (std::optional<CubicRecord> const record = read_cubic(context, node, start)) records.push_back(*record);
  });
  sort_records(context, parent, records, &CubicRecord::s, name);
  return records;
}

/// A speed limit in m/s from `max` and `unit` (m/s when absent).
[[nodiscard]] inline std::optional<double> read_speed(XmlContext& context, pugi::xml_node node) {
  std::string_view const text = trimmed(node.attribute("max").value());
  std::string_view const unit = trimmed(node.attribute("unit").value());
  if (text == "no limit") return std::numeric_limits<double>::infinity();
  if (text == "undefined") return std::nullopt;
  std::optional<double> const value = context.number<double>(node, "max");
  if (!value) return std::nullopt;
  if (*value < 0.0) {
    context.report(Severity::warning, node, "the speed limit is negative; no limit was read");
    return std::nullopt;
  }
  if (unit.empty() || unit == "m/s") return value;
  if (unit == "km/h") return *value / 3.6;
  if (unit == "mph") return *value * 0.44704;
  context.report(Severity::warning, node,
                 "unit \"" + std::string(unit) + "\" is none of m/s, km/h, mph; no limit was read");
  return std::nullopt;
}

[[nodiscard]] inline opendrive::LaneChange lane_change_from_string(std::string_view word) {
  using enum opendrive::LaneChange;
  if (word == "both") return both;
  if (word == "increase") return increase;
  if (word == "decrease") return decrease;
  if (word == "none") return none;
  return unspecified;
}

[[nodiscard]] inline opendrive::RoadMark read_road_mark(XmlContext& context, pugi::xml_node node) {
  opendrive::RoadMark mark;
  mark.s_offset = context.number_or(node, "sOffset", 0.0);
  mark.type = node.attribute("type").value();
  mark.color = node.attribute("color").value();
  mark.width = context.number_or(node, "width", 0.0);
  mark.lane_change = lane_change_from_string(node.attribute("laneChange").value());
  return mark;
}

/// The ids of all predecessor or successor elements; those that are no whole number are reported and left out.
[[nodiscard]] inline std::vector<int> read_lane_links(XmlContext& context, pugi::xml_node lane, char const* name) {
  std::vector<int> ids;
  for_each_child(find_child(lane, "link"), name, [&](pugi::xml_node node) {
    if (std::optional<int> const id = context.number<int>(node, "id")) ids.push_back(*id);
  });
  return ids;
}

inline void read_lane_children(XmlContext& context, pugi::xml_node node, opendrive::Lane& lane) {
  for_each_child(node, [&](pugi::xml_node child, std::string_view name) {
    if (name == "width") {
      if (auto const record = read_cubic(context, child, "sOffset")) lane.widths.push_back(*record);
    } else if (name == "border") {
      if (auto const record = read_cubic(context, child, "sOffset")) lane.borders.push_back(*record);
    } else if (name == "roadMark") {
      lane.road_marks.push_back(read_road_mark(context, child));
    } else if (name == "speed") {
      lane.speeds.push_back({context.number_or(child, "sOffset", 0.0), read_speed(context, child)});
    }
  });
  sort_records(context, node, lane.widths, &CubicRecord::s, "width records");
  sort_records(context, node, lane.borders, &CubicRecord::s, "border records");
  sort_records(context, node, lane.road_marks, &opendrive::RoadMark::s_offset, "road marks");
  sort_records(context, node, lane.speeds, &opendrive::SpeedRecord::s, "speed records");
}

inline void check_lane_width(XmlContext& context, pugi::xml_node node, opendrive::Lane const& lane) {
  if (lane.id == 0) return;
  if (lane.widths.empty() && lane.borders.empty())
    context.report(Severity::warning, node, "the lane has neither width nor border; its width counts as 0");
  if (!lane.widths.empty() && !lane.borders.empty())
    context.report(Severity::info, node, "the lane has widths and borders; the widths count");
  if (!lane.widths.empty() && lane.widths.front().s > 0.0)
    context.report(Severity::warning, node,
                   "the first width record starts behind the section's start; its first value counts before it too");
}

/// One lane, or nothing when its id is unusable.
[[nodiscard]] inline std::optional<opendrive::Lane> read_lane(XmlContext& context, pugi::xml_node node) {
  std::optional<int> const id = context.number<int>(node, "id");
  if (!id) {
    context.report(Severity::error, node, "the lane was left out, for it has no usable id");
    return std::nullopt;
  }
  context.lane = *id;
  opendrive::Lane lane;
  lane.id = *id;
  lane.line = context.line(node);
  std::string_view const type = node.attribute("type").value();
  lane.type = type.empty() ? LaneType::none : lane_type_from_string(type);
  if (type.empty() && *id != 0) context.report(Severity::warning, node, "attribute type is missing; none was taken");
  if (lane.type == LaneType::other)
    context.report(Severity::info, node,
                   "lane type \"" + std::string(type) + "\" is not known; nobody will drive there");
  lane.level = node.attribute("level").as_bool();
  std::string_view const direction = node.attribute("direction").value();
  if (direction == "reversed") lane.direction = opendrive::LaneDirection::reversed;
  if (direction == "both") lane.direction = opendrive::LaneDirection::both;
  lane.predecessors = read_lane_links(context, node, "predecessor");
  lane.successors = read_lane_links(context, node, "successor");
  read_lane_children(context, node, lane);
  check_lane_width(context, node, lane);
  context.lane.reset();
  return lane;
}

/// Puts the lanes in order from left to right, adds a missing lane 0, and reports double ids (the first counts) and
/// gaps.
inline void order_lanes(XmlContext& context, pugi::xml_node node, opendrive::LaneSection& section) {
  std::vector<opendrive::Lane>& lanes = section.lanes;
  auto const from_left = [](opendrive::Lane const& lane) { return -static_cast<long long>(lane.id); };
  stable_sort(lanes, from_left);
  for (std::size_t i = 1; i < lanes.size();) {
    if (lanes[i].id != lanes[i - 1].id) {
      ++i;
      continue;
    }
    context.report(Severity::error, lanes[i].line, "lane",
                   "lane id " + std::to_string(lanes[i].id) + " is there twice; the second one was left out");
    lanes.erase(lanes.begin() + static_cast<std::ptrdiff_t>(i));
  }
  if (!section.find(0)) {
    context.report(Severity::warning, node, "the section has no lane 0; an empty one was added");
    opendrive::Lane centre;
    centre.line = section.line;
    lanes.push_back(std::move(centre));
    stable_sort(lanes, from_left);
  }
  for (std::size_t i = 1; i < lanes.size(); ++i)
    if (from_left(lanes[i]) - from_left(lanes[i - 1]) > 1)
      context.report(Severity::warning, lanes[i].line, "lane",
                     "there is no lane between " + std::to_string(lanes[i - 1].id) + " and " +
                         std::to_string(lanes[i].id) + "; the two count as neighbours");
}

/// One lane section, or nothing when its start is unusable.
[[nodiscard]] inline std::optional<opendrive::LaneSection> read_lane_section(XmlContext& context, pugi::xml_node node) {
  std::optional<double> const s = context.number<double>(node, "s");
  if (!s) {
    context.report(Severity::error, node, "the lane section was left out, for its s is unusable");
    return std::nullopt;
  }
  opendrive::LaneSection section;
  section.s = *s;
  section.line = context.line(node);
  section.single_side = node.attribute("singleSide").as_bool();
  for_each_child(node, [&](pugi::xml_node side, std::string_view name) {
    if (name != "left" && name != "center" && name != "right") return;
    for_each_child(side, "lane", [&](pugi::xml_node lane_node) {
      std::optional<opendrive::Lane> lane = read_lane(context, lane_node);
      if (!lane) return;
      int const sign = name == "left" ? 1 : name == "right" ? -1 : 0;
      if ((lane->id > 0) - (lane->id < 0) != sign)
        context.report(
            Severity::warning, lane_node,
            "lane " + std::to_string(lane->id) + " is written as " + std::string(name) + "; its id's sign counts");
      section.lanes.push_back(std::move(*lane));
    });
  });
  order_lanes(context, node, section);
  return section;
}

/// Gives a section that speaks for one side only the other side's lanes, as they go on from the section before.
inline void complete_single_sides(std::vector<opendrive::LaneSection>& sections) {
  for (std::size_t k = 1; k < sections.size(); ++k) {
    opendrive::LaneSection& section = sections[k];
    if (!section.single_side) continue;
    double const shift = section.s - sections[k - 1].s;
    for (int const side : {1, -1}) {
      auto const is_there = [side](opendrive::Lane const& lane) { return lane.id * side > 0; };
      if (std::any_of(section.lanes.begin(), section.lanes.end(), is_there)) continue;
      for (opendrive::Lane& before : sections[k - 1].lanes) {
        if (!is_there(before)) continue;
        opendrive::Lane lane = before;
        for (CubicRecord& record : lane.widths) record.s -= shift;
        for (CubicRecord& record : lane.borders) record.s -= shift;
        for (opendrive::RoadMark& mark : lane.road_marks) mark.s_offset -= shift;
        for (opendrive::SpeedRecord& speed : lane.speeds) speed.s -= shift;
        before.successors = lane.predecessors = {lane.id};
        section.lanes.push_back(std::move(lane));
      }
    }
    stable_sort(section.lanes, [](opendrive::Lane const& lane) { return -static_cast<long long>(lane.id); });
  }
}

}  // namespace cambium::map::detail
