// What the document has fields for, and everything else of a file, which it keeps without understanding it.
#include <doctest/doctest.h>

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "cambium/map/opendrive/reading_limits.hpp"
#include "cambium/map/opendrive/writer.hpp"
#include "../support/error_of.hpp"
#include "road_text.hpp"

namespace {

using namespace cambium::map;
using opendrive::Orientation;
using road_text::count;
using road_text::read;

/// A file with one road; a test says what it holds beside a plan view and lanes.
std::string file_with(std::string const& in_road, std::string const& in_root = "", std::string const& in_lane = "") {
  return R"(<OpenDRIVE xmlns="http://x"><header revMajor="1" revMinor="8" date="today"><license name="l"/></header>
<road id="1" length="50" junction="-1" colour="red">)" +
         in_road + R"(<planView><geometry s="0" x="0" y="0" hdg="0" length="50"><line/></geometry></planView>
<lanes><laneSection s="0"><center><lane id="0"/></center><right><lane id="-1" type="driving">
<width sOffset="0" a="3" b="0" c="0" d="0"/>)" +
         in_lane + R"(</lane></right></laneSection></lanes></road>)" + in_root + "</OpenDRIVE>";
}

}  // namespace

TEST_CASE("a signal has fields for what the library uses, and keeps the rest") {
  auto const r = read(file_with(R"(<signals>
<signal id=" 7 " s="1.5" t="-2" orientation="-" type="274" dynamic="yes"><validity fromLane="-2" toLane="-1"/>
<dependency id="8" type="limitline"/></signal>
<signalReference id="9" s="4" t="5" orientation="+"><validity fromLane="1" toLane="1"/></signalReference>
<boards count="0"/></signals>)"));
  CHECK(r.diagnostics.empty());
  auto const& road = r.document.roads[0];
  opendrive::Signal const signal{"7", 1.5, Orientation::against, "274", {{-2, -1}}, road.signals.at(0).rest};
  CHECK(road.signals == std::vector{signal});
  CHECK(signal.rest.attributes == std::vector<opendrive::Attribute>{{"t", "-2"}, {"dynamic", "yes"}});
  CHECK(signal.rest.elements.at(0).name == "dependency");
  opendrive::Signal const reference{"9", 4.0, Orientation::along, "", {{1, 1}}, {{{"t", "5"}}, {}}};
  CHECK(road.signal_references == std::vector{reference});
  CHECK(road.rest.elements ==
        std::vector<opendrive::Element>{{"signals", {}, {{"boards", {{"count", "0"}}, {}, ""}}, ""}});
  CHECK(read(write_opendrive(r.document)).document == r.document);
}

TEST_CASE("objects are kept as they are, and written before the signals") {
  std::string const objects = R"(<objects note="n"><object id="o" s="1" t="2"><outlines><outline id="0">
<cornerLocal u="1" v="2"/></outline></outlines></object><object/><bridge id="b"/></objects>)";
  auto const r = read(file_with("<signals><signal id=\"1\" s=\"1\"/></signals>" + objects));
  CHECK(r.diagnostics.empty());
  auto const& kept = r.document.roads[0].rest.elements.at(0);
  CHECK(kept.name == "objects");
  CHECK(kept.children.size() == 3);
  CHECK(kept.children[0].children[0].children[0].children[0].attributes ==
        std::vector<opendrive::Attribute>{{"u", "1"}, {"v", "2"}});
  auto const text = write_opendrive(r.document);
  CHECK(text.find("<objects note") < text.find("<signals"));
  CHECK(read(text).document == r.document);
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
  CHECK(direct.lane_links.at(0).rest.find_attribute("overlapZone")->value == "12.5");
  auto const& v = junctions[1];
  CHECK(v.type == opendrive::JunctionType::virtual_);
  CHECK(v.rest.attributes.size() == 4);
  REQUIRE(v.connections.at(0).successor.has_value());
  CHECK(v.connections[0].successor->element_s == 6.0);
  CHECK(v.priorities == std::vector<opendrive::Priority>{{"1", "2"}});
  CHECK(v.rest.elements.at(0).name == "controller");
  CHECK(v.rest.elements.at(1).name == "crossPath");
  CHECK(junctions[2].type == opendrive::JunctionType::other);
  CHECK(junctions[2].rest.find_attribute("type")->value == "roundabout");
  REQUIRE(r.document.controllers.size() == 1);
  CHECK(r.document.controllers[0].controls.at(0).signal_id == "7");
  CHECK(read(write_opendrive(r.document)).document == r.document);
}

