// Whatever stands in a file is written again when it was read, or there is a finding.
#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <pugixml.hpp>

#include "cambium/core/error.hpp"
#include "cambium/map/opendrive/reader.hpp"
#include "cambium/map/opendrive/writer.hpp"

#include "../support/xml_damage.hpp"

namespace {

using Counts = std::map<std::string, int>;

/// The elements and attributes of OpenDRIVE 1.8 that describe roads, those that the reader makes no use of too, and
/// user data.
char const* const everything = R"(<OpenDRIVE>
<header revMajor="1" revMinor="8" name="everything" version="1" date="today" north="4" south="3" east="2" west="1"
    vendor="v"><geoReference>+proj=utm</geoReference><offset x="1" y="2" z="3" hdg="0"/></header>
<road id="1" length="50" junction="-1" name="all" rule="LHT">
  <link><predecessor elementType="road" elementId="2" contactPoint="end"/>
        <successor elementType="junction" elementId="7"/></link>
  <type s="0" type="town" country="DE"><speed max="50" unit="km/h"/></type>
  <planView>
    <geometry s="0" x="0" y="0" hdg="0" length="10"><line/></geometry>
    <geometry s="10" x="10" y="0" hdg="0" length="10"><arc curvature="0"/></geometry>
    <geometry s="20" x="20" y="0" hdg="0" length="10"><spiral curvStart="0" curvEnd="0"/></geometry>
    <geometry s="30" x="30" y="0" hdg="0" length="10">
      <paramPoly3 aU="0" bU="1" cU="0" dU="0" aV="0" bV="0" cV="0" dV="0" pRange="arcLength"/></geometry>
    <geometry s="40" x="40" y="0" hdg="0" length="10"><poly3 a="0" b="0" c="0.001" d="0"/></geometry>
  </planView>
  <elevationProfile><elevation s="0" a="1" b="0" c="0" d="0"/></elevationProfile>
  <lateralProfile><superelevation s="0" a="0.01" b="0" c="0" d="0"/>
    <crossfall s="0" a="0.01" b="0" c="0" d="0" side="left"/><shape s="0" t="0" a="0.1" b="0" c="0" d="0"/>
    </lateralProfile>
  <lanes><laneOffset s="0" a="0.5" b="0" c="0" d="0"/>
    <laneSection s="0">
      <left><lane id="1" type="driving" level="false"><border sOffset="0" a="3" b="0" c="0" d="0"/></lane></left>
      <center><lane id="0" type="none"><roadMark sOffset="0" type="solid"/></lane></center>
      <right><lane id="-1" type="driving"><link><predecessor id="-1"/><successor id="-1"/></link>
        <width sOffset="0" a="3" b="0" c="0" d="0"/>
        <roadMark sOffset="0" type="solid" weight="bold" color="white" material="paint" width="0.3"
            laneChange="none" height="0.02"><type name="t"><line length="1"/></type></roadMark>
        <height sOffset="0" inner="0.1" outer="0.1"/><access sOffset="0" rule="deny" restriction="bus">
        <restriction type="truck"/></access><rule sOffset="0" value="v"/>
        <speed sOffset="0" max="10" unit="m/s"/><material sOffset="0" surface="asphalt"/></lane></right>
    </laneSection>
  </lanes>
  <objects><object id="o" name="n" type="building" subtype="b" s="1" t="1" zOffset="0.5" hdg="0.1" pitch="0.2"
        roll="0.3" height="4" length="5" width="6" radius="7" orientation="none" validLength="8" dynamic="no"
        perpToRoad="true"><repeat s="0" length="5" distance="1" tStart="1" tEnd="2" widthStart="1" widthEnd="2"
        heightStart="3" heightEnd="4" zOffsetStart="0" zOffsetEnd="1" lengthStart="1" lengthEnd="2" radiusStart="1"
        radiusEnd="2"/>
      <outlines><outline id="1" closed="true" fillType="grass" laneType="none"><cornerLocal u="0" v="1" z="2"
          height="3" id="4"/></outline>
        <outline><cornerRoad s="0" t="1" dz="2" height="3" id="4"/></outline></outlines>
      <material surface="s"/><parkingSpace access="all"/><markings><marking side="left"/></markings><borders>
      <border type="t"/></borders>
      <surface/><skeleton/><validity fromLane="-1" toLane="-1"/></object>
    <objectReference id="o" s="2" t="1" zOffset="0" validLength="3" orientation="+">
    <validity fromLane="1" toLane="1"/></objectReference>
    <bridge id="b" s="0" length="9" type="concrete"/><tunnel id="t" s="0" length="9" type="standard"/></objects>
  <signals><signal id="s" name="n" dynamic="yes" orientation="+" s="1" t="1" zOffset="3" country="DE"
      countryRevision="2017" type="274" subtype="55" value="50" unit="km/h" height="0.6" width="0.5" text="slow"
      hOffset="0.1" pitch="0.2" roll="0.3"><validity fromLane="-1" toLane="-1"/>
      <dependency id="8" type="limitline"/><reference elementType="object" elementId="o"/>
      <positionRoad roadId="1" s="2" t="3"/></signal>
    <signalReference id="s" s="2" t="1" orientation="-"><validity fromLane="-1" toLane="-1"/></signalReference>
    </signals>
  <surface><CRG file="f"/></surface><railroad><switch id="w"/></railroad>
  <userData code="road"/>
</road>
<road id="2" length="10" junction="7" rule="LHT"><planView><geometry s="0" x="-10" y="0" hdg="0" length="10">
<line/></geometry></planView>
  <lanes><laneSection s="0"><center><lane id="0" type="none"/></center>
    <right><lane id="-1" type="driving"><width sOffset="0" a="3" b="0" c="0" d="0"/></lane></right></laneSection>
    </lanes></road>
<controller id="c" name="lights" sequence="2"><control signalId="s" type="t"/></controller>
<junction id="7" name="j" type="virtual" mainRoad="1" sStart="3" sEnd="6" orientation="+">
<connection id="0" incomingRoad="1" connectingRoad="2" contactPoint="end"><laneLink from="-1" to="-1"
    overlapZone="12.5"/>
    </connection><connection id="1" type="virtual"><predecessor elementType="road" elementId="1" elementS="5"
        elementDir="+"/>
    <successor elementType="road" elementId="1" elementS="9" elementDir="+"/></connection>
  <priority high="1" low="2"/><controller id="c" type="0" sequence="1"/><crossPath id="0"/></junction>
<junctionGroup id="g" name="n" type="roundabout"><junctionReference junction="7"/></junctionGroup>
<station id="st" name="n" type="small"><platform id="p"/></station>
<userData code="root"/>
</OpenDRIVE>)";

