// Malformed files at which other readers crash, invent places or fall silent, each with its stated outcome here: an
// error, or what is said and what the map then is.
#include <doctest/doctest.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "../support/error_of.hpp"
#include "../support/map_faults.hpp"
#include "road_text.hpp"
#include "cambium/map/opendrive.hpp"
#include "cambium/map/opendrive/reading_limits.hpp"

namespace {

using cambium::Diagnostic;
using cambium::MapError;
using cambium::Severity;

/// A straight road of two lanes, one that bends left behind it, and behind that a connecting road.
std::string const good_file = R"(<?xml version="1.0"?>
<OpenDRIVE>
  <header revMajor="1" revMinor="6"/>
  <road id="1" length="100" junction="-1">
    <link><successor elementType="road" elementId="2" contactPoint="start"/></link>
    <planView>
      <geometry s="0" x="0" y="0" hdg="0" length="60"><line/></geometry>
      <geometry s="60" x="60" y="0" hdg="0" length="40"><line/></geometry>
    </planView>
    <lanes><laneSection s="0">
      <center><lane id="0" type="none"/></center>
      <right>
        <lane id="-1" type="driving">
          <link><successor id="-1"/></link>
          <width sOffset="0" a="3" b="0" c="0" d="0"/>
        </lane>
        <lane id="-2" type="driving"><width sOffset="0" a="2" b="0" c="0" d="0"/></lane>
      </right>
    </laneSection></lanes>
  </road>
  <road id="2" length="50" junction="-1">
    <link><predecessor elementType="road" elementId="1" contactPoint="end"/>
      <successor elementType="junction" elementId="9"/></link>
    <planView><geometry s="0" x="100" y="0" hdg="0" length="50"><arc curvature="0.01"/></geometry></planView>
    <lanes><laneSection s="0">
      <center><lane id="0" type="none"/></center>
      <right><lane id="-1" type="driving">
        <link><predecessor id="-1"/></link>
        <width sOffset="0" a="3" b="0" c="0" d="0"/>
      </lane></right>
    </laneSection></lanes>
  </road>
  <road id="3" length="10" junction="9">
    <link><predecessor elementType="road" elementId="2" contactPoint="end"/></link>
    <planView><geometry s="0" x="147.9425538604203" y="12.24174381096272" hdg="0.5" length="10"><line/></geometry></planView>
    <lanes><laneSection s="0">
      <center><lane id="0" type="none"/></center>
      <right><lane id="-1" type="driving">
        <link><predecessor id="-1"/></link>
        <width sOffset="0" a="3" b="0" c="0" d="0"/>
      </lane></right>
    </laneSection></lanes>
  </road>
  <junction id="9" name=""><connection id="0" incomingRoad="2" connectingRoad="3" contactPoint="start">
    <laneLink from="-1" to="-1"/></connection></junction>
</OpenDRIVE>
)";

/// What a map is like, in some numbers.
struct Outcome {
  std::size_t roads = 3, lanes = 4;
  double length = 100.0;  ///< of the first lane's path [m]
  double end_y = -1.5;    ///< where that ends [m]
  double width = 3.0;     ///< of that in its middle [m]
  bool is_linked = true;  ///< whether a lane leads into the other road
};

/// A change of the good file, and what becomes of it.
struct Case {
  char const* name;
  std::string from, to;
  std::string element{}, words{};  ///< of the finding, part of its sentence; none where nothing is to be found
  Outcome map{};
  Severity severity = Severity::warning;
};

std::string const second_geometry =
    R"(<geometry s="0" x="100" y="0" hdg="0" length="50"><arc curvature="0.01"/></geometry>)";
std::string const first_width = R"(<width sOffset="0" a="3" b="0" c="0" d="0"/>)";
std::string const both_geometries = R"(<geometry s="0" x="0" y="0" hdg="0" length="60"><line/></geometry>
      <geometry s="60" x="60" y="0" hdg="0" length="40"><line/></geometry>)";
Outcome const without_road_2{.roads = 2, .lanes = 3, .is_linked = false};
Outcome const without_width{.end_y = 0.0, .width = 0.0};