TEST_CASE("profiles and lanes keep heights, crossfall and shape") {
  auto const r = read(file_with(R"(<type s="0" type="rural" country="US"/><lateralProfile>
<crossfall side="left" s="1" a="0.1" b="0" c="0" d="0"/><shape s="0" t="-2" a="0.2" b="0" c="0" d="0"/>
<superelevation s="0" a="0.3" b="0" c="0" d="0"/></lateralProfile>)",
                                "", R"(<height sOffset="1" inner="0.1" outer="0.2"/>
<access sOffset="2" rule="deny" restriction="truck"><restriction type="bus"/></access><rule sOffset="3" value="no stopping"/>
<material sOffset="0" friction="0.8"/><roadMark sOffset="0" type="solid" weight="bold" color="white" material="paint"
 width="0.3" laneChange="none" height="0.02"><type name="x" width="0.3"><line length="1"/></type><sway ds="0"/></roadMark>)"));
  CHECK(r.diagnostics.empty());
  auto const& road = r.document.roads[0];
  CHECK(road.types.at(0).rest.find_attribute("country")->value == "US");
  CHECK(road.crossfall == std::vector<opendrive::Crossfall>{{{1.0, 0.1}, opendrive::Side::left}});
  CHECK(road.shape == std::vector<opendrive::LateralShape>{{0.0, {-2.0, 0.2}}});
  CHECK(road.superelevation == std::vector<CubicRecord>{{0.0, 0.3}});
  auto const& lane = *road.lane_sections.at(0).find(-1);
  CHECK(lane.heights == std::vector<opendrive::HeightRecord>{{1.0, 0.1, 0.2}});
  for (std::size_t i = 0; i < 3; ++i)
    CHECK(lane.rest.elements.at(i).name == std::array{"access", "rule", "material"}[i]);
  auto const& mark = lane.road_marks.at(0);
  CHECK(mark.weight == "bold");
  CHECK(mark.rest.attributes == std::vector<opendrive::Attribute>{{"material", "paint"}, {"height", "0.02"}});
  CHECK(mark.lane_change == opendrive::LaneChangePermission::none);
  REQUIRE(mark.rest.elements.size() == 2);
  CHECK(mark.rest.elements[0].children.at(0).attributes.at(0).value == "1");
  CHECK(read(write_opendrive(r.document)).document == r.document);
}

TEST_CASE("elements without a field in the document are kept where they stood") {
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

TEST_CASE("signals without an id or a place are left out and reported; other bad values are kept as words") {
  for (char const* bad :
       {R"(<signal id="1" s="nan" t="0"/>)", R"(<signal s="1" t="0"/>)", R"(<signal id="" s="1" t="0"/>)",
        R"(<signal id="1" t="0"/>)", R"(<signal id="1" s="1e999"/>)", R"(<signalReference s="0" t="0"/>)"}) {
    CAPTURE(bad);
    auto const r = read(file_with(std::string("<signals>") + bad + R"(<signal id="good" s="0" t="0"/></signals>)"));
    REQUIRE(r.document.roads[0].signals.size() == 1);
    CHECK(r.document.roads[0].signals[0].id == "good");
    CHECK(r.document.roads[0].signal_references.empty());
    REQUIRE(r.find("it was left out"));
    CHECK(r.find("it was left out")->severity == cambium::Severity::warning);
  }
  auto const r = read(file_with(R"(<signals><signal id="1" s="1" t="0" value="fast" orientation="up"/></signals>)"));
  REQUIRE(r.document.roads[0].signals.size() == 1);
  auto const& signal = r.document.roads[0].signals[0];
  CHECK(signal.orientation == Orientation::both);
  CHECK(signal.rest.find_attribute("value")->value == "fast");
  CHECK(r.find("orientation=\"up\" is not one of none, +, -"));
  CHECK(signal.rest.find_attribute("orientation")->value == "up");
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
    auto const what = support::error_of([&] { (void)read(nested(levels)); });
    CHECK_MESSAGE(what.find("elements are nested 257 deep here; at most 256 are read") < what.size(), what);
    CHECK_MESSAGE(what.find(':') < what.find("elements are"), what);
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

TEST_CASE("attributes that occur twice are kept once") {
  auto const r = read(file_with(
      R"(<userData a="1" a="2"/><signals x="1" x="2"><signal id="1" id="2" s="0" t="0" q="1" q="2"/></signals>)"));
  CHECK(r.document.roads[0].signals.at(0).id == "1");
  auto const text = write_opendrive(r.document);
  CHECK(count(text, "=\"2\"") == 0);
  CHECK(read(text).document == r.document);
}
