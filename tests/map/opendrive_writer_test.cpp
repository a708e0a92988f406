#include "cambium/map/opendrive/writer.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <pugixml.hpp>

#include "../support/corpus.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/random.hpp"
#include "../support/maps.hpp"
#include "cambium/map/opendrive/detail/xml_context.hpp"
#include "cambium/map/opendrive/detail/xml_text.hpp"
#include "road_text.hpp"

namespace {

using namespace cambium::map;
using cambium::MapError;
using road_text::count;

OpenDriveDocument read(std::string const& text) { return road_text::read(text).document; }

/// How often each attribute with a value stands at a path, as "/road/type type=rural"; and each element.
using Census = std::map<std::string, int>;

/// As one word for one thing: numbers and truths are spelled in many ways.
std::string canonical(std::string value) {
  if (value == "true" || value == "yes") value = "1";
  if (value == "false" || value == "no" || value == "none" || value == "default" || value.empty()) value = "0";
  auto const number = cambium::map::detail::parse_number<double>(value);
  return number ? cambium::detail::number_text(*number + 0.0) : value;
}

void take_census(pugi::xml_node node, std::string const& parent, Census& census) {
  for (auto const child : node.children()) {
    if (child.type() != pugi::node_element) continue;
    auto const path = parent + "/" + child.name();
    ++census[path];
    for (auto const a : child.attributes()) ++census[path + " " + a.name() + "=" + canonical(a.value())];
    auto const text = cambium::map::detail::trimmed(child.child_value());
    if (!text.empty()) ++census[path + " " + std::string(text)];
    take_census(child, path, census);
  }
}

Census census_of(std::string const& text) {
  pugi::xml_document xml;
  REQUIRE(xml.load_buffer(text.data(), text.size(), pugi::parse_cdata | pugi::parse_escapes));
  Census census;
  take_census(xml, "", census);
  return census;
}

/// A road of one lane, with places where a test puts something.
std::string road_with(std::string const& planview, std::string const& in_lane = "", std::string const& in_road = "",
                      std::string const& in_root = "", std::string const& name = "r") {
  return "<OpenDRIVE><header revMajor=\"1\" revMinor=\"7\"/><road id=\"1\" name=\"" + name +
         "\" length=\"50\" junction=\"-1\"><planView><geometry s=\"0\" x=\"0\" y=\"0\" hdg=\"0\" length=\"50\">" +
         planview +
         "</geometry></planView><lanes><laneSection s=\"0\"><center><lane id=\"0\"/></center><right><lane id=\"-1\" "
         "type=\"driving\"><width sOffset=\"0\" a=\"3\" b=\"0\" c=\"0\" d=\"0\"/>" +
         in_lane + "</lane></right></laneSection></lanes>" + in_road + "</road>" + in_root + "</OpenDRIVE>";
}

}  // namespace

TEST_CASE("every map that was read and written is read as the same document, and written as the same text") {
  auto const maps = corpus::all_maps();
  CHECK(maps.size() >= 3);
  for (auto const& file : maps) {
    CAPTURE(file.string());
    auto const first = read(corpus::read(file));
    auto const text = write_opendrive(first);
    auto const second = read(text);
    CHECK(first == second);
    CHECK(write_opendrive(second) == text);
  }
}

TEST_CASE("no element of a map gets lost by being read and written, and no attribute that says more than nothing") {
  for (auto const& file : corpus::all_maps()) {
    CAPTURE(file.string());
    auto text = corpus::read(file);
    auto const before = census_of(text);
    auto after = census_of(write_opendrive(read(text)));
    for (auto const& [what, times] : before) {
      auto const is_default = what.ends_with("=0");
      auto const is_empty_container = what.ends_with("/elevationProfile") || what.ends_with("/lateralProfile") ||
                                      what.ends_with("/link") || what.ends_with("/objects") ||
                                      what.ends_with("/signals") || what.ends_with("/left");
      if (is_default || is_empty_container) continue;
      CHECK_MESSAGE(after[what] >= times, what << " was there " << times << " times, and is " << after[what]);
    }
  }
}