std::vector<Case> const cases{
    {"of a version to come", R"(revMajor="1" revMinor="6")", R"(revMajor="2" revMinor="7")", "header",
     "OpenDRIVE 2.7 is newer than the latest known revision, 1.8; it was read as 1.8"},
    {"no header", R"(<header revMajor="1" revMinor="6"/>)", "", "header", "no header"},
    {"section without lane 0", R"(<center><lane id="0" type="none"/></center>)", "", "laneSection", "no lane 0"},
    {"arc of curvature 0", R"(<line/></geometry>)", R"(<arc curvature="0"/></geometry>)"},
    {"spiral whose curvatures are equal", R"(<arc curvature="0.01"/>)", R"(<spiral curvStart="0.01" curvEnd="0.01"/>)"},
    {"spiral of length 0",
     second_geometry,
     second_geometry +
         R"(<geometry s="50" x="148" y="12" hdg="0.5" length="0"><spiral curvStart="0" curvEnd="0.1"/></geometry>)",
     "geometry",
     "length 0 was left out",
     {},
     Severity::info},
    {"unknown geometry", R"(<arc curvature="0.01"/>)", "<clothoids/>", "geometry", "not a line, arc, spiral",
     without_road_2},
    {"empty plan view", second_geometry, "", "planView", "has no geometry", without_road_2},
    {"no plan view", "<planView>" + second_geometry + "</planView>", "", "road", "has no geometry", without_road_2},
    {"userData before the geometry's kind", "<line/>", "<userData code=\"x\"/><line/>"},
    {"userData behind the geometry's kind", "<line/>", "<line/><userData code=\"x\"/>"},
    {"comment in a geometry", "<line/>", "<!-- <arc curvature=\"1\"/> --><line/>"},
    {"negative width", R"(a="3")", R"(a="-3")", "lane", "its width falls to -3 m; below 0 it counts as 0",
     without_width},
    {"no width", first_width, "", "lane", "neither width nor border", without_width},
    {"width that is not a number", R"(a="3")", R"(a="NaN")", "width", "a=\"NaN\" is not a finite number",
     without_width},
    {"infinite width", R"(a="3")", R"(a="inf")", "width", "a=\"inf\" is not a finite number", without_width},
    {"text in a number", R"(a="3")", R"(a="3 m")", "width", "a=\"3 m\" is not a finite number", without_width},
    {"comma in a number", R"(a="3")", R"(a="3,5")", "width", "a=\"3,5\" is not a finite number", without_width},
    {"text in a number of a geometry", R"(x="100")", R"(x="100m")", "geometry", "x=\"100m\" is not a finite number",
     without_road_2},
    {"number beyond all doubles", R"(a="3")", R"(a="1e999")", "width", "is not a finite number", without_width},
    {"number closer to 0 than all doubles", R"(b="0")", R"(b="1e-400")"},
    {"long number closer to 0 than all doubles", R"(b="0")", R"(b="-0.)" + std::string(400, '0') + "1\""},
    {"second lanes", "</lanes>", "</lanes><lanes><laneSection s=\"0\"/></lanes>", "lanes",
     "there is a second <lanes>; it was left out"},
    {"second plan view", "</planView>", "</planView><planView/>", "planView",
     "there is a second <planView>; it was left out"},
    {"two documents in one", "</OpenDRIVE>",
     "</OpenDRIVE>\n<?xml version=\"1.0\"?><!-- --><OpenDRIVE><road/></OpenDRIVE>", "OpenDRIVE",
     "what follows </OpenDRIVE> was left out"},
    {"road longer than its geometry", R"(length="100")", R"(length="140")", "road",
     "the length is 140 m, but the geometries end at 100 m"},
    {"road shorter than its geometry", R"(length="100")", R"(length="20")", "road",
     "the length is 20 m, but the geometries end at 100 m"},
    {"geometries not in order", both_geometries, R"(<geometry s="60" x="60" y="0" hdg="0" length="40"><line/></geometry>
      <geometry s="0" x="0" y="0" hdg="0" length="60"><line/></geometry>)",
     "planView", "not in the order of s"},
    {"lane offset that starts late",
     "<laneSection",
     R"(<laneOffset s="50" a="1" b="0" c="0" d="0"/><laneSection)",
     "link",
     "continues 1 m away",
     {.end_y = -0.5}},
    {"width that starts late", R"(<width sOffset="0" a="2")", R"(<width sOffset="60" a="2")", "lane",
     "its first value also counts before it"},
    {"the next lane's width starts late", R"(<width sOffset="0" a="3")", R"(<width sOffset="60" a="3")", "lane",
     "its first value also counts before it"},
    {"road id twice", R"(<road id="2")", R"(<road id="1")", "road", "id 1 occurs twice", without_road_2},
    {"link to a road that is not there", R"(elementId="2")", R"(elementId="22")", "successor", "no usable road 22"},
    {"connection to a road that is not there", R"(connectingRoad="3")", R"(connectingRoad="22")", "connection",
     "no usable road \"22\""},
    {"connection from a road that is not there", R"(incomingRoad="2")", R"(incomingRoad="11")", "connection",
     "no usable road \"11\""},
    {"no contact point", R"(elementId="2" contactPoint="start")", R"(elementId="2")", "successor",
     "contactPoint is missing"},
    {"lane section beyond the road's end", "</laneSection></lanes>",
     R"(</laneSection><laneSection s="300"><center><lane id="0"/></center><right>
       <lane id="-1" type="driving"/></right></laneSection></lanes>)",
     "laneSection", "beyond the road's end; it was left out"},
    {"header offset beyond the earth", "<header", R"(<header><offset x="1e300" y="0" z="0" hdg="0"/></header><ignored)",
     "offset", "beyond 100 000 km"},
    {"poly3 that starts far away", R"(<arc curvature="0.01"/>)", R"(<poly3 a="1e20" b="0" c="0" d="0"/>)", "geometry",
     "beyond 100 000 km", without_road_2},
    {"paramPoly3 without end", R"(<arc curvature="0.01"/>)",
     R"(<paramPoly3 pRange="normalized" aU="0" bU="1e9" cU="0" dU="0" aV="0" bV="0" cV="0" dV="0"/>)", "geometry",
     "beyond 1000 km", without_road_2},
    {"geometries that end before the road begins", R"(<geometry s="0" x="100")", R"(<geometry s="-50" x="100")",
     "geometry", "the geometries end at 0 m; the road was left out", without_road_2},
    {"all lane sections beyond the road's end",
     "<planView>" + second_geometry + "</planView>\n    <lanes><laneSection s=\"0\"",
     "<planView>" + second_geometry + "</planView><lanes><laneSection s=\"1e300\"", "laneSection",
     "beyond the road's end; the road was left out", without_road_2},
    {"a height beyond all numbers", "<lanes>",
     R"(<elevationProfile><elevation s="0" a="0" b="0" c="0" d="1e305"/></elevationProfile><lanes>)", "elevation",
     "it was left out"},
    {"a wild width hidden by another one at its place", R"(<width sOffset="0" a="2" b="0")",
     R"(<width sOffset="0" a="2" b="1e9"/><width sOffset="0" a="2" b="1e8"/><width sOffset="0" a="2" b="0")"},
    {"wild widths at one place", R"(<width sOffset="0" a="2" b="0")",
     R"(<width sOffset="0" a="2" b="1e9" c="0" d="0"/><width sOffset="0" a="2" b="1e9")", "width", "it was left out"},
    {"paramPoly3 of nothing but zeros", R"(<arc curvature="0.01"/>)",
     R"(<paramPoly3 pRange="arcLength" aU="0" bU="0" cU="0" dU="0" aV="0" bV="0" cV="0" dV="0"/>)", "paramPoly3",
     "has no length", without_road_2},
};