void count(pugi::xml_node node, Counts& counts) {
  for (auto const child : node)
    if (child.type() == pugi::node_element) {
      ++counts[child.name()];
      for (auto const a : child.attributes()) ++counts[child.name() + std::string(" ") + a.name() + "=" + a.value()];
      count(child, counts);
    }
}

Counts counts_of(std::string const& text) {
  pugi::xml_document xml;
  REQUIRE(xml.load_string(text.c_str()));
  Counts counts;
  count(xml, counts);
  return counts;
}

/// What reading gives: the elements that findings are about, and what is written again.
struct Outcome {
  std::vector<std::string> findings;
  std::string written;

  [[nodiscard]] bool is_found(std::string const& element) const {
    return std::find(findings.begin(), findings.end(), element) != findings.end();
  }
};

Outcome outcome_of(std::string const& text) {
  std::vector<cambium::Diagnostic> diagnostics;
  auto const document = cambium::map::read_opendrive_document(text, "test.xodr", diagnostics);
  Outcome outcome{{}, cambium::map::write_opendrive(document)};
  for (auto const& d : diagnostics) outcome.findings.push_back(d.element);
  return outcome;
}

/// Calls `visit(element)` with each element of a fresh copy of the file.
template <class Visit>
void for_each_element(Visit const& visit) {
  std::size_t elements = 1;
  for (std::size_t i = 0; i < elements; ++i) {
    pugi::xml_document xml;
    REQUIRE(xml.load_string(everything));
    std::vector<pugi::xml_node> all;
    xml_damage::collect(xml, all);
    elements = all.size();
    CAPTURE(all[i].path());
    visit(all[i]);
  }
  CHECK(elements > 80);
}

/// Adds something at each element of the file in turn; it must be written again, or there is a finding about it, the
/// element or the one around it.
template <class Add>
void check_elements(Add const& add) {
  for_each_element([&](pugi::xml_node node) {
    std::string const name = node.name(), around = node.parent().name();
    std::string const added = add(node);
    auto const text = xml_damage::text_of(node.root());
    auto const after = outcome_of(text);
    bool const is_found = after.is_found(name) || after.is_found(around) || after.is_found(added);
    CHECK((is_found || counts_of(after.written) == counts_of(text)));
  });
}

}  // namespace

TEST_CASE("everything that the reader knows is written again, without a finding") {
  auto const before = outcome_of(everything);
  CHECK(before.findings.empty());
  CHECK(counts_of(before.written) == counts_of(everything));
}

