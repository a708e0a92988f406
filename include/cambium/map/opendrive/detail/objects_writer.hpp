#pragma once

#include <string_view>
#include <vector>

#include "cambium/map/opendrive/detail/attribute_writer.hpp"
#include "cambium/map/opendrive/document.hpp"

namespace cambium::map::detail {

/// Elements that have lane validities.
template <class T>
void write_with_validities(XmlText& xml, std::string_view name, std::vector<T> const& all) {
  for (T const& x : all)
    xml.element(name, [&] {
      write_attributes(xml, x);
      write_leaves(xml, "validity", x.validities);
      write_rest(xml, x.rest);
    });
}

inline void write_outline(XmlText& xml, opendrive::Outline const& outline) {
  xml.element("outline", [&] {
    write_attributes(xml, outline);
    write_leaves(xml, "cornerRoad", outline.road_corners);
    write_leaves(xml, "cornerLocal", outline.local_corners);
    write_rest(xml, outline.rest);
  });
}

inline void write_object(XmlText& xml, opendrive::Object const& object) {
  xml.element("object", [&] {
    write_attributes(xml, object);
    write_leaves(xml, "repeat", object.repeats);
    write_container(xml, "outlines", object.rest, !object.outlines.empty(), [&] {
      for (opendrive::Outline const& outline : object.outlines) write_outline(xml, outline);
    });
    write_leaves(xml, "validity", object.validities);
    write_rest(xml, object.rest, {"outlines"});
  });
}

inline void write_objects(XmlText& xml, opendrive::Road const& road) {
  bool const needed = !road.objects.empty() || !road.object_references.empty();
  write_container(xml, "objects", road.rest, needed, [&] {
    for (opendrive::Object const& object : road.objects) write_object(xml, object);
    write_with_validities(xml, "objectReference", road.object_references);
  });
}

inline void write_signals(XmlText& xml, opendrive::Road const& road) {
  bool const needed = !road.signals.empty() || !road.signal_references.empty();
  write_container(xml, "signals", road.rest, needed, [&] {
    write_with_validities(xml, "signal", road.signals);
    write_with_validities(xml, "signalReference", road.signal_references);
  });
}

inline void write_controller(XmlText& xml, opendrive::Controller const& controller) {
  xml.element("controller", [&] {
    write_attributes(xml, controller);
    write_leaves(xml, "control", controller.controls);
    write_rest(xml, controller.rest);
  });
}

}  // namespace cambium::map::detail
