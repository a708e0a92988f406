#include "cambium/map/lanes/lane_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

#include <doctest/doctest.h>

#include "lanes_by_hand.hpp"

using namespace by_hand;

namespace {

/// Curved and straight lanes of all directions over each other; every third one widens, some are sidewalks.
std::vector<Lane> heap_of_lanes(std::uint64_t seed, int count) {
  Numbers random{seed};
  std::vector<Lane> lanes;
  for (int i = 0; i < count; ++i) {
    Pose const start{random(-150, 150), random(-150, 150), random(-3.1, 3.1)};
    bool const widens = i % 3 == 0;
    double const curvature = widens ? 0.0 : random(-0.05, 0.05);
    auto const id =
        add_lane(lanes, arc(start, curvature, random(5, 60), widens ? 100.0 : random(0.2, 3.0)), random(0.5, 2.5));
    auto& lane = lanes[index_of(id)];
    if (widens) lane.widths.back() = {random(0.0, 6.0), random(-1.0, 3.0)};
    if (i % 5 == 1) lane.type = LaneType::sidewalk;
  }
  return lanes;
}

LaneHit hit_by_projection(Lane const& lane, Point const& p) {
  auto const foot = lane.path.project(p);
  auto const widths = lane.widths_at(foot.s);
  double const aside = std::max({foot.lateral - widths.left, -widths.right - foot.lateral, 0.0});
  double const past = std::max({-foot.s, foot.s - lane.length(), 0.0});
  return {lane.id, foot.s, foot.lateral, std::hypot(aside, past), foot.segment};
}

std::vector<LaneHit> near_by_brute_force(std::vector<Lane> const& lanes, Point const& p, double radius) {
  std::vector<LaneHit> hits;
  for (auto const& lane : lanes)
    if (auto const hit = hit_by_projection(lane, p); hit.distance <= radius) hits.push_back(hit);
  std::sort(hits.begin(), hits.end(), [](LaneHit const& a, LaneHit const& b) {
    return std::tie(a.distance, a.lane) < std::tie(b.distance, b.lane);
  });
  return hits;
}

}  // namespace

TEST_CASE("the tree finds the lanes near a point that a look at every lane finds, nearest first") {
  std::size_t found = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    auto const lanes = heap_of_lanes(seed, 40);
    LaneTree const tree(lanes);
    Numbers random{100 + seed};
    for (int k = 0; k < 300; ++k) {
      Point const p{random(-180, 180), random(-180, 180)};
      double const radius = k % 3 == 0 ? 0.0 : random(0, 8);
      auto const expected = near_by_brute_force(lanes, p, radius);
      auto const hits = tree.near(p, {.radius = radius});
      REQUIRE(hits.size() == expected.size());
      for (std::size_t i = 0; i < hits.size(); ++i) {
        CHECK(hits[i].lane == expected[i].lane);
        CHECK(hits[i].s == doctest::Approx(expected[i].s));
        CHECK(hits[i].lateral == doctest::Approx(expected[i].lateral));
        CHECK(hits[i].distance == doctest::Approx(expected[i].distance));
        CHECK(hits[i].segment == expected[i].segment);
      }
      found += hits.size();
    }
  }
  CHECK(found > 400);
}

