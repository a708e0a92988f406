#include "cambium/map/lanes/lane_network.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "lanes_by_hand.hpp"
#include "road_text.hpp"

namespace {

using namespace road_text;
using cambium::MapOptions;
using cambium::Severity;
using cambium::map::check_lane_network;
using cambium::map::LaneType;
using cambium::map::NetworkFault;
using cambium::map::NetworkFinding;
using cambium::map::RoadDirection;

int faults(std::vector<NetworkFinding> const& findings, NetworkFault fault) {
  return static_cast<int>(
      std::count_if(findings.begin(), findings.end(), [fault](auto const& f) { return f.fault == fault; }));
}

NetworkFinding first(std::vector<NetworkFinding> const& findings, NetworkFault fault) {
  for (auto const& f : findings)
    if (f.fault == fault) return f;
  FAIL("there is no finding " << to_string(fault));
  return {};
}

/// Two roads of one lane, the second one at `x`, `y`; `linked` by both sides.
std::string two_roads(double x, double y, double heading, bool linked) {
  Road a;
  Road b{.id = "2", .x = x, .y = y, .heading = heading};
  if (linked) {
    a.behind = to_start("2");
    b.before = to_end("1");
    a.sections[0].lanes[0].behind = {-1};
    b.sections[0].lanes[0].before = {-1};
  }
  return file({a, b});
}

}  // namespace

TEST_CASE("lanes made in code are checked: links from one side, to nowhere, gaps, kinks, ends") {
  std::vector<by_hand::Lane> lanes;
  auto const a = by_hand::add_straight(lanes, {0, 0, 0}, 50), b = by_hand::add_straight(lanes, {50.02, 0, 0}, 50),
             c = by_hand::add_straight(lanes, {100.02, 0, 0.3}, 50),
             d = by_hand::add_straight(lanes, {0, 50, 0}, 50, 1.0),
             e = by_hand::add_straight(lanes, {50, 50, 0}, 50, 1.5);
  by_hand::link(lanes, a, b);
  by_hand::link(lanes, b, c);
  lanes[index_of(d)].successors.push_back(e);
  lanes[index_of(e)].successors.push_back(static_cast<cambium::LaneId>(99));
  auto const findings = check_lane_network(lanes);
  CHECK(faults(findings, NetworkFault::gap) == 1);
  CHECK(first(findings, NetworkFault::gap).lane == a);
  CHECK(first(findings, NetworkFault::gap).other == b);
  CHECK(first(findings, NetworkFault::gap).size == doctest::Approx(0.02));
  CHECK(first(findings, NetworkFault::kink).lane == b);
  CHECK(first(findings, NetworkFault::kink).size == doctest::Approx(0.3));
  CHECK(first(findings, NetworkFault::one_sided) == NetworkFinding{NetworkFault::one_sided, d, e, 0.0});
  CHECK(first(findings, NetworkFault::dangling).lane == e);
  CHECK(first(findings, NetworkFault::border_step).lane == d);
  CHECK(first(findings, NetworkFault::border_step).size == doctest::Approx(0.5));
  CHECK(faults(findings, NetworkFault::dead_end) == 1);
  CHECK(first(findings, NetworkFault::dead_end).lane == c);
  CHECK(faults(findings, NetworkFault::no_way_in) == 3);  // a, d and e, which d does not know as its predecessor
  CHECK(faults(findings, NetworkFault::possible_link) == 0);
}

TEST_CASE("a possible link is the nearest begin within reach, as a search over all pairs finds it") {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    by_hand::Numbers random{seed};
    std::vector<by_hand::Lane> lanes;
    for (int i = 0; i < 60; ++i) by_hand::add_straight(lanes, {random(0, 6), random(0, 6), random(-0.3, 0.3)}, 1.0);
    auto const findings = check_lane_network(lanes);
    for (auto const& lane : lanes) {
      NetworkFinding expected{NetworkFault::dead_end, lane.id};
      double best = 0.5;
      auto const end = lane.path.end_pose();
      for (auto const& other : lanes) {
        auto const begin = other.path.pose(0.0);
        double const apart = (begin.position() - end.position()).norm();
        if (other.id == lane.id || std::abs(begin.heading - end.heading) > 0.2 || apart >= best) continue;
        best = apart;
        expected = {NetworkFault::possible_link, lane.id, other.id, apart};
      }
      found += expected.fault == NetworkFault::possible_link;
      CHECK(std::count(findings.begin(), findings.end(), expected) == 1);
    }
  }
  CHECK(found > 100);
}

