#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cambium/map/reference_line.hpp"

/// Lays out reference lines whose pieces meet to 1e-9 m as they are printed, and writes roads as OpenDRIVE.
namespace make_maps {

using cambium::map::Geometry;
using cambium::map::GeometryKind;

// Every pose is rounded before the next piece is laid out from it, so that rounding errors do not add up along a road;
// and 1e-10 m is coarse enough for every compiler's sine to print the same file.
inline double round_position(double value) { return std::round(value * 1e10) / 1e10; }
inline double round_angle(double value) { return std::round(value * 1e13) / 1e13; }

/// The shortest text that reads back as the same number.
inline std::string number(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value == 0.0 ? 0.0 : value).ptr};
}

struct Piece {
  double length;
  double curvature_start = 0.0;
  double curvature_end = 0.0;
};

struct Start {
  double x, y, heading;
};

inline Geometry make_geometry(Piece const& piece, Start const& start) {
  Geometry g;
  g.x = round_position(start.x);
  g.y = round_position(start.y);
  g.heading = round_angle(start.heading);
  g.length = piece.length;
  g.curvature_start = piece.curvature_start;
  g.curvature_end = piece.curvature_end;
  g.kind = piece.curvature_start != piece.curvature_end ? GeometryKind::spiral
           : piece.curvature_start != 0.0               ? GeometryKind::arc
                                                        : GeometryKind::line;
  return g;
}

/// Where the last of the geometries ends.
inline Start end_of(std::vector<Geometry> const& geometries) {
  auto const p = evaluate(geometries.back(), geometries.back().length);
  return {p.x, p.y, p.heading};
}

/// Lays the pieces one behind the other, the first one at `start`.
inline std::vector<Geometry> lay_from(Start start, std::vector<Piece> const& pieces) {
  std::vector<Geometry> geometries;
  double s = 0.0;
  for (Piece const& piece : pieces) {
    geometries.push_back(make_geometry(piece, start));
    geometries.back().s = s;
    s += piece.length;
    start = end_of(geometries);
  }
  return geometries;
}

/// Lays the pieces so that the last one ends at `end`.
inline std::vector<Geometry> lay_to(Start end, std::vector<Piece> const& pieces) {
  std::vector<Geometry> geometries(pieces.size());
  for (std::size_t i = pieces.size(); i-- > 0;) {
    auto const local = evaluate(make_geometry(pieces[i], {0.0, 0.0, 0.0}), pieces[i].length);
    double const heading = end.heading - local.heading;
    double const c = std::cos(heading);
    double const s = std::sin(heading);
    end = {end.x - c * local.x + s * local.y, end.y - s * local.x - c * local.y, heading};
    geometries[i] = make_geometry(pieces[i], end);
    end = {geometries[i].x, geometries[i].y, geometries[i].heading};
  }
  for (std::size_t i = 1; i < geometries.size(); ++i) geometries[i].s = geometries[i - 1].s + geometries[i - 1].length;
  return geometries;
}

struct Width {
  double a;
  double b = 0.0;
  double c = 0.0;
  double d = 0.0;
};

/// A width that goes from `from` to 0 over `length` [m], with borders that start and end parallel.
inline Width taper(double from, double length) {
  return {from, 0.0, -3.0 * from / (length * length), 2.0 * from / (length * length * length)};
}

struct Mark {
  std::string type = "solid";
  std::string lane_change = "none";
};

struct LaneSpec {
  int id;
  std::string type;
  Width width;
  Mark mark;
  std::string predecessor;  ///< lane id; empty: no link
  std::string successor;
};

struct SectionSpec {
  double s;
  std::vector<LaneSpec> lanes;  ///< from left to right, without lane 0
};

struct RoadSpec {
  std::string id;
  std::string name;
  std::string junction = "-1";
  std::string predecessor;  ///< the link element's attributes; empty: no link
  std::string successor;
  double speed_limit;  ///< [km/h]
  std::vector<Geometry> geometries;
  std::vector<SectionSpec> sections;
};

/// Writes nested elements, two blanks a level.
class XmlWriter {
 public:
  void open(std::string const& element) {
    line("<" + element + ">");
    open_.push_back(element.substr(0, element.find(' ')));
  }
  void close() {
    std::string const name = std::move(open_.back());
    open_.pop_back();
    line("</" + name + ">");
  }
  void leaf(std::string const& element) { line("<" + element + "/>"); }
  void line(std::string const& text) { text_ += std::string(2 * open_.size(), ' ') + text + "\n"; }
  [[nodiscard]] std::string const& text() const { return text_; }

 private:
  std::string text_;
  std::vector<std::string> open_;
};

inline std::string attribute(char const* name, std::string_view value) {
  return " " + std::string(name) + "=\"" + std::string(value) + "\"";
}
inline std::string attribute(char const* name, double value) { return attribute(name, number(value)); }

