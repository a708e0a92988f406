#include <doctest/doctest.h>

#include <clocale>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "../support/corpus.hpp"
#include "../support/error_of.hpp"
#include "road_text.hpp"

namespace {

using namespace cambium::map;
using cambium::Diagnostic;
using cambium::MapError;
using cambium::Severity;
using road_text::read;
using road_text::Reading;

/// Two roads and a junction without fault; tests change a place in it.
std::string const good_file = R"(<?xml version="1.0"?>
<OpenDRIVE>
  <header revMajor="1" revMinor="6" name="test" north="1" south="2" east="3" west="4"/>
  <road name="first" length="100" id="1" junction="-1" rule="RHT">
    <link><successor elementType="road" elementId="2" contactPoint="start"/></link>
    <type s="0" type="rural"><speed max="50" unit="mph"/></type>
    <planView>
      <geometry s="0" x="0" y="0" hdg="0" length="60"><line/></geometry>
      <geometry s="60" x="60" y="0" hdg="0" length="40"><arc curvature="0.01"/></geometry>
    </planView>
    <elevationProfile><elevation s="0" a="1" b="0.1" c="0" d="0"/></elevationProfile>
    <lanes>
      <laneOffset s="0" a="0.5" b="0" c="0" d="0"/>
      <laneSection s="0">
        <center><lane id="0" type="none" level="false"/></center>
        <right>
          <lane id="-1" type="driving" level="false">
            <link><successor id="-1"/></link>
            <width sOffset="0" a="3.5" b="0" c="0" d="0"/>
            <roadMark sOffset="0" type="broken" color="white" width="0.12" laneChange="both"/>
            <speed sOffset="5" max="36" unit="km/h"/>
          </lane>
          <lane id="-2" type="shoulder" level="false"><width sOffset="0" a="2" b="0" c="0" d="0"/></lane>
        </right>
      </laneSection>
      <laneSection s="70">
        <center><lane id="0" type="none" level="false"/></center>
        <right>
          <lane id="-1" type="driving" level="false">
            <link><predecessor id="-1"/></link>
            <width sOffset="0" a="3.5" b="0" c="0" d="0"/>
          </lane>
        </right>
      </laneSection>
    </lanes>
  </road>
  <road name="second" length="10" id="2" junction="7" rule="LHT">
    <link><predecessor elementType="road" elementId="1" contactPoint="end"/></link>
    <planView>
      <geometry s="0" x="95" y="8" hdg="0.4" length="10"><spiral curvStart="0.01" curvEnd="0"/></geometry>
    </planView>
    <lanes><laneSection s="0">
      <left><lane id="1" type="driving" level="false"><width sOffset="0" a="3" b="0" c="0" d="0"/></lane></left>
      <center><lane id="0" type="none" level="false"/></center>
    </laneSection></lanes>
  </road>
  <junction id="7" name="j">
    <connection id="0" incomingRoad="1" connectingRoad="2" contactPoint="start"><laneLink from="-1" to="1"/></connection>
  </junction>
</OpenDRIVE>
)";

std::string replaced(std::string text, std::string const& from, std::string const& to) {
  std::size_t const at = text.find(from);
  REQUIRE_MESSAGE(at != text.npos, "the test's file has no " << from);
  return text.replace(at, from.size(), to);
}

/// What the error says that reading `text` must end with.
std::string error_of(std::string const& text) {
  return support::error_of([&] { (void)read(text); });
}

bool contains(std::string const& text, std::string const& words) { return text.find(words) != std::string::npos; }

}  // namespace

