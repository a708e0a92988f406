#include "cambium/map/building/map_builder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "cambium/map/building/build_map.hpp"
#include "cambium/map/opendrive.hpp"
#include "cambium/map/opendrive/check.hpp"
#include "cambium/map/opendrive/writer.hpp"
#include "../support/allocations.hpp"
#include "../support/error_of.hpp"
#include "lanes_by_hand.hpp"

using namespace by_hand;
using geometry::pi;
using opendrive::ContactPoint;

namespace {

constexpr auto start = ContactPoint::start;
constexpr auto end = ContactPoint::end;

RoadPlan straight(std::string id, Pose const& from, double length, std::size_t left, std::size_t right) {
  return {.id = std::move(id),
          .line = lay_from(from, {{length}}),
          .sections = {{.left = equal_lanes(left), .right = equal_lanes(right)}}};
}

std::shared_ptr<Map const> checked(MapBuilder const& builder) {
  std::vector<Diagnostic> diagnostics;
  auto map = builder.build({}, &diagnostics);
  for (auto const& d : diagnostics) FAIL_CHECK(to_string(d));
  return map;
}

LaneId lane_at(Map const& map, char const* road, int number) { return map.find_lane(road, 0.5, number); }

bool leads(Map const& map, LaneId from, LaneId to) {
  auto const& next = map.lane(from).successors;
  auto const& before = map.lane(to).predecessors;
  bool const there = std::count(next.begin(), next.end(), to) == 1;
  CHECK(there == (std::count(before.begin(), before.end(), from) == 1));
  return there;
}

/// Checks that `run` throws a `MapError` that says `words`; "no error": that it throws none.
void check_error(auto const& run, std::string const& words) {
  auto const what = support::error_of(run);
  CHECK_MESSAGE(what.find(words) != std::string::npos, what);
}

/// Lanes in a form that does not depend on ids, in order: for comparing maps. `mirror` -1: at the x axis, with left
/// and right swapped.
std::vector<std::vector<double>> contents(Map const& map, double mirror = 1.0) {
  std::vector<std::vector<double>> lanes;
  for (auto const& lane : map.lanes()) {
    auto const name = std::stod(map.road(lane.road).name);
    auto& row = lanes.emplace_back(std::vector<double>{name, double(lane.section), mirror * lane.number});
    for (auto const& p : {lane.path.pose(0.0), lane.path.pose(0.5 * lane.length()), lane.path.pose(lane.length())}) {
      row.push_back(std::round(1e6 * p.x));
      row.push_back(std::round(1e6 * mirror * p.y) + 0.0);
    }
    std::vector<double> next;
    for (auto const id : lane.successors)
      next.push_back(std::stod(map.road(map.lane(id).road).name) * 100 + mirror * map.lane(id).number);
    std::sort(next.begin(), next.end());
    row.insert(row.end(), next.begin(), next.end());
  }
  std::sort(lanes.begin(), lanes.end());
  return lanes;
}

/// A crossing of four arms with all turns; `mirror` -1: of left-hand traffic, mirrored at the x axis.
MapBuilder crossing(int mirror) {
  MapBuilder builder;
  builder.add_junction("100");
  for (int i = 0; i < 4; ++i) {
    double const angle = mirror * 0.5 * pi * i;
    auto const at = geometry::to_map({0, 0, angle}, {25.0, 0.0});
    auto arm = straight(std::to_string(i + 1), {}, 1.0, 2, 2);
    arm.line = lay_to({at.x(), at.y(), angle + pi}, {{50.0}});
    if (mirror < 0) arm.rule = opendrive::DrivingSide::left_hand;
    builder.add_road(arm);
  }
  for (int i = 0; i < 4; ++i) {
    auto const arm = [i](int further) { return RoadEnd{std::to_string((i + further) % 4 + 1), end}; };
    auto const id = [i](int turn) { return std::to_string(200 + 10 * i + turn); };
    builder.add_turn("100", arm(0), arm(2), {.id = id(0)});
    builder.add_turn("100", arm(0), arm(1), {.id = id(1), .lanes = {{-2 * mirror, 2 * mirror}}});
    builder.add_turn("100", arm(0), arm(3), {.id = id(2), .lanes = {{-mirror, mirror}}});
  }
  return builder;
}

}  // namespace