/// A text that is no map at all.
struct Refused {
  char const* name;
  std::string text;
  char const* words;
};

std::vector<Refused> const refused{
    {"empty", "", "test.xodr:1: the file is not well-formed XML"},
    {"not XML", "road 1: 100 m", "not well-formed XML"},
    {"bytes", std::string("\0\xff\xfe\x01<\0", 6), "not well-formed XML"},
    {"truncated XML", good_file.substr(0, good_file.find("<lanes>")), "test.xodr:10: the file is not well-formed XML"},
    {"wrong root", "<?xml version=\"1.0\"?>\n\n<osm/>", "test.xodr:3: the root element is <osm>"},
    {"nothing but a road with an unknown curve",
     "<OpenDRIVE>\n<road id='1' length='1'><planView><geometry s='0' x='0' y='0' hdg='0' "
     "length='1'><bezier/></geometry>"
     "</planView></road></OpenDRIVE>",
     "no usable road (test.xodr:2: warning: <geometry> of road 1"},
    {"no roads", "<OpenDRIVE><header/></OpenDRIVE>", "no usable road"},
    {"nothing but a road without lanes",
     R"(<OpenDRIVE><header/><road id="1" length="5"><planView><geometry s="0" x="0" y="0" hdg="0" length="5"><line/>
     </geometry></planView></road></OpenDRIVE>)",
     "no usable road"},
    {"nothing but lane 0",
     R"(<OpenDRIVE><header/><road id="1" length="5"><planView><geometry s="0" x="0" y="0" hdg="0" length="5"><line/>
     </geometry></planView><lanes><laneSection s="0"><center><lane id="0"/></center></laneSection></lanes></road>
     </OpenDRIVE>)",
     "no lane with a length"},
    {"lanes whose ids are none, and something harmless before",
     R"(<OpenDRIVE><header/><road id="1" length="5"><type s="x" type="town"/><planView><geometry s="0" x="0" y="0" hdg="0" length="5"><line/>
     </geometry></planView><lanes><laneSection s="0"><center><lane id="0"/></center><right><lane id="one"/></right>
     </laneSection></lanes></road></OpenDRIVE>)",
     "the lane was left out because it has no usable id"},
    {"a road that winds",
     R"(<OpenDRIVE><header/><road id="1" length="2970"><planView>
     <geometry s="0" x="0" y="0" hdg="0" length="990"><arc curvature="0.1"/><line/></geometry>
     <geometry s="990" x="-9.992" y="10.398" hdg="99" length="990"><arc curvature="0.1"/></geometry>
     <geometry s="1980" x="0" y="0" hdg="198" length="990"><arc curvature="0.1"/></geometry></planView><lanes>
     <laneSection s="0"><center><lane id="0"/></center><right><lane id="-1"/></right></laneSection></lanes></road>
     </OpenDRIVE>)",
     "the road winds around itself by 297 rad; the road was left out"},
};

