#include "cambium/map/lanes/overlaps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "cambium/map/building/map_builder.hpp"
#include "cambium/map/opendrive.hpp"
#include "corpus_maps.hpp"
#include "../support/map_use.hpp"
#include "../support/maps.hpp"
#include "lanes_by_hand.hpp"

using namespace by_hand;

namespace {

constexpr double clearance = 2.5;
constexpr double pi = 3.14159265358979;

void find(std::vector<Lane>& lanes, LaneElevation const& elevation = {}) { find_overlaps(lanes, elevation, clearance); }

/// Every overlap is entered on both lanes, lies on them and has a length.
void check_consistent(std::vector<Lane> const& lanes) {
  for (auto const& lane : lanes) {
    CHECK(std::is_sorted(lane.overlaps.begin(), lane.overlaps.end(),
                         [](auto const& a, auto const& b) { return a.begin < b.begin; }));
    for (auto const& o : lane.overlaps) {
      auto const& other = lanes[index_of(o.other)];
      CHECK(0.0 <= o.begin);
      CHECK(o.begin < o.end);
      CHECK(o.end <= lane.length());
      CHECK(std::count_if(other.overlaps.begin(), other.overlaps.end(), [&](Overlap const& b) {
              return b.other == lane.id && b.kind == o.kind && b.begin == o.other_begin && b.end == o.other_end &&
                     b.other_begin == o.begin;
            }) == 1);
    }
  }
}

}  // namespace

TEST_CASE("lanes that cross at an angle overlap by the clearance over its sine on either side") {
  for (double const angle : {0.5, 1.0, 1.2, 1.57, 2.0, 2.6}) {
    std::vector<Lane> lanes;
    auto const a = add_straight(lanes, {-50, 0, 0}, 100);
    auto const b = add_straight(lanes, {-40 * std::cos(angle), -40 * std::sin(angle), angle}, 100);
    find(lanes);
    check_consistent(lanes);
    REQUIRE(lanes[index_of(a)].overlaps.size() == 1);
    auto const& o = lanes[index_of(a)].overlaps[0];
    CHECK(o.other == b);
    CHECK(o.kind == (angle < pi / 3 ? OverlapKind::merge : OverlapKind::crossing));
    double const half = clearance / std::sin(angle);
    CHECK(std::abs(o.begin - (50 - half)) < 0.01);
    CHECK(std::abs(o.end - (50 + half)) < 0.01);
    CHECK(std::abs(o.other_begin - (40 - half)) < 0.01);
    CHECK(std::abs(o.other_end - (40 + half)) < 0.01);
  }
}

TEST_CASE(
    "a ramp that joins a lane tangentially merges from where it comes closer than the clearance, and splits likewise") {
  constexpr double radius = 300.0;
  for (bool const merges : {true, false}) {
    std::vector<Lane> lanes;
    auto const flip = [merges](std::vector<LineSample> samples) {
      if (merges) return samples;
      std::reverse(samples.begin(), samples.end());
      for (auto& p : samples) p.heading += pi;
      return samples;
    };
    // The straight lane ends at the origin; the ramp comes along a circle around (0, radius) and ends there too.
    auto const main = add_lane(lanes, flip(arc({-100, 0, 0}, 0.0, 100, 100)));
    double const turn = -0.3;
    auto const ramp = add_lane(lanes, flip(arc({radius * std::sin(turn), radius * (1 - std::cos(turn)), turn},
                                               1 / radius, 0.3 * radius, 0.05)));
    auto const common = merges ? add_straight(lanes, {0, 0, 0}, 100) : add_straight(lanes, {100, 0, pi}, 100);
    for (auto const lane : {main, ramp}) merges ? link(lanes, lane, common) : link(lanes, common, lane);
    find(lanes);
    check_consistent(lanes);
    REQUIRE(lanes[index_of(main)].overlaps.size() == 1);
    CHECK(lanes[index_of(common)].overlaps.empty());
    auto const& o = lanes[index_of(main)].overlaps[0];
    CHECK(o.kind == (merges ? OverlapKind::merge : OverlapKind::split));
    double const on_main = std::sqrt((radius + clearance) * (radius + clearance) - radius * radius);
    double const on_ramp = radius * std::acos(1 - clearance / radius);
    double const other_length = lanes[index_of(ramp)].length();
    CHECK(std::abs((merges ? 100 - o.begin : o.end) - on_main) < 0.005);
    CHECK(std::abs((merges ? o.end - 100 : o.begin)) < 1e-9);
    CHECK(std::abs((merges ? other_length - o.other_begin : o.other_end) - on_ramp) < 0.005);
    CHECK(std::abs((merges ? o.other_end - other_length : o.other_begin)) < 1e-9);
  }
}

