// Documents that no reader has looked at.
#include "cambium/map/build_map.hpp"

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "cambium/map/map_builder.hpp"

namespace {

using namespace cambium;
using namespace cambium::map;

OpenDriveDocument sound_document() {
  MapBuilder builder;
  for (char const* id : {"1", "2"})
    builder.add_road({.id = id, .line = lay_from({}, {{50.0}, {50.0}}), .sections = {{.right = equal_lanes(2)}}});
  return builder.document();
}

/// The message of what `build_map` throws; empty where it makes a map.
std::string message_for(OpenDriveDocument const& document) {
  std::vector<Diagnostic> diagnostics;
  try {
    (void)build_map(document, {}, "code", diagnostics);
  } catch (MapError const& e) {
    return e.what();
  }
  return {};
}

}  // namespace

TEST_CASE("a document made in code that lacks what a map needs is refused with the place and a remedy") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  CHECK(message_for(sound_document()).empty());
  using Harm = void (*)(opendrive::Road&);
  std::vector<std::pair<Harm, std::string>> const harms{
      {[](opendrive::Road& r) { r.geometries.clear(); }, "no geometry"},
      {[](opendrive::Road& r) { r.lane_sections.clear(); }, "no lane section"},
      {[](opendrive::Road& r) { r.geometries[0].kind = GeometryKind::cubic; }, "no curve"},
      {[](opendrive::Road& r) { r.geometries[0].x = nan; }, "not finite"},
      {[](opendrive::Road& r) { r.geometries[1].heading = infinity; }, "not finite"},
      {[](opendrive::Road& r) { r.geometries[1].length = -1.0; }, "below 0"},
      {[](opendrive::Road& r) { r.geometries[1].length = 1e9; }, "beyond any map"},
      {[](opendrive::Road& r) { r.geometries[1].curvature_end = 1e6; }, "1000 rad"},
      {[](opendrive::Road& r) { r.geometries[1].curvature_start = nan; }, "not finite"},
      {[](opendrive::Road& r) { std::swap(r.geometries[0], r.geometries[1]); }, "order of s"},
      {[](opendrive::Road& r) { r.lane_sections[0].s = nan; }, "order of s"},
      {[](opendrive::Road& r) { r.lane_sections[0].lanes[1].widths[0].a = nan; }, "width is not finite"},
      {[](opendrive::Road& r) { r.lane_sections[0].lanes[1].id = 0; }, "left to right"},
      {[](opendrive::Road& r) {
         r.lane_sections[0].lanes[1].speeds = {{nan, 10.0}};
       },
       "speed is not a number"},
      {[](opendrive::Road& r) {
         r.elevation = {{0.0, infinity, 0.0, 0.0, 0.0}};
       },
       "of the road is not finite"},
      {[](opendrive::Road& r) {
         r.lane_offset = {{nan, 0.0, 0.0, 0.0, 0.0}};
       },
       "of the road is not finite"},
      {[](opendrive::Road& r) { r.id = "1"; }, "same id"},
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
