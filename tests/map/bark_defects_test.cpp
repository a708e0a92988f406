// What a known reader of these maps (BARK, as studied) does wrong, and this one must not. More of it is in the tests of
// routes, of lanes near a point and of built corridors.
#include <cmath>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/map/lanes/lane_network.hpp"
#include "cambium/map/opendrive.hpp"
#include "road_text.hpp"
#include "../support/maps.hpp"

namespace {

using namespace road_text;
using cambium::LoadedMap;
using cambium::Severity;
using cambium::map::build_road_corridor;
using cambium::map::RoadDirection;

bool has_route(LoadedMap const& loaded, At const& from, At const& to) {
  auto const& map = *loaded.map;
  return map.shortest_route(map.find_lane(from.road, from.s, from.lane), map.find_lane(to.road, to.s, to.lane))
      .has_value();
}

/// No joined lanes are apart or kinked: whoever joins the wrong ends is found out.
void check_that_all_meet(LoadedMap const& loaded) {
  for (auto const& f : cambium::check_lane_network(*loaded.map))
    CHECK_MESSAGE((f.fault == cambium::NetworkFault::dead_end || f.fault == cambium::NetworkFault::no_way_in),
                  loaded.map->describe(f.lane) << ": " << to_string(f.fault));
}

constexpr double half_turn = cambium::geometry::pi;

}  // namespace

TEST_CASE("a junction at the road's start is entered there") {
  // its start is at x = 200, its end at x = 300; lane 1 is driven towards the start
  Road incoming{.x = 200,
                .before = to_junction("7"),
                .sections = {{0, {{.id = 1, .before = {}, .behind = {1}}}}, {60, {{.id = 1, .before = {1}}}}}};
  Road connecting{.id = "2",
                  .x = 200,
                  .heading = half_turn,
                  .before = to_start("1"),
                  .sections = {{.lanes = {{.id = -1, .before = {1}}}}},
                  .junction = "7"};
  auto const loaded = load(file({incoming, connecting}, junction("7", connection("1", "2", "start", 1, -1))));
  CHECK(loaded.diagnostics.empty());
  CHECK(leads(loaded, {"1", 10, 1}, {"2", 10, -1}));
  CHECK_FALSE(leads(loaded, {"1", 90, 1}, {"2", 10, -1}));
  CHECK(has_route(loaded, {"1", 90, 1}, {"2", 10, -1}));
  check_that_all_meet(loaded);
}

TEST_CASE("an incoming road is left from its last section, not from its first one") {
  Road incoming{.behind = to_junction("7"),
                .sections = {{0, {{.id = -1, .behind = {-1}}}}, {50, {{.id = -1, .before = {-1}}}}}};
  Road connecting{.id = "2", .x = 100, .before = to_end("1"), .junction = "7"};
  auto const loaded = load(file({incoming, connecting}, junction("7", connection("1", "2", "start", -1, -1))));
  CHECK(leads(loaded, {"1", 90, -1}, {"2", 10, -1}));
  CHECK_FALSE(leads(loaded, {"1", 10, -1}, {"2", 10, -1}));
  check_that_all_meet(loaded);
}

TEST_CASE("a connecting road that runs backwards is entered at its end") {
  Road incoming{.behind = to_junction("7")};
  Road connecting{.id = "2",
                  .x = 150,
                  .heading = half_turn,
                  .length = 50,
                  .before = to_start("3"),
                  .behind = to_end("1"),
                  .sections = {{.lanes = {{.id = 1, .before = {-1}, .behind = {-1}}}}},
                  .junction = "7"};
  Road outgoing{.id = "3", .x = 150, .before = to_junction("7")};
  auto const loaded = load(file({incoming, connecting, outgoing}, junction("7", connection("1", "2", "end", -1, 1))));
  CHECK(loaded.diagnostics.empty());
  CHECK(leads(loaded, {"1", 10, -1}, {"2", 10, 1}));
  CHECK(leads(loaded, {"2", 10, 1}, {"3", 10, -1}));
  CHECK(has_route(loaded, {"1", 10, -1}, {"3", 90, -1}));
  check_that_all_meet(loaded);
}