TEST_CASE("a road in three lines") {
  MapBuilder builder;
  builder.add_road({.id = "1", .line = lay_from({}, {{500.0}}), .sections = {{.right = equal_lanes(2)}}});
  auto const map = checked(builder);
  REQUIRE(map->lanes().size() == 2);
  CHECK(map->lanes()[0].path.pose(100.0).y == doctest::Approx(-1.75));
  CHECK(map->lanes()[1].left_neighbor == map->lanes()[0].id);
  CHECK(builder.road("1").lane_sections[0].lanes[1].road_marks[0].lane_change == opendrive::LaneChangePermission::both);
}

TEST_CASE("ids are numbers of their own where none are given") {
  MapBuilder builder;
  auto const a = builder.add_road(straight("", {}, 10, 0, 1)), b = builder.add_road(straight("", {0, 50, 0}, 10, 0, 1));
  auto const junction = builder.add_junction();
  CHECK(a != b);
  CHECK(junction != a);
  CHECK(junction != b);
  CHECK(builder.build()->lanes().size() == 2);
}

TEST_CASE("lanes taper, open and end from section to section") {
  MapBuilder builder;
  auto road = straight("1", {}, 300, 0, 2);
  road.sections.push_back({.s = 100, .right = {{}, {.end_width = 0.0, .next = 0}}});
  road.sections.push_back({.s = 200, .right = {{.next = -2}}});
  road.sections.push_back({.s = 250, .right = {{.width = 0.0, .end_width = 3.0}, {}}});
  builder.add_road(road);
  auto const map = checked(builder);
  auto const lane = [&map](double s, int number) { return map->find_lane("1", s, number); };
  CHECK(leads(*map, lane(50, -2), lane(150, -2)));
  CHECK(map->lane(lane(150, -2)).merges_into == lane(150, -1));
  CHECK(leads(*map, lane(220, -1), lane(260, -2)));
  CHECK(map->lane(lane(260, -1)).predecessors.empty());
  auto const& opening = map->lane(lane(260, -1));
  CHECK(opening.widths.front().left == doctest::Approx(0.0));
  CHECK(opening.widths.back().left == doctest::Approx(1.5));
}

TEST_CASE("two roads are joined whichever of their ends meet") {
  for (auto const end_a : {start, end})
    for (auto const end_b : {start, end}) {
      MapBuilder builder;
      // Both touch the origin; where it is the road's end, the road is laid out to it.
      auto a = straight("1", {}, 1, 2, 3), b = straight("2", {}, 1, 2, 3);
      a.line = end_a == end ? lay_to({0, 0, 0}, {{100.0}}) : lay_from({0, 0, pi}, {{100.0}});
      b.line = end_b == start ? lay_from({0, 0, 0}, {{100.0}}) : lay_to({0, 0, pi}, {{100.0}});
      builder.add_road(a);
      builder.add_road(b);
      builder.connect({"1", end_a}, {"2", end_b});
      auto const map = checked(builder);
      int joined = 0;
      for (auto const& lane : map->lanes()) {
        if (is_valid(lane.merges_into)) continue;  // it ends there
        for (auto const id : lane.successors) {
          auto const& next = map->lane(id);
          CHECK((lane.path.samples().back().position() - next.path.samples().front().position()).norm() < 1e-9);
          CHECK(next.number == (end_a == end_b ? -lane.number : lane.number));
        }
        joined += static_cast<int>(lane.successors.size());
      }
      CHECK(joined == (end_a == end_b ? 4 : 5));
    }
}

TEST_CASE("forks and joints need only a connect for each branch, in any order") {
  std::vector<std::pair<char const*, char const*>> branches{{"1", "3"}, {"1", "4"}, {"2", "4"}};
  do {
    MapBuilder builder;
    for (auto const& [id, x] : {std::pair{"1", -50.0}, {"2", -50.0}, {"3", 0.0}, {"4", 0.0}})
      builder.add_road(straight(id, {x, 0, 0}, 50, 1, 1));
    for (auto const& [from, to] : branches) builder.connect({from, end}, {to, start});
    CHECK(builder.document().junctions.size() == 1);
    for (auto const& map : {checked(builder), parse_opendrive(write_opendrive(builder.document())).map}) {
      CHECK(leads(*map, lane_at(*map, "1", -1), lane_at(*map, "3", -1)));
      CHECK(leads(*map, lane_at(*map, "1", -1), lane_at(*map, "4", -1)));
      CHECK(leads(*map, lane_at(*map, "2", -1), lane_at(*map, "4", -1)));
      CHECK_FALSE(leads(*map, lane_at(*map, "2", -1), lane_at(*map, "3", -1)));
      CHECK(leads(*map, lane_at(*map, "4", 1), lane_at(*map, "2", 1)));
      CHECK(leads(*map, lane_at(*map, "3", 1), lane_at(*map, "1", 1)));
    }
  } while (std::next_permutation(branches.begin(), branches.end()));
}

