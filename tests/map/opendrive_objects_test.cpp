// Signals, controllers, objects, junctions and everything else of a file that is kept and not interpreted.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "../support/corpus.hpp"
#include "cambium/map/opendrive.hpp"
#include "cambium/map/opendrive/reader.hpp"
#include "cambium/map/opendrive/reading_limits.hpp"
#include "cambium/map/opendrive/writer.hpp"
#include "../support/maps.hpp"

namespace {

using namespace cambium::map;
using cambium::Diagnostic;
using opendrive::Orientation;

struct Reading {
  OpenDriveDocument document;
  std::vector<Diagnostic> diagnostics;

  [[nodiscard]] Diagnostic const* find(std::string const& words) const {
    for (Diagnostic const& d : diagnostics)
      if (d.sentence.find(words) != std::string::npos) return &d;
    return nullptr;
  }
};

Reading read(std::string const& text) {
  Reading reading;
  reading.document = cambium::map::read_opendrive_document(text, "test.xodr", reading.diagnostics);
  return reading;
}

/// A file with one road; a test says what it holds beside a plan view and lanes.
std::string file_with(std::string const& in_road, std::string const& in_root = "", std::string const& in_lane = "") {
  return R"(<OpenDRIVE xmlns="http://x"><header revMajor="1" revMinor="8" date="today"><license name="l"/></header>
<road id="1" length="50" junction="-1" colour="red">)" +
         in_road + R"(<planView><geometry s="0" x="0" y="0" hdg="0" length="50"><line/></geometry></planView>
<lanes><laneSection s="0"><center><lane id="0"/></center><right><lane id="-1" type="driving">
<width sOffset="0" a="3" b="0" c="0" d="0"/>)" +
         in_lane + R"(</lane></right></laneSection></lanes></road>)" + in_root + "</OpenDRIVE>";
}

std::size_t count(std::string const& text, std::string_view words) {
  std::size_t found = 0;
  for (auto at = text.find(words); at != text.npos; at = text.find(words, at + 1)) ++found;
  return found;
}

std::string without_comments(std::string text) {
  for (auto at = text.find("<!--"); at != text.npos; at = text.find("<!--", at))
    text.erase(at, text.find("-->", at) + 3 - at);
  return text;
}

}  // namespace

TEST_CASE("every signal, reference, controller, object and priority of the corpus is read") {
  auto const folder = corpus::find("opendrive");
  if (!folder) return;
  struct Counts {
    std::size_t signals{}, references{}, objects{}, repeats{}, corners{}, controllers{}, controls{}, priorities{},
        validities{}, marks{}, heights{};
  } sum;
  for (auto const& file : corpus::maps(*folder)) {
    CAPTURE(file.string());
    auto const text = without_comments(corpus::read(file));
    auto const document = read(text).document;
    Counts here;
    for (auto const& road : document.roads) {
      here.signals += road.signals.size();
      here.references += road.signal_references.size();
      here.objects += road.objects.size();
      for (auto const& signal : road.signals) here.validities += signal.validities.size();
      for (auto const& object : road.objects) here.repeats += object.repeats.size();
      for (auto const& object : road.objects)
        for (auto const& outline : object.outlines)
          here.corners += outline.road_corners.size() + outline.local_corners.size();
      for (auto const& section : road.lane_sections)
        for (auto const& lane : section.lanes) {
          here.marks += lane.road_marks.size();
          here.heights += lane.heights.size();
        }
    }
    for (auto const& controller : document.controllers) here.controls += controller.controls.size();
    here.controllers = document.controllers.size();
    for (auto const& junction : document.junctions) {
      here.priorities += junction.priorities.size();
      here.controllers += junction.controllers.size();
    }
    CHECK(here.signals == count(text, "<signal "));
    CHECK(here.references == count(text, "<signalReference "));
    CHECK(here.objects == count(text, "<object "));
    CHECK(here.repeats == count(text, "<repeat "));
    CHECK(here.corners == count(text, "<cornerRoad ") + count(text, "<cornerLocal "));
    CHECK(here.controllers == count(text, "<controller "));
    CHECK(here.controls == count(text, "<control "));
    CHECK(here.priorities == count(text, "<priority "));
    CHECK(here.validities == count(text, "<validity "));
    CHECK(here.marks == count(text, "<roadMark "));
    CHECK(here.heights == count(text, "<height "));
    sum.signals += here.signals;
    sum.controllers += here.controllers;
    sum.objects += here.objects;
  }
  CHECK(sum.signals == 220);
  CHECK(sum.controllers == 54);
  CHECK(sum.objects == 13);
}