TEST_CASE("a missing link is reported; asked to, the map joins the lanes") {
  for (double const x : {100.0, 100.3, 100.7}) {
    for (double const heading : {0.0, 0.3}) {
      CAPTURE(x);
      CAPTURE(heading);
      std::string const text = two_roads(x, 0, heading, false);
      bool const meets = x < 100.5 && heading < 0.2;
      auto const off = load(text);
      CHECK(count(off, Severity::warning, "is the link missing?") == (meets ? 1 : 0));
      CHECK_FALSE(leads(off, {"1", 50, -1}, {"2", 50, -1}));
      MapOptions options;
      options.infer_links = true;
      auto const on = load(text, options);
      CHECK(count(on, Severity::info, "the two were joined") == (meets ? 1 : 0));
      CHECK(leads(on, {"1", 50, -1}, {"2", 50, -1}) == meets);
      CHECK(on.map->shortest_route(on.map->find_lane("1", 1, -1), on.map->find_lane("2", 1, -1)).has_value() == meets);
    }
  }
}

TEST_CASE("no link is inferred where the road's link leads elsewhere, or the lane runs the other way") {
  MapOptions options;
  options.infer_links = true;
  Road a{.behind = to_start("3"), .sections = {{.lanes = {{.behind = {}}}}}};
  Road b{.id = "2", .x = 100};
  Road c{.id = "3", .x = 100};
  auto const elsewhere = load(file({a, b, c}), options);
  CHECK_FALSE(leads(elsewhere, {"1", 1, -1}, {"2", 1, -1}));
  CHECK(leads(elsewhere, {"1", 1, -1}, {"3", 1, -1}));
  a.behind = to_junction("7");
  CHECK_FALSE(leads(load(file({a, b}, junction("7", "")), options), {"1", 1, -1}, {"2", 1, -1}));
  b.junction = "7";
  CHECK(leads(load(file({a, b}, junction("7", "")), options), {"1", 1, -1}, {"2", 1, -1}));
  a.behind = b.junction = "";
  b.rule = "LHT";
  CHECK_FALSE(leads(load(file({a, b}), options), {"1", 1, -1}, {"2", 1, -1}));
}

TEST_CASE("joined lanes that do not meet are reported with their distance, those that meet are not") {
  CHECK(load(two_roads(100, 0, 0, true)).diagnostics.empty());
  CHECK(load(two_roads(100, 0.009, 0, true)).diagnostics.empty());
  auto const gap = load(two_roads(100, 0.25, 0, true));
  CHECK(count(gap, Severity::warning, "continues 0.25 m away from where it ends") == 1);
  CHECK(leads(gap, {"1", 1, -1}, {"2", 1, -1}));
  auto const kink = load(two_roads(100, 0, 0.15, true));
  CHECK(kink.diagnostics.size() == 1);
  CHECK(count(kink, Severity::warning, "m away from where it ends, 0.15 rad off its direction; the link was kept") ==
        1);
}

TEST_CASE("lanes that meet at an angle are an info; nobody can follow a sharp one, which is a warning") {
  for (std::string const angle : {"0.15", "0.8", "3.1"}) {
    std::string const middle = "<laneOffset s=\"0\" a=\"1.75\" b=\"0\" c=\"0\" d=\"0\"/>";
    Road a{.behind = to_start("2"), .sections = {{.lanes = {{.behind = {-1}}}}}, .lane_offset = middle};
    Road b{.id = "2",
           .x = 100,
           .heading = std::stod(angle),
           .before = to_end("1"),
           .sections = {{.lanes = {{.before = {-1}}}}},
           .lane_offset = middle};
    auto const loaded = load(file({a, b}));
    CHECK(leads(loaded, {"1", 1, -1}, {"2", 1, -1}));
    REQUIRE(loaded.diagnostics.size() == 1);
    CAPTURE(to_string(loaded.diagnostics[0]));
    CHECK(count(loaded, std::stod(angle) < 0.5 ? Severity::info : Severity::warning,
                "continues " + angle + " rad off its direction; the link was kept") == 1);
  }
}

