// What is the same network written in another way gives the same map.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include <doctest/doctest.h>

#include "cambium/core/random.hpp"
#include "cambium/map/building/build_map.hpp"
#include "cambium/map/opendrive.hpp"

#include "../support/corpus.hpp"
#include "transformed_documents.hpp"
#include "../support/maps.hpp"

namespace {

using namespace cambium;
using namespace cambium::map;
using geometry::Point;
using geometry::Pose;

using MapPointer = std::shared_ptr<Map const>;

OpenDriveDocument document_of(std::filesystem::path const& path) {
  std::vector<Diagnostic> diagnostics;
  return cambium::map::load_opendrive_document(path.string(), diagnostics);
}

MapPointer built(OpenDriveDocument const& document) {
  std::vector<Diagnostic> diagnostics;
  return cambium::map::build_map(document, {}, "test", diagnostics);
}

/// Which lane of the other map a lane is.
using LaneNames = std::vector<LaneId>;
using Transform = std::function<Pose(Pose const&)>;

/// The lanes of `other` in the order of those of `map`: of the same road, section (counted from the other end where
/// `is_reversed`), number (with the other sign where `negated`) and direction.
LaneNames names(Map const& map, Map const& other, std::function<bool(Road const&)> const& is_reversed,
                std::function<bool(Road const&)> const& negated) {
  std::map<std::tuple<std::string, std::size_t, int>, LaneId> index;
  for (auto const& lane : other.lanes())
    if (auto const& road = other.road(lane.road); true) index[{road.name, lane.section, lane.number}] = lane.id;
  LaneNames result;
  for (auto const& lane : map.lanes()) {
    auto const& road = map.road(lane.road);
    auto const section = is_reversed(road) ? road.sections.size() - 1 - lane.section : lane.section;
    auto const at = index.find({road.name, section, negated(road) ? -lane.number : lane.number});
    result.push_back(at == index.end() ? none<LaneId> : at->second);
  }
  return result;
}

std::set<LaneId> renamed(std::vector<LaneId> const& ids, LaneNames const& names) {
  std::set<LaneId> result;
  for (auto const id : ids) result.insert(names[index_of(id)]);
  return result;
}

LaneId renamed(LaneId id, LaneNames const& names) { return is_valid(id) ? names[index_of(id)] : id; }

/// Largest distance of the paths: at their ends, directions included, and anywhere.
std::pair<double, double> distance(Lane const& lane, Lane const& other, Transform const& transform) {
  double ends = 0.0, between = 0.0;
  for (int i = 0; i <= 8; ++i) {
    Pose const a = transform(lane.path.pose(lane.length() * i / 8.0)), b = other.path.pose(other.length() * i / 8.0);
    double const apart = (a.position() - b.position()).norm();
    double const turn = std::abs(geometry::angle_difference(a.heading, b.heading));
    if (i % 8 == 0) ends = std::max({ends, apart, turn});
    between = std::max(between, apart);  // where a lane has a kink, its direction is that of either side
  }
  return {ends, between};
}

/// Whether the lanes overlap the same lanes in the same way on the same stretches of their paths, to `tolerance` [m].
bool same_overlaps(Lane const& lane, Lane const& twin, LaneNames const& names, double tolerance) {
  auto const near = [tolerance](double a, double b) { return std::abs(a - b) < tolerance; };
  auto const has_twin = [&](Overlap const& a) {
    return std::any_of(twin.overlaps.begin(), twin.overlaps.end(), [&](Overlap const& b) {
      return renamed(a.other, names) == b.other && a.kind == b.kind && near(a.begin, b.begin) && near(a.end, b.end) &&
             near(a.other_begin, b.other_begin) && near(a.other_end, b.other_end);
    });
  };
  return lane.overlaps.size() == twin.overlaps.size() &&
         std::all_of(lane.overlaps.begin(), lane.overlaps.end(), has_twin);
}

struct Comparison {
  double tolerance = 1e-6;   ///< of paths [m]
  bool swaps_sides = false;  ///< left is right
  double along = 0.01;       ///< tolerance of where overlaps begin and end [m]
};

/// Checks that `other` is `map` under `transform`.
void compare(Map const& map, Map const& other, LaneNames const& names, Transform const& transform,
             Comparison const& c) {
  REQUIRE(map.lanes().size() == other.lanes().size());
  double worst_end = 0.0, worst_between = 0.0, worst_swing = 0.0;
  int wrong_links = 0, wrong_sides = 0, wrong_merges = 0, wrong_overlaps = 0;
  for (auto const& lane : map.lanes()) {
    REQUIRE(is_valid(names[index_of(lane.id)]));
    auto const& twin = other.lane(names[index_of(lane.id)]);
    auto const [ends, between] = distance(lane, twin, transform);
    worst_end = std::max(worst_end, ends);
    (is_valid(lane.merges_into) ? worst_swing : worst_between) =
        std::max(is_valid(lane.merges_into) ? worst_swing : worst_between, between);
    std::set<LaneId> const successors(twin.successors.begin(), twin.successors.end());
    wrong_links += renamed(lane.successors, names) != successors;
    wrong_sides += renamed(lane.left_neighbor, names) != (c.swaps_sides ? twin.right_neighbor : twin.left_neighbor);
    wrong_merges += renamed(lane.merges_into, names) != twin.merges_into;
    wrong_overlaps += !same_overlaps(lane, twin, names, c.along);
  }
  CHECK(worst_end < c.tolerance);
  CHECK(worst_between < std::max(c.tolerance, 1e-4));
  CHECK(worst_swing < 0.05);  // it begins at one of the stations that the lane is sampled at
  CHECK(wrong_links == 0);
  CHECK(wrong_sides == 0);
  CHECK(wrong_merges == 0);
  CHECK(wrong_overlaps == 0);
}

/// Routes between random lanes are there in both maps or in none, and as long. Their number.
int compare_routes(Map const& map, Map const& other, LaneNames const& names, double tolerance) {
  int routes = 0;
  cambium::RandomStream next(7, 0, 0);
  for (int i = 0; i < 60; ++i) {
    auto const from = static_cast<LaneId>(next() % map.lanes().size()),
               to = static_cast<LaneId>(next() % map.lanes().size());
    auto const a = map.shortest_route(from, to), b = other.shortest_route(renamed(from, names), renamed(to, names));
    REQUIRE(a.has_value() == b.has_value());
    if (!a) continue;
    ++routes;
    // Of two routes of one cost either may be found.
    CHECK(std::abs(a->cost - b->cost) < tolerance);
  }
  return routes;
}

bool never(Road const&) { return false; }
bool always(Road const&) { return true; }

}  // namespace