TEST_CASE("a document differs from another one by every thing that it says, but not by its lines") {
  auto const text = road_with("<line/>", "<userData code=\"a\"/>", "<surface><CRG file=\"f\"/></surface>");
  auto const document = read(text);
  CHECK(read("\n\n" + text) == document);
  CHECK_FALSE(read(road_with("<line/>", "<userData code=\"b\"/>", "<surface><CRG file=\"f\"/></surface>")) == document);
  CHECK_FALSE(read(road_with("<line/>", "<userData code=\"a\"/>", "<surface><CRG file=\"g\"/></surface>")) == document);
  CHECK_FALSE(read(road_with("<line/>", "", "", "", "other")) == read(road_with("<line/>")));
}

TEST_CASE("names with every character that XML makes special are kept") {
  std::string const name = "A&B <\"quoted\"> 'single' \xC3\xBC\xE2\x82\xAC \t\n end";
  auto document = read(road_with("<line/>"));
  document.roads[0].name = name;
  document.header.geo_reference = "+proj=tmerc <&> \"]]>\"";
  document.roads[0].rest.elements = {{"userData", {{"code", name}}, {{"inner", {}, {}, "  "}}, "text & <more>\r\n"}};
  auto const text = write_opendrive(document);
  CHECK(count(text, "A&amp;B &lt;&quot;quoted&quot;&gt; 'single' \xC3\xBC\xE2\x82\xAC &#9;&#10; end") == 2);
  auto const again = read(text);
  CHECK(again == document);
  CHECK(again.roads[0].name == name);
  CHECK(again.roads[0].rest.elements[0].text == "text & <more>\r\n");
  CHECK(again.roads[0].rest.elements[0].children[0].text == "  ");
}

TEST_CASE("text that XML cannot hold is replaced or refused") {
  auto document = read(road_with("<line/>"));
  document.roads[0].name = std::string("a\x01z\0", 4);
  CHECK(read(write_opendrive(document)).roads[0].name == "a\xEF\xBF\xBDz\xEF\xBF\xBD");
  for (char const* name : {"", "a b", "<", "1st", "a\"", "-x", "a=b", "x/"}) {
    CAPTURE(name);
    auto wrong = document;
    wrong.rest.elements = {{name, {}, {}, ""}};
    CHECK_THROWS_AS((void)write_opendrive(wrong), MapError);
    wrong.rest.elements = {{"userData", {{name, "value"}}, {}, ""}};
    CHECK_THROWS_AS((void)write_opendrive(wrong), MapError);
  }
  document.roads[0].geometries[0].x = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH_AS((void)write_opendrive(document), doctest::Contains("attribute x"), MapError);
}

TEST_CASE("a curve is written as the element that it was read from") {
  for (std::string const curve : {
           R"(<line/>)",
           R"(<arc curvature="0.01"/>)",
           R"(<spiral curvStart="0" curvEnd="-0.02"/>)",
           R"(<poly3 a="0" b="0.1" c="0.001" d="-2e-05"/>)",
           R"(<paramPoly3 aU="0" bU="50" cU="0.25" dU="0" aV="0" bV="0" cV="1" dV="0.5" pRange="normalized"/>)",
           R"(<paramPoly3 aU="0" bU="1" cU="0" dU="0" aV="0" bV="0" cV="0.001" dV="0" pRange="arcLength"/>)",
       }) {
    CAPTURE(curve);
    auto const document = read(road_with(curve));
    auto const text = write_opendrive(document);
    CHECK(count(text, curve) == 1);
    CHECK(read(text) == document);
  }
}

TEST_CASE("a cubic whose parameter ends anywhere is written as the same curve") {
  auto document = read(road_with("<line/>"));
  auto& g = document.roads[0].geometries[0];
  g.kind = GeometryKind::cubic;
  g.cubic = std::make_shared<ParametricCubic const>(ParametricCubic::Coefficients{0, 25, 0, 0},
                                                    ParametricCubic::Coefficients{0, 0, 0.5, 0.25}, 2.0);
  auto const again = read(write_opendrive(document)).roads[0].geometries[0];
  for (double const s : {0.0, 10.0, 33.0, 50.0}) {
    auto const a = evaluate(g, s), b = evaluate(again, s);
    CHECK(std::hypot(a.x - b.x, a.y - b.y) < 1e-11);
    CHECK(a.heading == doctest::Approx(b.heading).epsilon(1e-12));
  }
}