TEST_CASE("reference lines that do not meet are no fault where the lanes do") {
  Road a{.behind = to_start("2"), .sections = {{.lanes = {{.behind = {-1}}}}}};
  Road b{.id = "2",
         .x = 100,
         .y = 3,
         .before = to_end("1"),
         .sections = {{.lanes = {{.before = {-1}}}}},
         .lane_offset = "<laneOffset s=\"0\" a=\"-3\" b=\"0\" c=\"0\" d=\"0\"/>"};
  CHECK(load(file({a, b})).diagnostics.empty());
}

TEST_CASE("many gaps between two roads are one finding") {
  Road a{.behind = to_start("2")};
  Road b{.id = "2", .x = 100.1, .before = to_end("1")};
  a.sections[0].lanes.clear();
  for (int id = -1; id >= -4; --id) a.sections[0].lanes.push_back({.id = id, .behind = {id}});
  b.sections[0].lanes.clear();
  for (int id = -1; id >= -4; --id) b.sections[0].lanes.push_back({.id = id, .before = {id}});
  auto const loaded = load(file({a, b}));
  CHECK(loaded.diagnostics.size() == 1);
  CHECK(count(loaded, Severity::warning, "(and 3 more such)") == 1);
}

TEST_CASE("a link that only one side names is entered once, and reported if the other side names another") {
  Road a{.behind = to_start("2"), .sections = {{.lanes = {{.id = -1, .behind = {-1}}, {.id = -2, .behind = {-2}}}}}};
  Road b{.id = "2", .x = 100, .before = to_end("1"), .sections = a.sections};
  b.sections[0].lanes[0].behind = b.sections[0].lanes[1].behind = {};
  auto const one_sided = load(file({a, b}));  // the lanes of road 2 name nothing
  CHECK(one_sided.diagnostics.size() == 1);
  CHECK(count(one_sided, Severity::info, "which names none back (and 1 more such); the lanes were joined") == 1);
  CHECK(lane_at(one_sided, {"1", 1, -1}).successors.size() == 1);
  b.sections[0].lanes[0].before = {-2};
  auto const other = load(file({a, b}));
  CHECK(count(other, Severity::info, "lane -1 of section 0 names lane -1 of road 2, which names lane -2") == 1);
  CHECK(leads(other, {"1", 1, -1}, {"2", 1, -1}));
  CHECK(leads(other, {"1", 1, -2}, {"2", 1, -1}));
  b.before = to_start("1");
  b.sections[0].lanes[0].before = {};
  auto const road_link = load(file({a, b}));
  CHECK(count(road_link, Severity::warning, "names the start of road 2, which names another place") == 1);
  b.before.clear();
  CHECK(count(load(file({a, b})), Severity::warning, "which names nothing there") == 1);
}

TEST_CASE("a lane that ends although its own goes on behind the road's link is reported") {
  Road a{.behind = to_start("2")};
  // too far for a possible link
  Road b{.id = "2", .x = 101, .before = to_end("1")};
  auto const loaded = load(file({a, b}));
  CHECK(count(loaded, Severity::warning, "it ends here, but lane -1 of road 2 continues from there") == 1);
  b.sections[0].lanes[0].id = -2;
  b.sections[0].lanes.insert(b.sections[0].lanes.begin(), {.id = -1, .type = "sidewalk"});
  CHECK(count(load(file({a, b})), Severity::warning) == 0);
}

TEST_CASE("links lead through sections that have no length") {
  Road road{.sections = {{0, {{.id = -1, .behind = {-1}}}},
                         {50, {{.id = -1, .before = {-1}, .behind = {-2}}}},
                         {50 + 2e-7, {{.id = -1, .type = "shoulder"}, {.id = -2, .before = {-1}}}}}};
  auto const loaded = load(file({road}));
  CHECK(loaded.map->lanes().size() == 3);
  CHECK(leads(loaded, {"1", 10, -1}, {"1", 90, -2}));
  CHECK(loaded.diagnostics.size() == 2);
  CHECK(count(loaded, Severity::warning, "away from where it ends") == 1);
  CHECK(count(loaded, Severity::info, "it has no length") == 1);
  // At the end of a road, to the next road.
  Road next{.id = "2", .x = 100, .before = to_end("1")};
  road.behind = to_start("2");
  road.sections = {{0, {{.id = -1, .behind = {-1}}}}, {100 - 2e-7, {{.id = -1, .before = {-1}, .behind = {-1}}}}};
  CHECK(leads(load(file({road, next})), {"1", 10, -1}, {"2", 10, -1}));
}