TEST_CASE("a lane that forks: its two ways overlap, and routes lead along both") {
  MapBuilder builder;
  builder.add_road(straight("1", {}, 100, 0, 1));
  builder.add_road(straight("2", {100, 0, 0}, 100, 0, 1));
  auto third = straight("3", {}, 1, 0, 1);
  third.line = lay_from({100, 0, 0}, {{30.0, 0.0, -0.02}, {60.0, -0.02, -0.02}});
  builder.add_road(third);
  builder.connect({"1", end}, {"2", start});
  builder.connect({"1", end}, {"3", start});
  auto const map = checked(builder);
  for (auto const* to : {"2", "3"}) CHECK(map->shortest_route(lane_at(*map, "1", -1), lane_at(*map, to, -1)));
  auto const& overlaps = map->lane(lane_at(*map, "2", -1)).overlaps;
  REQUIRE(overlaps.size() == 1);
  CHECK(overlaps[0].kind == OverlapKind::split);
}

TEST_CASE("turns join lanes smoothly, with the widths of both") {
  MapBuilder builder;
  builder.add_junction("9");
  auto from = straight("1", {0, -60, 0.5 * pi}, 40, 0, 1), to = straight("2", {25, 3, 0.1}, 50, 0, 2);
  from.sections[0].right[0].width = 3.0;
  for (auto& lane : to.sections[0].right) lane.width = 4.0;
  builder.add_road(from);
  builder.add_road(to);
  auto const id = builder.add_turn("9", {"1", end}, {"2", start}, {.lanes = {{-1, -2}}, .speed_limit = 8.0});
  auto const map = checked(builder);
  auto const& turn = map->lane(lane_at(*map, id.c_str(), -1));
  CHECK(leads(*map, lane_at(*map, "1", -1), turn.id));
  CHECK(leads(*map, turn.id, lane_at(*map, "2", -2)));
  CHECK(turn.speed_limit_at(0.0) == 8.0);
  auto const& before = map->lane(lane_at(*map, "1", -1));
  auto const& behind = map->lane(lane_at(*map, "2", -2));
  for (auto border : {&Lane::left, &Lane::right, &Lane::path}) {
    auto const ends = [border](Lane const& lane) { return (lane.*border).samples(); };
    CHECK((ends(before).back().position() - ends(turn).front().position()).norm() < 1e-8);
    CHECK((ends(turn).back().position() - ends(behind).front().position()).norm() < 1e-8);
    CHECK(std::abs(geometry::angle_difference(ends(turn).back().heading, ends(behind).front().heading)) < 1e-6);
  }
}

TEST_CASE("a turn between ends that meet already says which ones, and nothing is added") {
  MapBuilder builder;
  builder.add_junction("9");
  builder.add_road(straight("1", {0, 0, 0}, 40, 0, 1));
  builder.add_road(straight("2", {40, 0, 0}, 40, 0, 1));
  CHECK_THROWS_WITH_AS(builder.add_turn("9", {"1", end}, {"2", start}),
                       doctest::Contains("turn from road 1 to road 2: its ends are less than a millimetre apart"),
                       MapError);
  CHECK(builder.document().roads.size() == 2);
}

TEST_CASE("a crossing of left-hand traffic is the mirror image of one of right-hand traffic") {
  auto const right = checked(crossing(1)), left = checked(crossing(-1));
  CHECK(right->lanes().size() == 32);
  CHECK(contents(*right) == contents(*left, -1.0));
  for (auto const& lane : left->lanes())
    for (auto const& other : left->lanes()) {
      if (!lane.predecessors.empty() || !other.successors.empty()) continue;
      CHECK(left->shortest_route(lane.id, other.id).has_value() == (lane.road != other.road));
    }
}

