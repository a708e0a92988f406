#pragma once

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "cambium/map/opendrive.hpp"
#include "cambium/map/opendrive/reader.hpp"
#include "../support/maps.hpp"

/// OpenDRIVE texts put together in tests: what is not said is a straight road of 100 m with one lane of 3.5 m.
namespace road_text {

struct Lane {
  int id = -1;
  std::vector<int> before{}, behind{};  ///< the lanes that it names as predecessors and successors
  std::string type = "driving";
  double width = 3.5;
  std::string direction{};  ///< of revision 1.8
  std::string widths{};     ///< width records in place of `width`
};

struct Section {
  double s = 0.0;
  std::vector<Lane> lanes{Lane{}};
};

/// The attributes of a link: to the start or end of a road, or to a junction.
inline std::string to_start(std::string const& road) {
  return "elementType=\"road\" elementId=\"" + road + "\" contactPoint=\"start\"";
}
inline std::string to_end(std::string const& road) {
  return "elementType=\"road\" elementId=\"" + road + "\" contactPoint=\"end\"";
}
inline std::string to_junction(std::string const& junction) {
  return "elementType=\"junction\" elementId=\"" + junction + "\"";
}

struct Road {
  std::string id = "1";
  double x = 0.0, y = 0.0, heading = 0.0, length = 100.0;
  std::string before{}, behind{};  ///< links
  std::vector<Section> sections{Section{}};
  double curvature = 0.0;
  std::string junction = "-1", rule = "RHT";
  std::string lane_offset{};  ///< elements
};

inline void write(std::ostringstream& xml, Lane const& lane) {
  xml << "<lane id=\"" << lane.id << "\" type=\"" << lane.type << '"';
  if (!lane.direction.empty()) xml << " direction=\"" << lane.direction << '"';
  xml << "><link>";
  for (int const id : lane.before) xml << "<predecessor id=\"" << id << "\"/>";
  for (int const id : lane.behind) xml << "<successor id=\"" << id << "\"/>";
  xml << "</link>";
  if (lane.widths.empty())
    xml << "<width sOffset=\"0\" a=\"" << lane.width << "\" b=\"0\" c=\"0\" d=\"0\"/>";
  else
    xml << lane.widths;
  xml << "</lane>\n";
}

inline void write(std::ostringstream& xml, Road const& road) {
  xml << "<road id=\"" << road.id << "\" length=\"" << road.length << "\" junction=\"" << road.junction << "\" rule=\""
      << road.rule << "\"><link>";
  if (!road.before.empty()) xml << "<predecessor " << road.before << "/>";
  if (!road.behind.empty()) xml << "<successor " << road.behind << "/>";
  xml << "</link>\n<planView><geometry s=\"0\" x=\"" << road.x << "\" y=\"" << road.y << "\" hdg=\"" << road.heading
      << "\" length=\"" << road.length << "\">";
  if (road.curvature == 0.0)
    xml << "<line/>";
  else
    xml << "<arc curvature=\"" << road.curvature << "\"/>";
  xml << "</geometry></planView>\n<lanes>" << road.lane_offset;
  for (auto const& section : road.sections) {
    xml << "<laneSection s=\"" << section.s << "\"><left>\n";
    for (auto const& lane : section.lanes)
      if (lane.id > 0) write(xml, lane);
    xml << "</left><center><lane id=\"0\" type=\"none\"/></center><right>\n";
    for (auto const& lane : section.lanes)
      if (lane.id < 0) write(xml, lane);
    xml << "</right></laneSection>";
  }
  xml << "</lanes></road>\n";
}

/// The text of a file; `junctions` are elements.
inline std::string file(std::vector<Road> const& roads, std::string const& junctions = "") {
  std::ostringstream xml;
  xml.precision(17);
  xml << "<OpenDRIVE><header revMajor=\"1\" revMinor=\"8\"/>\n";
  for (auto const& road : roads) write(xml, road);
  xml << junctions << "</OpenDRIVE>";
  return xml.str();
}

/// A junction of one connection over lane `from` to lane `to`.
inline std::string connection(std::string const& incoming, std::string const& connecting, std::string const& contact,
                              int from, int to, std::string const& road_attribute = "connectingRoad") {
  return "<connection id=\"0\" incomingRoad=\"" + incoming + "\" " + road_attribute + "=\"" + connecting +
         "\" contactPoint=\"" + contact + "\"><laneLink from=\"" + std::to_string(from) + "\" to=\"" +
         std::to_string(to) + "\"/></connection>";
}
inline std::string junction(std::string const& id, std::string const& connections,
                            std::string const& type = "default") {
  return "<junction id=\"" + id + "\" name=\"\" type=\"" + type + "\">" + connections + "</junction>";
}

inline cambium::LoadedMap load(std::string const& text, cambium::MapOptions const& options = {}) {
  return cambium::parse_opendrive(text, options, "test.xodr");
}

/// What reading a text gives.
struct Reading {
  cambium::map::OpenDriveDocument document;
  std::vector<cambium::Diagnostic> diagnostics;

  /// The first finding whose sentence holds `words`.
  [[nodiscard]] cambium::Diagnostic const* find(std::string const& words) const {
    for (auto const& d : diagnostics)
      if (d.sentence.find(words) != std::string::npos) return &d;
    return nullptr;
  }
};

inline Reading read(std::string const& text) {
  Reading reading;
  reading.document = cambium::map::read_opendrive_document(text, "test.xodr", reading.diagnostics);
  return reading;
}

/// How many findings of the severity have `words` in their sentence.
inline int count(cambium::LoadedMap const& loaded, cambium::Severity severity, std::string const& words = "") {
  int found = 0;
  for (auto const& d : loaded.diagnostics)
    found += d.severity == severity && d.sentence.find(words) != std::string::npos;
  return found;
}

/// Whether lane `to` (road, s, number) is a successor of lane `from`.
struct At {
  std::string road;
  double s;
  int lane;
};
inline cambium::map::Lane const& lane_at(cambium::LoadedMap const& loaded, At const& at) {
  return loaded.map->lane(loaded.map->find_lane(at.road, at.s, at.lane));
}
inline bool leads(cambium::LoadedMap const& loaded, At const& from, At const& to) {
  auto const &a = lane_at(loaded, from), &b = lane_at(loaded, to);
  auto const has = [](auto const& ids, cambium::LaneId id) {
    return std::find(ids.begin(), ids.end(), id) != ids.end();
  };
  bool const forward = has(a.successors, b.id), back = has(b.predecessors, a.id);
  CHECK(forward == back);
  return forward;
}

}  // namespace road_text
