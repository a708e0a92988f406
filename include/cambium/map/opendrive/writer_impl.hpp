#pragma once

#include <cmath>
#include <cstddef>
#include <string_view>
#include <vector>

#include "cambium/core/macros.hpp"
#include "cambium/core/write_file.hpp"
#include "cambium/map/opendrive/detail/attribute_writer.hpp"
#include "cambium/map/opendrive/detail/lanes_writer.hpp"
#include "cambium/map/opendrive/writer.hpp"

namespace cambium::inline v0_1::map {

namespace detail {

inline void write_header(XmlText& xml, opendrive::Header const& header) {
  xml.element("header", [&] {
    write_attributes(xml, header);
    if (!header.geo_reference.empty()) xml.element("geoReference", [&] { xml.text(header.geo_reference); });
    if (!(header.offset == opendrive::HeaderOffset{}))
      xml.element("offset", [&] {
        AttributeWriter writer(xml, nullptr);
        fields(writer, header.offset);
      });
    write_rest(xml, header.rest);
  });
}

/// A cubic as the element that it was read from: its parameter ends at the geometry's length, at 1, or is u itself.
/// One that does not is written with the coefficients that make it end at 1.
inline void write_curve(XmlText& xml, ParametricCubic const& cubic, double length) {
  using Coefficients = ParametricCubic::Coefficients;
  bool const by_length = cubic.end() == length, is_normalized = !by_length && cubic.end() == 1.0;
  if (!by_length && !is_normalized && cubic.u() == Coefficients{0, 1, 0, 0} &&
      std::abs(cubic.length() - length) <= 1e-9 * length)
    return xml.element("poly3", [&] {
      for (std::size_t i = 0; i < 4; ++i) write_number(xml, poly3_kind.attributes[i], cubic.v()[i]);
    });
  xml.element("paramPoly3", [&] {
    for (std::size_t i = 0; i < 8; ++i) {
      double const scale = by_length || is_normalized ? 1.0 : std::pow(cubic.end(), static_cast<double>(i % 4));
      write_number(xml, param_poly3_kind.attributes[i], scale * (i < 4 ? cubic.u() : cubic.v())[i % 4]);
    }
    xml.attribute("pRange", by_length ? "arcLength" : "normalized");
  });
}

inline void write_geometry(XmlText& xml, Geometry const& g, opendrive::Rest const& rest) {
  xml.element("geometry", [&] {
    AttributeWriter writer(xml, &rest);
    fields(writer, g);
    for (opendrive::Attribute const& a : rest.attributes) xml.attribute(a.name, a.value);
    if (g.kind == GeometryKind::cubic && g.cubic)
      write_curve(xml, *g.cubic, g.length);
    else if (g.kind == GeometryKind::spiral)
      xml.element("spiral", [&] {
        write_number(xml, "curvStart", g.curvature_start);
        write_number(xml, "curvEnd", g.curvature_end);
      });
    else if (g.kind == GeometryKind::arc)
      xml.element("arc", [&] { write_number(xml, "curvature", g.curvature_start); });
    else
      xml.element("line", [] {});
    write_rest(xml, rest);
  });
}

inline void write_plan_view(XmlText& xml, opendrive::RoadElement const& road) {
  write_container(xml, "planView", road.rest, true, [&] {
    opendrive::Rest const nothing;
    auto rest = road.geometry_rests.begin();
    for (std::size_t i = 0; i < road.geometries.size(); ++i) {
      while (rest != road.geometry_rests.end() && rest->geometry < i) ++rest;
      bool const has_rest = rest != road.geometry_rests.end() && rest->geometry == i;
      write_geometry(xml, road.geometries[i], has_rest ? rest->rest : nothing);
    }
  });
}

inline void write_road_links(XmlText& xml, opendrive::RoadElement const& road) {
  write_container(xml, "link", road.rest, road.predecessor || road.successor, [&] {
    if (road.predecessor) write_leaf(xml, "predecessor", *road.predecessor);
    if (road.successor) write_leaf(xml, "successor", *road.successor);
  });
}

inline void write_road_type(XmlText& xml, opendrive::RoadType const& type) {
  xml.element("type", [&] {
    write_attributes(xml, type);
    if (type.limit) xml.element("speed", [&] { write_limit(xml, type.limit, type.unit); });
    write_rest(xml, type.rest);
  });
}

inline void write_profiles(XmlText& xml, opendrive::RoadElement const& road) {
  write_container(xml, "elevationProfile", road.rest, !road.elevation.empty(),
                  [&] { write_cubics(xml, "elevation", "s", road.elevation); });
  bool const is_flat = road.superelevation.empty() && road.crossfall.empty() && road.shape.empty();
  write_container(xml, "lateralProfile", road.rest, !is_flat, [&] {
    write_cubics(xml, "superelevation", "s", road.superelevation);
    for (opendrive::Crossfall const& crossfall : road.crossfall)
      xml.element("crossfall", [&] {
        xml.attribute("side", word_of(crossfall.side));
        write_cubic(xml, "s", crossfall.record);
      });
    for (opendrive::LateralShape const& shape : road.shape)
      xml.element("shape", [&] {
        write_number(xml, "s", shape.s);
        write_cubic(xml, "t", shape.record);
      });
  });
}

/// Elements with a list of parts.
template <class T, class Part>
void write_with(XmlText& xml, std::string_view name, std::vector<T> const& all, std::string_view part,
                std::vector<Part> T::*parts) {
  for (T const& x : all)
    xml.element(name, [&] {
      write_attributes(xml, x);
      write_leaves(xml, part, x.*parts);
      write_rest(xml, x.rest);
    });
}

/// Objects, which are nothing but rest, stand before the signals.
inline void write_objects_and_signals(XmlText& xml, opendrive::RoadElement const& road) {
  for (opendrive::Element const& element : road.rest.elements)
    if (element.name == "objects") write_element(xml, element);
  bool const needed = !road.signals.empty() || !road.signal_references.empty();
  write_container(xml, "signals", road.rest, needed, [&] {
    write_with(xml, "signal", road.signals, "validity", &opendrive::Signal::validities);
    write_with(xml, "signalReference", road.signal_references, "validity", &opendrive::Signal::validities);
  });
}

inline void write_road(XmlText& xml, opendrive::RoadElement const& road) {
  xml.element("road", [&] {
    write_attributes(xml, road);
    write_road_links(xml, road);
    for (opendrive::RoadType const& type : road.types) write_road_type(xml, type);
    write_plan_view(xml, road);
    write_profiles(xml, road);
    write_container(xml, "lanes", road.rest, true, [&] {
      write_cubics(xml, "laneOffset", "s", road.lane_offset);
      for (opendrive::LaneSection const& section : road.lane_sections) write_lane_section(xml, section);
    });
    write_objects_and_signals(xml, road);
    write_rest(xml, road.rest,
               {"link", "planView", "elevationProfile", "lateralProfile", "lanes", "objects", "signals"});
  });
}

inline void write_connection(XmlText& xml, opendrive::Connection const& connection) {
  xml.element("connection", [&] {
    write_attributes(xml, connection);
    if (connection.predecessor) write_leaf(xml, "predecessor", *connection.predecessor);
    if (connection.successor) write_leaf(xml, "successor", *connection.successor);
    write_leaves(xml, "laneLink", connection.lane_links);
    write_rest(xml, connection.rest);
  });
}

inline void write_junction(XmlText& xml, opendrive::JunctionElement const& junction) {
  xml.element("junction", [&] {
    write_attributes(xml, junction);
    for (opendrive::Connection const& connection : junction.connections) write_connection(xml, connection);
    write_leaves(xml, "priority", junction.priorities);
    write_rest(xml, junction.rest);
  });
}

}  // namespace detail

CAMBIUM_COLD std::string write_opendrive(OpenDriveDocument const& document) {
  detail::XmlText xml;
  xml.element("OpenDRIVE", [&] {
    for (opendrive::Attribute const& a : document.rest.attributes) xml.attribute(a.name, a.value);
    if (document.header.line != 0 || !(document.header == opendrive::Header{}))
      detail::write_header(xml, document.header);
    for (opendrive::RoadElement const& road : document.roads) detail::write_road(xml, road);
    detail::write_with(xml, "controller", document.controllers, "control", &opendrive::Controller::controls);
    for (opendrive::JunctionElement const& junction : document.junctions) detail::write_junction(xml, junction);
    detail::write_rest(xml, document.rest);
  });
  return xml.take();
}

CAMBIUM_COLD void write_opendrive(std::filesystem::path const& path, OpenDriveDocument const& document) {
  write_file(path, write_opendrive(document));
}

}  // namespace cambium::inline v0_1::map
