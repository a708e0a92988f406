#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/stable_sort.hpp"
#include "cambium/map/detail/geometry_fault.hpp"
#include "cambium/map/opendrive/detail/attribute_reader.hpp"
#include "cambium/map/opendrive/detail/fields.hpp"
#include "cambium/map/road/reference_line.hpp"

namespace cambium::inline v0_1::map::detail {

using cambium::detail::rounded_text;

/// Sets the curve; false where it is unusable.
[[nodiscard]] inline bool set_cubic(XmlContext& context, pugi::xml_node node, ParametricCubic const& cubic,
                                    Geometry& g) {
  g.kind = GeometryKind::cubic;
  g.cubic = std::make_shared<ParametricCubic const>(cubic);
  if (!cubic.is_regular()) {
    context.report(Severity::warning, node, "the curve has no length, or stops somewhere");
    return false;
  }
  if (std::abs(cubic.length() - g.length) > 1e-3 * g.length)
    context.report(Severity::warning, node,
                   "the curve is " + rounded_text(cubic.length()) + " m long, its length attribute says " +
                       rounded_text(g.length) + " m; it is stretched along to that");
  return true;
}

/// Reads a curve from its element; false where a number is missing or bad, or the curve unusable.
[[nodiscard]] inline bool read_kind(XmlContext& context, pugi::xml_node node, CurveKind const& kind, Geometry& g) {
  report_others(context, node, kind.attributes);
  std::array<double, 8> k{};
  for (std::size_t i = 0; i < k.size() && !kind.attributes[i].empty(); ++i) {
    auto const value = context.number<double>(node, kind.attributes[i].data());  // NOLINT: a literal
    if (!value) return false;
    k[i] = *value;
  }
  if (kind.name == "line") return true;
  if (kind.name == "arc" || kind.name == "spiral") {
    g.kind = kind.name == "arc" ? GeometryKind::arc : GeometryKind::spiral;
    g.curvature_start = k[0];
    g.curvature_end = kind.name == "arc" ? k[0] : k[1];
    return true;
  }
  if (!(g.length > 0.0)) return true;  // left out later
  if (kind.name == "poly3")
    return set_cubic(context, node, ParametricCubic::along_u({k[0], k[1], k[2], k[3]}, g.length), g);
  std::string_view const range = node.attribute("pRange").value();
  if (range != "arcLength" && range != "normalized")
    context.report(Severity::warning, node, "pRange is neither arcLength nor normalized; normalized is assumed");
  double const end = range == "arcLength" ? g.length : 1.0;
  return set_cubic(context, node, {{k[0], k[1], k[2], k[3]}, {k[4], k[5], k[6], k[7]}, end}, g);
}

/// The curve of a geometry element: the child that names its kind may stand anywhere among the others.
[[nodiscard]] inline bool read_curve(XmlContext& context, pugi::xml_node node, Geometry& g, opendrive::Rest& rest) {
  bool is_found = false, good = true;
  for_each_child(node, [&](pugi::xml_node child, std::string_view name) {
    auto const kind =
        std::find_if(curve_kinds.begin(), curve_kinds.end(), [name](CurveKind const& k) { return k.name == name; });
    if (kind == curve_kinds.end()) return keep_element(context, child, rest);
    if (std::exchange(is_found, true))
      return context.report(Severity::warning, child, "the geometry has a curve already; this one was left out");
    good = read_kind(context, child, *kind, g);
  });
  if (!is_found)
    context.report(Severity::warning, node, "the geometry is not a line, arc, spiral, poly3 or paramPoly3");
  return is_found && good;
}

/// A geometry with what goes along with it.
struct ReadGeometry {
  Geometry geometry;
  opendrive::FileLine line;
  opendrive::Rest rest;
};

/// False when the geometry, and with it the road, is unusable. A geometry of length 0 is left out without harm.
[[nodiscard]] inline bool read_geometry(XmlContext& context, pugi::xml_node node, std::vector<ReadGeometry>& all) {
  ReadGeometry read;
  Geometry& g = read.geometry;
  if (!read_attributes(context, node, g, &read.rest) || !read_curve(context, node, g, read.rest)) return false;
  if (g.length == 0.0) {
    context.report(Severity::info, node, "a geometry of length 0 was left out");
    return true;
  }
  if (auto const* const fault = fault_of(g)) {
    context.report(Severity::warning, node, fault);
    return false;
  }
  read.line = context.line(node);
  all.push_back(std::move(read));
  return true;
}

/// False when there is no usable plan view.
[[nodiscard]] inline bool read_plan_view(XmlContext& context, pugi::xml_node road_node, opendrive::RoadElement& road) {
  pugi::xml_node const node = find_only_child(context, road_node, "planView");
  std::vector<ReadGeometry> all;
  bool good = true;
  read_container(context, node, road.rest, [&](pugi::xml_node child, std::string_view name) {
    if (name == "geometry") good = good && read_geometry(context, child, all);
    return name == "geometry";
  });
  if (!good) return false;
  if (all.empty()) {
    context.report(Severity::warning, node ? node : road_node, "the road has no geometry");
    return false;
  }
  if (cambium::detail::stable_sort(all, [](ReadGeometry const& read) { return read.geometry.s; }))
    context.report(Severity::warning, node, "geometries are not in the order of s; they were sorted");
  for (ReadGeometry& read : all) {
    if (!read.rest.attributes.empty() || !read.rest.elements.empty())
      road.geometry_rests.push_back({road.geometries.size(), std::move(read.rest)});
    road.geometries.push_back(std::move(read.geometry));
    road.geometry_lines.push_back(read.line);
  }
  return true;
}

}  // namespace cambium::inline v0_1::map::detail
