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

inline std::string number(double value) {
  std::ostringstream text;
  text.precision(17);
  text << value;
  return text.str();
}

inline std::string geometry(double s, double x, double y, double heading, double length,
                            std::string const& kind = "<line/>") {
  return "<geometry s=\"" + number(s) + "\" x=\"" + number(x) + "\" y=\"" + number(y) + "\" hdg=\"" + number(heading) +
         "\" length=\"" + number(length) + "\">" + kind + "</geometry>";
}

inline std::string width(double s, double a, double b = 0.0) {
  return "<width sOffset=\"" + number(s) + "\" a=\"" + number(a) + "\" b=\"" + number(b) + "\" c=\"0\" d=\"0\"/>";
}

inline std::string text_of(Lane const& lane) {
  std::string text = "<lane id=\"" + std::to_string(lane.id) + "\" type=\"" + lane.type + "\"";
  if (!lane.direction.empty()) text += " direction=\"" + lane.direction + "\"";
  text += "><link>";
  for (int const id : lane.before) text += "<predecessor id=\"" + std::to_string(id) + "\"/>";
  for (int const id : lane.behind) text += "<successor id=\"" + std::to_string(id) + "\"/>";
  return text + "</link>" + (lane.widths.empty() ? width(0.0, lane.width) : lane.widths) + "</lane>\n";
}

inline std::string text_of(Road const& road) {
  auto const kind = road.curvature == 0.0 ? "<line/>" : "<arc curvature=\"" + number(road.curvature) + "\"/>";
  std::string text = "<road id=\"" + road.id + "\" length=\"" + number(road.length) + "\" junction=\"" + road.junction +
                     "\" rule=\"" + road.rule + "\"><link>";
  if (!road.before.empty()) text += "<predecessor " + road.before + "/>";
  if (!road.behind.empty()) text += "<successor " + road.behind + "/>";
  text += "</link>\n<planView>" + geometry(0.0, road.x, road.y, road.heading, road.length, kind) +
          "</planView>\n<lanes>" + road.lane_offset;
  for (auto const& section : road.sections) {
    std::string left, right;
    for (auto const& lane : section.lanes) (lane.id > 0 ? left : right) += text_of(lane);
    text += "<laneSection s=\"" + number(section.s) + "\"><left>\n" + left +
            "</left><center><lane id=\"0\" type=\"none\"/></center><right>\n" + right + "</right></laneSection>";
  }
  return text + "</lanes></road>\n";
}

/// The text of a file; `junctions` are elements.
inline std::string file(std::vector<Road> const& roads, std::string const& junctions = "") {
  std::string text = "<OpenDRIVE><header revMajor=\"1\" revMinor=\"8\"/>\n";
  for (auto const& road : roads) text += text_of(road);
  return text + junctions + "</OpenDRIVE>";
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

/// How often `words` stand in a text.
inline std::size_t count(std::string const& text, std::string const& words) {
  std::size_t found = 0;
  for (std::size_t at = text.find(words); at != text.npos; at = text.find(words, at + 1)) ++found;
  return found;
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