TEST_CASE("lanes over the same place that begin together split, and merge where they end together") {
  std::vector<Lane> lanes;
  auto const before = add_straight(lanes, {-50, 0, 0}, 50);
  auto const a = add_straight(lanes, {0, 0, 0}, 30);
  auto const b = add_lane(lanes, arc({0, 0, 0}, 1e-5, 30));
  link(lanes, before, a);
  link(lanes, before, b);
  find(lanes);
  REQUIRE(lanes[index_of(a)].overlaps.size() == 1);
  CHECK(lanes[index_of(a)].overlaps[0].kind == OverlapKind::split);
  auto const after = add_straight(lanes, {30, 0, 0}, 50);
  link(lanes, a, after);
  link(lanes, b, after);
  find(lanes);
  REQUIRE(lanes[index_of(a)].overlaps.size() == 1);
  CHECK(lanes[index_of(a)].overlaps[0].kind == OverlapKind::merge);
  CHECK(lanes[index_of(a)].overlaps[0].begin == 0.0);
  CHECK(lanes[index_of(a)].overlaps[0].end == lanes[index_of(a)].length());
  CHECK(lanes[index_of(before)].overlaps.empty());
}

TEST_CASE(
    "lanes that belong together do not overlap: successors, also behind a short lane, and the lanes beside them") {
  std::vector<Lane> lanes;
  auto const a = add_straight(lanes, {0, 0, 0}, 50);
  auto const short_one = add_straight(lanes, {48, 0, 0}, 2.0);
  auto const c = add_straight(lanes, {40, 0, 0}, 60);  // a file may be that rough
  auto const beside = add_straight(lanes, {40, -2.0, 0}, 60);
  find(lanes);
  CHECK(lanes[index_of(a)].overlaps.size() == 3);
  link(lanes, a, short_one);
  link(lanes, short_one, c);
  find(lanes);
  REQUIRE(lanes[index_of(a)].overlaps.size() == 1);
  CHECK(lanes[index_of(a)].overlaps[0].other == beside);
  link(lanes, a, c);
  put_beside(lanes, c, beside);
  find(lanes);
  for (auto const& lane : lanes)
    if (lane.id != short_one && lane.id != beside) CHECK(lane.overlaps.empty());
}

TEST_CASE("lanes that only touch end to begin do not overlap, and a stretch beyond a lane's end is not counted to it") {
  std::vector<Lane> lanes;
  auto const first = add_straight(lanes, {0, 0, 0}, 50), second = add_straight(lanes, {50, 0, 0}, 50);
  auto const along = add_straight(lanes, {0, 1.0, 0}, 100);
  find(lanes);
  check_consistent(lanes);
  REQUIRE(lanes[index_of(first)].overlaps.size() == 1);
  REQUIRE(lanes[index_of(along)].overlaps.size() == 2);
  CHECK(lanes[index_of(along)].overlaps[0].other == first);
  CHECK(lanes[index_of(along)].overlaps[0].end == doctest::Approx(50));
  CHECK(lanes[index_of(along)].overlaps[1].other == second);
  CHECK(lanes[index_of(along)].overlaps[1].begin == doctest::Approx(50));
}

TEST_CASE("neighbours overlap only where one swings onto the other") {
  std::vector<Lane> lanes;
  auto const stays = add_straight(lanes, {0, 0, 0}, 100);
  auto const swings = add_swinging(lanes);
  put_beside(lanes, stays, swings);
  find(lanes);
  CHECK(lanes[index_of(stays)].overlaps.empty());
  lanes[index_of(swings)].merges_into = stays;
  find(lanes);
  REQUIRE(lanes[index_of(stays)].overlaps.size() == 1);
  auto const& o = lanes[index_of(swings)].overlaps[0];
  CHECK(o.kind == OverlapKind::merge);
  CHECK(o.end == lanes[index_of(swings)].length());
  CHECK(std::abs(lanes[index_of(swings)].path.pose(o.begin).y + clearance) < 0.01);
  check_consistent(lanes);
}

TEST_CASE("a bridge does not overlap with the lane below, a ramp on the ground does") {
  std::vector<Lane> lanes;
  add_straight(lanes, {-50, 0, 0}, 100);
  auto const bridge = add_straight(lanes, {0, -50, 1.5708}, 100);
  find(lanes, [bridge](Lane const& lane, double) { return lane.id == bridge ? 5.0 : 0.0; });
  CHECK(lanes[0].overlaps.empty());
  find(lanes, [bridge](Lane const& lane, double) { return lane.id == bridge ? 2.0 : 0.0; });
  CHECK(lanes[0].overlaps.size() == 1);
}

