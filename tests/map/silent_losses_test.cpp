// Whatever stands in a file is written again when it was read, or there is a finding.
#include <cstddef>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <pugixml.hpp>

#include "cambium/core/error.hpp"
#include "cambium/map/opendrive_writer.hpp"

#include "../support/maps.hpp"

namespace {

using Counts = std::map<std::string, int>;

/// Every element that the reader knows, and one that it does not know.
char const* const everything = R"(<OpenDRIVE>
<header revMajor="1" revMinor="8"><geoReference>+proj=utm</geoReference><offset x="1" y="2" z="3" hdg="0"/></header>
<road id="1" length="50" junction="-1" name="all">
  <link><predecessor elementType="road" elementId="2" contactPoint="end"/>
        <successor elementType="junction" elementId="7"/></link>
  <type s="0" type="town"><speed max="50" unit="km/h"/></type>
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
    <crossfall s="0" a="0.01" b="0" c="0" d="0" side="left"/><shape s="0" t="0" a="0.1" b="0" c="0" d="0"/></lateralProfile>
  <lanes><laneOffset s="0" a="0.5" b="0" c="0" d="0"/>
    <laneSection s="0">
      <left><lane id="1" type="driving"><border sOffset="0" a="3" b="0" c="0" d="0"/></lane></left>
      <center><lane id="0" type="none"><roadMark sOffset="0" type="solid"/></lane></center>
      <right><lane id="-1" type="driving"><link><predecessor id="-1"/><successor id="-1"/></link>
        <width sOffset="0" a="3" b="0" c="0" d="0"/>
        <roadMark sOffset="0" type="solid"><type name="t"><line length="1"/></type></roadMark>
        <height sOffset="0" inner="0.1" outer="0.1"/><access sOffset="0" restriction="bus"/><rule sOffset="0" value="v"/>
        <speed sOffset="0" max="10"/><material sOffset="0" surface="asphalt"/></lane></right>
    </laneSection>
  </lanes>
  <objects><object id="o" s="1" t="1"><repeat s="0" length="5" distance="1"/><validity fromLane="-1" toLane="-1"/>
      <outlines><outline id="1"><cornerLocal u="0" v="0"/></outline><outline><cornerRoad s="0" t="0"/></outline></outlines>
    </object><objectReference id="o" s="2" t="1"><validity fromLane="1" toLane="1"/></objectReference></objects>
  <signals><signal id="s" s="1" t="1"><validity fromLane="-1" toLane="-1"/></signal>
    <signalReference id="s" s="2" t="1"><validity fromLane="-1" toLane="-1"/></signalReference></signals>
  <userData code="road"/>
</road>
<road id="2" length="10" junction="7"><planView><geometry s="0" x="-10" y="0" hdg="0" length="10"><line/></geometry></planView>
  <lanes><laneSection s="0"><center><lane id="0" type="none"/></center>
    <right><lane id="-1" type="driving"><width sOffset="0" a="3" b="0" c="0" d="0"/></lane></right></laneSection></lanes></road>
<controller id="c"><control signalId="s"/></controller>
<junction id="7"><connection id="0" incomingRoad="1" connectingRoad="2" contactPoint="end"><laneLink from="-1" to="-1"/>
    </connection><connection id="1"><predecessor elementType="road" elementId="1" elementS="5" elementDir="+"/>
    <successor elementType="road" elementId="1" elementS="9" elementDir="+"/></connection>
  <priority high="1" low="2"/><controller id="c"/></junction>
<userData code="root"/>
</OpenDRIVE>)";

void count(pugi::xml_node node, Counts& counts) {
  for (auto const child : node)
    if (child.type() == pugi::node_element) {
      ++counts[child.name()];
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

/// What reading gives: how many findings, and the elements of what is written again.
struct Outcome {
  std::size_t findings = 0;
  Counts written;
};

Outcome outcome_of(std::string const& text) {
  std::vector<cambium::Diagnostic> diagnostics;
  auto const document = support::read_opendrive_document(text, "test.xodr", diagnostics);
  return {diagnostics.size(), counts_of(cambium::map::write_opendrive(document))};
}

void collect(pugi::xml_node node, std::vector<pugi::xml_node>& all) {
  for (auto const child : node)
    if (child.type() == pugi::node_element) {
      all.push_back(child);
      collect(child, all);
    }
}

/// Changes the file at each of its elements in turn; what is added must be written again, or found.
template <class Change>
void check_all(Change const& change) {
  auto const before = outcome_of(everything);
  CHECK(before.findings == 0);
  CHECK(before.written == counts_of(everything));
  std::size_t elements = 1;
  for (std::size_t i = 0; i < elements; ++i) {
    pugi::xml_document xml;
    REQUIRE(xml.load_string(everything));
    std::vector<pugi::xml_node> all;
    collect(xml, all);
    elements = all.size();
    CAPTURE(all[i].path());
    change(all[i]);
    std::ostringstream text;
    xml.save(text, "", pugi::format_raw);
    auto const after = outcome_of(text.str());
    CHECK((after.findings > 0 || after.written == counts_of(text.str())));
  }
  CHECK(elements > 80);
}

}  // namespace

TEST_CASE("no element that is there twice gets lost without a finding") {
  check_all([](pugi::xml_node node) { node.parent().insert_copy_after(node, node); });
}

TEST_CASE("user data in any element is kept, or found to be lost") {
  check_all([](pugi::xml_node node) { node.append_child("userData").append_attribute("code") = "x"; });
}

TEST_CASE("an element that nobody knows is kept anywhere, or found to be lost") {
  check_all([](pugi::xml_node node) { node.prepend_child("later").append_child("revision"); });
}
