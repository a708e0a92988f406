#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/geometry/box.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/opendrive_document.hpp"

#include "../common/map_file.hpp"

namespace map_example {

namespace cb = cambium;
namespace odr = cambium::map::opendrive;

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

inline std::string header_text(odr::Header const& header) {
  std::string text = "OpenDRIVE, revision not written";
  if (header.rev_major > 0)
    text = "OpenDRIVE " + std::to_string(header.rev_major) + "." + std::to_string(header.rev_minor);
  if (!header.name.empty()) text += " \"" + header.name + '"';
  if (!header.vendor.empty()) text += " by " + header.vendor;
  return cb::detail::printable(text);
}

/// What is written in the file.
inline std::string document_text(odr::Document const& document) {
  std::map<std::string, std::size_t> geometries, junctions;
  std::size_t sections = 0, signals = 0, references = 0, objects = 0, connections = 0, left_hand = 0;
  for (auto const& road : document.roads) {
    for (auto const& g : road.geometries) ++geometries[kind_of(g)];
    sections += road.lane_sections.size();
    signals += road.signals.size();
    references += road.signal_references.size();
    objects += road.objects.size();
    left_hand += road.rule == odr::TrafficRule::left_hand;
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

/// What the map has.
inline std::string map_text(cb::Map const& map) {
  std::map<std::string, std::size_t> types, overlaps;
  constexpr char const* kinds[] = {"merges", "splits", "crossings"};
  std::size_t dead_ends = 0, merging = 0;
  double length = 0.0;
  cb::geometry::Box box;
  for (auto const& lane : map.lanes()) {
    ++types[std::string(to_string(lane.type))];
    if (!lane.drivable()) continue;
    length += lane.length();
    dead_ends += lane.successors.empty();
    merging += is_valid(lane.merges_into);
    for (auto const& p : lane.path.points()) box.add(p.x(), p.y());
    for (auto const& overlap : lane.overlaps)
      if (lane.id < overlap.other) ++overlaps[kinds[static_cast<std::size_t>(overlap.kind)]];
  }
  using cb::detail::rounded_text;
  std::string text = line("lanes", list(types));
  if (length == 0.0) return text + line("to drive on", "no lane");
  text += line("to drive on", rounded_text(length) + " m of lanes, x from " + rounded_text(box.min_x) + " to " +
                                  rounded_text(box.max_x) + ", y from " + rounded_text(box.min_y) + " to " +
                                  rounded_text(box.max_y) + " m");
  text += line("lane ends", std::to_string(dead_ends) + " without a way on, " + std::to_string(merging) +
                                " that merge into a neighbour");
  return text + line("overlaps", list(overlaps));
}

/// What the file contains and how much is odd about it.
inline std::string summary(examples::OpenedMap const& opened, std::string const& file) {
  std::map<std::string, std::size_t> severities;
  for (auto const& diagnostic : opened.diagnostics) ++severities[std::string(to_string(diagnostic.severity))];
  return file + '\n' + document_text(opened.document) + map_text(*opened.map) +
         line("diagnostics", severities.empty() ? "none" : list(severities));
}

}  // namespace map_example