TEST_CASE("the nearest lanes of a direction are those that a look at every lane finds") {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  auto const lanes = heap_of_lanes(5, 80);
  LaneTree const tree(lanes);
  Numbers random{11};
  int compared = 0;
  for (int k = 0; k < 1500; ++k) {
    Point const p{random(-300, 300), random(-300, 300)};
    cambium::map::LaneQuery query{.radius = k % 2 == 0 ? infinity : random(0, 60)};
    query.count = static_cast<std::size_t>(random(1, 12));
    query.only_drivable = k % 3 == 0;
    if (k % 5 != 0) query.heading = random(-10, 10);
    query.heading_tolerance = random(0.1, 3.3);
    auto expected = near_by_brute_force(lanes, p, query.radius);
    bool is_close_call = false;  // at a vertex there are two directions
    std::erase_if(expected, [&](LaneHit const& hit) {
      auto const& lane = lanes[index_of(hit.lane)];
      auto const& segment = lane.path.segments()[hit.segment];
      double const error = std::abs(
          cambium::geometry::angle_difference(std::atan2(segment.uy, segment.ux), query.heading.value_or(0.0)));
      is_close_call = is_close_call || (query.heading && std::abs(error - query.heading_tolerance) < 0.06);
      return (query.only_drivable && !lane.drivable()) || (query.heading && error > query.heading_tolerance);
    });
    if (is_close_call) continue;
    ++compared;
    if (expected.size() > query.count) expected.resize(query.count);
    auto const hits = tree.near(p, query);
    // A lane may have a second foot point that runs the right way (the twin looks at its nearest only), and come
    // before.
    REQUIRE(hits.size() >= expected.size());
    bool const is_full = hits.size() == query.count;
    for (auto const& hit : expected) {
      bool const found = std::any_of(hits.begin(), hits.end(), [&](LaneHit const& h) { return h.lane == hit.lane; });
      CHECK((found || (is_full && hits.back().distance <= hit.distance)));
    }
    CHECK(hits.size() <= query.count);
    CHECK(std::is_sorted(hits.begin(), hits.end(),
                         [](LaneHit const& a, LaneHit const& b) { return a.distance < b.distance; }));
    if (!query.heading && hits.size() == expected.size())
      for (std::size_t i = 0; i < hits.size(); ++i) CHECK(hits[i].lane == expected[i].lane);
  }
  CHECK(compared > 200);
  CHECK(tree.near({0, 0}, {.radius = std::nan("")}).empty());
  for (auto const& lane : lanes)
    CHECK_FALSE(tree.nearest_drivable({lane.path.pose(0).x, lane.path.pose(0).y, std::nan("")}, 5.0));
  CHECK(tree.near({0, 0}, {.radius = infinity, .count = 1000}).size() == lanes.size());
  CHECK(tree.near({0, 0}, {.radius = infinity}).size() == lanes.size());
  for (double const r : {1e30, 3.5e38, 1e300, infinity}) CHECK(tree.in({-r, -r, r, r}).size() == lanes.size());
}

TEST_CASE("the lanes in a box are those whose area meets it") {
  auto const lanes = heap_of_lanes(9, 120);
  LaneTree const tree(lanes);
  Numbers random{12};
  std::size_t found = 0;
  for (int k = 0; k < 400; ++k) {
    double const x = random(-180, 180), y = random(-180, 180);
    cambium::geometry::Box const box{x, y, x + random(0, 30), y + random(0, 30)};
    auto const in = tree.in(box);
    for (auto const& lane : lanes) {
      bool const is_found = std::find(in.begin(), in.end(), lane.id) != in.end();
      found += is_found;
      // Points of the lane within the box: seen means it must be found; and found means that one is near the box.
      bool seen = false, near = false;
      for (auto const& g : lane.path.segments())
        for (int i = 0; i <= 20; ++i) {
          auto const w =
              lane.widths_at(g.s + g.length * i / 20, static_cast<std::uint32_t>(&g - lane.path.segments().data()));
          for (int j = 0; j <= 20; ++j) {
            double const t = -w.right + (w.left + w.right) * j / 20;
            Point const p(g.x + g.ux * g.length * i / 20 - g.uy * t, g.y + g.uy * g.length * i / 20 + g.ux * t);
            seen = seen || box.contains(p);
            near = near || box.grown(1.0 + 0.05 * (g.length + w.left + w.right)).contains(p);
          }
        }
      CHECK((!seen || is_found));
      CHECK((!is_found || near));
    }
  }
  CHECK(found > 300);
}

TEST_CASE("a point is on a drivable lane when one holds it, slits between lanes apart") {
  auto const lanes = heap_of_lanes(7, 60);
  LaneTree const tree(lanes);
  Numbers random{8};
  int on = 0;
  for (int k = 0; k < 5000; ++k) {
    Point const p{random(-180, 180), random(-180, 180)};
    auto const hits = near_by_brute_force(lanes, p, LaneTree::slack);
    bool const expected =
        std::any_of(hits.begin(), hits.end(), [&](LaneHit const& h) { return lanes[index_of(h.lane)].drivable(); });
    CHECK(tree.any_drivable_at(p) == expected);
    on += expected;
  }
  CHECK(on > 100);
}