TEST_CASE("a built map equals the map of its written file") {
  auto builder = crossing(1);
  builder.add_road(straight("50", {300, 0, 1}, 40, 1, 2));
  auto const text = write_opendrive(builder.document());
  auto const loaded = parse_opendrive(text);
  CHECK(loaded.diagnostics.empty());
  CHECK(contents(*loaded.map) == contents(*checked(builder)));
}

TEST_CASE("a plan that cannot be built is refused with a sentence") {
  double const nan = std::numeric_limits<double>::quiet_NaN();
  MapBuilder builder;
  builder.add_road(straight("1", {}, 100, 1, 1));
  builder.add_road(straight("2", {101, 0, 0}, 100, 1, 1));
  builder.add_junction("9");
  check_error([&] { builder.connect({"1", end}, {"7", start}); }, "road 7: there is none of that id");
  check_error([&] { builder.connect({"1", end}, {"2", start}); }, "they do not meet: there are 1 m");
  check_error(
      [&] {
        builder.connect({"1", end}, {"2", start}, {{-1, -2}});
      },
      "road 2, start, lane -2: there is no such lane");
  check_error([&] { builder.add_turn("9", {"1", end}, {"2", start}, {.lanes = {{1, -1}}}); }, "the wrong way");
  CHECK_THROWS_AS(builder.connect({"1", ContactPoint::none}, {"2", start}), MapError);
  CHECK_THROWS_AS(builder.add_turn("8", {"1", end}, {"2", start}), MapError);
  CHECK_THROWS_AS((void)builder.lane_pose({"1", end}, 0), MapError);
  CHECK_THROWS_AS(builder.add_junction("9"), MapError);
  CHECK_THROWS_AS(builder.add_road(straight("1", {}, 10, 0, 1)), MapError);
  auto const refused = [&](auto const& change) {
    auto plan = straight("", {0, 99, 0}, 100, 0, 1);
    change(plan);
    CHECK_THROWS_AS(builder.add_road(plan), MapError);
  };
  refused([](RoadPlan& plan) { plan.line.clear(); });
  refused([](RoadPlan& plan) { plan.sections.clear(); });
  refused([](RoadPlan& plan) { plan.sections[0].s = 5; });
  refused([](RoadPlan& plan) { plan.sections.push_back({.s = 100}); });
  refused([](RoadPlan& plan) { plan.sections.push_back({}); });
  refused([](RoadPlan& plan) { plan.junction = "8"; });
  refused([nan](RoadPlan& plan) { plan.sections.push_back({.s = nan}); });
  refused([nan](RoadPlan& plan) { plan.speed_limit = nan; });
  refused([](RoadPlan& plan) { plan.speed_limit = -1.0; });
  refused([nan](RoadPlan& plan) { plan.lane_offset = {{0, nan, 0, 0, 0}}; });
  refused([nan](RoadPlan& plan) { plan.line[0].x = nan; });
  refused([nan](RoadPlan& plan) { plan.line[0].length = nan; });
  for (double const width : {nan, -1.0, 1e9, std::numeric_limits<double>::infinity()}) {
    refused([width](RoadPlan& plan) { plan.sections[0].right[0].width = width; });
    refused([width](RoadPlan& plan) { plan.sections[0].right[0].end_width = width; });
    refused([width](RoadPlan& plan) { plan.sections[0].right[0].widths = {{0, width, 0, 0, 0}}; });
  }
  refused([](RoadPlan& plan) {
    plan.sections[0].right[0].next = -7;
    plan.sections.push_back({.s = 50, .right = equal_lanes(1)});
  });
  CHECK(builder.document().roads.size() == 2);
  CHECK_THROWS_AS((void)MapBuilder().build(), MapError);
}