std::string changed(Case const& c) {
  auto const at = good_file.find(c.from);
  REQUIRE_MESSAGE(at != good_file.npos, "the file has no " << c.from);
  return std::string(good_file).replace(at, c.from.size(), c.to);
}

void check_finding(Case const& c, std::vector<Diagnostic> const& diagnostics) {
  if (c.element.empty()) {
    CHECK_MESSAGE(diagnostics.empty(), to_string(diagnostics.front()));
    return;
  }
  bool is_found = false;
  std::string all;
  for (auto const& d : diagnostics) {
    is_found |= d.severity == c.severity && d.element == c.element && d.sentence.find(c.words) != std::string::npos;
    all += "\n" + to_string(d);
  }
  CHECK_MESSAGE(is_found, "found was only" << all);
}

void check_map(Outcome const& expected, cambium::Map const& map) {
  CHECK(map_faults::first_fault(map) == "");
  CHECK(map.roads().size() == expected.roads);
  REQUIRE(map.lanes().size() == expected.lanes);
  auto const& lane = map.lanes()[0];
  CHECK(lane.length() == doctest::Approx(expected.length).epsilon(0.005));
  CHECK(lane.path.pose(lane.length()).y == doctest::Approx(expected.end_y).epsilon(1e-9));
  auto const widths = lane.widths_at(0.5 * lane.length());
  CHECK(widths.left + widths.right == doctest::Approx(expected.width).epsilon(1e-9));
  CHECK(lane.successors.empty() != expected.is_linked);
}

}  // namespace

TEST_CASE("a file beyond the limits is refused before it takes memory, with limit, finding and remedy") {
  auto const file = std::filesystem::path(CAMBIUM_BUILD_DIR) / "too_large.xodr";
  std::ofstream(file) << "<OpenDRIVE>";
  std::filesystem::resize_file(file, cambium::map::largest_map_file + 1);  // sparse: it takes no room
  auto const large = support::error_of([&] { (void)cambium::load_opendrive(file.string()); });
  std::filesystem::remove(file);
  CHECK(large == file.string() +
                     ": it has 536870913 bytes, more than the 536870912 that are read; split the map, or "
                     "remove what is not needed");

  std::string many = "<OpenDRIVE>\n";
  many.reserve(5 * cambium::map::most_elements);
  for (std::size_t i = 0; i <= cambium::map::most_elements / 2; ++i) many += "<a b=''/>";
  CHECK(support::error_of([&] { (void)cambium::parse_opendrive(many, {}, "many.xodr"); }) ==
        "many.xodr:2: up to here there are 15000001 elements and attributes; at most 15000000 are read; split the map, "
        "or remove what is not needed");
}