TEST_CASE("roads that meet with their ends, or with their starts, are joined there") {
  for (bool const by_end : {true, false}) {
    Road a, b;
    (by_end ? a.behind : a.before) = by_end ? to_end("2") : to_start("2");
    b.id = "2";
    b.x = by_end ? 200 : 0;
    b.heading = half_turn;
    (by_end ? b.behind : b.before) = by_end ? to_end("1") : to_start("1");
    std::vector<int> const there{-1};
    a.sections[0].lanes =
        by_end ? std::vector<Lane>{{.id = -1, .behind = {1}}} : std::vector<Lane>{{.id = -1, .before = {1}}};
    b.sections[0].lanes =
        by_end ? std::vector<Lane>{{.id = 1, .behind = there}} : std::vector<Lane>{{.id = 1, .before = there}};
    auto const loaded = load(file({a, b}));
    CHECK(loaded.diagnostics.empty());
    // Lane -1 of road 1 runs along it, lane 1 of road 2 against that: out of the joint of the ends into ...
    CHECK(leads(loaded, {"1", 50, -1}, {"2", 50, 1}) == by_end);
    CHECK(leads(loaded, {"2", 50, 1}, {"1", 50, -1}) != by_end);
    check_that_all_meet(loaded);
  }
}

TEST_CASE("links are entered in the direction of travel only") {
  Road a{.behind = to_start("2"), .sections = {{.lanes = {{.id = 1, .behind = {1}}, {.id = -1, .behind = {-1}}}}}};
  Road b{.id = "2",
         .x = 100,
         .before = to_end("1"),
         .sections = {{.lanes = {{.id = 1, .before = {1}}, {.id = -1, .before = {-1}}}}}};
  auto const loaded = load(file({a, b}));
  CHECK(has_route(loaded, {"1", 1, -1}, {"2", 1, -1}));
  CHECK_FALSE(has_route(loaded, {"2", 1, -1}, {"1", 1, -1}));
  CHECK(has_route(loaded, {"2", 1, 1}, {"1", 1, 1}));
  CHECK_FALSE(has_route(loaded, {"1", 1, 1}, {"2", 1, 1}));
  for (auto const& lane : loaded.map->lanes()) CHECK(lane.successors.size() + lane.predecessors.size() == 1);
}

TEST_CASE("road ids above 1000, and ids that are no numbers, are ids like any other") {
  for (std::string const id : {"1001", "4294967296", "99999999999999999999", "main street/7", "-5"}) {
    // what leads into it must not get lost, either
    Road a{.before = to_end(id), .sections = {{.lanes = {{.before = {-1}}}}}};
    Road b{.id = id, .x = -100, .behind = to_start("1"), .sections = {{.lanes = {{.behind = {-1}}}}}};
    auto const loaded = load(file({a, b}));
    CHECK(loaded.diagnostics.empty());
    CHECK(has_route(loaded, {id, 1, -1}, {"1", 99, -1}));
  }
}

TEST_CASE("a road without successor keeps its predecessor") {
  Road a;
  Road b{.id = "2", .x = 100, .before = to_end("1"), .sections = {{.lanes = {{.before = {-1}}}}}};
  auto const loaded = load(file({a, b}));
  CHECK(leads(loaded, {"1", 1, -1}, {"2", 1, -1}));
}

TEST_CASE("several sections of one road are linked to each other, and only the last one to the next road") {
  Road a{.behind = to_start("2"),
         .sections = {{0, {{.id = -1, .behind = {-1}}}},
                      {30, {{.id = -1, .before = {-1}, .behind = {-2}}}},
                      {60, {{.id = -1}, {.id = -2, .before = {-1}, .behind = {-1}}}}}};
  Road b;
  a.sections[2].lanes[0].width = 0.5;
  a.sections[2].lanes[0].type = "shoulder";
  b.id = "2";
  b.x = 100;
  b.before = to_end("1");
  b.lane_offset = "<laneOffset s=\"0\" a=\"-0.5\" b=\"0\" c=\"0\" d=\"0\"/>";
  auto const loaded = load(file({a, b}));
  CHECK(leads(loaded, {"1", 10, -1}, {"1", 40, -1}));
  CHECK(leads(loaded, {"1", 40, -1}, {"1", 70, -2}));
  CHECK(leads(loaded, {"1", 70, -2}, {"2", 10, -1}));
  CHECK(lane_at(loaded, {"1", 10, -1}).successors.size() == 1);
  CHECK(lane_at(loaded, {"1", 40, -1}).successors.size() == 1);
  CHECK(has_route(loaded, {"1", 1, -1}, {"2", 99, -1}));
}

