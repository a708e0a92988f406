#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <utility>

#include <pugixml.hpp>

#include "cambium/core/error.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/map/detail/findings.hpp"
#include "cambium/map/opendrive/check.hpp"
#include "cambium/map/opendrive/detail/junctions_reader.hpp"
#include "cambium/map/opendrive/detail/lanes_reader.hpp"
#include "cambium/map/opendrive/detail/plan_view.hpp"
#include "cambium/map/opendrive/detail/xml_context.hpp"
#include "cambium/map/opendrive/detail/xml_root.hpp"
#include "cambium/map/opendrive/reader.hpp"

namespace cambium::inline v0_1::map {

namespace detail {

/// An offset that leads out of the world counts as none.
inline void read_offset(XmlContext& context, pugi::xml_node node, opendrive::HeaderOffset& offset) {
  report_content(context, node);
  static_cast<void>(read_attributes(context, node, offset, nullptr));
  if (std::max({std::abs(offset.x), std::abs(offset.y), std::abs(offset.z)}) <= 1e8 && std::abs(offset.heading) <= 1e4)
    return;
  context.report(Severity::warning, node,
                 "it lies beyond 100 000 km, or turns by more than 10 000 rad; it was left out");
  offset = {};
}

[[nodiscard]] inline opendrive::Header read_header(XmlContext& context, pugi::xml_node node) {
  opendrive::Header header;
  static_cast<void>(read_attributes(context, node, header));  // it needs none
  pugi::xml_node const reference = find_only_child(context, node, "geoReference");
  for (pugi::xml_attribute a = reference.first_attribute(); a; a = a.next_attribute())
    lose_attribute(context, reference, a);
  header.geo_reference = trimmed(reference.child_value());
  if (reference.first_child().next_sibling())
    context.report(Severity::warning, reference, "what follows its first text was left out");
  if (auto const offset = find_only_child(context, node, "offset")) read_offset(context, offset, header.offset);
  for_each_child(node, [&](pugi::xml_node child, std::string_view name) {
    if (name != "geoReference" && name != "offset") keep_element(context, child, header.rest);
  });
  return header;
}

inline void read_road_types(XmlContext& context, pugi::xml_node road_node, opendrive::RoadElement& road) {
  for_each_child(road_node, "type", [&](pugi::xml_node node) {
    opendrive::RoadType& type = road.types.emplace_back();
    auto const is_speed = [](pugi::xml_node, std::string_view name) { return name == "speed"; };
    if (!read_with(context, node, type, is_speed)) return road.types.pop_back();
    if (auto const speed = find_only_child(context, node, "speed")) {
      report_others(context, speed, {"max", "unit"});
      read_speed(context, speed, type);
    }
  });
  sort_records(context, road_node, road.types, &opendrive::RoadType::s, "road types");
}

inline void read_elevation(XmlContext& context, pugi::xml_node road_node, opendrive::RoadElement& road) {
  pugi::xml_node const node = find_only_child(context, road_node, "elevationProfile");
  read_container(context, node, road.rest, [&](pugi::xml_node child, std::string_view name) {
    if (name == "elevation") append_cubic(context, child, "s", road.elevation);
    return name == "elevation";
  });
  sort_records(context, node, road.elevation, &CubicRecord::s, "elevation");
}

inline void read_lateral_record(XmlContext& context, pugi::xml_node node, std::string_view name,
                                opendrive::RoadElement& road) {
  if (name == "superelevation") return append_cubic(context, node, "s", road.superelevation);
  if (name == "crossfall") {
    std::optional<CubicRecord> const record = read_cubic(context, node, "s", "side");
    if (!record) return;
    road.crossfall.push_back({*record, opendrive::Side::both});
    return AttributeReader(context, node, nullptr).optional("side", road.crossfall.back().side);
  }
  std::optional<CubicRecord> const record = read_cubic(context, node, "t", "s");
  std::optional<double> const s = context.number<double>(node, "s");
  if (record && s) road.shape.push_back({*s, *record});
}

inline void read_lateral_profile(XmlContext& context, pugi::xml_node road_node, opendrive::RoadElement& road) {
  pugi::xml_node const node = find_only_child(context, road_node, "lateralProfile");
  read_container(context, node, road.rest, [&](pugi::xml_node child, std::string_view name) {
    if (name != "superelevation" && name != "crossfall" && name != "shape") return false;
    read_lateral_record(context, child, name, road);
    return true;
  });
  sort_records(context, node, road.superelevation, &CubicRecord::s, "superelevation");
  sort_records(
      context, node, road.crossfall, [](auto const& c) { return c.record.s; }, "crossfall");
  sort_records(context, node, road.shape, &opendrive::LateralShape::s, "shape");
}

/// False when there is no usable lane section.
[[nodiscard]] inline bool read_lanes(XmlContext& context, pugi::xml_node road_node, opendrive::RoadElement& road) {
  pugi::xml_node const node = find_only_child(context, road_node, "lanes");
  std::size_t index = 0;
  read_container(context, node, road.rest, [&](pugi::xml_node child, std::string_view name) {
    if (name == "laneOffset") append_cubic(context, child, "s", road.lane_offset);
    if (name == "laneSection") {
      context.section = index++;
      if (!read_lane_section(context, child, road.lane_sections.emplace_back())) road.lane_sections.pop_back();
      context.section.reset();
    }
    return name == "laneOffset" || name == "laneSection";
  });
  sort_records(context, node, road.lane_offset, &CubicRecord::s, "laneOffset");
  sort_records(context, node, road.lane_sections, &opendrive::LaneSection::s, "lane sections");
  complete_single_sides(road.lane_sections);
  if (road.lane_sections.empty())
    context.report(Severity::warning, node ? node : road_node, "the road has no lane section");
  return !road.lane_sections.empty();
}

inline void read_signals(XmlContext& context, pugi::xml_node road_node, opendrive::RoadElement& road) {
  pugi::xml_node const node = find_only_child(context, road_node, "signals");
  read_container(context, node, road.rest, [&](pugi::xml_node child, std::string_view name) {
    if (name != "signal" && name != "signalReference") return false;
    auto& signals = name == "signal" ? road.signals : road.signal_references;
    append_with(context, child, signals, "validity", &opendrive::Signal::validities);
    return true;
  });
}

/// False when the road is unusable.
[[nodiscard]] inline bool read_road(XmlContext& context, pugi::xml_node node, opendrive::RoadElement& road) {
  road.length = -1.0;  // missing
  if (!read_attributes(context, node, road)) {
    context.report(Severity::warning, node, "the road was left out because it has no id");
    return false;
  }
  read_road_links(context, node, road);
  read_road_types(context, node, road);
  if (!read_plan_view(context, node, road) || !read_lanes(context, node, road)) {
    context.report(Severity::warning, node, "the road was left out, see the previous finding");
    return false;
  }
  read_elevation(context, node, road);
  read_lateral_profile(context, node, road);
  read_signals(context, node, road);
  constexpr std::string_view known[] = {"link",           "type",  "planView", "elevationProfile",
                                        "lateralProfile", "lanes", "signals"};
  for (bool const objects : {true, false})  // the order in which they are written
    for_each_child(node, [&](pugi::xml_node child, std::string_view name) {
      if ((name == "objects") == objects && std::find(std::begin(known), std::end(known), name) == std::end(known))
        keep_element(context, child, road.rest);
    });
  return true;
}

inline void read_top_level(XmlContext& context, pugi::xml_node node, std::string_view name,
                           OpenDriveDocument& document) {
  if (name == "header") {
    if (document.header.line > 0)
      return context.report(Severity::warning, node, "there is a second <header>; it was left out");
    document.header = read_header(context, node);
  } else if (name == "road") {
    pugi::xml_attribute const id = node.attribute("id");
    context.road = id ? id.value() : nullptr;
    if (!read_road(context, node, document.roads.emplace_back())) document.roads.pop_back();
    context.section.reset();
    context.road = nullptr;
  } else if (name == "junction") {
    context.junction = node.attribute("id").value();
    if (auto junction = read_junction(context, node)) document.junctions.push_back(std::move(*junction));
    context.junction = nullptr;
  } else if (name == "controller") {
    append_with(context, node, document.controllers, "control", &opendrive::Controller::controls);
  } else {
    keep_element(context, node, document.rest);
  }
}

}  // namespace detail

CAMBIUM_COLD OpenDriveDocument read_opendrive_document(std::string_view text, std::string file_name,
                                                       std::vector<Diagnostic>& diagnostics) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  pugi::xml_document xml;
  pugi::xml_node const root =
      detail::parse_root(xml, text, file_name, "OpenDRIVE", "give an OpenDRIVE file (usually named .xodr)");
  detail::XmlContext context(text, std::move(file_name), diagnostics);
  OpenDriveDocument document;
  for (pugi::xml_attribute a = root.first_attribute(); a; a = a.next_attribute())
    detail::keep_attribute(document.rest.attributes, a);
  detail::for_each_child(
      root, [&](pugi::xml_node node, std::string_view name) { detail::read_top_level(context, node, name, document); });
  detail::lose_text(context, root);
  context.report_losses();
  if (pugi::xml_node const next = root.next_sibling())
    context.report(Severity::warning, next, "what follows </OpenDRIVE> was left out");
  check_opendrive_document(document, context.file(), diagnostics);
  if (document.roads.empty())
    throw MapError(context.file(), "the file has no usable road" + detail::likely_cause(diagnostics),
                   "give a file with a road that has a plan view and lanes");
  return document;
}

}  // namespace cambium::inline v0_1::map
