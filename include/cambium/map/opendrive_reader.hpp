#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <pugixml.hpp>

#include "cambium/core/diagnostic.hpp"
#include "cambium/core/error.hpp"
#include "cambium/map/detail/opendrive_lanes.hpp"
#include "cambium/map/detail/stable_sort.hpp"
#include "cambium/map/detail/xml_context.hpp"
#include "cambium/map/opendrive_check.hpp"
#include "cambium/map/opendrive_document.hpp"

namespace cambium::map {
namespace detail {

[[nodiscard]] inline opendrive::Header read_header(XmlContext& context, pugi::xml_node node) {
  opendrive::Header header;
  header.line = context.line(node);
  header.rev_major = context.number_or(node, "revMajor", 0);
  header.rev_minor = context.number_or(node, "revMinor", 0);
  header.name = node.attribute("name").value();
  header.vendor = node.attribute("vendor").value();
  header.north = context.number_or(node, "north", 0.0);
  header.south = context.number_or(node, "south", 0.0);
  header.east = context.number_or(node, "east", 0.0);
  header.west = context.number_or(node, "west", 0.0);
  header.geo_reference = trimmed(find_child(node, "geoReference").child_value());
  if (pugi::xml_node const offset = find_child(node, "offset"))
    header.offset = {context.number_or(offset, "x", 0.0), context.number_or(offset, "y", 0.0),
                     context.number_or(offset, "z", 0.0), context.number_or(offset, "hdg", 0.0)};
  return header;
}

[[nodiscard]] inline opendrive::ContactPoint read_contact_point(XmlContext& context, pugi::xml_node node) {
  std::string_view const word = node.attribute("contactPoint").value();
  if (word == "start") return opendrive::ContactPoint::start;
  if (word == "end") return opendrive::ContactPoint::end;
  context.report(Severity::warning, node,
                 word.empty() ? "contactPoint is missing; the reader cannot tell which end is meant"
                              : "contactPoint=\"" + std::string(word) + "\" is neither start nor end");
  return opendrive::ContactPoint::none;
}

[[nodiscard]] inline std::optional<opendrive::RoadLink> read_road_link(XmlContext& context, pugi::xml_node road,
                                                                       char const* name) {
  pugi::xml_node const node = find_child(find_child(road, "link"), name);
  if (!node) return std::nullopt;
  opendrive::RoadLink link;
  link.line = context.line(node);
  link.id = trimmed(node.attribute("elementId").value());
  std::string_view const type = node.attribute("elementType").value();
  if (link.id.empty() || (type != "road" && type != "junction")) {
    context.report(Severity::warning, node,
                   "the link was left out: it needs an elementId and the elementType road or junction");
    return std::nullopt;
  }
  if (type == "junction")
    link.element_type = opendrive::ElementType::junction;
  else if (node.attribute("elementS"))
    link.element_s = context.number<double>(node, "elementS");
  else
    link.contact_point = read_contact_point(context, node);
  return link;
}

[[nodiscard]] inline bool has_usable_cubic(XmlContext& context, pugi::xml_node node, Geometry const& g) {
  if (!g.cubic->is_regular()) {
    context.report(Severity::warning, node, "the curve has no length, or stops somewhere");
    return false;
  }
  double const length = g.cubic->length();
  if (std::abs(length - g.length) > 1e-3 * g.length)
    context.report(Severity::warning, node,
                   "the curve is " + rounded_text(length) + " m long, its length attribute says " +
                       rounded_text(g.length) + " m; it is stretched along to that");
  return true;
}

[[nodiscard]] inline bool read_poly3(XmlContext& context, pugi::xml_node node, Geometry& g) {
  ParametricCubic::Coefficients v{};
  if (!context.numbers(node, {{"a", &v[0]}, {"b", &v[1]}, {"c", &v[2]}, {"d", &v[3]}})) return false;
  if (!(g.length > 0.0)) return true;  // left out later
  g.kind = GeometryKind::cubic;
  g.cubic = std::make_shared<ParametricCubic const>(ParametricCubic::along_u(v, g.length));
  return has_usable_cubic(context, node, g);
}

[[nodiscard]] inline bool read_param_poly3(XmlContext& context, pugi::xml_node node, Geometry& g) {
  ParametricCubic::Coefficients u{}, v{};
  if (!context.numbers(node, {{"aU", &u[0]},
                              {"bU", &u[1]},
                              {"cU", &u[2]},
                              {"dU", &u[3]},
                              {"aV", &v[0]},
                              {"bV", &v[1]},
                              {"cV", &v[2]},
                              {"dV", &v[3]}}))
    return false;
  if (!(g.length > 0.0)) return true;
  std::string_view const range = node.attribute("pRange").value();
  if (range != "arcLength" && range != "normalized")
    context.report(Severity::warning, node, "pRange is neither arcLength nor normalized; normalized was taken");
  g.kind = GeometryKind::cubic;
  g.cubic = std::make_shared<ParametricCubic const>(u, v, range == "arcLength" ? g.length : 1.0);
  return has_usable_cubic(context, node, g);
}

/// The curve of a geometry element: the child that says its kind may stand anywhere among other children.
[[nodiscard]] inline bool read_curve(XmlContext& context, pugi::xml_node node, Geometry& g) {
  for (pugi::xml_node child = node.first_child(); child; child = child.next_sibling()) {
    std::string_view const kind = local_name(child);
    if (kind == "line") return true;
    if (kind == "arc") {
      g.kind = GeometryKind::arc;
      if (!context.numbers(child, {{"curvature", &g.curvature_start}})) return false;
      g.curvature_end = g.curvature_start;
      return true;
    }
    if (kind == "spiral") {
      g.kind = GeometryKind::spiral;
      return context.numbers(child, {{"curvStart", &g.curvature_start}, {"curvEnd", &g.curvature_end}});
    }
    if (kind == "poly3") return read_poly3(context, child, g);
    if (kind == "paramPoly3") return read_param_poly3(context, child, g);
  }
  context.report(Severity::warning, node, "the geometry is none of line, arc, spiral, poly3, paramPoly3");
  return false;
}

/// False when the geometry is unusable, and the road with it. One of length 0 is left out, which harms nothing.
[[nodiscard]] inline bool read_geometry(XmlContext& context, pugi::xml_node node, opendrive::Road& road) {
  Geometry g;
  if (!context.numbers(node, {{"s", &g.s}, {"x", &g.x}, {"y", &g.y}, {"hdg", &g.heading}, {"length", &g.length}}) ||
      !read_curve(context, node, g))
    return false;
  if (g.length < 0.0) {
    context.report(Severity::warning, node, "the length is negative");
    return false;
  }
  if (g.length == 0.0) {
    context.report(Severity::info, node, "a geometry of length 0 was left out");
    return true;
  }
  constexpr double farthest = 1e8, longest = 1e6;  // [m]: beyond any map
  if (!(std::abs(g.x) <= farthest && std::abs(g.y) <= farthest && std::abs(g.s) <= longest && g.length <= longest)) {
    context.report(Severity::warning, node, "a coordinate lies beyond 100 000 km, or a length beyond 1000 km");
    return false;
  }
  if (!(std::abs(g.heading) <= 1e4)) {
    context.report(Severity::warning, node, "hdg is beyond 10 000 rad");
    return false;
  }
  constexpr double max_turn = 1000.0;  // rad: more than any road, little enough to be integrated
  if (!(std::max(std::abs(g.curvature_start), std::abs(g.curvature_end)) * g.length < max_turn)) {
    context.report(Severity::warning, node, "the curve turns by more than 1000 rad");
    return false;
  }
  road.geometries.push_back(g);
  road.geometry_lines.push_back(context.line(node));
  return true;
}

inline void sort_geometries(XmlContext& context, pugi::xml_node plan_view, opendrive::Road& road) {
  std::vector<std::pair<Geometry, int>> both;
  for (std::size_t i = 0; i < road.geometries.size(); ++i)
    both.emplace_back(road.geometries[i], road.geometry_lines[i]);
  if (!stable_sort(both, [](std::pair<Geometry, int> const& g) { return g.first.s; })) return;
  for (std::size_t i = 0; i < both.size(); ++i) {
    road.geometries[i] = both[i].first;
    road.geometry_lines[i] = both[i].second;
  }
  context.report(Severity::warning, plan_view, "geometries are not in the order of s; they were sorted");
}

/// False when there is no usable plan view.
[[nodiscard]] inline bool read_plan_view(XmlContext& context, pugi::xml_node road_node, opendrive::Road& road) {
  pugi::xml_node const node = find_child(road_node, "planView");
  for (pugi::xml_node child = node.first_child(); child; child = child.next_sibling())
    if (local_name(child) == "geometry" && !read_geometry(context, child, road)) return false;
  if (road.geometries.empty()) {
    context.report(Severity::warning, node ? node : road_node, "the road has no geometry");
    return false;
  }
  sort_geometries(context, node, road);
  return true;
}

inline void read_road_types(XmlContext& context, pugi::xml_node road_node, opendrive::Road& road) {
  for_each_child(road_node, "type", [&](pugi::xml_node node) {
    opendrive::RoadType type{context.number_or(node, "s", 0.0), node.attribute("type").value(), std::nullopt};
    if (pugi::xml_node const speed = find_child(node, "speed")) type.limit = read_speed(context, speed);
    road.types.push_back(std::move(type));
  });
  sort_records(context, road_node, road.types, &opendrive::RoadType::s, "road types");
}

/// False when there is no usable lane section.
[[nodiscard]] inline bool read_lanes(XmlContext& context, pugi::xml_node road_node, opendrive::Road& road) {
  pugi::xml_node const node = find_child(road_node, "lanes");
  road.lane_offset = read_cubics(context, node, "laneOffset", "s");
  std::size_t index = 0;
  for_each_child(node, "laneSection", [&](pugi::xml_node section_node) {
    context.section = index++;
    if (std::optional<opendrive::LaneSection> section = read_lane_section(context, section_node))
      road.lane_sections.push_back(std::move(*section));
  });
  context.section.reset();
  sort_records(context, node, road.lane_sections, &opendrive::LaneSection::s, "lane sections");
  complete_single_sides(road.lane_sections);
  if (road.lane_sections.empty())
    context.report(Severity::warning, node ? node : road_node, "the road has no lane section");
  return !road.lane_sections.empty();
}

[[nodiscard]] inline std::optional<opendrive::Road> read_road(XmlContext& context, pugi::xml_node node) {
  opendrive::Road road;
  road.line = context.line(node);
  road.id = trimmed(node.attribute("id").value());
  if (road.id.empty()) {
    context.report(Severity::error, node, "the road was left out, for it has no id");
    return std::nullopt;
  }
  road.name = node.attribute("name").value();
  road.length = context.number_or(node, "length", -1.0);
  road.junction = trimmed(node.attribute("junction").value());
  if (road.junction == "-1") road.junction.clear();
  std::string_view const rule = node.attribute("rule").value();
  if (rule == "LHT") road.rule = opendrive::TrafficRule::left_hand;
  if (!rule.empty() && rule != "LHT" && rule != "RHT")
    context.report(Severity::warning, node, "rule=\"" + std::string(rule) + "\" is neither RHT nor LHT; RHT was taken");
  road.predecessor = read_road_link(context, node, "predecessor");
  road.successor = read_road_link(context, node, "successor");
  read_road_types(context, node, road);
  if (!read_plan_view(context, node, road) || !read_lanes(context, node, road)) {
    context.report(Severity::warning, node, "the road was left out, see the finding before");
    return std::nullopt;
  }
  road.elevation = read_cubics(context, find_child(node, "elevationProfile"), "elevation", "s");
  road.superelevation = read_cubics(context, find_child(node, "lateralProfile"), "superelevation", "s");
  return road;
}

[[nodiscard]] inline opendrive::Connection read_connection(XmlContext& context, pugi::xml_node node) {
  opendrive::Connection connection;
  connection.line = context.line(node);
  connection.id = node.attribute("id").value();
  connection.incoming_road = trimmed(node.attribute("incomingRoad").value());
  pugi::xml_attribute const connecting = node.attribute("connectingRoad");
  connection.connecting_road = trimmed((connecting ? connecting : node.attribute("linkedRoad")).value());
  connection.contact_point = read_contact_point(context, node);
  for_each_child(node, "laneLink", [&](pugi::xml_node link) {
    std::optional<int> const from = context.number<int>(link, "from");
    std::optional<int> const to = context.number<int>(link, "to");
    if (from && to) connection.lane_links.push_back({*from, *to});
  });
  return connection;
}

[[nodiscard]] inline std::optional<opendrive::Junction> read_junction(XmlContext& context, pugi::xml_node node) {
  opendrive::Junction junction;
  junction.line = context.line(node);
  junction.id = trimmed(node.attribute("id").value());
  if (junction.id.empty()) {
    context.report(Severity::error, node, "the junction was left out, for it has no id");
    return std::nullopt;
  }
  junction.name = node.attribute("name").value();
  if (node.attribute("type")) junction.type = node.attribute("type").value();
  for_each_child(node, "connection",
                 [&](pugi::xml_node child) { junction.connections.push_back(read_connection(context, child)); });
  return junction;
}

/// The root element; throws when the text is no XML or its root is another one.
[[nodiscard]] inline pugi::xml_node parse_root(pugi::xml_document& xml, std::string_view text,
                                               std::string const& file) {
  pugi::xml_parse_result const result =
      xml.load_buffer(text.data(), text.size(), pugi::parse_cdata | pugi::parse_escapes);
  if (!result) {
    int const line = LineTable(text).line(result.offset);
    throw MapError(file + ":" + std::to_string(std::max(1, line)),
                   "the file is not well-formed XML (" + std::string(result.description()) + ")",
                   "repair it there, or export it again");
  }
  pugi::xml_node const root = xml.document_element();
  if (local_name(root) != "OpenDRIVE")
    throw MapError(file + ":" + std::to_string(LineTable(text).line(root.offset_debug())),
                   "the root element is <" + std::string(root.name()) + ">, not <OpenDRIVE>",
                   "give an OpenDRIVE file (usually named .xodr)");
  return root;
}

}  // namespace detail

/// Reads an OpenDRIVE file (revisions 1.1 to 1.8) from its text; `file_name` only names it in messages. Numbers are
/// read in the C locale. What is odd goes to `diagnostics`, and is read as far as it makes sense: a bad record is left
/// out, a road with an unusable geometry too. Elements that are not listed in
/// `opendrive::Document` are passed over silently. An XML namespace prefix is ignored. Throws `MapError` when the text
/// is no XML, its root is not OpenDRIVE, or no road is usable. Linear in the length of the text; lines are counted in
/// bytes of UTF-8.
[[nodiscard]] inline OpenDriveDocument read_opendrive_document(std::string_view text, std::string file_name,
                                                               std::vector<Diagnostic>& diagnostics) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  pugi::xml_document xml;
  pugi::xml_node const root = detail::parse_root(xml, text, file_name);
  detail::XmlContext context(text, std::move(file_name), diagnostics);
  OpenDriveDocument document;
  detail::for_each_child(root, [&](pugi::xml_node node, std::string_view name) {
    if (name == "header") document.header = detail::read_header(context, node);
    if (name == "road") {
      pugi::xml_attribute const id = node.attribute("id");
      context.road = id ? id.value() : nullptr;
      if (auto road = detail::read_road(context, node)) document.roads.push_back(std::move(*road));
      context.section.reset();
      context.road = nullptr;
    }
    if (name == "junction") {
      context.junction = node.attribute("id").value();
      if (auto junction = detail::read_junction(context, node)) document.junctions.push_back(std::move(*junction));
      context.junction = nullptr;
    }
  });
  check_opendrive_document(document, context.file(), diagnostics);
  if (document.roads.empty()) {
    std::string why;
    for (Diagnostic const& d : diagnostics)
      if (why.empty() && d.severity != Severity::info && d.line > 0) why = " (first finding: " + to_string(d) + ")";
    throw MapError(context.file(), "the file has no usable road" + why,
                   "give a file with a road that has a plan view and lanes");
  }
  return document;
}

}  // namespace cambium::map