TEST_CASE("outside of a sharp bend the corner is the foot point") {
  std::vector<Lane> lanes;
  std::vector<Point> const points{{0, 0}, {10, 0}, {10, 10}};
  add_straight(lanes, {0, 0, 0}, 1.0);
  lanes[0].path = geometry::Line::from_points(points);
  lanes[0].widths.assign(3, {2.0, 2.0});
  LaneTree const tree(lanes);
  auto const hits = tree.near({11.2, -1.2}, {});  // 1.7 m from the corner
  REQUIRE(hits.size() == 1);
  CHECK(hits[0].s == doctest::Approx(10.0));
  CHECK(hits[0].lateral == doctest::Approx(-1.2 * std::sqrt(2.0)));
  CHECK(tree.near({11.5, -1.5}, {}).empty());  // 2.12 m
}

TEST_CASE("of the lanes that hold a vehicle the one with its direction is taken") {
  std::vector<Lane> lanes;
  auto const east = add_straight(lanes, {0, 0, 0}, 100);
  auto const north = add_straight(lanes, {50, -50, 1.5708}, 100);
  auto const west = add_straight(lanes, {100, 0.5, 3.14159}, 100);
  LaneTree const tree(lanes);
  CHECK(tree.nearest_drivable({50, 0.1, 0.2}, 5)->lane == east);
  CHECK(tree.nearest_drivable({50, 0.1, 1.4}, 5)->lane == north);
  CHECK(tree.nearest_drivable({50, 0.1, -3.0}, 5)->lane == west);
  CHECK(tree.nearest_drivable({20, 0.1, 1.0}, 5)->lane == east);
}

TEST_CASE(
    "of lanes with the same direction that hold a vehicle the one whose path is nearest is taken, then the first") {
  std::vector<Lane> lanes;
  auto const a = add_straight(lanes, {0, 0, 0.001}, 100);
  auto const b = add_straight(lanes, {0, 1.0, 0}, 100);
  add_straight(lanes, {0, 1.0, 0}, 100);
  LaneTree const tree(lanes);
  CHECK(tree.nearest_drivable({30, 0.3, 0}, 5)->lane == a);
  CHECK(tree.nearest_drivable({30, 0.7, 0}, 5)->lane == b);
}

TEST_CASE("a vehicle beside all lanes gets the nearest that does not run against it, within the radius") {
  std::vector<Lane> lanes;
  auto const there = add_straight(lanes, {0, 0, 0}, 100);
  auto const back = add_straight(lanes, {100, 8, 3.14159}, 100);
  auto const walk = add_straight(lanes, {0, -3.0, 0}, 100, 1.0);
  lanes[index_of(walk)].type = LaneType::sidewalk;
  LaneTree const tree(lanes);
  CHECK(tree.nearest_drivable({50, 5, 0.1}, 5)->lane == there);
  CHECK(tree.nearest_drivable({50, 3, 3.0}, 5)->lane == back);
  CHECK(tree.nearest_drivable({50, -3, 0}, 5)->lane == there);
  CHECK_FALSE(tree.nearest_drivable({50, 5, 0.1}, 3).has_value());
  CHECK_FALSE(tree.nearest_drivable({50, 50, 0.1}, 5).has_value());
  auto const past_the_end = tree.nearest_drivable({103, 0, 0}, 5);
  REQUIRE(past_the_end.has_value());
  CHECK(past_the_end->s == doctest::Approx(103.0));
  CHECK(past_the_end->distance == doctest::Approx(3.0));
}

TEST_CASE("a tree of no lanes finds nothing") {
  for (LaneTree const& tree : {LaneTree(), LaneTree(std::vector<Lane>())}) {
    CHECK(tree.near({0, 0}, {.radius = 1e9}).empty());
    CHECK_FALSE(tree.nearest_drivable({0, 0, 0}, 1e9).has_value());
    CHECK_FALSE(tree.any_drivable_at({0, 0}));
  }
}