TEST_CASE("faults in a plan are named with their number") {
  auto const check = [](auto const& change, std::string const& words) {
    auto plan = straight("1", {}, 100, 0, 2);
    plan.line = lay_from({}, {{40.0}, {30.0, 0.01, 0.01}, {30.0}});
    change(plan);
    check_error([&] { MapBuilder().add_road(plan); }, words);
  };
  check([](RoadPlan&) {}, "no error");
  check([](RoadPlan& p) { p.line[0].s = 1.0; }, "geometry 0 is at s 1 m instead of 0 m");
  check([](RoadPlan& p) { p.line[2].s = 60.0; }, "geometry 2 is at s 60 m instead of 70 m");
  check([](RoadPlan& p) { p.line[1].y = 0.5; }, "geometry 1 begins 0.5 m and 0 rad from where");
  check([](RoadPlan& p) { p.line[1].heading = 0.25; }, "geometry 1 begins 0 m and 0.25 rad from where");
  check([](RoadPlan& p) { p.line[1].length = -30.0; }, "geometry 1 has no length");
  check([](RoadPlan& p) { p.line[2].x = NAN; }, "geometry 2: a coordinate lies beyond");
  check([](RoadPlan& p) { p.line[2].curvature_end = 1e9; }, "geometry 2: the curve turns by more than 100 rad");
  check([](RoadPlan& p) { p.line[0].kind = GeometryKind::cubic; }, "geometry 0: it is a cubic without its curve");
  auto const check_widths = [&](std::vector<CubicRecord> const& records, std::string const& words) {
    check([&](RoadPlan& p) { p.sections[0].right[1].widths = records; }, words);
  };
  check_widths({{0, 3, 0, 0, 0}, {50, 3, 0, 0, 0}, {70, 3, 0, 0, 0}}, "no error");
  check_widths({{0, 3, 0, 0, 0}, {50, 3, 0, 0, 0}, {20, 3, 0, 0, 0}},
               "lane -2, width record 2 is at s 20 m, not after the previous one, at 50 m");
  check_widths({{0, 3, 0, 0, 0}, {0, 4, 0, 0, 0}}, "width record 1 is at s 0 m, not after the previous one, at 0 m");
  check_widths({{-1, 3, 0, 0, 0}}, "width record 0 is at s -1 m, not after 0");
  check_widths({{0, 3, 0, 0, 0}, {50, NAN, 0, 0, 0}}, "width record 1 is not finite");
  check(
      [](RoadPlan& p) {
        p.lane_offset = {{30, 0, 0, 0, 0}, {10, 1, 0, 0, 0}};
      },
      "lane offset record 1 is at s 10 m, not after the previous one, at 30 m");
  check([](RoadPlan& p) { p.line.front().s = 0.004; }, "no error");  // rounded as in files
}

TEST_CASE("a map of nothing is refused with what to add, and no word about a file") {
  CHECK(support::error_of([] { (void)MapBuilder("mine").build(); }) ==
        "map 'mine': no road has been added to it; call MapBuilder::add_road before build");
  MapBuilder bare;
  bare.add_road({.id = "1", .line = lay_from({}, {{50.0}}), .sections = {{}}});
  auto const what = support::error_of([&] { (void)bare.build(); });
  CHECK_MESSAGE(what.find("the map has no lane with a length") < what.size(), what);
  CHECK_MESSAGE(what.find("file") == what.npos, what);
}

TEST_CASE("a call that fails changes nothing") {
  MapBuilder builder;
  for (auto const* id : {"8", "9"}) builder.add_junction(id);
  for (auto const& [id, x] : {std::pair{"1", 0.0}, {"2", 80.0}, {"3", 80.0}, {"4", 30.0}, {"5", 50.0}, {"6", 0.0}})
    builder.add_road(straight(id, {x, 0, 0}, 50, 0, 1));
  builder.add_turn("8", {"1", end}, {"3", start});
  builder.connect({"4", end}, {"2", start});
  auto const fails = [&builder](auto const& run, std::string const& why) {
    auto const before = builder.document();
    check_error(run, why);
    CHECK(builder.document() == before);
  };
  // Where the turn begins, where it ends, its id:
  fails([&] { builder.add_turn("9", {"1", end}, {"2", start}); }, "it is linked to another road or junction");
  fails([&] { builder.add_turn("9", {"6", end}, {"2", start}); }, "it is linked to another road or junction");
  fails([&] { builder.add_junction("-1"); }, "its id means none");
  fails([&] { builder.add_road({.id = " ", .line = {}, .sections = {}}); }, "its id means none");
  fails([&] { builder.add_turn("9", {"6", end}, {"3", start}, {.id = "5"}); }, "this id is already in use");
  fails([&] { builder.connect({"1", end}, {"5", start}); }, "it is linked to a junction already");
  // A link that cannot be dissolved, for a lane that is not there:
  builder.document().roads[3].lane_sections[0].lanes[1].successors = {-7};
  builder.add_road(straight("77", {80, 0, 0}, 50, 0, 1));
  fails([&] { builder.connect({"4", end}, {"77", start}); }, "road 2, start, lane -7: there is no such lane");
  // And all of it goes on as if nothing had been.
  CHECK(builder.add_turn("9", {"6", end}, {"77", start}, {.id = "10"}) == "10");
  CHECK(builder.document().roads.size() == 9);
}

