#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/geometry/box.hpp"
#include "cambium/map/lanes/junction.hpp"
#include "cambium/map/lanes/lane_network.hpp"
#include "cambium/map/lanes/right_of_way.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/opendrive/document.hpp"

#include "opened_map.hpp"

namespace map_example {

namespace cb = cambium;
namespace odr = cambium::map::opendrive;

/// A number of metres to the centimetre.
inline std::string metres(double value) { return cb::detail::rounded_text(std::round(100.0 * value) / 100.0 + 0.0); }

/// "3 arc, 2 line" from counts by name.
inline std::string list(std::map<std::string, std::size_t> const& counts) {
  std::string text;
  for (auto const& [name, count] : counts) text += (text.empty() ? "" : ", ") + std::to_string(count) + ' ' + name;
  return text.empty() ? "none" : text;
}

inline std::string line(std::string_view name, std::string const& text) {
  return "  " + std::string(name) + std::string(name.size() < 15 ? 15 - name.size() : 1, ' ') + text + '\n';
}

inline char const* kind_of(cb::map::Geometry const& g) {
  constexpr char const* words[] = {"line", "arc", "spiral", "cubic"};
  return words[static_cast<std::size_t>(g.kind)];
}

/// "dead end" for `dead_end`.
inline std::string readable(cb::map::NetworkFault fault) {
  std::string word(to_string(fault));
  std::replace(word.begin(), word.end(), '_', ' ');
  return word;
}

inline std::string header_text(odr::Header const& header) {
  std::string text = "OpenDRIVE, revision not written";
  if (header.rev_major > 0)
    text = "OpenDRIVE " + std::to_string(header.rev_major) + "." + std::to_string(header.rev_minor);
  if (!header.name.empty()) text += " \"" + header.name + '"';
  if (!header.vendor.empty()) text += " by " + header.vendor;
  return cb::detail::printable(text);
}

/// Summary of the file: what is written in it.
inline std::string document_text(odr::Document const& document) {
  std::map<std::string, std::size_t> geometries, junctions;
  std::size_t sections = 0, signals = 0, references = 0, objects = 0, connections = 0, left_hand = 0;
  for (auto const& road : document.roads) {
    for (auto const& g : road.geometries) ++geometries[kind_of(g)];
    sections += road.lane_sections.size();
    signals += road.signals.size();
    references += road.signal_references.size();
    for (auto const& element : road.rest.elements)
      if (element.name == "objects")
        for (auto const& child : element.children) objects += child.name == "object";
    left_hand += road.rule == odr::DrivingSide::left_hand;
  }
  constexpr char const* words[] = {"default", "direct", "virtual", "crossing", "other"};
  for (auto const& junction : document.junctions) {
    ++junctions[words[static_cast<std::size_t>(junction.type)]];
    connections += junction.connections.size();
  }
  std::string text = line("file", header_text(document.header));
  if (!document.header.geo_reference.empty())
    text += line("projection", cb::detail::printable(document.header.geo_reference));
  text += line("roads", std::to_string(document.roads.size()) + ", " + std::to_string(sections) +
                            " lane sections; geometries: " + list(geometries) +
                            (left_hand > 0 ? "; left-hand traffic" : ""));
  text += line("junctions", list(junctions) + "; " + std::to_string(connections) + " connections");
  text += line("signals", std::to_string(signals) + ", " + std::to_string(references) + " references, " +
                              std::to_string(document.controllers.size()) + " controllers; " + std::to_string(objects) +
                              " objects");
  return text;
}

/// Counts of overlaps between lanes.
inline std::string overlaps_text(cb::Map const& map) {
  std::map<std::string, std::size_t> overlaps;
  constexpr char const* kinds[] = {"merges", "splits", "crossings"};
  for (auto const& lane : map.lanes())
    for (auto const& overlap : lane.overlaps)
      if (lane.id < overlap.other) ++overlaps[kinds[static_cast<std::size_t>(overlap.kind)]];
  std::size_t in_junctions = 0, ruled = 0;
  for (auto const& junction : map.junctions())
    for (auto const& conflict : conflict_areas(map, junction.id)) {
      ++in_junctions;
      ruled += goes_first(junction, map.lane(conflict.first).road, map.lane(conflict.second).road).has_value();
    }
  if (in_junctions == 0) return list(overlaps);
  return list(overlaps) + "; " + std::to_string(in_junctions) + " of them in junctions, where priorities rule " +
         std::to_string(ruled);
}

/// Whether the lane has a positive, finite width somewhere; otherwise nobody can drive on it.
inline bool has_width(cb::map::Lane const& lane) {
  return std::any_of(lane.widths.begin(), lane.widths.end(),
                     [](auto const& sides) { return std::isfinite(sides.left) && sides.left + sides.right > 0.0; });
}

/// Whether the file needs attention: a warning, an error, or a road that is not in the map.
inline bool is_odd(OpenedMap const& opened) {
  return opened.map->roads().size() < opened.document.roads.size() ||
         std::any_of(opened.diagnostics.begin(), opened.diagnostics.end(),
                     [](auto const& diagnostic) { return diagnostic.severity != cb::Severity::info; });
}

/// Summary of the map built from the file.
inline std::string map_text(cb::Map const& map) {
  std::map<std::string, std::size_t> types, faults;
  std::size_t merging = 0;
  double length = 0.0;
  for (auto const& lane : map.lanes()) {
    ++types[std::string(to_string(lane.type))];
    if (!lane.drivable() || !has_width(lane)) continue;
    length += lane.length();
    merging += is_valid(lane.merges_into);
  }
  for (auto const& finding : check_lane_network(map)) ++faults[readable(finding.fault)];
  std::string text = line("lanes", list(types));
  if (!map.lanes().empty()) {
    auto const& box = map.bounds();
    text += line("extent", "x from " + metres(box.min_x) + " to " + metres(box.max_x) + ", y from " +
                               metres(box.min_y) + " to " + metres(box.max_y) + " m");
  }
  if (length == 0.0) return text + line("to drive on", "no lane");
  text += line("to drive on", metres(length) + " m of lanes; " + std::to_string(merging) +
                                  (merging == 1 ? " merges" : " merge") + " into a neighbour");
  return text + line("overlaps", overlaps_text(map)) + line("network", list(faults));
}

/// Summary of the file and the map, and counts of the diagnostics.
inline std::string summary(OpenedMap const& opened, std::string const& file) {
  std::map<std::string, std::size_t> severities;
  for (auto const& diagnostic : opened.diagnostics) ++severities[std::string(to_string(diagnostic.severity))];
  auto const content = opened.lanelets.empty() ? document_text(opened.document)
                                               : line("file", cb::detail::printable(opened.lanelets)) +
                                                     line("lights", std::to_string(opened.map->lights().size()));
  return file + '\n' + content + map_text(*opened.map) +
         line("diagnostics", severities.empty() ? "none" : list(severities));
}

}  // namespace map_example