// There no corridor at all comes of road ids: its search never says that it has found one.
TEST_CASE("a corridor follows from two roads' ids, in either direction") {
  Road a{.behind = to_start("2"), .sections = {{.lanes = {{.id = 1, .behind = {1}}, {.id = -1, .behind = {-1}}}}}};
  Road b{.id = "2",
         .x = 100,
         .before = to_end("1"),
         .sections = {{.lanes = {{.id = 1, .before = {1}}, {.id = -1, .before = {-1}}}}}};
  auto const loaded = load(file({a, b}));
  auto const& map = *loaded.map;
  using Names = std::vector<std::string>;
  for (bool const forward : {true, false}) {
    auto const names = forward ? Names{"1", "2"} : Names{"2", "1"};
    auto const direction = forward ? RoadDirection::forward : RoadDirection::backward;
    auto const road = build_road_corridor(map, names, direction);
    REQUIRE(road != nullptr);
    REQUIRE(road->corridors.size() == 1);
    auto const& corridor = road->corridors[road->main];
    int const number = forward ? -1 : 1;
    REQUIRE(corridor.pieces.size() == 2);
    CHECK(corridor.pieces[0].lane == map.find_lane(names[0], 50, number));
    CHECK(corridor.pieces[1].lane == map.find_lane(names[1], 50, number));
    CHECK(corridor.length() == doctest::Approx(200));
    auto const pose = corridor.center.pose(150);
    CHECK(pose.x == doctest::Approx(forward ? 150 : 50));
    CHECK(pose.y == doctest::Approx(number * 1.75));
    CHECK(corridor.reaches_destination);
    // The same roads, against their traffic or in the other order, are no way.
    auto const other = forward ? RoadDirection::backward : RoadDirection::forward;
    CHECK_THROWS_AS((void)build_road_corridor(map, names, other), cambium::MapError);
  }
}

TEST_CASE("the lane offset moves all lanes the same way, by every record, to the side that the specification says") {
  Road road{.sections = {{.lanes = {{.id = 2}, {.id = 1}, {.id = -1}, {.id = -2}}}}};
  road.lane_offset =
      "<laneOffset s=\"0\" a=\"0.5\" b=\"0\" c=\"0\" d=\"0\"/>"
      "<laneOffset s=\"50\" a=\"0.5\" b=\"-0.05\" c=\"0\" d=\"0\"/>";
  auto const loaded = load(file({road}));
  for (auto const& [s, offset] : {std::pair(20.0, 0.5), std::pair(90.0, -1.5)})
    for (int const lane : {2, 1, -1, -2}) {
      double const y = offset + (lane > 0 ? lane - 0.5 : lane + 0.5) * 3.5;
      auto const& path = lane_at(loaded, {"1", s, lane}).path;
      CHECK(std::abs(path.project({s, y}).lateral) < 1e-6);
      // There the first record alone widens lanes 1 and -1: borders of the right move the wrong way, by 1 m.
      auto const& outer = lane_at(loaded, {"1", s, lane}).right;  // in travel direction
      double const theirs = lane * 3.5 + std::copysign(0.5, lane);
      CHECK(std::abs(outer.project({s, offset + lane * 3.5}).lateral) < 1e-2);
      if (lane < 0 || s > 50.0) CHECK(std::abs(outer.project({s, theirs}).lateral) > 0.9);
      auto const& left = lane > 0 ? lane_at(loaded, {"1", s, lane}).right : lane_at(loaded, {"1", s, lane}).left;
      CHECK(std::abs(left.project({s, y + 1.75}).lateral) < 1e-2);  // to the left along the road
    }
}

TEST_CASE("a road without lanes is a finding, and the rest is read") {
  Road a;
  Road b{.id = "2", .y = 50};
  std::string text = file({a, b});
  auto const begin = text.find("<lanes>");
  auto const laneless = load(text.erase(begin, text.find("</lanes>") + 8 - begin));
  CHECK(laneless.map->roads().size() == 1);
  CHECK(count(laneless, Severity::warning, "no lane section") == 1);
}

TEST_CASE("a lane link to a lane that is not there costs that link only") {
  Road a{.behind = to_start("2"), .sections = {{.lanes = {{.id = -1, .behind = {-1}}, {.id = -2, .behind = {-7}}}}}};
  Road b{.id = "2", .x = 100, .before = to_end("1")};
  auto const loaded = load(file({a, b}));
  CHECK(count(loaded, Severity::warning, "it names lane -7 of road 2, which does not exist") == 1);
  CHECK(leads(loaded, {"1", 1, -1}, {"2", 1, -1}));
}
