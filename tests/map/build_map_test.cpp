// Documents that no reader has looked at.
#include "cambium/map/building/build_map.hpp"

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "../support/error_of.hpp"
#include "../support/map_faults.hpp"
#include "../support/map_use.hpp"
#include "cambium/map/building/map_builder.hpp"
#include "cambium/map/opendrive/check.hpp"

namespace {

using namespace cambium;
using namespace cambium::map;

OpenDriveDocument sound_document() {
  MapBuilder builder;
  for (char const* id : {"1", "2"})
    builder.add_road({.id = id, .line = lay_from({}, {{50.0}, {50.0}}), .sections = {{.right = equal_lanes(2)}}});
  return builder.document();
}

/// The message of what `build_map` throws.
std::string message_for(OpenDriveDocument const& document) {
  std::vector<Diagnostic> diagnostics;
  return support::error_of([&] { (void)build_map(document, {}, "code", diagnostics); });
}

}  // namespace

TEST_CASE("a document made in code that lacks what a map needs is refused with the place and a remedy") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  CHECK(message_for(sound_document()) == "no error");
  using Harm = void (*)(opendrive::RoadElement&);
  std::vector<std::pair<Harm, std::string>> const harms{
      {[](opendrive::RoadElement& r) { r.geometries.clear(); }, "no geometry"},
      {[](opendrive::RoadElement& r) { r.lane_sections.clear(); }, "no lane section"},
      {[](opendrive::RoadElement& r) { r.geometries[0].kind = GeometryKind::cubic; }, "without its curve"},
      {[](opendrive::RoadElement& r) { r.geometries[0].x = nan; }, "not finite"},
      {[](opendrive::RoadElement& r) { r.geometries[1].heading = infinity; }, "not finite"},
      {[](opendrive::RoadElement& r) { r.geometries[1].length = -1.0; }, "negative"},
      {[](opendrive::RoadElement& r) { r.geometries[1].y = nan; }, "not finite"},
      {[](opendrive::RoadElement& r) { r.geometries[1].curvature_end = nan; }, "not finite"},
      {[](opendrive::RoadElement& r) {
         r.types.emplace_back();
         r.types[0].s = nan;
       },
       "speed of the road is not a number"},
      {[](opendrive::RoadElement& r) { r.geometries[1].length = 1e9; }, "beyond 1000 km"},
      {[](opendrive::RoadElement& r) { r.geometries[1].curvature_end = 1e6; }, "100 rad"},
      {[](opendrive::RoadElement& r) { r.geometries[1].curvature_start = nan; }, "not finite"},
      {[](opendrive::RoadElement& r) { std::swap(r.geometries[0], r.geometries[1]); }, "order of s"},
      {[](opendrive::RoadElement& r) { r.lane_sections[0].s = nan; }, "order of s"},
      {[](opendrive::RoadElement& r) { r.lane_sections[0].lanes[1].widths[0].a = nan; }, "width is not finite"},
      {[](opendrive::RoadElement& r) { r.lane_sections[0].lanes[1].id = 0; }, "left to right"},
      {[](opendrive::RoadElement& r) {
         r.lane_sections[0].lanes[1].speeds = {{nan, 10.0}};
       },
       "speed of a lane is not a number"},
      {[](opendrive::RoadElement& r) {
         r.elevation = {{0.0, infinity, 0.0, 0.0, 0.0}};
       },
       "of the road is not finite"},
      {[](opendrive::RoadElement& r) {
         r.lane_offset = {{nan, 0.0, 0.0, 0.0, 0.0}};
       },
       "of the road is not finite"},
      {[](opendrive::RoadElement& r) { r.id = "1"; }, "same id"},
  };
  for (auto const& [harm, sentence] : harms) {
    CAPTURE(sentence);
    auto document = sound_document();
    harm(document.roads[1]);
    auto const message = message_for(document);
    CHECK(message.find("road ") != std::string::npos);
    CHECK(message.find(sentence) != std::string::npos);
  }
  auto document = sound_document();
  document.header.offset.x = nan;
  CHECK(message_for(document).find("header") != std::string::npos);
  document.header.offset = {1e300, 0.0, 0.0, 0.0};
  CHECK(message_for(document).find("header") != std::string::npos);
}

TEST_CASE("a lane given by its border has its middle at a road's end where the map has it") {
  MapBuilder builder;
  builder.add_road({.id = "1", .line = lay_from({}, {{50.0}}), .sections = {{.right = equal_lanes(2)}}});
  auto& lanes = builder.road("1").lane_sections[0].lanes;
  for (int i = 1; i <= 2; ++i) {
    auto& lane = lanes[static_cast<std::size_t>(i)];
    lane.widths.clear();
    lane.borders = {{0.0, -3.0 * i, 0.0, 0.0, 0.0}};
  }
  CHECK(builder.lane_pose({"1", opendrive::ContactPoint::end}, -2).y == doctest::Approx(-4.5));
  auto const map = builder.build();
  CHECK(map->lane(map->find_lane("1", 10.0, -2)).path.pose(10.0).y == doctest::Approx(-4.5));
}

TEST_CASE("a finite number beyond any road costs its element, not the map") {
  constexpr double huge = 1e308;
  CubicRecord const wild{0.0, 0.0, huge, huge, 0.0}, behind{1e6, 3.0, huge, huge, huge};
  using Harm = void (*)(OpenDriveDocument&, CubicRecord const&);
  for (Harm const harm :
       {Harm([](auto&d, auto&r) { d.roads[0].superelevation = {r}; }),
        Harm([](auto&d, auto&r) { d.roads[0].elevation = {r}; }),
        Harm([](auto&d, auto&r) { d.roads[0].lane_offset = {r}; }), Harm([](auto&d, auto&r) {
          d.roads[0].crossfall = {{r, opendrive::Side::both}};
        }),
        Harm([](auto&d, auto&r) {
          d.roads[0].shape = {{0.0, r}};
        }),
        Harm([](auto&d, auto&r) { d.roads[0].lane_sections[0].lanes[1].widths.push_back(r); }), Harm([](auto&d, auto&) {
          opendrive::HeightRecord height;
          height.inner = height.outer = huge;
          d.roads[0].lane_sections[0].lanes[1].heights = {height};
        }),
        Harm([](auto&d, auto&) { d.header.offset.x = 1e300; })})
    for (auto const* record : {&wild, &behind}) {
      auto document = sound_document();
      harm(document, *record);
      std::vector<Diagnostic> diagnostics;
      check_opendrive_document(document, "code", diagnostics);
      auto const map = build_map(document, {}, "code", diagnostics);
      CHECK(map->roads().size() == 2);
      CHECK(map_faults::first_fault(*map) == "");
      CHECK(map_use::first_failure(*map) == "");
    }
}

TEST_CASE("a lane section that starts before the road keeps the places of its records") {
  auto document = sound_document();
  auto& section = document.roads[0].lane_sections[0];
  section.s = -10.0;
  section.lanes[1].widths = {{0.0, 3.0, 0.0, 0.0, 0.0}, {30.0, 4.0, 0.0, 0.0, 0.0}};
  std::vector<Diagnostic> diagnostics;
  check_opendrive_document(document, "code", diagnostics);
  CHECK(section.s == 0.0);
  REQUIRE(section.lanes[1].widths.size() == 2);
  CHECK(section.lanes[1].widths[1].s == 20.0);
}