TEST_CASE("a file with a fault at each element gives a bounded list of findings") {
  std::string const road = road_text::text_of(road_text::Road{.id = "0"});
  std::string text = "<OpenDRIVE>" + road;
  for (std::size_t i = 0; i <= cambium::map::most_diagnostics; ++i) text += "<road/>";
  auto const loaded = cambium::parse_opendrive(text + "</OpenDRIVE>");
  CHECK(loaded.map->roads().size() == 1);
  CHECK(loaded.diagnostics.size() == cambium::map::most_diagnostics);
  CHECK(loaded.diagnostics.back().sentence.find("the file has more than") != std::string::npos);
  std::string junctions = "<OpenDRIVE>" + road;  // found not by the reader, but by the check after it
  for (std::size_t i = 0; i <= cambium::map::most_diagnostics; ++i) junctions += "<junction id='1'/>";
  CHECK(cambium::parse_opendrive(junctions + "</OpenDRIVE>").diagnostics.size() == cambium::map::most_diagnostics);
}

TEST_CASE("a file in UTF-16 or UTF-32 is read as one in UTF-8, and its limits hold") {
  struct Encoding {
    char const* name;
    std::size_t width, low;
    std::string mark;
  };
  for (Encoding const& e : {Encoding{"UTF-16LE", 2, 0, "\xff\xfe"},
                            {"UTF-16BE", 2, 1, "\xfe\xff"},
                            {"UTF-16LE, no mark", 2, 0, ""},
                            {"UTF-32LE", 4, 0, std::string("\xff\xfe\0\0", 4)},
                            {"UTF-32BE", 4, 3, std::string("\0\0\xfe\xff", 4)}}) {
    CAPTURE(e.name);
    auto const widened = [&e](std::string const& text) {
      std::string wide = e.mark;
      for (char const c : text) {
        std::string unit(e.width, '\0');
        unit[e.low] = c;
        wide += unit;
      }
      return wide;
    };
    std::string const text(std::string_view(good_file).substr(std::string_view(good_file).find('<')));
    CHECK(cambium::parse_opendrive(widened(text)).map->roads().size() ==
          cambium::parse_opendrive(text).map->roads().size());
    std::string deep = "<OpenDRIVE>";
    for (std::size_t i = 0; i < 1000; ++i) deep += "<a>";
    CHECK_THROWS_WITH_AS((void)cambium::parse_opendrive(widened(deep)), doctest::Contains("at most 256 are read"),
                         cambium::MapError);
  }
}

TEST_CASE("of roads and junctions whose ids occur twice, however many, the first ones stay") {
  std::string roads, junctions;
  for (int const id : {1, 1, 2, 2, 3, 3, 3, 4}) {
    auto const number = std::to_string(id);
    roads += road_text::text_of(road_text::Road{.id = number});
    junctions += "<junction id='" + number + "'/>";
  }
  auto const loaded = cambium::parse_opendrive("<OpenDRIVE>" + roads + junctions + "</OpenDRIVE>");
  std::string kept;
  for (auto const& road : loaded.map->roads()) kept += road.name + " ";
  for (auto const& junction : loaded.map->junctions()) kept += junction.name + " ";
  CHECK(kept == "1 2 3 4 1 2 3 4 ");
  std::size_t twice = 0;
  for (auto const& d : loaded.diagnostics) twice += d.sentence.find("occurs twice") != std::string::npos;
  CHECK(twice == 8);
}

TEST_CASE("a malformed file gives the map and the finding that are stated for it") {
  auto const good = road_text::load(good_file);
  CHECK(good.diagnostics.empty());
  check_map({}, *good.map);
  for (auto const& c : cases) {
    CAPTURE(c.name);
    auto const loaded = road_text::load(changed(c));
    check_finding(c, loaded.diagnostics);
    check_map(c.map, *loaded.map);
  }
}

TEST_CASE("a map without drivable lanes is a map, with a finding") {
  std::string text = good_file;
  for (std::string const type = "driving"; text.find(type) != text.npos;)
    text.replace(text.find(type), type.size(), "sidewalk");
  auto const loaded = road_text::load(text);
  CHECK(loaded.map->lanes().size() == 4);
  REQUIRE(loaded.diagnostics.size() == 1);
  CHECK(to_string(loaded.diagnostics[0]) == "test.xodr: warning: the map has no drivable lane");
}

TEST_CASE("a file that is no map is refused with a sentence, the place and a remedy") {
  for (auto const& r : refused) {
    CAPTURE(r.name);
    auto const said = support::error_of([&] { (void)road_text::load(r.text); });
    CHECK_MESSAGE(said.find(r.words) != std::string::npos, said);
    CHECK(said.starts_with("test.xodr"));
  }
}
