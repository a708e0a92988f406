// What is found on each map of the corpus: new findings, and lost ones, are to be explained here.
#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "cambium/map/opendrive.hpp"
#include "../support/corpus.hpp"
#include "../support/map_use.hpp"
#include "../support/maps.hpp"

namespace {

using cambium::Severity;

struct Expected {
  char const* map;
  int infos, warnings;
  bool must_warn = false;  ///< the corpus' description says that it is faulty
};

Expected const expected[]{
    {"4way_intersection", 0, 0},
    {"Crossing8Course", 1, 0},  // signs that have no effect
    {"DR_CHN_Merging_ZS_partial_v02", 0, 0},
    {"DR_DEU_Merging_MT_v01_centered", 0, 0},
    {"DR_DEU_Merging_MT_v01_shifted", 0, 0},
    {"Ex_Entry_Exit", 0, 3},                    // two lane links to lanes that are not there, a gap of 2 cm
    {"ParametricCubicCurveComplexRoad", 0, 0},  // its hdg is not the curves' direction, which has no kinks
    {"SingleRoadNegativeWidth", 0, 2, true},
    {"SingleRoadSDirectionChange", 0, 0},
    {"SingleRoadTinyGeometry", 0, 1, true},
    {"Town04", 6, 2, true},  // sections without length; gaps in two reference lines
    {"city_highway_straight", 0, 0},
    {"e6mini-lht", 0, 0, 0},
    {"fabriksgatan", 0, 0},
    {"highway_example_with_merge_and_split", 0, 0},
    {"lane_border", 0, 0},
    {"libopendrive_test", 26, 6, true},   // the same, and lanes that do not meet by 2 to 5 cm
    {"multi_intersections", 6, 0},        // links of one side, signs that limit the speed or have no effect
    {"parking_demo", 0, 1},               // a lane without width between two bays
    {"positive18", 4, 17},                // signs that are not known, or stand at no lane
    {"XCrossStopAllWay", 0, 1},           // signs of type 1022
    {"road_corridor_test", 0, 10, true},  // links to nowhere, and to the wrong ends of roads
    {"route_strategy_test_road", 0, 0},
    {"simple_3way_intersection_lht", 0, 0},
    {"soderleden", 1, 1},  // a road link that is not returned
    {"threeway_intersection", 0, 0},
    {"two_plus_one", 0, 0},
    {"velodrome", 0, 0},
    {"virtual_junction_priority", 0, 2, true},  // a junction without connections, a lane without width
};

}  // namespace

TEST_CASE("these maps of the corpus have the findings that are known, and no other") {
  auto const folder = corpus::find("opendrive");
  if (!folder) return;
  for (auto const& path : corpus::maps(*folder)) {
    auto const known = [&](Expected const& e) { return path.stem() == e.map; };
    if (std::none_of(std::begin(expected), std::end(expected), known)) MESSAGE("no findings are known of " << path);
  }
  std::size_t roads = 0;
  for (auto const& e : expected) {
    CAPTURE(e.map);
    auto const loaded = cambium::load_opendrive((*folder / (std::string(e.map) + ".xodr")).string());
    auto const count = [&](Severity severity) {
      return std::count_if(loaded.diagnostics.begin(), loaded.diagnostics.end(),
                           [severity](auto const& d) { return d.severity == severity; });
    };
    std::string all;
    for (auto const& d : loaded.diagnostics) all += "\n" + to_string(d);
    CAPTURE(all);
    CHECK(count(Severity::info) == e.infos);
    CHECK(count(Severity::warning) == e.warnings);
    CHECK((!e.must_warn || count(Severity::warning) > 0));
    roads += loaded.map->roads().size();
    for (auto const& d : loaded.diagnostics) {
      CHECK(d.line > 0);
      CHECK_FALSE(d.sentence.empty());
    }
  }
  CHECK(roads >= 690);
}

TEST_CASE("a road has a handful of findings, however often it is at fault") {
  auto const folder = corpus::find("opendrive");
  if (!folder) return;
  for (auto const& path : corpus::maps(*folder)) {
    std::vector<std::string> roads;
    for (auto const& d : cambium::load_opendrive(path.string()).diagnostics)
      roads.push_back(d.ids.substr(0, d.ids.find(',')));
    for (auto const& road : roads) CHECK(std::count(roads.begin(), roads.end(), road) <= 4);
  }
}

// The same uses that the fuzzer makes of damaged maps.
TEST_CASE("routes, corridors, junctions, look-ups and pictures work on our own maps and on maps of the corpus") {
  for (auto const& file : corpus::some_maps(
           {"DR_DEU_Merging_MT_v01_shifted", "fabriksgatan", "multi_intersections", "virtual_junction_priority"})) {
    CAPTURE(file.string());
    CHECK(map_use::first_failure(*cambium::load_opendrive(file.string()).map) == "");
  }
}