TEST_CASE("a map in the mirror is the mirrored map, left-hand traffic for right-hand traffic") {
  int routes = 0;
  for (auto const& path : corpus::all_maps()) {
    CAPTURE(path.filename().string());
    auto const document = document_of(path);
    auto const map = built(document), other = built(transformed::mirrored(document));
    auto const twins = names(*map, *other, never, always);
    compare(*map, *other, twins, [](Pose const& p) { return Pose{p.x, -p.y, -p.heading}; }, {1e-6, true});
    routes += compare_routes(*map, *other, twins, 1e-5);
  }
  if (corpus::root()) CHECK(routes > 300);
}

TEST_CASE("a map whose header moves it is the moved map") {
  int routes = 0;
  for (auto const& path : corpus::all_maps()) {
    CAPTURE(path.filename().string());
    auto const document = document_of(path);
    for (double const heading : {0.0, 1.0, -2.5}) {
      auto const map = built(document), other = built(transformed::moved(document, 300, -200, heading));
      double const c = std::cos(heading), s = std::sin(heading);
      auto const twins = names(*map, *other, never, never);
      compare(*map, *other, twins,
              [&](Pose const& p) {
                return Pose{c * p.x - s * p.y + 300, s * p.x + c * p.y - 200, p.heading + heading};
              },
              {1e-6, false});
      routes += compare_routes(*map, *other, twins, 1e-5);
    }
  }
  if (corpus::root()) CHECK(routes > 900);
}

TEST_CASE("roads written from their other end give the same network") {
  int reversed = 0, routes = 0;
  for (auto const& path : corpus::all_maps())
    for (int const every : {1, 2, 3}) {
      CAPTURE(path.filename().string());
      CAPTURE(every);
      auto const document = document_of(path);
      std::set<std::string> ids;
      for (std::size_t i = 0; i < document.roads.size(); ++i) {
        auto const& road = document.roads[i];
        bool const has_cubic = std::any_of(road.geometries.begin(), road.geometries.end(),
                                           [](auto const& g) { return g.kind == GeometryKind::cubic; });
        if (!has_cubic && i % static_cast<std::size_t>(every) == 0) ids.insert(road.id);
      }
      reversed += static_cast<int>(ids.size());
      auto const map = built(document), other = built(transformed::with_reversed_roads(document, ids));
      auto const is_reversed = [&](Road const& road) { return ids.contains(road.name); };
      auto const twins = names(*map, *other, is_reversed, is_reversed);
      // Stations of files are rounded: where geometries overlap or leave gaps, that is now at their other end. A
      // millimetre across is some centimetres along where lanes merge.
      compare(*map, *other, twins, [](Pose const& p) { return p; }, {1e-3, false, 0.03});
      routes += compare_routes(*map, *other, twins, 0.1);
    }
  if (corpus::root()) CHECK(reversed > 1000);
  if (corpus::root()) CHECK(routes > 900);
}

TEST_CASE("a map that is built twice is the same to the last bit") {
  for (auto const& path : corpus::all_maps()) {
    CAPTURE(path.filename().string());
    auto const a = cambium::load_opendrive(path.string()), b = cambium::load_opendrive(path.string());
    CHECK(a.diagnostics == b.diagnostics);
    REQUIRE(a.map->lanes().size() == b.map->lanes().size());
    bool same = true;
    for (auto const& l : a.map->lanes()) {
      auto const& r = b.map->lane(l.id);
      same = same && l.path.segments().size() == r.path.segments().size() && l.successors == r.successors &&
             l.predecessors == r.predecessors && l.overlaps.size() == r.overlaps.size() && l.number == r.number &&
             l.index_begin == r.index_begin;
      if (!same) break;
      same = std::memcmp(l.path.segments().data(), r.path.segments().data(), l.path.segments().size_bytes()) == 0;
      for (std::size_t i = 0; i < l.overlaps.size(); ++i)
        same = same && l.overlaps[i].other == r.overlaps[i].other && l.overlaps[i].begin == r.overlaps[i].begin &&
               l.overlaps[i].end == r.overlaps[i].end && l.overlaps[i].kind == r.overlaps[i].kind;
    }
    CHECK(same);
  }
}