TEST_CASE("a file without fault is read as it is written, without a finding") {
  Reading const r = read(good_file);
  for (Diagnostic const& d : r.diagnostics) MESSAGE(to_string(d));
  CHECK(r.diagnostics.empty());
  CHECK(r.document.header.rev_minor == 6);
  CHECK(r.document.header.rest.find_attribute("west")->value == "4");
  REQUIRE(r.document.roads.size() == 2);
  opendrive::RoadElement const& road = r.document.roads[0];
  CHECK(road.id == "1");
  CHECK(road.name == "first");
  CHECK(road.junction.empty());
  CHECK(road.rule == opendrive::DrivingSide::right_hand);
  CHECK(road.line == 4);
  CHECK_FALSE(road.predecessor.has_value());
  REQUIRE(road.successor.has_value());
  CHECK(road.successor->id == "2");
  CHECK(road.successor->contact_point == opendrive::ContactPoint::start);
  CHECK(road.successor->line == 5);
  REQUIRE(road.types.size() == 1);
  CHECK(road.types[0].limit == 50 * 0.44704);
  REQUIRE(road.geometries.size() == 2);
  CHECK(road.geometries[1] == Geometry{60.0, 60.0, 0.0, 0.0, 40.0, GeometryKind::arc, 0.01, 0.01});
  CHECK(road.geometry_lines[1] == 9);
  CHECK(road.elevation == std::vector<CubicRecord>{{0.0, 1.0, 0.1}});
  CHECK(road.lane_offset == std::vector<CubicRecord>{{0.0, 0.5}});
  opendrive::RoadElement const& second = r.document.roads[1];
  CHECK(second.junction == "7");
  CHECK(second.rule == opendrive::DrivingSide::left_hand);
  CHECK(second.geometries[0] == Geometry{0.0, 95.0, 8.0, 0.4, 10.0, GeometryKind::spiral, 0.01, 0.0});
  REQUIRE(r.document.junctions.size() == 1);
  REQUIRE(r.document.junctions[0].connections.size() == 1);
  CHECK(r.document.junctions[0].connections[0].connecting_road == "2");
  CHECK(r.document.junctions[0].connections[0].lane_links[0].to == 1);
}

TEST_CASE("lanes keep their types, links, widths, marks and limits") {
  Reading const r = read(good_file);
  REQUIRE(r.document.roads[0].lane_sections.size() == 2);
  opendrive::LaneSection const& section = r.document.roads[0].lane_sections[0];
  REQUIRE(section.lanes.size() == 3);
  CHECK(section.lanes[0].id == 0);
  opendrive::LaneElement const& lane = section.lanes[1];
  CHECK(lane.id == -1);
  CHECK(lane.type == LaneType::driving);
  CHECK(lane.successors == std::vector{-1});
  CHECK(lane.predecessors.empty());
  CHECK(lane.widths == std::vector<CubicRecord>{{0.0, 3.5}});
  REQUIRE(lane.road_marks.size() == 1);
  CHECK(lane.road_marks[0].type == "broken");
  CHECK(lane.road_marks[0].lane_change == opendrive::LaneChangePermission::both);
  REQUIRE(lane.speeds.size() == 1);
  CHECK(lane.speeds[0].s == 5.0);
  CHECK(lane.speeds[0].limit == 10.0);
  CHECK(lane.line == 17);
  CHECK(section.find(-2)->type == LaneType::shoulder);
  CHECK(section.find(5) == nullptr);
}

