// The project's own maps: that they are in order, that one gets through them, and that make_maps makes them.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "../support/corpus.hpp"
#include "../support/skipped.hpp"
#include "../viewer/browser.hpp"
#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/map/opendrive.hpp"
#include "../support/maps.hpp"

namespace {

namespace cb = cambium;
namespace fs = std::filesystem;
using cb::LaneId;
using cb::map::Lane;
using cb::map::OverlapKind;

fs::path const folder = fs::path(CAMBIUM_SOURCE_DIR) / "maps";

/// The lanes on which one comes onto the map (`in`) or leaves it: not those that open or end within a road.
std::vector<LaneId> ends_of(cb::Map const& map, bool in) {
  std::vector<LaneId> ids;
  for (auto const& lane : map.lanes()) {
    bool const at_start = lane.along_road == in;
    bool const at_end_of_road = lane.section == (at_start ? 0 : map.road(lane.road).sections.size() - 1);
    if (lane.drivable() && at_end_of_road && (in ? lane.predecessors : lane.successors).empty()) ids.push_back(lane.id);
  }
  return ids;
}

std::string road_of(cb::Map const& map, LaneId lane) { return map.road(map.lane(lane).road).name; }

double gap(cb::geometry::Pose const& a, cb::geometry::Pose const& b) { return (a.position() - b.position()).norm(); }

struct Ways {
  char const* file;
  std::set<std::string> roads;  ///< from > to
  int lane_pairs;
};

/// Where one can get to from where, by hand from the maps' pictures.
std::vector<Ways> const all_ways{
    {"highway.xodr", {"1>1"}, 9},
    {"lane_drop.xodr", {"1>1"}, 6},
    {"merging.xodr", {"1>3", "2>3"}, 6},
    {"highway_exit.xodr", {"1>3", "1>2"}, 12},
    {"intersection_3way.xodr", {"1>2", "1>3", "2>1", "2>3", "3>1", "3>2"}, 6},
    {"intersection_4way.xodr",
     {"1>2", "1>3", "1>4", "2>1", "2>3", "2>4", "3>1", "3>2", "3>4", "4>1", "4>2", "4>3"},
     48},
    {"roundabout.xodr",
     {"1>1", "1>2", "1>3", "1>4", "2>1", "2>2", "2>3", "2>4", "3>1", "3>2", "3>3", "3>4", "4>1", "4>2", "4>3", "4>4"},
     16}};

using Pair = std::pair<LaneId, LaneId>;

std::set<Pair> crossings(cb::Map const& map) {
  std::set<Pair> pairs;
  for (auto const& lane : map.lanes())
    for (auto const& overlap : lane.overlaps)
      if (overlap.kind == OverlapKind::crossing) pairs.insert(std::minmax(lane.id, overlap.other));
  return pairs;
}

/// Pairs of ways through a junction around the origin whose ends lie alternately around it, so that they must cross.
std::set<Pair> alternating(cb::Map const& map) {
  std::set<Pair> pairs;
  auto const angles = [](Lane const& lane) {
    auto const a = lane.path.samples().front(), b = lane.path.samples().back();
    return std::minmax({std::atan2(a.y, a.x), std::atan2(b.y, b.x)});
  };
  auto const same = [](double a, double b) { return std::abs(a - b) < 1e-3; };
  for (auto const& a : map.lanes())
    for (auto const& b : map.lanes()) {
      if (a.id >= b.id || !is_valid(map.road(a.road).junction) || !is_valid(map.road(b.road).junction)) continue;
      auto const [a0, a1] = angles(a);
      auto const [b0, b1] = angles(b);
      if (same(a0, b0) || same(a1, b1) || same(a0, b1) || same(a1, b0)) continue;
      if ((b0 > a0 && b0 < a1) != (b1 > a0 && b1 < a1)) pairs.insert({a.id, b.id});
    }
  return pairs;
}

}  // namespace

TEST_CASE("own maps load without a diagnostic, and are those that this file knows") {
  CHECK(corpus::maps(folder).size() == all_ways.size());
  for (auto const& ways : all_ways) {
    CAPTURE(ways.file);
    auto const loaded = cambium::load_opendrive((folder / ways.file).string());
    for (auto const& d : loaded.diagnostics) FAIL_CHECK(to_string(d));
    for (auto const& lane : loaded.map->lanes())
      CHECK_MESSAGE(std::isfinite(lane.speed_limit_at(0.0)), loaded.map->describe(lane.id));
  }
}