TEST_CASE("a road that comes back over itself overlaps there, but not along its lanes") {
  std::vector<Lane> lanes;
  // Two lanes of one road, 2.2 m apart: straight on, three quarters of a circle around to the left, and straight on.
  for (double const radius : {30.0, 32.2}) {
    std::vector<LineSample> samples;
    for (auto const& [curvature, length] : {std::pair(0.0, 100.0), {1 / radius, 1.5 * pi * radius}, {0.0, 100.0}}) {
      Pose const start = samples.empty() ? Pose{0, 30.0 - radius, 0}
                                         : Pose{samples.back().x, samples.back().y, samples.back().heading};
      auto const piece = arc(start, curvature, length, 0.5);
      samples.insert(samples.end(), piece.begin() + (samples.empty() ? 0 : 1), piece.end());
    }
    auto& lane = lanes[index_of(add_lane(lanes, samples))];
    lane.road = static_cast<RoadId>(0);
    lane.road_end = 345.0;
  }
  find(lanes);
  check_consistent(lanes);
  for (auto const& lane : lanes) {
    CHECK(lane.overlaps.size() == 4);  // with itself, and with the other one, each way
    for (auto const& o : lane.overlaps) {
      CHECK(o.kind == OverlapKind::crossing);
      CHECK(std::abs(o.begin - o.other_begin) > 20.0);
    }
  }
}

TEST_CASE("a bridge is told from a crossing by the heights at the place, however long the straight roads are") {
  for (auto const& [height, overlaps] : {std::pair(2.5, 1u), {10.0, 0u}, {-0.3, 1u}, {-0.7, 0u}}) {
    cambium::MapBuilder builder;
    builder.add_road({.id = "rises", .line = lay_from({}, {{400.0}}), .sections = {{.right = equal_lanes(1)}}});
    builder.add_road(
        {.id = "level", .line = lay_from({50, -50, pi / 2}, {{100.0}}), .sections = {{.right = equal_lanes(1)}}});
    builder.road("rises").elevation = {{0.0, 0.0, 0.05, 0.0, 0.0}};
    builder.road("level").elevation = {{0.0, height, 0.0, 0.0, 0.0}};
    auto const map = builder.build();
    CAPTURE(height);
    CHECK(map->lanes()[0].overlaps.size() == overlaps);
  }
}

TEST_CASE("a ramp overlaps with the road that it rises over only while it is low") {
  std::vector<Lane> lanes;
  add_straight(lanes, {0, 0, 0}, 600);
  auto const ramp = add_straight(lanes, {600, 1, pi}, 600);
  find(lanes, [ramp](Lane const& lane, double s) { return lane.id == ramp ? 0.02 * s : 0.0; });
  REQUIRE(lanes[0].overlaps.size() == 1);
  CHECK(lanes[0].overlaps[0].end == doctest::Approx(600));
  CHECK(lanes[0].overlaps[0].begin < 450);
  CHECK(lanes[0].overlaps[0].begin > 350);
}

TEST_CASE("a road that leads into a loop which crosses it overlaps with it there, and not at their joint") {
  for (double const radius : {8.0, 20.0, 60.0}) {
    cambium::MapBuilder builder;
    builder.add_road({.id = "1", .line = lay_from({}, {{200.0}}), .sections = {{.right = equal_lanes(1)}}});
    builder.add_road({.id = "2",
                      .line = lay_from({200, 0, 0}, {{1.5 * pi * radius, 1 / radius, 1 / radius}, {100.0 + radius}}),
                      .sections = {{.right = equal_lanes(1)}}});
    builder.connect({"1", opendrive::ContactPoint::end}, {"2", opendrive::ContactPoint::start});
    auto const map = builder.build();
    CAPTURE(radius);
    auto const& first = map->lanes()[0];
    REQUIRE(first.successors.size() == 1);
    REQUIRE(first.overlaps.size() == 1);
    auto const& o = first.overlaps[0];
    CHECK(o.kind == OverlapKind::crossing);
    CHECK(std::abs(o.begin - (200.0 - radius - 1.75 - clearance)) < 0.01);  // the lane lies right of its road
    CHECK(std::abs(o.end - o.begin - 2.0 * clearance) < 0.01);
  }
}

TEST_CASE("a lane that crosses itself overlaps with itself, both ways") {
  constexpr double radius = 40.0;
  cambium::MapBuilder builder;
  builder.add_road({.id = "1",
                    .line = lay_from({}, {{200.0}, {1.5 * pi * radius, 1 / radius, 1 / radius}, {200.0}}),
                    .sections = {{.right = equal_lanes(1)}}});
  auto const map = builder.build();
  auto const& lane = map->lanes()[0];
  check_consistent({lane});
  REQUIRE(lane.overlaps.size() == 2);
  CHECK(lane.overlaps[0].other == lane.id);
  CHECK(lane.overlaps[0].kind == OverlapKind::crossing);
  CHECK(std::abs(lane.overlaps[0].begin - (200.0 - radius - 1.75 - clearance)) < 0.01);
  CHECK(std::abs(lane.overlaps[0].end - lane.overlaps[0].begin - 2.0 * clearance) < 0.01);
  CHECK(lane.overlaps[1].begin == lane.overlaps[0].other_begin);
  CHECK(map_use::first_failure(*map) == "");
}

