#pragma once

#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "cambium/map/opendrive/detail/attribute_reader.hpp"
#include "cambium/map/opendrive/document.hpp"

namespace cambium::map::detail {

/// As `read_leaf`, but `take(child, name, x)` may take children (true).
template <class T, class Take>
void append_with(XmlContext& context, pugi::xml_node node, std::vector<T>& list, Take const& take) {
  T x;
  if (!read_attributes(context, node, x))
    return context.report(Severity::warning, node, "it was left out for that, see the finding before");
  for_each_child(node, [&](pugi::xml_node child, std::string_view name) {
    if (!take(child, name, x)) keep_element(context, child, x.rest);
  });
  list.push_back(std::move(x));
}

/// As `read_leaf`, for what has lane validities.
template <class T>
void append_with_validities(XmlContext& context, pugi::xml_node node, std::vector<T>& list) {
  append_with(context, node, list, [&](pugi::xml_node child, std::string_view name, T& x) {
    if (name == "validity") append_leaf(context, child, x.validities);
    return name == "validity";
  });
}

inline void append_outline(XmlContext& context, pugi::xml_node node, opendrive::Object& object) {
  append_with(context, node, object.outlines, [&](pugi::xml_node child, std::string_view name, auto& outline) {
    if (name == "cornerRoad") append_leaf(context, child, outline.road_corners);
    if (name == "cornerLocal") append_leaf(context, child, outline.local_corners);
    return name == "cornerRoad" || name == "cornerLocal";
  });
}

/// An outline may stand in the object itself (until revision 1.4) or in its `outlines`.
inline void append_object(XmlContext& context, pugi::xml_node node, std::vector<opendrive::Object>& objects) {
  opendrive::Object object;
  if (!read_attributes(context, node, object))
    return context.report(Severity::warning, node, "it was left out for that, see the finding before");
  read_container(context, find_only_child(context, node, "outlines"), object.rest,
                 [&](pugi::xml_node child, std::string_view name) {
                   if (name == "outline") append_outline(context, child, object);
                   return name == "outline";
                 });
  for_each_child(node, [&](pugi::xml_node child, std::string_view name) {
    if (name == "outline") return append_outline(context, child, object);
    if (name == "repeat") return append_leaf(context, child, object.repeats);
    if (name == "validity") return append_leaf(context, child, object.validities);
    if (name != "outlines") keep_element(context, child, object.rest);
  });
  objects.push_back(std::move(object));
}

inline void read_objects(XmlContext& context, pugi::xml_node road_node, opendrive::Road& road) {
  read_container(context, find_only_child(context, road_node, "objects"), road.rest,
                 [&](pugi::xml_node child, std::string_view name) {
                   if (name == "object") append_object(context, child, road.objects);
                   if (name == "objectReference") append_with_validities(context, child, road.object_references);
                   return name == "object" || name == "objectReference";
                 });
}

inline void read_signals(XmlContext& context, pugi::xml_node road_node, opendrive::Road& road) {
  read_container(context, find_only_child(context, road_node, "signals"), road.rest,
                 [&](pugi::xml_node child, std::string_view name) {
                   if (name == "signal") append_with_validities(context, child, road.signals);
                   if (name == "signalReference") append_with_validities(context, child, road.signal_references);
                   return name == "signal" || name == "signalReference";
                 });
}

inline void append_controller(XmlContext& context, pugi::xml_node node,
                              std::vector<opendrive::Controller>& controllers) {
  append_with(context, node, controllers, [&](pugi::xml_node child, std::string_view name, auto& controller) {
    if (name == "control") append_leaf(context, child, controller.controls);
    return name == "control";
  });
}

}  // namespace cambium::map::detail