TEST_CASE("in own maps geometries meet to a nanometre, and joined lanes in position, direction and borders") {
  for (auto const& ways : all_ways) {
    CAPTURE(ways.file);
    auto const map = cambium::load_opendrive((folder / ways.file).string()).map;
    for (auto const& road : map->roads()) {
      auto const all = road.reference_line.geometries();
      for (std::size_t i = 1; i < all.size(); ++i) {
        auto const end = evaluate(all[i - 1], all[i - 1].length), next = evaluate(all[i], 0.0);
        CHECK(std::hypot(end.x - next.x, end.y - next.y) < 1e-9);
        CHECK(std::abs(end.heading - next.heading) < 1e-12);
        CHECK(std::abs(end.curvature - next.curvature) < 1e-12);
      }
    }
    for (auto const& lane : map->lanes())
      for (auto const id : lane.successors) {
        auto const& next = map->lane(id);
        CAPTURE(map->describe(lane.id));
        CAPTURE(map->describe(id));
        auto const end = lane.path.samples().back(), begin = next.path.samples().front();
        CHECK(gap(end, begin) < 1e-6);
        CHECK(std::abs(cb::geometry::angle_difference(end.heading, begin.heading)) < 1e-6);
        if (is_valid(lane.merges_into) || lane.widths.back().left + lane.widths.back().right < 1e-6) continue;
        CHECK(gap(lane.left.samples().back(), next.left.samples().front()) < 0.01);
        CHECK(gap(lane.right.samples().back(), next.right.samples().front()) < 0.01);
      }
  }
}

TEST_CASE("in own maps every way in leads to every way out that it should, along corridors without kinks") {
  for (auto const& ways : all_ways) {
    CAPTURE(ways.file);
    auto const map = cambium::load_opendrive((folder / ways.file).string()).map;
    std::set<std::string> roads;
    int lane_pairs = 0;
    double largest_turn = 0.0, largest_curvature = 0.0;
    for (auto const from : ends_of(*map, true))
      for (auto const to : ends_of(*map, false)) {
        auto const route = map->shortest_route(from, to);
        if (!route) continue;
        ++lane_pairs;
        roads.insert(road_of(*map, from) + ">" + road_of(*map, to));
        auto const road = build_road_corridor(*map, *route);
        for (auto const& corridor : road->corridors) {
          auto const segments = corridor.center.segments();
          for (std::size_t i = 0; i < segments.size(); ++i) {
            auto const& g = segments[i];
            largest_turn = std::max(largest_turn, std::abs(g.curvature * g.length));
            largest_curvature = std::max(largest_curvature, std::abs(g.curvature));
            if (i == 0) continue;
            auto const& before = segments[i - 1];
            double const turn = std::atan2(before.ux * g.uy - before.uy * g.ux, before.ux * g.ux + before.uy * g.uy);
            largest_turn = std::max(largest_turn, std::abs(turn));
          }
        }
      }
    CHECK(roads == ways.roads);
    CHECK(lane_pairs == ways.lane_pairs);
    CHECK(largest_turn < 0.053);
    CHECK(largest_curvature < 1.0 / 6.0);
  }
}

TEST_CASE("in the intersections those ways cross that must, and no others") {
  for (auto const& [file, count] : {std::pair{"intersection_3way.xodr", 3u}, {"intersection_4way.xodr", 36u}}) {
    CAPTURE(file);
    auto const map = cambium::load_opendrive((folder / file).string()).map;
    CHECK(crossings(*map).size() == count);
    CHECK(crossings(*map) == alternating(*map));
  }
  for (auto const* file : {"roundabout.xodr", "highway_exit.xodr", "merging.xodr", "lane_drop.xodr", "highway.xodr"})
    CHECK(crossings(*cambium::load_opendrive((folder / file).string()).map).empty());
}

TEST_CASE("in the roundabout each arm merges into the ring and splits off it") {
  auto const map = cambium::load_opendrive((folder / "roundabout.xodr").string()).map;
  for (std::string const arm : {"1", "2", "3", "4"}) {
    auto const& ring = map->lane(map->find_lane(arm + "01", 1.0, -1));
    auto const has = [&ring](LaneId other, OverlapKind kind) {
      return std::any_of(ring.overlaps.begin(), ring.overlaps.end(),
                         [&](auto const& o) { return o.other == other && o.kind == kind; });
    };
    CHECK(ring.overlaps.size() == 2);
    CHECK(has(map->find_lane(arm + "02", 1.0, -1), OverlapKind::split));
    CHECK(has(map->find_lane(arm + "03", 1.0, -1), OverlapKind::merge));
  }
}

TEST_CASE("make_maps writes the maps as they are kept") {
  fs::path const program = CAMBIUM_EXAMPLES_DIR "/make_maps";
  if (!fs::exists(program)) {
    support::skip("no example programs: build the examples");
    return;
  }
  browser::TemporaryFolder const out;
  REQUIRE(std::system((browser::quoted(program.string()) + " --out " + browser::quoted(out.path().string()) + " >" +
                       browser::quoted((out.path() / "out").string()))
                          .c_str()) == 0);
  CHECK(corpus::maps(out.path()).size() == all_ways.size());
  for (auto const& ways : all_ways)
    CHECK_MESSAGE(corpus::read(out.path() / ways.file) == corpus::read(folder / ways.file), ways.file);
}