TEST_CASE("overlaps are where a look along every pair of lanes finds them") {
  std::size_t total = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Numbers random{seed};
    std::vector<Lane> lanes;
    for (int i = 0; i < 12; ++i)
      add_lane(lanes, arc({random(-60, 60), random(-60, 60), random(-3, 3)}, random(-0.04, 0.04), random(20, 70),
                          random(0.3, 2)));
    lanes[3].type = LaneType::sidewalk;
    find(lanes);
    check_consistent(lanes);
    CHECK(lanes[3].overlaps.empty());
    for (auto const& a : lanes) {
      for (auto const& b : lanes) {
        if (a.id == b.id || !a.drivable() || !b.drivable()) continue;
        auto const inside = [&](double s, double margin) {
          return std::any_of(a.overlaps.begin(), a.overlaps.end(), [&](Overlap const& o) {
            return o.other == b.id && s > o.begin - margin && s < o.end + margin;
          });
        };
        for (double s = 0; s < a.length(); s += 0.05) {
          auto const p = a.path.pose(s).position();
          double const distance = by_hand::distance(b.path, p), foot = b.path.project(p).s;
          bool const is_beside = foot > 0.02 && foot < b.length() - 0.02;  // past the end only crossings count
          if (distance < clearance - 0.02 && is_beside) CHECK(inside(s, 1e-9));
          if (distance > clearance + 0.02) CHECK_FALSE(inside(s, 0.0));
        }
      }
      for (auto const& o : a.overlaps) {
        // Ends are on the clearance to a centimetre, or where one of the lanes ends.
        auto const& b = lanes[index_of(o.other)];
        for (double const s : {o.begin, o.end}) {
          auto const p = a.path.pose(s).position();
          double const foot = b.path.project(p).s;
          bool const ends_here = s == 0.0 || s == a.length() || foot < 0.3 || foot > b.length() - 0.3;
          if (!ends_here) CHECK(std::abs(by_hand::distance(b.path, p) - clearance) < 0.01);
        }
      }
      total += a.overlaps.size();
    }
  }
  CHECK(total > 100);
}

TEST_CASE("narrow oncoming lanes of roads that follow each other are no conflict") {
  cambium::MapBuilder builder;
  for (auto const& [id, x] : {std::pair("1", 0.0), {"2", 50.0}})
    builder.add_road({.id = id,
                      .line = lay_from({x, 0.0, 0.0}, {{50.0}}),
                      .sections = {{.left = equal_lanes(1, 2.0), .right = equal_lanes(1, 2.0)}}});
  builder.connect({"1", opendrive::ContactPoint::end}, {"2", opendrive::ContactPoint::start});
  auto const map = builder.build();
  REQUIRE(map->lanes().size() == 4);
  for (auto const& lane : map->lanes()) CHECK(lane.overlaps.empty());
}

TEST_CASE("on every map of the corpus overlaps end within 1 cm of where finely sampled lanes come as near") {
  MapOptions fine;
  fine.position_tolerance = 5e-5;
  fine.heading_tolerance = 1e-3;
  std::size_t ends = 0;
  bool const is_there = for_each_corpus_map([&](auto const& file, Map const& map) {
    auto const twin = cambium::load_opendrive(file.string(), fine).map;
    REQUIRE(map.lanes().size() == twin->lanes().size());
    std::vector<Lane> lanes(twin->lanes().begin(), twin->lanes().end());
    find_overlaps(
        lanes, [&](Lane const& lane, double s) { return twin->road(lane.road).elevation.value(lane.station_at(s)); },
        fine.overlap_clearance);  // without the exact paths
    double worst = 0.0;
    for (auto const& lane : map.lanes()) {
      auto const& other = lanes[index_of(lane.id)];
      CAPTURE(map.describe(lane.id));
      CHECK(lane.overlaps.size() == other.overlaps.size());
      for (auto const& o : lane.overlaps) {
        auto const off = [&](double s, double fine_s) {
          auto const foot = other.path.project(lane.path.pose(s).position(), other.path.find(fine_s)).s;
          return std::abs(std::clamp(foot, 0.0, other.length()) - fine_s);
        };
        double nearest = std::numeric_limits<double>::infinity();
        for (auto const& f : other.overlaps)
          if (f.other == o.other && f.kind == o.kind)
            nearest = std::min(nearest, std::max(off(o.begin, f.begin), off(o.end, f.end)));
        worst = std::max(worst, nearest);
        ends += 2;
      }
    }
    CHECK(worst < 0.01);
  });
  if (is_there) CHECK(ends > 9000);
}
