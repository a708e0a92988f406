#pragma once

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/stable_sort.hpp"
#include "cambium/map/detail/geometry_fault.hpp"
#include "cambium/map/opendrive/detail/attribute_reader.hpp"
#include "cambium/map/road/reference_line.hpp"

namespace cambium::map::detail {

using cambium::detail::rounded_text;

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
    context.report(Severity::warning, node, "pRange is neither arcLength nor normalized; normalized is assumed");
  g.kind = GeometryKind::cubic;
  g.cubic = std::make_shared<ParametricCubic const>(u, v, range == "arcLength" ? g.length : 1.0);
  return has_usable_cubic(context, node, g);
}

[[nodiscard]] inline bool read_kind(XmlContext& context, pugi::xml_node node, std::string_view kind, Geometry& g) {
  if (kind == "poly3") return read_poly3(context, node, g);
  if (kind == "paramPoly3") return read_param_poly3(context, node, g);
  if (kind == "spiral") {
    g.kind = GeometryKind::spiral;
    return context.numbers(node, {{"curvStart", &g.curvature_start}, {"curvEnd", &g.curvature_end}});
  }
  if (kind == "arc") {
    g.kind = GeometryKind::arc;
    if (!context.numbers(node, {{"curvature", &g.curvature_start}})) return false;
    g.curvature_end = g.curvature_start;
  }
  return true;
}

/// Reports what is not read of a curve's element.
inline void report_curve(XmlContext& context, pugi::xml_node node, std::string_view kind) {
  if (kind == "line") return report_others(context, node, {});
  if (kind == "arc") return report_others(context, node, {"curvature"});
  if (kind == "spiral") return report_others(context, node, {"curvStart", "curvEnd"});
  if (kind == "poly3") return report_others(context, node, {"a", "b", "c", "d"});
  report_others(context, node, {"aU", "bU", "cU", "dU", "aV", "bV", "cV", "dV", "pRange"});
}

/// The curve of a geometry element: the child that names its kind may stand anywhere among the others.
[[nodiscard]] inline bool read_curve(XmlContext& context, pugi::xml_node node, Geometry& g, opendrive::Rest& rest) {
  constexpr std::string_view kinds[] = {"line", "arc", "spiral", "poly3", "paramPoly3"};
  bool is_found = false, good = true;
  for_each_child(node, [&](pugi::xml_node child, std::string_view name) {
    if (std::find(std::begin(kinds), std::end(kinds), name) == std::end(kinds))
      return keep_element(context, child, rest);
    if (std::exchange(is_found, true))
      return context.report(Severity::warning, child, "the geometry has a curve already; this one was left out");
    report_curve(context, child, name);
    good = read_kind(context, child, name, g);
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

}  // namespace cambium::map::detail
