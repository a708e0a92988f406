#pragma once

#include <optional>
#include <string_view>

#include "cambium/map/opendrive/detail/attribute_reader.hpp"
#include "cambium/map/opendrive/document.hpp"

namespace cambium::inline v0_1::map::detail {

inline void report_missing_contact_point(XmlContext& context, pugi::xml_node node) {
  if (*node.attribute("contactPoint").value() == '\0')
    context.report(Severity::warning, node, "contactPoint is missing; the reader cannot tell which end is meant");
}

[[nodiscard]] inline std::optional<opendrive::RoadLink> read_road_link(XmlContext& context, pugi::xml_node node) {
  opendrive::RoadLink link;
  if (!read_leaf(context, node, link)) return std::nullopt;
  if (link.element_type == opendrive::ElementType::junction)
    link.contact_point = opendrive::ContactPoint::none;
  else if (!link.element_s)
    report_missing_contact_point(context, node);
  return link;
}

inline void read_road_links(XmlContext& context, pugi::xml_node road_node, opendrive::RoadElement& road) {
  pugi::xml_node const node = find_only_child(context, road_node, "link");
  if (auto const child = find_only_child(context, node, "predecessor"))
    road.predecessor = read_road_link(context, child);
  if (auto const child = find_only_child(context, node, "successor")) road.successor = read_road_link(context, child);
  read_container(context, node, road.rest,
                 [](pugi::xml_node, std::string_view name) { return name == "predecessor" || name == "successor"; });
}

[[nodiscard]] inline opendrive::Connection read_connection(XmlContext& context, pugi::xml_node node) {
  opendrive::Connection connection;
  static_cast<void>(read_attributes(context, node, connection));  // it needs none
  for_each_child(node, [&](pugi::xml_node child, std::string_view name) {
    if (name == "laneLink")
      append_leaf(context, child, connection.lane_links);
    else if (name == "predecessor" && !connection.predecessor)
      connection.predecessor = read_road_link(context, child);
    else if (name == "successor" && !connection.successor)
      connection.successor = read_road_link(context, child);
    else
      keep_element(context, child, connection.rest);
  });
  if (!connection.predecessor && !connection.successor) report_missing_contact_point(context, node);
  return connection;
}

[[nodiscard]] inline std::optional<opendrive::JunctionElement> read_junction(XmlContext& context, pugi::xml_node node) {
  opendrive::JunctionElement junction;
  if (!read_attributes(context, node, junction)) {
    context.report(Severity::warning, node, "the junction was left out because it has no id");
    return std::nullopt;
  }
  for_each_child(node, [&](pugi::xml_node child, std::string_view name) {
    if (name == "connection")
      junction.connections.push_back(read_connection(context, child));
    else if (name == "priority")
      append_leaf(context, child, junction.priorities);
    else
      keep_element(context, child, junction.rest);
  });
  return junction;
}

}  // namespace cambium::inline v0_1::map::detail