namespace {

/// A fault, and what is to be said and done about it; more of them, with the maps that they lead to, are in
/// malformed_files_test.cpp.
struct Fault {
  char const* name;
  char const* from;   ///< this text of the good file ...
  char const* to;     ///< ... becomes this one
  char const* words;  ///< part of the finding's sentence; empty: nothing is found
  int line;
  std::size_t roads = 2;  ///< that are left
};

Fault const faults[]{
    {"header without revision", R"(revMajor="1" revMinor="6")", "", "", 0},
    {"tiny geometry", R"(length="40"><arc curvature="0.01"/></geometry>)",
     R"(length="40"><arc curvature="0.01"/></geometry><geometry s="100" x="1" y="1" hdg="0" length="1e-15"><line/></geometry>)",
     "98.1842 m and 0.4 rad off the end", 9},
    {"negative length", R"(length="60")", R"(length="-60")", "the length is negative", 8, 1},
    {"straight poly3", "<line/>", R"(<poly3 a="0" b="0" c="0" d="0"/>)", "", 0},
    {"poly3 without a coefficient", "<line/>", R"(<poly3 a="0" b="0" c="0"/>)", "attribute d is missing", 8, 1},
    {"straight paramPoly3", "<line/>",
     R"(<paramPoly3 pRange="normalized" aU="0" bU="60" cU="0" dU="0" aV="0" bV="0" cV="0" dV="0"/>)", "", 0},
    {"paramPoly3 of another length", "<line/>",
     R"(<paramPoly3 pRange="arcLength" aU="0" bU="1.01" cU="0" dU="0" aV="0" bV="0" cV="0" dV="0"/>)",
     "the curve is 60.6 m long, its length attribute says 60 m", 8},
    {"paramPoly3 without a range", "<line/>",
     R"(<paramPoly3 aU="0" bU="60" cU="0" dU="0" aV="0" bV="0" cV="0" dV="0"/>)", "normalized is assumed", 8},
    {"geometry without a kind", "<line/>", "", "not a line, arc, spiral", 8, 1},
    {"lane id that is no number", R"(<lane id="-2")", R"(<lane id="two")", "id=\"two\" is not a finite whole number",
     23},
    {"lane id twice", R"(<lane id="-2")", R"(<lane id="-1")", "lane id -1 occurs twice", 23},
    {"lane on the wrong side", R"(<lane id="1")", R"(<lane id="-1")", "lane -1 is written as left", 43},
    {"wild width", R"(a="3.5" b="0")", R"(a="3.5" b="1e9")", "reaches 7e+10 m; it was left out", 17},
    {"jump in the plan view", R"(s="60" x="60")", R"(s="60" x="61")", "it starts 1 m and 0 rad off the end", 9},
    {"jump to another place", R"(s="60" x="60")", R"(s="60" x="6000")", "5940 m and 0 rad off the end", 9, 1},
    {"wild heading", R"(hdg="0" length="60")", R"(hdg="1e300" length="60")", "hdg is beyond", 8, 1},
    {"section before the road", R"(<laneSection s="0">)", R"(<laneSection s="-5">)", "counts from the road's start",
     14},
    {"missing attribute", R"( hdg="0" length="60")", R"( length="60")", "attribute hdg is missing", 8, 1},
    {"road without length", R"( length="100")", "", "the length is missing", 4},
    {"geometries with a gap in s", R"(s="60" x="60")", R"(s="60.5" x="60")", "0.5 m beyond the end", 9},
    {"road without id", R"(id="2" junction="7")", R"(junction="7")", "it has no id", 37, 1},
    {"junction that is not there", R"(junction="7")", R"(junction="8")", "no junction 8", 37},
    {"lane link to a lane that is not there", R"(<successor id="-1"/>)", R"(<successor id="-8"/>)", "no lane -8", 17},
    {"no lane sections", R"(<laneSection s="0">
      <left>)",
     R"(<other s="0"><left>)", "XML", 0, 0},
    {"unknown lane type", R"(type="shoulder")", R"(type="hovercraft")", "\"hovercraft\" is unknown", 23},
    {"unknown unit", R"(unit="mph")", R"(unit="knots")", "not one of m/s, km/h, mph", 6},
    {"curl without end", R"(curvature="0.01")", R"(curvature="1e9")", "more than 100 rad", 9, 1},
    {"unknown rule", R"(rule="LHT")", R"(rule="MIDDLE")", "not one of RHT, LHT", 37},
};

}  // namespace

TEST_CASE("every fault has its stated outcome: what remains, the finding and its line") {
  for (Fault const& fault : faults) {
    std::string const name = fault.name;
    CAPTURE(name);
    std::string const text = replaced(good_file, fault.from, fault.to);
    if (fault.roads == 0) {
      CHECK(contains(error_of(text), fault.words));
      continue;
    }
    Reading const r = read(text);
    CHECK(r.document.roads.size() == fault.roads);
    if (std::string(fault.words).empty()) {
      CHECK_MESSAGE(r.diagnostics.empty(), to_string(r.diagnostics.front()));
      continue;
    }
    Diagnostic const* const found = r.find(fault.words);
    for (Diagnostic const& d : r.diagnostics)
      if (!found) MESSAGE(to_string(d));
    REQUIRE(found);
    CHECK(found->line == fault.line);
    CHECK(found->file == "test.xodr");
  }
}

