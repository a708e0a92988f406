// Writes cambium's own OpenDRIVE maps: highway.xodr, merging.xodr and lane_drop.xodr.
//
//   examples/run make_maps --out maps
//
// It shows how a map can be laid out in code: pieces of reference line, lanes with widths, a junction. The same program
// always writes the same bytes.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <string>
#include <system_error>
#include <vector>

#include "cambium/core/write_file.hpp"

#include "../common/command_line.hpp"
#include "road_writer.hpp"

namespace make_maps {
namespace {

constexpr double lane_width = 3.5;      // [m]
constexpr double inner_shoulder = 1.0;  // [m]
constexpr double outer_shoulder = 2.5;  // [m]
Mark const may_change{"broken", "both"};
Mark const only_inwards{"broken", "increase"};  // towards larger lane ids: from the ending lane, never into it
Mark const solid{};

/// `count` driving lanes between two shoulders. `before`, `after`: the same lanes go on there, as lane links tell.
SectionSpec carriageway(double s, int count, double width, bool before, bool after) {
  SectionSpec section{s, {}};
  auto const link = [](int id, bool there) { return there ? std::to_string(id) : std::string(); };
  auto const add = [&](int id, char const* type, double w, Mark const& mark) {
    section.lanes.push_back({id, type, {w}, mark, link(id, before), link(id, after)});
  };
  add(1, "shoulder", inner_shoulder, solid);
  for (int i = 1; i <= count; ++i) add(-i, "driving", width, i < count ? may_change : solid);
  add(-count - 1, "shoulder", outer_shoulder, solid);
  return section;
}

/// Three sections of a carriageway that loses its outermost lane `-count`: whole up to `begin`, tapering up to `end`,
/// gone. The tapering lane has no successor; the outer shoulder takes over its number.
std::vector<SectionSpec> ending_lane(int count, double width, char const* type, double begin, double end, bool linked) {
  std::vector<SectionSpec> sections{carriageway(0.0, count, width, linked, true),
                                    carriageway(begin, count, width, true, true),
                                    carriageway(end, count - 1, width, true, false)};
  auto const last = static_cast<std::size_t>(count);  // lane +1 stands before lane -1
  for (std::size_t i : {0u, 1u}) sections[i].lanes[last].type = type;
  sections[1].lanes[last].width = taper(width, end - begin);
  sections[1].lanes[last].successor.clear();
  sections[1].lanes[last - 1].mark = only_inwards;
  sections[1].lanes[last + 1].successor = std::to_string(-count);
  sections[2].lanes[last].predecessor = std::to_string(-count - 1);
  return sections;
}

std::string highway() {
  constexpr double left = 1.0 / 640.0;
  constexpr double right = -1.0 / 800.0;
  RoadSpec road{"1", "highway", "-1", "", "", 120.0, {}, {carriageway(0.0, 3, 3.75, false, false)}};
  road.geometries = lay_from({0.0, 0.0, 0.0}, {{300.0},
                                               {150.0, 0.0, left},
                                               {400.0, left, left},
                                               {150.0, left, 0.0},
                                               {150.0, 0.0, right},
                                               {350.0, right, right},
                                               {150.0, right, 0.0},
                                               {350.0}});
  XmlWriter xml;
  open_file(xml, "highway", {road});
  write_road(xml, road);
  xml.close();
  return xml.text();
}

std::string lane_drop() {
  constexpr double left = 1.0 / 1000.0;
  RoadSpec road{"1", "lane drop", "-1", "", "", 120.0, {}, ending_lane(3, 3.75, "driving", 400.0, 480.0, false)};
  road.geometries =
      lay_from({0.0, 0.0, 0.0}, {{160.0}, {80.0, 0.0, left}, {120.0, left, left}, {80.0, left, 0.0}, {360.0}});
  XmlWriter xml;
  open_file(xml, "lane drop", {road});
  write_road(xml, road);
  xml.close();
  return xml.text();
}

// The merging map: main road 1, ramp 2, junction 100 with the ways 10 (main) and 11 (ramp), and road 3 behind it, whose
// lane -3 is the acceleration lane.

RoadSpec main_before() {
  constexpr double left = 1.0 / 640.0;
  RoadSpec road{"1", "main before", "-1", "", "elementType=\"junction\" elementId=\"100\"", 100.0, {}, {}};
  road.geometries =
      lay_from({0.0, 0.0, 0.0}, {{100.0}, {50.0, 0.0, left}, {50.0, left, left}, {50.0, left, 0.0}, {50.0}});
  road.sections = {carriageway(0.0, 2, lane_width, false, true), carriageway(240.0, 2, lane_width, true, false)};
  road.sections[1].lanes.back().width = taper(outer_shoulder, 60.0);  // makes room for the ramp
  return road;
}

RoadSpec main_through(RoadSpec const& before) {
  RoadSpec road{"10",
                "main through junction",
                "100",
                "elementType=\"road\" elementId=\"1\" contactPoint=\"end\"",
                "elementType=\"road\" elementId=\"3\" contactPoint=\"start\"",
                100.0,
                {},
                {}};
  road.geometries = lay_from(end_of(before.geometries), {{50.0}});
  road.sections = {carriageway(0.0, 2, lane_width, true, true)};
  road.sections[0].lanes.pop_back();  // the ramp comes where the shoulder was
  return road;
}

RoadSpec main_after(RoadSpec const& through) {
  constexpr double right = -1.0 / 800.0;
  RoadSpec road{"3", "main after", "-1", "elementType=\"junction\" elementId=\"100\"", "", 100.0, {}, {}};
  road.geometries = lay_from(end_of(through.geometries),
                             {{280.0}, {60.0, 0.0, right}, {120.0, right, right}, {60.0, right, 0.0}, {130.0}});
  road.sections = ending_lane(3, lane_width, "entry", 200.0, 260.0, false);
  return road;
}

std::vector<SectionSpec> ramp_lanes(std::string const& lane_before, std::string const& lane_after,
                                    std::string const& shoulder_before, std::string const& shoulder_after) {
  return {{0.0,
           {{-1, "onRamp", {lane_width}, solid, lane_before, lane_after},
            {-2, "shoulder", {outer_shoulder}, solid, shoulder_before, shoulder_after}}}};
}

/// The ramp's way through the junction: it ends where the acceleration lane begins, and stays clear of the main lanes.
RoadSpec ramp_through(RoadSpec const& after) {
  constexpr double right = -1.0 / 250.0;
  Geometry const& first = after.geometries.front();
  double const offset = 2.0 * lane_width;
  Start const end{first.x + offset * std::sin(first.heading), first.y - offset * std::cos(first.heading),
                  first.heading};
  RoadSpec road{"11",
                "ramp through junction",
                "100",
                "elementType=\"road\" elementId=\"2\" contactPoint=\"end\"",
                "elementType=\"road\" elementId=\"3\" contactPoint=\"start\"",
                80.0,
                {},
                ramp_lanes("-1", "-3", "-2", "-4")};
  road.geometries = lay_to(end, {{50.0, right, 0.0}});
  return road;
}

RoadSpec ramp_before(RoadSpec const& through) {
  constexpr double right = -1.0 / 250.0;
  Geometry const& next = through.geometries.front();
  RoadSpec road{
      "2", "on-ramp", "-1", "", "elementType=\"junction\" elementId=\"100\"", 80.0, {}, ramp_lanes("", "", "", "")};
  road.geometries = lay_to({next.x, next.y, next.heading}, {{110.0}, {50.0, 0.0, right}, {40.0, right, right}});
  return road;
}

void write_connection(XmlWriter& xml, char const* id, char const* from, char const* way,
                      std::vector<std::string> const& lanes) {
  xml.open("connection" + attribute("id", id) + attribute("incomingRoad", from) + attribute("connectingRoad", way) +
           attribute("contactPoint", "start"));
  for (std::string const& lane : lanes) xml.leaf("laneLink" + attribute("from", lane) + attribute("to", lane));
  xml.close();
}

std::string merging() {
  RoadSpec const before = main_before();
  RoadSpec const through = main_through(before);
  RoadSpec const after = main_after(through);
  RoadSpec const ramp_way = ramp_through(after);
  std::vector<RoadSpec> const roads{before, ramp_before(ramp_way), after, through, ramp_way};
  XmlWriter xml;
  open_file(xml, "merging", roads);
  for (RoadSpec const& road : roads) write_road(xml, road);
  xml.open("junction" + attribute("id", "100") + attribute("name", "ramp") + attribute("type", "default"));
  write_connection(xml, "0", "1", "10", {"-1", "-2"});
  write_connection(xml, "1", "2", "11", {"-1", "-2"});
  xml.close();
  xml.close();
  return xml.text();
}

void write_all(std::filesystem::path const& folder) {
  struct File {
    char const* name;
    std::string text;
  };
  std::error_code ignored;  // a folder that cannot be made shows as files that cannot be written
  std::filesystem::create_directories(folder, ignored);
  for (File const& file :
       {File{"highway.xodr", highway()}, File{"merging.xodr", merging()}, File{"lane_drop.xodr", lane_drop()}}) {
    cambium::write_file(folder / file.name, file.text);
    std::cout << (folder / file.name).string() << ": " << file.text.size() << " bytes\n";
  }
}

}  // namespace
}  // namespace make_maps

int main(int argc, char** argv) {
  std::string folder = "maps";
  CLI::App program("Writes highway.xodr, merging.xodr and lane_drop.xodr.", "make_maps");
  program.add_option("--out", folder, "folder to write into, made if it is not there")
      ->type_name("DIR")
      ->capture_default_str();
  return examples::run_program(program, argc, argv, [&] { make_maps::write_all(folder); });
}