TEST_CASE("a second connection changes nothing") {
  MapBuilder builder;
  builder.add_junction("9");
  for (auto const& [id, x] : {std::pair{"1", 0.0}, {"2", 50.0}, {"3", 50.0}, {"4", 100.0}, {"5", 170.0}})
    builder.add_road(straight(id, {x, 0, 0}, 50, 1, 2));
  auto const turn = builder.add_turn("9", {"4", end}, {"5", start}, {.lanes = {{-1, -1}}});
  auto const connect = [&](bool again) {
    for (auto const* to : {"2", "3"}) {
      builder.connect({"1", end}, {to, start}, {{-1, -1}, {1, 1}});
      if (again) builder.connect({to, start}, {"1", end}, {{-1, -1}, {-1, -1}});
    }
    builder.connect({"2", end}, {"4", start});
    if (again) builder.connect({"4", start}, {"2", end});
    if (again) builder.connect({"4", end}, {turn, start}, {{-1, -1}});
  };
  connect(false);
  auto const once = builder.document();
  CHECK(once.junctions.size() == 2);
  CHECK(once.junctions.back().connections.size() == 4);
  for (int i = 0; i < 2; ++i) connect(true);
  CHECK(builder.document() == once);
  builder.connect({"1", end}, {"2", start}, {{-2, -2}, {-2, -2}, {-1, -1}});  // lane -2 is new
  CHECK(builder.document().junctions.back().connections.size() == 5);
  CHECK(builder.document().junctions.back().connections.back().lane_links.size() == 1);
}

TEST_CASE("two thousand roads, joined and with turns, are made with about twice the allocations of half") {
  auto const make = [](MapBuilder& builder, int count) {
    auto const before = support::allocations();
    auto const name = [](int number) { return std::to_string(number); };
    for (int i = 0; i < count; ++i) builder.add_road(straight("", {10.0 * (i + i / 10), 0, 0}, 10, 1, 1));
    for (int i = 1; i < count; ++i) {
      if (i % 10 > 0) {
        builder.connect({name(i), end}, {name(i + 1), start});
        continue;
      }
      auto const junction = builder.add_junction("j" + name(i));
      builder.add_turn(junction, {name(i), end}, {name(i + 1), start}, {.id = "t" + junction});
    }
    return support::allocations() - before;
  };
  MapBuilder half, whole;
  auto const few = make(half, 1000), all = make(whole, 2000);
  CHECK(all <= 3 * few);  // 0 where they are not counted
  CHECK(whole.road("1999").predecessor->id == "1998");
  CHECK(whole.road("tj500").predecessor->id == "500");
  CHECK(whole.document().roads.size() == 2199);
  CHECK(whole.add_junction() == "2200");
  CHECK(whole.add_junction() == "2201");
}

TEST_CASE("road ends where no lane goes on as a lane of the other are not connected") {
  MapBuilder builder;
  builder.add_road(straight("1", {}, 50, 0, 1));
  builder.add_road(straight("2", {5000, 5000, 1}, 50, 0, 1));
  builder.add_road(straight("3", {50, 0, 0}, 50, 1, 1));
  auto const before = builder.document();
  auto const refuses = [&builder](RoadEnd const& a, RoadEnd const& b, std::string const& why) {
    check_error([&] { builder.connect(a, b); }, why);
  };
  refuses({"1", end}, {"2", end}, "no lane of one continues as a lane of the other");
  refuses({"1", end}, {"1", end}, "no lane of one continues as a lane of the other");
  refuses({"1", end}, {"2", start}, "they do not meet");
  refuses({"3", end}, {"3", end}, "they do not meet");
  CHECK(builder.document() == before);
  refuses({"1", end}, {"3", start}, "no error");
}