TEST_CASE("a signal keeps all that it says") {
  auto const r = read(file_with(R"(<signals>
<signal id=" 7 " s="1.5" t="-2" name="n&amp;m" dynamic="yes" orientation="-" zOffset="3" country="DE"
 countryRevision="2017" type="274" subtype="55" value="50" unit="km/h" height="0.6" width="0.5" text="slow" hOffset="0.1"
 pitch="0.2" roll="0.3" length="0.01"><validity fromLane="-2" toLane="-1"/><dependency id="8" type="limitline"/></signal>
<signalReference id="9" s="4" t="5" orientation="+"><validity fromLane="1" toLane="1"/></signalReference>
<boards count="0"/></signals>)"));
  for (auto const& d : r.diagnostics) MESSAGE(to_string(d));
  auto const& road = r.document.roads[0];
  REQUIRE(road.signals.size() == 1);
  auto const& s = road.signals[0];
  CHECK(s.id == "7");
  CHECK(std::array{s.s, s.t, s.z_offset, s.h_offset, s.pitch, s.roll} == std::array{1.5, -2.0, 3.0, 0.1, 0.2, 0.3});
  CHECK(s.name == "n&m");
  CHECK(s.dynamic);
  CHECK(s.orientation == Orientation::against);
  CHECK(s.country == "DE");
  CHECK(s.country_revision == "2017");
  CHECK(s.type == "274");
  CHECK(s.subtype == "55");
  CHECK(s.value == 50.0);
  CHECK(s.unit == "km/h");
  CHECK(s.height == 0.6);
  CHECK(s.width == 0.5);
  CHECK(s.text == "slow");
  CHECK(s.line == 3);
  CHECK(s.validities == std::vector<opendrive::Validity>{{-2, -1}});
  CHECK(s.rest.attributes == std::vector<opendrive::Attribute>{{"length", "0.01"}});
  REQUIRE(s.rest.elements.size() == 1);
  CHECK(s.rest.elements[0].name == "dependency");
  REQUIRE(road.signal_references.size() == 1);
  CHECK(road.signal_references[0].id == "9");
  CHECK(road.signal_references[0].orientation == Orientation::along);
  CHECK(road.signal_references[0].validities[0].from_lane == 1);
  CHECK(road.rest.elements ==
        std::vector<opendrive::Element>{{"signals", {}, {{"boards", {{"count", "0"}}, {}, ""}}, ""}});
  CHECK(read(write_opendrive(r.document)).document == r.document);
}

TEST_CASE("an object keeps all that it says") {
  auto const r = read(file_with(R"(<objects><object id="o" s="1" t="2" zOffset="3" type="building" subtype="b" name="n"
 hdg="0.1" pitch="0.2" roll="0.3" height="4" length="5" width="6" orientation="none" validLength="7" dynamic="no" perpToRoad="true">
<repeat s="0" length="10" distance="0" tStart="1" tEnd="2" heightStart="3" heightEnd="4"/>
<outlines><outline id="0" closed="true" fillType="grass"><cornerRoad s="1" t="2" dz="0.1" height="3" id="4"/></outline>
<outline><cornerLocal u="1" v="2" z="0.5" height="3"/></outline></outlines>
<parkingSpace access="all"/><validity fromLane="0" toLane="2"/></object>
<object id="old" s="1" t="1"><outline><cornerLocal u="0" v="0"/></outline></object>
<objectReference id="o" s="9" t="8" zOffset="7" validLength="6" orientation="-"/>
<bridge id="b" s="0" length="9" type="concrete"/></objects>)"));
  CHECK(r.diagnostics.empty());
  auto const& road = r.document.roads[0];
  REQUIRE(road.objects.size() == 2);
  auto const& o = road.objects[0];
  CHECK(std::array{o.s, o.t, o.z_offset, o.heading, o.pitch, o.roll, o.valid_length} ==
        std::array{1.0, 2.0, 3.0, 0.1, 0.2, 0.3, 7.0});
  CHECK(o.height == 4.0);
  CHECK(o.length == 5.0);
  CHECK(o.width == 6.0);
  CHECK_FALSE(o.radius.has_value());
  CHECK_FALSE(o.dynamic);
  REQUIRE(o.repeats.size() == 1);
  CHECK(o.repeats[0].t_end == 2.0);
  CHECK_FALSE(o.repeats[0].width_start.has_value());
  REQUIRE(o.outlines.size() == 2);
  CHECK(o.outlines[0].closed);
  CHECK(o.outlines[0].fill_type == "grass");
  REQUIRE(o.outlines[0].road_corners.size() == 1);
  CHECK(o.outlines[0].road_corners[0].dz == 0.1);
  CHECK(o.outlines[0].road_corners[0].id == 4);
  CHECK(o.outlines[1].local_corners.at(0).z == 0.5);
  CHECK(o.validities.size() == 1);
  CHECK(o.rest.attributes.at(0).name == "perpToRoad");
  CHECK(o.rest.elements.at(0).name == "parkingSpace");
  CHECK(road.objects[1].outlines.size() == 1);
  REQUIRE(road.object_references.size() == 1);
  CHECK(road.object_references[0].z_offset == 7.0);
  CHECK(road.rest.elements.at(0).children.at(0).name == "bridge");
  CHECK(read(write_opendrive(r.document)).document == r.document);
}

TEST_CASE("junctions of every kind keep connections, priorities and controllers") {
  auto const r = read(file_with("", R"(
<controller id="c" name="lights" sequence="2"><control signalId="7" type="t"/><userData code="x"/></controller>
<junction id="10" name="d" type="direct"><connection id="0" incomingRoad="1" linkedRoad="1" contactPoint="end">
<laneLink from="-1" to="-1" overlapZone="12.5"/></connection></junction>
<junction id="11" name="v" type="virtual" mainRoad="1" sStart="3" sEnd="6" orientation="+">
<connection id="0" type="virtual"><predecessor elementType="road" elementId="1" elementS="3" elementDir="+"/>
<successor elementType="road" elementId="1" elementS="6" elementDir="-"/><laneLink from="-1" to="-1"/></connection>
<priority high="1" low="2"/><controller id="c" type="0" sequence="1"/><crossPath id="0"/></junction>
<junction id="12" type="roundabout"/>)"));
  for (auto const& d : r.diagnostics) MESSAGE(to_string(d));
  CHECK(r.diagnostics.size() == 2);  // of the unknown type, and that it has no connection
  auto const& junctions = r.document.junctions;
  REQUIRE(junctions.size() == 3);
  CHECK(junctions[0].type == opendrive::JunctionType::direct);
  auto const& direct = junctions[0].connections.at(0);
  CHECK(direct.connecting_road.empty());
  CHECK(direct.linked_road == "1");
  CHECK(direct.entered_road() == "1");
  CHECK(direct.lane_links.at(0).overlap_zone == 12.5);
  auto const& v = junctions[1];
  CHECK(v.type == opendrive::JunctionType::virtual_);
  CHECK(v.main_road == "1");
  CHECK(v.s_start == 3.0);
  CHECK(v.s_end == 6.0);
  CHECK(v.orientation == Orientation::along);
  CHECK(v.connections.at(0).type == "virtual");
  REQUIRE(v.connections[0].successor.has_value());
  CHECK(v.connections[0].successor->element_s == 6.0);
  CHECK(v.connections[0].successor->element_direction == Orientation::against);
  CHECK(v.priorities == std::vector<opendrive::Priority>{{"1", "2"}});
  CHECK(v.controllers == std::vector<opendrive::JunctionController>{{"c", "0", 1}});
  CHECK(v.rest.elements.at(0).name == "crossPath");
  CHECK(junctions[2].type == opendrive::JunctionType::other);
  CHECK(junctions[2].rest.find_attribute("type")->value == "roundabout");
  REQUIRE(r.document.controllers.size() == 1);
  CHECK(r.document.controllers[0].sequence == 2);
  CHECK(r.document.controllers[0].controls.at(0).signal_id == "7");
  CHECK(read(write_opendrive(r.document)).document == r.document);
}

TEST_CASE("profiles and lanes keep heights, access, rules, crossfall and shape") {
  auto const r = read(file_with(R"(<type s="0" type="rural" country="US"/><lateralProfile>
<crossfall side="left" s="1" a="0.1" b="0" c="0" d="0"/><shape s="0" t="-2" a="0.2" b="0" c="0" d="0"/>
<superelevation s="0" a="0.3" b="0" c="0" d="0"/></lateralProfile>)",
                                "", R"(<height sOffset="1" inner="0.1" outer="0.2"/>
<access sOffset="2" rule="deny" restriction="truck"><restriction type="bus"/></access><rule sOffset="3" value="no stopping"/>
<material sOffset="0" friction="0.8"/><roadMark sOffset="0" type="solid" weight="bold" color="white" material="paint"
 width="0.3" laneChange="none" height="0.02"><type name="x" width="0.3"><line length="1"/></type><sway ds="0"/></roadMark>)"));
  CHECK(r.diagnostics.empty());
  auto const& road = r.document.roads[0];
  CHECK(road.types.at(0).country == "US");
  CHECK(road.crossfall == std::vector<opendrive::Crossfall>{{{1.0, 0.1}, opendrive::Side::left}});
  CHECK(road.shape == std::vector<opendrive::LateralShape>{{0.0, {-2.0, 0.2}}});
  CHECK(road.superelevation == std::vector<CubicRecord>{{0.0, 0.3}});
  auto const& lane = *road.lane_sections.at(0).find(-1);
  CHECK(lane.heights == std::vector<opendrive::LaneHeight>{{1.0, 0.1, 0.2}});
  CHECK(lane.accesses.at(0).rule == "deny");
  CHECK(lane.accesses[0].restriction == "truck");
  CHECK(lane.accesses[0].rest.elements.at(0).name == "restriction");
  CHECK(lane.rules.at(0).value == "no stopping");
  CHECK(lane.rest.elements.at(0).name == "material");
  auto const& mark = lane.road_marks.at(0);
  CHECK(mark.weight == "bold");
  CHECK(mark.material == "paint");
  CHECK(mark.height == 0.02);
  CHECK(mark.lane_change == opendrive::LaneChange::none);
  REQUIRE(mark.rest.elements.size() == 2);
  CHECK(mark.rest.elements[0].children.at(0).attributes.at(0).value == "1");
  CHECK(read(write_opendrive(r.document)).document == r.document);
}

TEST_CASE("what the document has no field for is kept where it stood") {
  auto const r = read(file_with(
      R"(<link note="l"><neighbor side="left" elementId="2"/></link><railroad><switch id="s"/></railroad>
<userData code="c" value="v"><deep><deeper>text</deeper></deep></userData>)",
      R"(<station id="s"/><include file="f"/>)", R"(<userData><vectorLane travelDir="forward"/></userData>)"));
  CHECK(r.diagnostics.empty());
  auto const& d = r.document;
  CHECK(d.rest.attributes == std::vector<opendrive::Attribute>{{"xmlns", "http://x"}});
  CHECK(d.rest.elements.size() == 2);
  CHECK(d.header.rest.find_attribute("date")->value == "today");
  CHECK(d.header.rest.elements.at(0).name == "license");
  auto const& road = d.roads[0];
  CHECK(road.rest.find_attribute("colour")->value == "red");
  REQUIRE(road.rest.elements.size() == 3);
  CHECK(road.rest.elements[0].name == "link");
  CHECK(road.rest.elements[0].children.at(0).name == "neighbor");
  CHECK(road.rest.elements[2].children.at(0).children.at(0).text == "text");
  CHECK(road.lane_sections[0].find(-1)->rest.elements.at(0).children.at(0).name == "vectorLane");
  auto const text = write_opendrive(d);
  CHECK(read(text).document == d);
  CHECK(count(text, "<link note=\"l\">") == 1);
  CHECK(count(text, "<deeper>text</deeper>") == 1);
}

TEST_CASE("user data in a geometry, and words that are not known, are kept, whatever the order of the geometries") {
  auto text = file_with("");
  text.replace(text.find("length=\"50\"><line/>"), 19, R"(length="50" colour="c"><userData code="late"/><line/>)");
  text.replace(text.find(" s=\"0\" x=\"0\""), 12, R"( s="30" x="30")");
  auto const at = text.find("</planView>");
  text.insert(at, R"(<geometry s="0" x="0" y="0" hdg="0" length="30"><line/></geometry>)");
  text.replace(text.find("\"driving\""), 9, "\"hovercraft\"");
  auto const r = read(text);
  auto const& road = r.document.roads[0];
  REQUIRE(road.geometry_rests.size() == 1);
  CHECK(road.geometry_rests[0].geometry == 1);
  CHECK(road.geometry_rests[0].rest.attributes.at(0).name == "colour");
  CHECK(road.geometry_rests[0].rest.elements.at(0).attributes.at(0).value == "late");
  CHECK(road.lane_sections[0].find(-1)->type == LaneType::other);
  CHECK(count(write_opendrive(r.document), "type=\"hovercraft\"") == 1);
  CHECK(read(write_opendrive(r.document)).document == r.document);
}

TEST_CASE(
    "signals and objects without an id or a place are left out and reported; other bad numbers are kept as words") {
  for (char const* bad :
       {R"(<signal id="1" s="nan" t="0"/>)", R"(<signal s="1" t="0"/>)", R"(<signal id="" s="1" t="0"/>)",
        R"(<signal id="1" t="0"/>)", R"(<signal id="1" s="1" t="1e999"/>)", R"(<signalReference s="0" t="0"/>)"}) {
    CAPTURE(bad);
    auto const r = read(file_with(std::string("<signals>") + bad + R"(<signal id="good" s="0" t="0"/></signals>)"));
    REQUIRE(r.document.roads[0].signals.size() == 1);
    CHECK(r.document.roads[0].signals[0].id == "good");
    CHECK(r.document.roads[0].signal_references.empty());
    REQUIRE(r.find("it was left out"));
    CHECK(r.find("it was left out")->severity == cambium::Severity::warning);
  }
  auto const r = read(file_with(R"(<signals><signal id="1" s="1" t="0" value="fast" zOffset="inf" orientation="up"
    pitch="" dynamic="maybe"/></signals><objects><object id="o" s="0" t="0" width="wide"><repeat s="0"/></object></objects>)"));
  REQUIRE(r.document.roads[0].signals.size() == 1);
  auto const& signal = r.document.roads[0].signals[0];
  CHECK_FALSE(signal.value.has_value());
  CHECK(signal.z_offset == 0.0);
  CHECK(signal.orientation == Orientation::both);
  CHECK(signal.rest.find_attribute("value")->value == "fast");
  CHECK(r.find("orientation=\"up\" is none of none, +, -"));
  CHECK(r.document.roads[0].objects.at(0).repeats.empty());
  CHECK(read(write_opendrive(r.document)).document == r.document);
}

TEST_CASE("user data of any depth is no danger") {
  auto const nested = [](std::size_t levels, std::string const& between = "\n") {
    std::string text;
    for (std::size_t i = 0; i < levels; ++i) text += between + "<a>";
    for (std::size_t i = 0; i < levels; ++i) text += "</a>";
    return file_with(text);
  };
  auto const r = read(nested(cambium::map::deepest_element - 2));  // within a road within the root
  CHECK(r.find("more than 100 levels deep"));
  CHECK(read(write_opendrive(r.document)).document == r.document);
  for (std::size_t const levels : {cambium::map::deepest_element - 1, std::size_t{200'000}}) {
    std::string what;
    try {
      (void)read(nested(levels));
    } catch (cambium::MapError const& e) {
      what = e.what();
    }
    CHECK_MESSAGE(what.find("the elements lie 257 deep here; at most 256 are read") < what.size(), what);
    CHECK_MESSAGE(what.find(':') < what.find("the elements"), what);
  }
  // Nothing hides elements from the count that the parser sees.
  for (std::string const before : {"<!--><a b=\"-->", "<![CDATA[]>]]>", "<?a b=\"?>", "<!DOCTYPE x \"<a b='\">"}) {
    CAPTURE(before);
    CHECK_THROWS_WITH_AS((void)read(before + nested(200'000)), doctest::Contains("at most 256 are read"),
                         cambium::MapError);
  }
  for (std::string const type : {"<!DOCTYPE x [<!ENTITY a 'b'>]>", "<!DOCTYPE x <!-- \" --> >",
                                 "<!DOCTYPE x <?a \" ?> >", "<!DOCTYPE x <!-- > <![CDATA[ --> >"})
    CHECK_THROWS_WITH_AS((void)read(type + nested(1)), doctest::Contains("comments of its own"), cambium::MapError);
  // What is no element does not count, whatever it looks like.
  CHECK_NOTHROW((void)read(nested(200, "<!-- <a><a><a> --><![CDATA[<a><a>]]><?a <a> ?><b c='<a><a>' d=\"'/>\" />")));
}

TEST_CASE("attributes that are there twice are kept once") {
  auto const r = read(file_with(
      R"(<userData a="1" a="2"/><signals x="1" x="2"><signal id="1" id="2" s="0" t="0" q="1" q="2"/></signals>)"));
  CHECK(r.document.roads[0].signals.at(0).id == "1");
  auto const text = write_opendrive(r.document);
  CHECK(count(text, "=\"2\"") == 0);
  CHECK(read(text).document == r.document);
}