TEST_CASE("speed limits are written in the unit that they were read in, and give the same limit again") {
  for (char const* unit : {"km/h", "mph", "m/s"})
    for (int speed = 0; speed <= 200; ++speed)
      for (char const* fraction : {"", ".5", ".37", ".997999999999998"}) {
        auto const written = "max=\"" + std::to_string(speed) + fraction + "\" unit=\"" + unit + "\"";
        auto const document = read(road_with("<line/>", "<speed sOffset=\"0\" " + written + "/>"));
        auto const text = write_opendrive(document);
        auto const expected = speed == 0 && *fraction == '\0' ? "max=\"0\"" : written;
        bool const is_short = std::string(fraction).size() < 4;  // of others another value may give the same limit
        if (is_short) CHECK_MESSAGE(count(text, expected) == 1, written);
        CHECK(read(text) == document);
      }
  for (char const* other : {"no limit", "undefined"}) {
    auto const document = read(road_with("<line/>", std::string("<speed sOffset=\"0\" max=\"") + other + "\"/>"));
    CHECK(count(write_opendrive(document), other) == 1);
    CHECK(read(write_opendrive(document)) == document);
  }
}

TEST_CASE("a limit that no number of its unit gives is written in m/s, exactly") {
  auto document = read(road_with("<line/>"));
  cambium::RandomStream random(1, 2, 3);
  for (int i = 0; i < 200; ++i) {
    double const limit = 50.0 * cambium::uniform01(random);
    document.roads[0].types = {{0.0, "rural", limit, opendrive::SpeedUnit::miles_per_hour}};
    CHECK(read(write_opendrive(document)).roads[0].types[0].limit == limit);
  }
}

TEST_CASE("numbers are written as short as they can be") {
  auto document = read(road_with("<line/>"));
  document.roads[0].elevation = {{0.0, 0.1, 1.0 / 3.0, -1e-300, 0.0123456789}};
  auto const text = write_opendrive(document);
  CHECK(count(text, R"(<elevation s="0" a="0.1" b="0.3333333333333333" c="-1e-300" d="0.0123456789"/>)") == 1);
  CHECK(read(text) == document);
}

TEST_CASE("a section that spoke for one side is written for both, with records from its own start on") {
  auto text =
      road_with("<line/>",
                "<roadMark sOffset=\"5\" type=\"solid\"/><roadMark sOffset=\"25\" type=\"broken\"/>"
                "<access sOffset=\"0\"/><access sOffset=\"9\"/><rule sOffset=\"0\"/><access sOffset=\"25\"/><note/>");
  auto const end = text.find("</lanes>");
  text.insert(
      end,
      R"(<laneSection s="20" singleSide="true"><left><lane id="1" type="driving"><width sOffset="0" a="2" b="0" c="0"
              d="0"/></lane></left><center><lane id="0"/></center></laneSection>)");
  auto const slope = text.find(R"(a="3" b="0")");
  text.replace(slope, 11, R"(a="3" b="0.01")");
  auto const document = read(text);
  auto const& section = document.roads[0].lane_sections[1];
  CHECK_FALSE(section.single_side);
  auto const* const lane = section.find(-1);
  REQUIRE(lane);
  CHECK(lane->predecessors == std::vector{-1});
  CHECK(document.roads[0].lane_sections[0].find(-1)->successors == std::vector{-1});
  REQUIRE(lane->widths.size() == 1);
  CHECK(lane->widths[0].s == 0.0);
  CHECK(lane->widths[0].value(0.0) == doctest::Approx(3.2));
  CHECK(lane->widths[0].value(10.0) == doctest::Approx(3.3));
  REQUIRE(lane->road_marks.size() == 2);
  CHECK(lane->road_marks[0].s_offset == 0.0);
  CHECK(lane->road_marks[1].s_offset == 5.0);
  // What the library makes no use of, too: the access at 9 m is in force at the section's start.
  std::vector<opendrive::Element> const expected{{"access", {{"sOffset", "0"}}, {}, ""},
                                                 {"rule", {{"sOffset", "0"}}, {}, ""},
                                                 {"access", {{"sOffset", "5"}}, {}, ""},
                                                 {"note", {}, {}, ""}};
  CHECK(lane->rest.elements == expected);
  CHECK(read(write_opendrive(document)) == document);
}