TEST_CASE("no element that occurs twice gets lost without a finding") {
  check_elements([](pugi::xml_node node) {
    node.parent().insert_copy_after(node, node);
    bool const is_side = !node.child("lane").empty();  // its lanes occur twice
    return is_side ? "lane" : node.name();
  });
}

TEST_CASE("user data in any element is kept, or found to be lost") {
  check_elements([](pugi::xml_node node) {
    node.append_child("userData").append_attribute("code") = "x";
    return "userData";
  });
}

TEST_CASE("an unknown element is kept anywhere, or reported as lost") {
  check_elements([](pugi::xml_node node) {
    node.prepend_child("later").append_child("revision");
    return "later";
  });
}

TEST_CASE("an unknown attribute is kept anywhere, or reported as lost") {
  for_each_element([](pugi::xml_node node) {
    node.append_attribute("vendorNote") = "kept or found";
    auto const after = outcome_of(xml_damage::text_of(node.root()));
    CHECK((after.is_found(node.name()) || after.written.find("vendorNote=\"kept or found\"") != std::string::npos));
  });
}

TEST_CASE("text in any element is kept, or found to be lost") {
  for_each_element([](pugi::xml_node node) {
    node.append_child(pugi::node_pcdata).set_value("kept or found");
    auto const after = outcome_of(xml_damage::text_of(node.root()));
    CHECK((after.is_found(node.name()) || after.written.find("kept or found") != std::string::npos));
  });
}

TEST_CASE("an unreadable value is kept in any attribute, or reported, and a bad position is always reported") {
  for_each_element([](pugi::xml_node node) {
    for (pugi::xml_attribute a = node.first_attribute(); a; a = a.next_attribute()) {
      std::string const before = a.value(), name = a.name();
      CAPTURE(name);
      a = "yes please";
      Outcome after;
      try {
        after = outcome_of(xml_damage::text_of(node.root()));
      } catch (cambium::MapError const&) {
        after.findings = {node.name()};  // the only road is unusable
      }
      CHECK((after.is_found(node.name()) || after.written.find("\"yes please\"") != std::string::npos));
      std::string const path = node.path();
      bool is_raw = false;
      for (char const* const raw : {"/objects/", "/positionRoad", "/access", "/rule", "/material"})
        is_raw |= path.find(raw) != path.npos;
      if (!is_raw && (name == "sOffset" || name == "s")) CHECK(after.is_found(node.name()));
      a = before.c_str();
    }
  });
}

TEST_CASE("a word that is neither true nor false is found") {
  for (char const* const attribute : {"singleSide=\"maybe\"", "singleSide=\"twice\""}) {
    auto text = std::string(everything);
    text.insert(text.find("<laneSection") + 13, attribute + std::string(" "));
    auto const after = outcome_of(text);
    CHECK(after.findings == std::vector<std::string>{"laneSection"});
    CHECK(after.written.find(attribute) != std::string::npos);
  }
}

TEST_CASE("unknown attributes give one finding for each kind of element, with their number") {
  auto text = std::string(everything);
  for (std::size_t at = 0; (at = text.find("<width ", at)) != std::string::npos; at += 7)
    text.insert(at + 7, "v=\"1\" ");
  for (std::size_t at = 0; (at = text.find("<speed ", at)) != std::string::npos; at += 7)
    text.insert(at + 7, "v=\"1\" ");
  std::vector<cambium::Diagnostic> diagnostics;
  (void)cambium::map::read_opendrive_document(text, "test.xodr", diagnostics);
  REQUIRE(diagnostics.size() == 2);
  CHECK(to_string(diagnostics[0]).find("like 1 more") != std::string::npos);
  CHECK(diagnostics[0].element == "speed");
  CHECK(diagnostics[0].line == 7);
  CHECK(diagnostics[1].element == "width");
}

TEST_CASE("a record with a bad place is left out") {
  auto text = std::string(everything);
  for (std::string const record :
       {"<roadMark sOffset=\"0\"", "<speed sOffset=\"0\"", "<type s=\"0\"", "<height sOffset=\"0\""}) {
    auto bad = record;
    bad.replace(bad.find("\"0\""), 3, "\"x\"");
    for (auto at = text.find(record); at != std::string::npos; at = text.find(record))
      text.replace(at, record.size(), bad);
  }
  std::vector<cambium::Diagnostic> diagnostics;
  auto const road = cambium::map::read_opendrive_document(text, "test.xodr", diagnostics).roads.at(0);
  CHECK(road.types.empty());
  for (auto const& lane : road.lane_sections.at(0).lanes) {
    CHECK(lane.road_marks.empty());
    CHECK(lane.speeds.empty());
    CHECK(lane.heights.empty());
  }
}