TEST_CASE("a link that only one of the roads' lanes names becomes a connection like any other") {
  for (bool const known_to_first : {true, false}) {
    CAPTURE(known_to_first);
    MapBuilder builder;
    builder.add_road(straight("1", {}, 50, 1, 1));
    for (auto const* id : {"2", "3"}) builder.add_road(straight(id, {50, 0, 0}, 50, 1, 1));
    builder.connect({"1", end}, {"2", start});
    for (auto& lane : builder.document().roads[known_to_first ? 1 : 0].lane_sections[0].lanes)
      (known_to_first ? lane.predecessors : lane.successors).clear();
    builder.connect({"1", end}, {"3", start});
    auto const map = checked(builder);
    for (auto const* id : {"2", "3"}) {
      CHECK(leads(*map, lane_at(*map, "1", -1), lane_at(*map, id, -1)));
      CHECK(leads(*map, lane_at(*map, id, 1), lane_at(*map, "1", 1)));
    }
  }
}

TEST_CASE("a link that another road contradicts is not dissolved") {
  MapBuilder builder;
  builder.add_road(straight("1", {}, 50, 0, 1));
  for (auto const* id : {"2", "3"}) builder.add_road(straight(id, {50, 0, 0}, 50, 0, 1));
  builder.connect({"1", end}, {"2", start});
  builder.document().roads[1].predecessor->id = "3";
  auto const before = builder.document();
  check_error([&] { builder.connect({"1", end}, {"3", start}); }, "only one of them is linked to the other");
  CHECK(builder.document() == before);
}

TEST_CASE("ids that were changed in the document are known") {
  MapBuilder builder;
  for (auto const* id : {"1", "2"}) builder.add_road(straight(id, {}, 50, 0, 1));
  builder.document().roads[0].id = "renamed";
  CHECK_NOTHROW(builder.add_road(straight("1", {50, 0, 0}, 50, 0, 1)));
  CHECK_THROWS_AS(builder.add_road(straight("renamed", {}, 50, 0, 1)), MapError);
  builder.connect({"renamed", end}, {"1", start});
  CHECK(builder.road("renamed").successor->id == "1");
  builder.document().roads.erase(builder.document().roads.begin() + 1);
  CHECK(std::as_const(builder).road("1").predecessor->id == "renamed");
  CHECK_THROWS_AS((void)builder.end_pose({"2", end}), MapError);
  auto& held = builder.document();
  CHECK_NOTHROW(builder.add_road(straight("2", {}, 50, 0, 1)));
  std::swap(held.roads[0], held.roads[1]);
  CHECK(builder.road("renamed").id == "renamed");
}

TEST_CASE("a document that was changed to something unusable loses those roads, with a word") {
  MapBuilder builder;
  for (char const* id : {"1", "2", "3", "4"}) builder.add_road(straight(id, {0, id[0] * 50.0, 0}, 100, 0, 1));
  auto document = builder.document();
  document.roads[0].geometries.push_back({100.0, 100.0, document.roads[0].geometries[0].y, 0.0, 10.0});
  document.roads[1].geometries.clear();
  document.roads[2].lane_sections.clear();
  document.roads[3].geometries[0].kind = GeometryKind::cubic;
  std::vector<Diagnostic> diagnostics;
  check_opendrive_document(document, "changed", diagnostics);
  REQUIRE(document.roads.size() == 1);
  CHECK(document.roads[0].id == "1");
  CHECK(std::count_if(diagnostics.begin(), diagnostics.end(), [](Diagnostic const& d) {
          return d.sentence.find("the road was left out") != std::string::npos;
        }) == 3);
  CHECK(build_map(document, {}, "changed", diagnostics)->lanes().size() == 1);
}

TEST_CASE("a junction that only a sidewalk leads through needs no connection") {
  MapBuilder builder;
  for (auto const& [id, x] : {std::pair{"1", 0.0}, {"2", 80.0}})
    builder.add_road({.id = id,
                      .line = lay_from({x, 0, 0}, {{50.0}}),
                      .sections = {{.right = {{.type = LaneType::sidewalk, .width = 2.0}}}}});
  builder.add_junction("9");
  auto const findings = [&builder] {
    std::vector<Diagnostic> diagnostics;
    (void)builder.build({}, &diagnostics);
    return std::count_if(diagnostics.begin(), diagnostics.end(), [](Diagnostic const& d) {
      return d.sentence.find("it has no connection") != std::string::npos;
    });
  };
  CHECK(findings() == 1);
  builder.add_turn("9", {"1", end}, {"2", start}, {.lanes = {{-1, -1}}});
  CHECK(builder.document().junctions[0].connections.empty());
  CHECK(findings() == 0);
}