inline std::string cubic(char const* element, char const* start, double s, Width const& w) {
  return element + attribute(start, s) + attribute("a", w.a) + attribute("b", w.b) + attribute("c", w.c) +
         attribute("d", w.d);
}

inline void write_geometry(XmlWriter& xml, Geometry const& g) {
  xml.open("geometry" + attribute("s", g.s) + attribute("x", g.x) + attribute("y", g.y) + attribute("hdg", g.heading) +
           attribute("length", g.length));
  if (g.kind == GeometryKind::line) xml.leaf("line");
  if (g.kind == GeometryKind::arc) xml.leaf("arc" + attribute("curvature", g.curvature_start));
  if (g.kind == GeometryKind::spiral)
    xml.leaf("spiral" + attribute("curvStart", g.curvature_start) + attribute("curvEnd", g.curvature_end));
  xml.close();
}

inline void write_mark(XmlWriter& xml, Mark const& mark) {
  xml.leaf("roadMark" + attribute("sOffset", 0.0) + attribute("type", mark.type) + attribute("weight", "standard") +
           attribute("color", "white") + attribute("width", 0.15) + attribute("laneChange", mark.lane_change));
}

inline void write_lane(XmlWriter& xml, LaneSpec const& lane) {
  xml.open("lane" + attribute("id", std::to_string(lane.id)) + attribute("type", lane.type) +
           attribute("level", "false"));
  if (!lane.predecessor.empty() || !lane.successor.empty()) {
    xml.open("link");
    if (!lane.predecessor.empty()) xml.leaf("predecessor" + attribute("id", lane.predecessor));
    if (!lane.successor.empty()) xml.leaf("successor" + attribute("id", lane.successor));
    xml.close();
  }
  xml.leaf(cubic("width", "sOffset", 0.0, lane.width));
  write_mark(xml, lane.mark);
  xml.close();
}

inline void write_section(XmlWriter& xml, SectionSpec const& section) {
  xml.open("laneSection" + attribute("s", section.s));
  auto const side = [&](char const* name, int sign) {
    bool open = false;
    for (LaneSpec const& lane : section.lanes) {
      if ((lane.id > 0) - (lane.id < 0) != sign) continue;
      if (!open) xml.open(name);
      open = true;
      write_lane(xml, lane);
    }
    if (open) xml.close();
  };
  side("left", 1);
  xml.open("center");
  xml.open("lane" + attribute("id", "0") + attribute("type", "none") + attribute("level", "false"));
  write_mark(xml, {});
  xml.close();
  xml.close();
  side("right", -1);
  xml.close();
}

inline void write_road(XmlWriter& xml, RoadSpec const& road) {
  xml.open("road" + attribute("name", road.name) +
           attribute("length", road.geometries.back().s + road.geometries.back().length) + attribute("id", road.id) +
           attribute("junction", road.junction) + attribute("rule", "RHT"));
  if (!road.predecessor.empty() || !road.successor.empty()) {
    xml.open("link");
    if (!road.predecessor.empty()) xml.leaf("predecessor " + road.predecessor);
    if (!road.successor.empty()) xml.leaf("successor " + road.successor);
    xml.close();
  }
  xml.open("type" + attribute("s", 0.0) + attribute("type", "motorway"));
  xml.leaf("speed" + attribute("max", road.speed_limit) + attribute("unit", "km/h"));
  xml.close();
  xml.open("planView");
  for (Geometry const& g : road.geometries) write_geometry(xml, g);
  xml.close();
  xml.open("elevationProfile");
  xml.leaf(cubic("elevation", "s", 0.0, {0.0}));
  xml.close();
  xml.open("lanes");
  xml.leaf(cubic("laneOffset", "s", 0.0, {0.0}));
  for (SectionSpec const& section : road.sections) write_section(xml, section);
  xml.close();
  xml.close();
}

/// Starts a file: declaration, root, header with the bounds of the reference lines' joints.
inline void open_file(XmlWriter& xml, std::string const& name, std::vector<RoadSpec> const& roads) {
  double west = roads.front().geometries.front().x, east = west;
  double south = roads.front().geometries.front().y, north = south;
  for (RoadSpec const& road : roads)
    for (Geometry const& g : road.geometries)
      for (double const ds : {0.0, g.length}) {
        auto const p = evaluate(g, ds);
        west = std::min(west, p.x);
        east = std::max(east, p.x);
        south = std::min(south, p.y);
        north = std::max(north, p.y);
      }
  auto const metre = [](double value) { return number(std::round(value)); };
  xml.line("<?xml version=\"1.0\" encoding=\"UTF-8\"?>");
  xml.line("<!-- Written by examples/make_maps; change that, not this. -->");
  xml.open("OpenDRIVE");
  xml.leaf("header" + attribute("revMajor", "1") + attribute("revMinor", "6") + attribute("name", name) +
           attribute("version", "1") + attribute("north", metre(north)) + attribute("south", metre(south)) +
           attribute("east", metre(east)) + attribute("west", metre(west)) + attribute("vendor", "cambium"));
}

}  // namespace make_maps