TEST_CASE("a road that closes upon itself can be driven round and round") {
  Road ring{.length = 2 * cambium::geometry::pi * 50,
            .before = to_end("1"),
            .behind = to_start("1"),
            .sections = {{.lanes = {{.id = -1, .before = {-1}, .behind = {-1}}}}},
            .curvature = 0.02};
  auto const loaded = load(file({ring}));
  CHECK(loaded.diagnostics.empty());
  REQUIRE(loaded.map->lanes().size() == 2);
  CHECK(leads(loaded, {"1", 10, -1}, {"1", 300, -1}));
  CHECK(leads(loaded, {"1", 300, -1}, {"1", 10, -1}));
  CHECK(faults(check_lane_network(*loaded.map), NetworkFault::gap) == 0);
}

TEST_CASE("a lane for both directions is two lanes, oncoming to each other, and linked each in its own") {
  for (bool const by_type : {false, true}) {
    Road a{.behind = to_start("2"), .sections = {{.lanes = {{.id = -1, .behind = {-1}}, {.id = -2, .behind = {-2}}}}}};
    Road b;
    (by_type ? a.sections[0].lanes[0].type : a.sections[0].lanes[0].direction) = by_type ? "bidirectional" : "both";
    b = a;
    b.id = "2";
    b.x = 100;
    b.before = to_end("1");
    b.behind.clear();
    for (auto& lane : b.sections[0].lanes) lane.before = std::exchange(lane.behind, {});
    auto const loaded = load(file({a, b}));
    auto const& map = *loaded.map;
    CHECK(loaded.diagnostics.empty());
    REQUIRE(map.lanes().size() == 6);
    auto const& there = lane_at(loaded, {"1", 50, -1});
    REQUIRE(is_valid(there.opposite));
    auto const& back = map.lane(there.opposite);
    CHECK(map.road(there.road).sections[0].lanes[0].opposite == back.id);
    CHECK(back.opposite == there.id);
    CHECK(there.along_road);
    CHECK_FALSE(back.along_road);
    CHECK(back.path.pose(0).x == doctest::Approx(100));
    CHECK(std::abs(back.path.pose(0).heading) == doctest::Approx(cambium::geometry::pi));
    CHECK(leads(loaded, {"1", 50, -1}, {"2", 50, -1}));
    auto const& back_behind = map.lane(lane_at(loaded, {"2", 50, -1}).opposite);
    CHECK(back_behind.successors == std::vector<cambium::LaneId>{back.id});
    CHECK(back.successors.empty());
    CHECK(there.successors.size() == 1);
    for (auto const& lane : map.lanes()) {
      CHECK(lane.overlaps.empty());
      CHECK_FALSE(is_valid(lane.left_neighbor));
      CHECK_FALSE(is_valid(lane.right_neighbor));
    }
    CHECK(map.nearest_lane({50, -1.75, 0.0})->lane == there.id);
    CHECK(map.nearest_lane({50, -1.75, cambium::geometry::pi})->lane == back.id);
    CHECK(map.find_lane("1", 50, -1) == there.id);
    CHECK(map.find_lane("1", 50, -1, RoadDirection::forward) == there.id);
    CHECK(map.find_lane("1", 50, -1, RoadDirection::backward) == back.id);
    CHECK(map.describe(there.id) == "road 1, section 0, lane -1, forward");
    CHECK(map.describe(back.id) == "road 1, section 0, lane -1, backward");
    CHECK(is_valid(map.find_lane("1", 50, -2, RoadDirection::forward)));
    CHECK_THROWS_WITH_AS((void)map.find_lane("1", 50, -2, RoadDirection::backward),
                         doctest::Contains("road 1, section 0, lane -2: it is driven the other way only"),
                         cambium::MapError);
  }
}