TEST_CASE("ids with control characters are kept, and spelled out in messages") {
  auto const text = replaced(good_file, R"(id="2" junction="7")", "id=\"2&#27;[2J&#10;\" junction=\"8\"");
  Reading const r = read(text);
  CHECK(r.document.roads[1].id == "2\x1b[2J");
  Diagnostic const* const found = r.find("no junction 8");
  REQUIRE(found);
  CHECK(to_string(*found) ==
        R"(test.xodr:37: warning: <road> of road 2\x1b[2J: there is no junction 8 that it could belong to)");
  for (Diagnostic const& d : r.diagnostics) CHECK_FALSE(contains(to_string(d), "\x1b"));
  CHECK(contains(error_of("<OpenDRIVE><road id=\"a&#10;b&#27;\"/></OpenDRIVE>"), R"(road a\x0ab\x1b)"));
}

TEST_CASE("a finding names its lane in full") {
  Reading const r = read(replaced(good_file, R"(a="3.5")", R"(a="3,5")"));
  REQUIRE(r.diagnostics.size() >= 1);
  CHECK(to_string(r.diagnostics[0]) ==
        "test.xodr:19: warning: <width> of road 1, section 0, lane -1: a=\"3,5\" is not a finite number; the record "
        "was left out");
}

TEST_CASE("geometries in the wrong order are sorted, with their lines") {
  Reading const r =
      read(replaced(replaced(good_file, R"(s="0" x="0")", R"(s="40" x="0")"), R"(s="60" x="60")", R"(s="0" x="60")"));
  CHECK(r.find("geometries are not in the order of s"));
  CHECK(r.document.roads[0].geometries[0].kind == GeometryKind::arc);
  CHECK(r.document.roads[0].geometry_lines[0] == 9);
  CHECK(r.document.roads[0].geometry_length() == 100.0);
}

TEST_CASE("speed limits are in m/s, none is infinite, undefined is empty") {
  auto const limit = [](char const* speed) {
    return read(replaced(good_file, R"(max="50" unit="mph")", speed)).document.roads[0].types[0].limit;
  };
  CHECK(limit(R"(max="13.5")") == 13.5);
  CHECK(limit(R"(max="72" unit="km/h")") == 20.0);
  CHECK(limit(R"(max="no limit")") == std::numeric_limits<double>::infinity());
  CHECK_FALSE(limit(R"(max="undefined")").has_value());
}

TEST_CASE("a namespace prefix and a byte order mark change nothing") {
  std::string text = good_file;
  for (std::size_t at = 0; (at = text.find('<', at)) != text.npos; ++at)
    if (text[at + 1] != '?') text.insert(at + (text[at + 1] == '/' ? 2 : 1), "odr:");
  Reading const r = read("\xEF\xBB\xBF" + text);
  CHECK(r.diagnostics.empty());
  REQUIRE(r.document.roads.size() == 2);
  CHECK(r.document.roads[0].lane_sections[0].lanes[1].line == 17);
  CHECK(r.document.roads[0].geometries.size() == 2);
}

TEST_CASE("numbers are read the same in every locale") {
  char const* const german = std::setlocale(LC_ALL, "de_DE.UTF-8");
  if (!german) MESSAGE("there is no German locale here; the C locale was used");
  Reading const r = read(replaced(good_file, R"(a="3.5")", R"(a=" +35e-1 ")"));
  std::setlocale(LC_ALL, "C");
  CHECK(r.diagnostics.empty());
  CHECK(r.document.roads[0].lane_sections[0].lanes[1].widths[0].a == 3.5);
}

TEST_CASE("every lane type survives being written and read") {
  for (int i = 0; i <= static_cast<int>(LaneType::other); ++i)
    CHECK(lane_type_from_string(to_string(static_cast<LaneType>(i))) == static_cast<LaneType>(i));
  CHECK(is_drivable(LaneType::entry));
  CHECK(is_drivable(lane_type_from_string("mwyExit")));
  CHECK_FALSE(is_drivable(LaneType::shoulder));
  CHECK_FALSE(is_drivable(lane_type_from_string("DRIVING")));
}