TEST_CASE("a written file is the document's text; one that cannot be written is an error that names it") {
  auto const document = read(road_with("<line/>"));
  auto const path = std::filesystem::path(CAMBIUM_BUILD_DIR) / "written_by_a_test.xodr";
  write_opendrive(path, document);
  CHECK(corpus::read(path) == write_opendrive(document));
  std::filesystem::remove(path);
  CHECK_THROWS_WITH_AS(write_opendrive("/no/such/folder/map.xodr", document), doctest::Contains("/no/such/folder"),
                       cambium::Error);
}

TEST_CASE("the remains of a damaged file are read again as they were written") {
  auto const good = corpus::read(std::filesystem::path(CAMBIUM_SOURCE_DIR) / "maps" / "lane_drop.xodr");
  auto const rich = road_with(
      R"(<userData a="b"/><paramPoly3 aU="0" bU="1" cU="0" dU="0" aV="0" bV="0" cV="0.001" dV="0" pRange="arcLength"/>)",
      R"(<link><predecessor id="-1"/></link><roadMark sOffset="1" type="solid" laneChange="both"><sway/></roadMark>)",
      R"(<objects><object id="a" s="1" t="2"><repeat s="0" length="1" distance="2"/><outline><cornerRoad s="1" t="2"/>
         </outline></object></objects><signals><signal id="s" s="0" t="1" value="5"><validity fromLane="0" toLane="1"/>
         </signal></signals>)",
      R"(<junction id="2" type="direct"><connection id="0" incomingRoad="1" linkedRoad="1" contactPoint="end"><laneLink
         from="-1" to="-1"/></connection><priority high="1" low="2"/></junction>)");
  int readable = 0;
  for (auto const& original : {good, rich})
    for (std::size_t at = 0; at<original.size(); at += original.size()> 3000 ? 7 : 1) {
      auto text = original;
      text.erase(at, 1);
      OpenDriveDocument document;
      try {
        document = read(text);
      } catch (MapError const&) {
        continue;
      }
      ++readable;
      auto const written = write_opendrive(document);
      auto const again = read(written);
      CHECK_MESSAGE(again == document, "without its character " << at << ": " << text);
      CHECK(write_opendrive(again) == written);
    }
  CHECK(readable > 900);
}

TEST_CASE("elements that OpenDRIVE does not know are kept, wherever they stand") {
  auto text = corpus::read(std::filesystem::path(CAMBIUM_SOURCE_DIR) / "maps" / "lane_drop.xodr");
  std::string_view const begin = "<planView>";
  text.insert(text.find(begin), R"(<own a="1"/><objects><object id="a" s="1" t="2"/></objects><own a="2"/>)");
  auto const document = read(text);
  REQUIRE(document.roads[0].rest.elements.size() >= 3);
  CHECK(read(write_opendrive(document)) == document);
}

TEST_CASE("records that are left out leave none behind that would be, were the file read again") {
  // Each is within bounds up to the next one, which is not; without that it holds farther.
  auto text = road_with("<line/>", "");
  text.insert(text.find("<lanes"), R"(<lateralProfile><crossfall side="left" s="0" a="0" b="0" c="1" d="0"/>
    <crossfall side="left" s="1" a="0" b="0" c="1e9" d="0"/><shape s="0" t="0" a="0" b="0" c="-2" d="0"/>
    <shape s="0" t="0" a="0" b="0" c="-2" d="0"/></lateralProfile>)");
  auto const document = read(text);
  CHECK(document.roads.at(0).crossfall.empty());
  CHECK(document.roads[0].shape.empty());
  CHECK(read(write_opendrive(document)) == document);
}