TEST_CASE("a direct junction joins its roads without a connecting road") {
  Road main{.behind = to_junction("7"), .sections = {{.lanes = {{.id = -1}, {.id = -2}}}}};
  Road on{.id = "2", .x = 100, .before = to_end("1")};
  Road off{.id = "3", .x = 100, .y = -3.5, .before = to_end("1")};
  auto const text = file({main, on, off}, junction("7",
                                                   connection("1", "2", "start", -1, -1, "linkedRoad") +
                                                       connection("1", "3", "start", -2, -1, "linkedRoad"),
                                                   "direct"));
  auto const loaded = load(text);
  CHECK(loaded.diagnostics.empty());
  CHECK(leads(loaded, {"1", 1, -1}, {"2", 1, -1}));
  CHECK(leads(loaded, {"1", 1, -2}, {"3", 1, -1}));
  CHECK_FALSE(leads(loaded, {"1", 1, -1}, {"3", 1, -1}));
}

TEST_CASE("a connecting road of a virtual junction leaves the main road in its middle, which goes on") {
  Road main{.sections = {{.lanes = {{.id = 1}, {.id = -1}}}}};
  Road side;
  main.sections[0].lanes[1].widths = "<width sOffset=\"0\" a=\"3\" b=\"0.01\" c=\"0\" d=\"0\"/>";
  side.id = "2";
  side.x = 40;
  side.length = 30;
  side.junction = "7";
  side.curvature = -0.02;
  side.before = "elementType=\"road\" elementId=\"1\" elementS=\"40\" elementDir=\"+\"";
  side.sections[0].lanes = {{.id = -1, .before = {-1}, .width = 3.4}};
  for (bool const in_connection : {false, true}) {
    if (in_connection) side.sections[0].lanes[0].before = {};
    auto const text = file({main, side}, junction("7", connection("1", "2", "start", -1, -1), "virtual"));
    auto const loaded = load(text);
    CHECK(count(loaded, Severity::warning) == 0);
    CHECK(leads(loaded, {"1", 10, -1}, {"2", 10, -1}));
    CHECK(leads(loaded, {"1", 10, -1}, {"1", 90, -1}));  // not interrupted
    CHECK(leads(loaded, {"1", 90, 1}, {"1", 10, 1}));
    CHECK_FALSE(leads(loaded, {"1", 90, -1}, {"2", 10, -1}));
    CHECK(lane_at(loaded, {"1", 10, -1}).length() == doctest::Approx(40).epsilon(1e-4));
    auto const& behind = lane_at(loaded, {"1", 90, -1});
    CHECK(behind.widths.front().left + behind.widths.front().right == doctest::Approx(3.4));
    CHECK(behind.widths.back().left + behind.widths.back().right == doctest::Approx(4.0));
    for (auto const& f : check_lane_network(*loaded.map)) CHECK(f.fault != NetworkFault::kink);
  }
  side.before.clear();
  auto const lost = load(file({main, side}, junction("7", connection("1", "2", "start", -1, -1), "virtual")));
  CHECK(count(lost, Severity::warning, "gives no elementS") == 1);
}

TEST_CASE("a lane that is linked to what its neighbour goes on as, beside its own end, swings over") {
  Road road;
  std::string const taper =
      "<width sOffset=\"0\" a=\"3.5\" b=\"0\" c=\"0\" d=\"0\"/>"
      "<width sOffset=\"10\" a=\"3.5\" b=\"-0.0875\" c=\"0\" d=\"0\"/>";
  road.sections = {{0, {{.id = -1, .behind = {-1}}, {.id = -2, .behind = {-1}, .widths = taper}}},
                   {50, {{.id = -1, .before = {-1}}}}};
  auto const loaded = load(file({road}));
  auto const& lane = lane_at(loaded, {"1", 10, -2});
  CHECK(leads(loaded, {"1", 10, -2}, {"1", 60, -1}));
  CHECK(lane.merges_into == lane_at(loaded, {"1", 10, -1}).id);
  CHECK(faults(check_lane_network(*loaded.map), NetworkFault::gap) == 0);
}
