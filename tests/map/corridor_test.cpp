// As in polygon_union.hpp.
#if defined(__clang__)
#pragma clang diagnostic push
#if __has_warning("-Wenum-constexpr-conversion")
#pragma clang diagnostic ignored "-Wenum-constexpr-conversion"
#endif
#elif defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <boost/geometry/algorithms/is_valid.hpp>
#include <boost/geometry/geometries/multi_polygon.hpp>
#if defined(__clang__)
#pragma clang diagnostic pop
#elif defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

#include "cambium/geometry/detail/boost_polygon.hpp"
#include "cambium/map/corridor/build_corridor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "cambium/map/corridor/lane_area.hpp"
#include "cambium/map/corridor/lane_place.hpp"
#include "cambium/map/corridor/road_area.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/opendrive.hpp"
#include "../support/error_of.hpp"
#include "../support/scale.hpp"
#include "../support/corpus.hpp"
#include "corpus_maps.hpp"
#include "lanes_by_hand.hpp"
#include "road_text.hpp"
#include "../support/maps.hpp"

using namespace by_hand;

namespace {

constexpr double never = -std::numeric_limits<double>::infinity();

std::vector<LaneId> lanes_of(LaneCorridor const& corridor) {
  std::vector<LaneId> lanes;
  for (auto const& piece : corridor.pieces) lanes.push_back(piece.lane);
  return lanes;
}

/// The roads that a route passes, in its order.
std::vector<std::string> road_names(Map const& map, std::vector<LaneId> const& route) {
  std::vector<std::string> names;
  for (auto const lane : route)
    if (auto const& name = map.road(map.lane(lane).road).name; names.empty() || names.back() != name)
      names.push_back(name);
  return names;
}

Route route_of(Map const& map, std::vector<LaneId> lanes) {
  Route route{std::move(lanes), 0.0};
  for (auto const lane : route.lanes) route.length += map.lane(lane).length();
  return route;
}

/// Laws of every road corridor: what a world relies on.
void check_laws(Map const& map, RoadCorridor const& road) {
  REQUIRE(index_of(road.main) < road.corridors.size());
  CHECK(road.corridor_of(road.route.back()) != none<CorridorId>);
  std::size_t wrong_places = 0;
  for (auto const& corridor : road.corridors) {
    REQUIRE(corridor.widths.size() == corridor.center.segments().size() + 1);
    REQUIRE_FALSE(corridor.pieces.empty());
    CHECK(corridor.pieces.front().begin == 0.0);
    CHECK(corridor.pieces.back().end == corridor.length());
    for (std::size_t i = 0; i < corridor.pieces.size(); ++i) {
      auto const& piece = corridor.pieces[i];
      auto const& lane = map.lane(piece.lane);
      if (i > 0) CHECK(piece.begin == corridor.pieces[i - 1].end);
      CHECK(piece.end - piece.begin == doctest::Approx(lane.length()).epsilon(0.01).scale(0.1));
      // The lane coordinate leads to the same place on the lane and on the corridor.
      for (double const u : {0.2, 0.5, 0.9}) {
        double const s = piece.begin + u * (piece.end - piece.begin),
                     on_lane = s + piece.index_offset - lane.index_begin;
        if (s - piece.begin < 2.5) continue;
        auto const a = corridor.center.pose(s), b = lane.path.pose(on_lane);
        bool const same_place = (a.position() - b.position()).norm() < 0.02 &&
                                std::abs(geometry::angle_difference(a.heading, b.heading)) < 0.01;
        wrong_places += !same_place;
        auto const w = corridor.widths_at(s, corridor.center.find(s)), v = lane.widths_at(on_lane);
        wrong_places += !(std::abs(w.left - v.left) < 0.02 && std::abs(w.right - v.right) < 0.02);
      }
      for (auto const& [side, number] :
           {std::pair(lane.left_neighbor, piece.left), std::pair(lane.right_neighbor, piece.right)}) {
        CHECK(is_valid(side) == (number != none<CorridorId>));
        if (!is_valid(side)) continue;
        auto const beside = lanes_of(road.corridors[number]);
        CHECK(std::count(beside.begin(), beside.end(), side) == 1);
      }
    }
  }
  CHECK(wrong_places == 0);
}

void check_feeder_laws(Map const& map, LaneCorridor const& corridor) {
  auto const own = lanes_of(corridor);
  CHECK(std::is_sorted(corridor.feeders.begin(), corridor.feeders.end(),
                       [](Feeder const& a, Feeder const& b) { return a.begin < b.begin; }));
  std::map<LaneId, std::vector<std::pair<double, double>>> stretches;
  for (auto const& f : corridor.feeders) {
    auto const& lane = map.lane(f.lane);
    CHECK(f.index_begin < f.index_end);
    CHECK(f.begin < f.end);
    CHECK(f.index_begin >= lane.index_begin - 1e-9);
    CHECK(f.index_end <= lane.index_begin + lane.length() + 1e-9);
    if (f.end > 1e-6 && f.begin < corridor.length() - 1e-6) CHECK(std::count(own.begin(), own.end(), f.lane) == 0);
    stretches[f.lane].emplace_back(f.index_begin, f.index_end);
  }
  for (auto& [lane, list] : stretches) {
    std::sort(list.begin(), list.end());
    for (std::size_t i = 0; i + 1 < list.size(); ++i) CHECK(list[i].second <= list[i + 1].first + 1e-5);
  }
}

/// `count` arcs of `length` [m] that close to a ring.
std::vector<Lane> ring_of(int count, double length) {
  std::vector<Lane> lanes;
  for (int i = 0; i < count; ++i)
    add_lane(lanes,
             arc(i == 0 ? Pose{0, 0, 0} : lanes.back().path.end_pose(), 2 * geometry::pi / (count * length), length));
  for (auto const& lane : lanes) link(lanes, lane.id, lanes[(index_of(lane.id) + 1) % lanes.size()].id);
  return lanes;
}

/// An on-ramp: `before` and `ramp` (with `approach` behind it) merge into `after`.
struct Merge {
  std::vector<Lane> lanes;
  LaneId before, after, ramp, approach;

  Merge() {
    before = add_straight(lanes, {-100, 0, 0}, 100);
    after = add_straight(lanes, {0, 0, 0}, 100);
    auto samples = arc({0, 0, geometry::pi}, 1.0 / 100, 40, 0.5);  // backwards from the merge
    std::reverse(samples.begin(), samples.end());
    for (auto& p : samples) p.heading -= geometry::pi;
    ramp = add_lane(lanes, samples);
    auto const begin = samples.front();
    approach = add_straight(
        lanes, {begin.x - 500 * std::cos(begin.heading), begin.y - 500 * std::sin(begin.heading), begin.heading}, 500);
    link(lanes, before, after);
    link(lanes, ramp, after);
    link(lanes, approach, ramp);
  }
};

/// Every map of the project and of the corpus.
template <class Check>
void for_each_real_map(Check const& check) {
  Numbers random{1};
  for (auto const& file : corpus::all_maps()) {
    CAPTURE(file.string());
    check(*cambium::load_opendrive(file.string()).map, random);
  }
}

/// Corridors straight on from a few lanes, and along routes between lanes.
template <class Check>
void for_some_routes(Map const& map, Numbers& random, Check const& check) {
  auto const any = [&] { return static_cast<LaneId>(random(0, static_cast<double>(map.lanes().size()) - 1e-9)); };
  for (int i = 0; i < 6; ++i) {
    auto const lane = any();
    CAPTURE(map.describe(lane));
    check(*build_road_corridor(map, straight_route(map, lane, random(0, 1000))));
    auto const reached = map.reachable(lane, 500.0);
    auto const to = reached[static_cast<std::size_t>(random(0, static_cast<double>(reached.size()) - 1e-9))].lane;
    CAPTURE(map.describe(to));
    check(*build_road_corridor(map, *map.shortest_route(lane, to)));
  }
}

/// Valid by Boost.Geometry, holes counter-clockwise as they come.
bool is_valid_polygon(geometry::Polygon const& outer, std::vector<geometry::Polygon> const& holes) {
  geometry::detail::BoostPolygon polygon = geometry::detail::to_boost(outer);
  for (auto const& hole : holes) {
    auto ring = geometry::detail::to_boost(hole).outer();
    std::reverse(ring.begin(), ring.end());
    polygon.inners().push_back(ring);
  }
  return boost::geometry::is_valid(polygon);
}

}  // namespace

TEST_CASE("lanes one behind the other become one corridor, with the step between their widths kept short") {
  std::vector<Lane> lanes;
  auto const a = add_straight(lanes, {0, 0, 0}, 100, 1.5), b = add_straight(lanes, {100, 0, 0}, 200, 2.0);
  link(lanes, a, b);
  auto const map = make_map(lanes);
  auto const road = build_road_corridor(*map, straight_route(*map, a));
  REQUIRE(road->corridors.size() == 1);
  auto const& corridor = road->corridors[0];
  CHECK(lanes_of(corridor) == std::vector<LaneId>{a, b});
  CHECK(corridor.length() == doctest::Approx(300));
  CHECK(corridor.pieces[1].begin == doctest::Approx(100));
  CHECK(corridor.pieces[1].index_offset == doctest::Approx(map->lane(b).index_begin - 100));
  CHECK(corridor.left.length() == doctest::Approx(300.5).epsilon(0.01));
  CHECK_FALSE(corridor.continues);
  for (auto const& [s, width] :
       {std::pair(50.0, 1.5), std::pair(99.9, 1.5), std::pair(100.2, 2.0), std::pair(250.0, 2.0)})
    CHECK(corridor.widths_at(s, corridor.center.find(s)).left == doctest::Approx(width));
  check_laws(*map, *road);
}

TEST_CASE("a gap between two lanes is bridged within a metre or two, and the lane coordinate stays true behind it") {
  std::vector<Lane> lanes;
  auto const a = add_straight(lanes, {0, 0, 0}, 100), b = add_straight(lanes, {100.04, 0.03, 0}, 100),
             c = add_straight(lanes, {200.0, 0.03, 0.01}, 50);
  link(lanes, a, b);
  link(lanes, b, c);
  auto const map = make_map(lanes);
  auto const road = build_road_corridor(*map, straight_route(*map, a));
  check_laws(*map, *road);
  auto const& corridor = road->corridors[0];
  CHECK(corridor.pieces[1].begin == doctest::Approx(100));
  double const on_b = corridor.pieces[1].index_offset + 150.0 - map->lane(b).index_begin;
  CHECK(on_b == doctest::Approx(49.96).epsilon(1e-4));
  CHECK(corridor.center.pose(102.0).y == doctest::Approx(0.03));
  for (auto const& segment : corridor.center.segments()) CHECK(std::abs(segment.uy) < 0.05);
}

TEST_CASE("at a fork the corridor keeps to the route, else it goes the straighter way") {
  std::vector<Lane> lanes;
  auto const a = add_straight(lanes, {0, 0, 0}, 100);
  auto const turns = add_lane(lanes, arc({100, 0, 0}, 0.02, 50)), goes_on = add_straight(lanes, {100, 0, 0}, 100);
  link(lanes, a, turns);
  link(lanes, a, goes_on);
  auto const map = make_map(lanes);
  CHECK(straight_route(*map, a).lanes == std::vector<LaneId>{a, goes_on});
  auto const road = build_road_corridor(*map, route_of(*map, {a, turns}));
  REQUIRE(road->corridors.size() == 1);
  CHECK(lanes_of(road->corridors[0]) == std::vector<LaneId>{a, turns});
  // The lane that parts is seen while it overlaps, at its true place.
  REQUIRE(road->corridors[0].feeders.size() == 1);
  auto const& split = road->corridors[0].feeders[0];
  CHECK(split.lane == goes_on);
  CHECK(split.free_until == never);
  CHECK(split.begin == doctest::Approx(100));
  CHECK(split.index_begin == doctest::Approx(map->lane(goes_on).index_begin));
  CHECK(road->corridors[0].continues == false);
  auto const one = build_road_corridor(*map, route_of(*map, {a}));
  CHECK(one->corridors[0].continues);
}

TEST_CASE("lanes that part split along all lanes of the way, where that is cut into short ones, too") {
  std::vector<Lane> lanes;
  auto const a = add_straight(lanes, {0, 0, 0}, 100);
  auto const exit = add_lane(lanes, arc({100, 0, 0}, -0.005, 60));
  auto const piece = add_straight(lanes, {100, 0, 0}, 10), goes_on = add_straight(lanes, {110, 0, 0}, 100);
  link(lanes, a, exit);
  link(lanes, a, piece);
  link(lanes, piece, goes_on);
  auto const map = make_map(lanes);
  for (auto const& route : {std::vector<LaneId>{a, exit}, std::vector<LaneId>{a, piece, goes_on}}) {
    auto const road = build_road_corridor(*map, route_of(*map, route));
    auto const& conflicts = road->corridors[0].conflicts;
    CHECK(conflicts.size() >= 2);
    for (auto const& conflict : conflicts) CHECK(conflict.kind == OverlapKind::split);
  }
}

TEST_CASE("lanes that have parted and meet again cross, however short the lanes between are") {
  for (double const length : {25.0, 45.0, 70.0}) {
    std::vector<Lane> lanes;
    auto const a = add_straight(lanes, {0, 0, 0}, 100);
    auto const left = add_straight(lanes, {100, 0, 0.5}, length), right = add_straight(lanes, {100, 0, -0.5}, length);
    double const x = 100 + length * std::cos(0.5), y = length * std::sin(0.5);
    auto const down = add_straight(lanes, {x, y, -0.35}, 140), up = add_lane(lanes, arc({x, -y, 0.35}, 0.004, 140));
    link(lanes, a, left);
    link(lanes, a, right);
    link(lanes, left, down);
    link(lanes, right, up);
    auto const map = make_map(lanes);
    auto const road = build_road_corridor(*map, route_of(*map, {a, left, down}));
    auto const& conflicts = road->corridors[0].conflicts;
    CHECK(std::any_of(conflicts.begin(), conflicts.end(), [&](Conflict const& conflict) {
      return conflict.other == up && conflict.kind == OverlapKind::crossing;
    }));
  }
}

TEST_CASE("a corridor follows its route where a lane has two successors side by side") {
  std::vector<Lane> lanes;
  auto const a = add_straight(lanes, {0, 0, 0}, 100);
  auto const left = add_straight(lanes, {100, 0, 0}, 100), right = add_straight(lanes, {100, 0, -0.02}, 100);
  put_beside(lanes, left, right);
  link(lanes, a, left);
  link(lanes, a, right);
  auto const map = make_map(lanes);
  for (auto const& [first, second] : {std::pair(left, right), std::pair(right, left)}) {
    auto const road = build_road_corridor(*map, route_of(*map, {a, first}));
    REQUIRE(road->corridors.size() == 2);
    CHECK(lanes_of(road->corridors[0]) == std::vector<LaneId>{a, first});
    CHECK(lanes_of(road->corridors[1]) == std::vector<LaneId>{second});
    CHECK(index_of(road->main) == 0);
  }
}

TEST_CASE("straight routes end at their length, at a dead end, and before they repeat") {
  auto const map = make_map(ring_of(4, 120));
  std::vector<LaneId> const ring{LaneId{0}, LaneId{1}, LaneId{2}, LaneId{3}};
  CHECK(straight_route(*map, ring[1]).lanes == std::vector<LaneId>{ring[1], ring[2], ring[3], ring[0]});
  CHECK(straight_route(*map, ring[0], 150).lanes.size() == 2);
  CHECK(straight_route(*map, ring[0], 150).length == doctest::Approx(240).epsilon(1e-3));
  CHECK(straight_route(*map, ring[0], 0).lanes.size() == 1);
  CHECK_THROWS_AS((void)straight_route(*map, static_cast<LaneId>(4)), MapError);
  // On a ring the traffic behind the begin is on the corridor's own last lane, that beyond the end on its first one.
  auto const road = build_road_corridor(*map, straight_route(*map, ring[0]));
  REQUIRE(road->corridors[0].feeders.size() == 2);
  auto const &behind = road->corridors[0].feeders[0], &beyond = road->corridors[0].feeders[1];
  CHECK(behind.lane == ring[3]);
  CHECK(behind.begin == doctest::Approx(-100));
  CHECK(behind.end == 0.0);
  CHECK(beyond.lane == ring[0]);
  CHECK(beyond.begin == road->corridors[0].length());
  CHECK(beyond.end == doctest::Approx(beyond.begin + 30.0));
  CHECK_FALSE(beyond.is_still_to_merge());
}

TEST_CASE("lanes beside the route have corridors that know each other, and one that opens later begins its own") {
  std::vector<Lane> lanes;
  std::vector<std::vector<LaneId>> sections;
  for (int k = 0; k < 3; ++k) {  // 2, 3, 2 lanes
    sections.emplace_back();
    for (int i = 0; i < (k == 1 ? 3 : 2); ++i)
      sections.back().push_back(add_straight(lanes, {100.0 * k, -3.5 * i, 0}, 100));
    for (std::size_t i = 0; i + 1 < sections.back().size(); ++i)
      put_beside(lanes, sections.back()[i], sections.back()[i + 1]);
    if (k > 0)
      for (std::size_t i = 0; i < 2; ++i) link(lanes, sections[static_cast<std::size_t>(k - 1)][i], sections.back()[i]);
  }
  auto const map = make_map(lanes);
  auto const road = build_road_corridor(*map, straight_route(*map, sections[0][0]));
  check_laws(*map, *road);
  REQUIRE(road->corridors.size() == 3);
  CHECK(index_of(road->main) == 0);
  for (std::size_t i = 0; i < 2; ++i)
    CHECK(lanes_of(road->corridors[i]) == std::vector<LaneId>{sections[0][i], sections[1][i], sections[2][i]});
  CHECK(lanes_of(road->corridors[2]) == std::vector<LaneId>{sections[1][2]});
  CHECK(index_of(road->corridors[0].pieces[1].right) == 1);
  CHECK(road->corridors[1].pieces[0].right == none<CorridorId>);
  CHECK(index_of(road->corridors[1].pieces[1].right) == 2);
  CHECK(index_of(road->corridors[2].pieces[0].left) == 1);
  CHECK(index_of(road->corridor_of(sections[1][2])) == 2);
  // A lane change is a part of the route: the corridor of its last lane is the main one.
  auto const changes = build_road_corridor(*map, route_of(*map, {sections[0][0], sections[0][1], sections[1][1]}));
  CHECK(index_of(changes->main) == 1);
  CHECK(changes->corridors.size() == 3);
}

TEST_CASE("a lane that merges into its neighbour goes on as that one") {
  std::vector<Lane> lanes;
  auto const stays = add_straight(lanes, {0, 0, 0}, 100);
  auto const ends = add_swinging(lanes);
  auto const after = add_straight(lanes, {100, 0, 0}, 100), after_right = add_straight(lanes, {100, -3.5, 0}, 100);
  put_beside(lanes, stays, ends);
  put_beside(lanes, after, after_right);
  lanes[index_of(ends)].merges_into = stays;
  link(lanes, stays, after);
  link(lanes, ends, after);
  auto const map = make_map(lanes);
  auto const road = build_road_corridor(*map, straight_route(*map, ends));
  check_laws(*map, *road);
  REQUIRE(road->corridors.size() == 3);
  CHECK(lanes_of(road->corridors[0]) == std::vector<LaneId>{stays, after});
  CHECK(lanes_of(road->corridors[1]) == std::vector<LaneId>{ends, after});
  CHECK(index_of(road->main) == 1);                         // it has more of the route
  CHECK(index_of(road->corridors[2].pieces[0].left) == 0);  // the one that was there before
  for (int i = 0; i < 2; ++i) {
    auto const& corridor = road->corridors[static_cast<std::size_t>(i)];
    check_feeder_laws(*map, corridor);
    auto const other = i == 0 ? ends : stays;
    auto const overlap = std::find_if(corridor.feeders.begin(), corridor.feeders.end(),
                                      [](Feeder const& f) { return f.begin == f.free_until; });
    REQUIRE(overlap != corridor.feeders.end());
    CHECK(overlap->lane == other);
    CHECK(overlap->end == doctest::Approx(100).epsilon(0.01));
    for (auto const& f : corridor.feeders) CHECK(f.lane == other);
  }
}

TEST_CASE(
    "a merging lane feeds the corridor on the overlap and from the merge view before it on, through its predecessors") {
  Merge const merge;
  auto const map = make_map(merge.lanes);
  auto const road = build_road_corridor(*map, straight_route(*map, merge.before));
  auto const& corridor = road->corridors[0];
  check_laws(*map, *road);
  check_feeder_laws(*map, corridor);
  auto const& o = map->lane(merge.before).overlaps[0];
  REQUIRE(corridor.feeders.size() == 3);
  auto const &far = corridor.feeders[0], &near = corridor.feeders[1], &overlap = corridor.feeders[2];
  for (auto const& f : corridor.feeders) CHECK(f.free_until == doctest::Approx(o.begin));
  CHECK(overlap.lane == merge.ramp);
  CHECK(overlap.begin == doctest::Approx(o.begin));
  CHECK(overlap.end == doctest::Approx(100.0));
  CHECK(overlap.index_begin == doctest::Approx(map->lane(merge.ramp).index_begin + o.other_begin));
  CHECK(near.lane == merge.ramp);
  CHECK(near.end == doctest::Approx(o.begin));
  CHECK(near.begin == doctest::Approx(o.begin - o.other_begin));
  CHECK(far.lane == merge.approach);
  CHECK(far.end == doctest::Approx(near.begin));
  CHECK(far.begin == doctest::Approx(o.begin - map->options().merge_view));
  CHECK(far.index_end == doctest::Approx(map->lane(merge.approach).index_begin + 500));
  // There and back again.
  CHECK(overlap.image(overlap.index_at(overlap.begin + 1.0)) == doctest::Approx(overlap.begin + 1.0));
}

TEST_CASE("behind the corridor's begin there is traffic too, for a hundred metres and on every lane that leads there") {
  Merge const merge;
  auto const map = make_map(merge.lanes);
  auto const road = build_road_corridor(*map, route_of(*map, {merge.after}));
  auto const& feeders = road->corridors[0].feeders;
  check_feeder_laws(*map, road->corridors[0]);
  REQUIRE(feeders.size() == 3);
  for (auto const& f : feeders) {
    CHECK(f.free_until == never);
    CHECK(f.begin >= -100.0 - 1e-9);
    CHECK(f.end <= 1e-9);
    CHECK(f.end - f.begin == doctest::Approx(f.index_end - f.index_begin));
  }
  CHECK(feeders[0].lane == merge.before);
  CHECK(feeders[1].lane == merge.approach);
  CHECK(feeders[1].end == doctest::Approx(-40).epsilon(0.001));
  CHECK(feeders[2].lane == merge.ramp);
}

TEST_CASE("behind a ring of microns and behind lanes linked crosswise the traffic is found at once") {
  std::vector<Lane> ring;
  auto const only = add_straight(ring, {0, 0, 0}, 2e-5);
  link(ring, only, only);
  auto const round = make_map(ring);
  CHECK(build_road_corridor(*round, straight_route(*round, only))->corridors[0].feeders.size() == 1);
  // 2^30 ways lead through thirty sections.
  std::vector<Lane> crosswise;
  std::vector<LaneId> last;
  for (int i = 0; i < 30; ++i) {
    LaneId const left = add_straight(crosswise, {3.0 * i, 0, 0}, 3),
                 right = add_straight(crosswise, {3.0 * i, -9, 0}, 3);
    for (auto const before : last)
      for (auto const next : {left, right}) link(crosswise, before, next);
    last = {left, right};
  }
  auto const map = make_map(crosswise);
  auto const road = build_road_corridor(*map, route_of(*map, {last.front()}));
  auto const& corridor = road->corridors[0];
  check_feeder_laws(*map, corridor);
  CHECK(corridor.feeders.size() == 2 * 29);
  CHECK(corridor.feeders.front().begin == doctest::Approx(-3.0 * 29));
}

TEST_CASE("a lane that leads in at a right angle feeds the corridor from its joint on") {
  std::vector<Lane> lanes;
  auto const before = add_straight(lanes, {-100, 0, 0}, 100), after = add_straight(lanes, {0, 0, 0}, 100);
  auto const side = add_straight(lanes, {0, -200, 0.5 * geometry::pi}, 200);
  link(lanes, before, after);
  link(lanes, side, after);
  auto const map = make_map(lanes);
  auto const road = build_road_corridor(*map, straight_route(*map, before));
  REQUIRE(road->corridors[0].feeders.size() == 1);
  auto const& f = road->corridors[0].feeders[0];
  CHECK(f.lane == side);
  CHECK(f.free_until == doctest::Approx(100));
  CHECK(f.end == doctest::Approx(100));
  CHECK(f.begin == doctest::Approx(100 - map->options().merge_view));
}

TEST_CASE("a route without lanes, with a lane that is not there, or with a jump is refused in a sentence") {
  Merge const merge;
  auto const map = make_map(merge.lanes);
  CHECK_THROWS_AS((void)build_road_corridor(*map, Route{}), MapError);
  CHECK_THROWS_AS((void)build_road_corridor(*map, Route{{static_cast<LaneId>(99)}, 0.0}), MapError);
  auto const jump = support::error_of([&] {
    (void)build_road_corridor(*map, Route{{merge.approach, merge.after}, 0.0});
  });
  CHECK_MESSAGE(jump.find("neither follows nor is beside") != std::string::npos, jump);
}

TEST_CASE("straight on from every drivable lane of the project's and the corpus' maps the corridors keep their laws") {
  auto const files =
      corpus::some_maps({"DR_CHN_Merging_ZS_partial_v02", "DR_DEU_Merging_MT_v01_centered", "threeway_intersection"});
  CHECK(files.size() >= 3);
  for (auto const& file : files) {
    CAPTURE(file.string());
    auto const map = cambium::load_opendrive(file.string()).map;
    for (auto const& lane : map->lanes()) {
      if (!lane.drivable()) continue;
      auto const road = build_road_corridor(*map, straight_route(*map, lane.id));
      check_laws(*map, *road);
      for (auto const& corridor : road->corridors) check_feeder_laws(*map, corridor);
    }
  }
}

TEST_CASE("positions on a corridor and on its lanes lead to each other, and to the same widths and limits") {
  for_each_real_map([](Map const& map, Numbers& random) {
    for_some_routes(map, random, [&](RoadCorridor const& road) {
      std::size_t wrong = 0;
      for (auto const& corridor : road.corridors)
        for (int i = 0; i < 20; ++i) {
          double const s = random(0, corridor.length());
          auto const at = corridor.lane_at(s);
          auto const& lane = map.lane(at.lane);
          auto const& piece = corridor.pieces[corridor.piece_at(s, {})];
          wrong += at.lane != piece.lane || piece.type != lane.type;
          bool const is_first = corridor.pieces[corridor.piece_at(*corridor.position_of(at), {})].begin == piece.begin;
          if (is_first) wrong += !(std::abs(*corridor.position_of(at) - s) < 1e-6);
          if (s - piece.begin < 2.5) continue;  // where gaps are bridged
          wrong += !((lane.path.pose(at.s).position() - corridor.center.pose(s).position()).norm() < 0.02);
          double const width = lane.widths_at(at.s).left + lane.widths_at(at.s).right;
          wrong += !(std::abs(corridor.width_at(s) - width) < 0.04);
          wrong += corridor.speed_limit_at(s) != lane.speed_limit_at(at.s) &&
                   corridor.speed_limit_at(s + 0.02) != lane.speed_limit_at(at.s + 0.02);
          wrong += corridor.length_until_end(s) != corridor.length() - s;
        }
      CHECK(wrong == 0);
      CHECK(road.corridors[0].length_until_end(road.corridors[0].length() + 5) == 0.0);
      CHECK_FALSE(road.corridors[0].position_of({none<LaneId>, 0}).has_value());
    });
  });
}

TEST_CASE("a corridor's limit changes where its lanes' limits do, and is none where none has any") {
  std::vector<Lane> lanes;
  auto const a = add_straight(lanes, {0, 0, 0}, 100), b = add_straight(lanes, {100, 0, 0}, 100),
             c = add_straight(lanes, {200, 0, 0}, 100);
  link(lanes, a, b);
  link(lanes, b, c);
  auto const plain = make_map(lanes);
  CHECK(build_road_corridor(*plain, straight_route(*plain, a))->corridors[0].speed_limits.empty());
  lanes[index_of(a)].speed_limits = {{0, 30}, {40, 20}};
  lanes[index_of(b)].speed_limits = {{0, 20}, {70, 10}};
  auto const map = make_map(lanes);
  auto const road = build_road_corridor(*map, straight_route(*map, a));
  double const infinity = -never;
  CHECK(road->corridors[0].speed_limits == std::vector<SpeedStep>{{0, 30}, {40, 20}, {170, 10}, {200, infinity}});
}

TEST_CASE("the ground of corridors and roads is made of valid polygons that hold what is in the lanes, and no more") {
  for_each_real_map([](Map const& map, Numbers& random) {
    for_some_routes(map, random, [&](RoadCorridor const& road) {
      std::vector<std::vector<geometry::Polygon>> grounds;
      std::size_t invalid = 0, missed = 0, beyond = 0;
      for (auto const& corridor : road.corridors) {
        grounds.push_back(area_of(corridor));
        for (auto const& polygon : grounds.back()) invalid += !is_valid_polygon(polygon, {});
      }
      auto const ground = area_of(road);
      for (auto const& area : ground) invalid += !is_valid_polygon(area.outer, area.holes);
      CHECK(invalid == 0);
      for (std::size_t i = 0; i < road.corridors.size(); ++i) {
        auto const& corridor = road.corridors[i];
        for (int k = 0; k < 10; ++k) {
          double const s = random(0.01, 0.99) * corridor.length();
          auto const sides = corridor.widths_at(s);
          if (sides.left + sides.right < 0.5) continue;
          auto const pose = corridor.center.pose(s);
          auto const at = [&pose](double t) {
            return Point(pose.x - t * std::sin(pose.heading), pose.y + t * std::cos(pose.heading));
          };
          auto const holds = [](auto const& areas, Point const& p) {
            return std::any_of(areas.begin(), areas.end(), [&p](auto const& area) { return area.contains(p); });
          };
          Point const inside = at(random(-sides.right + 0.1, sides.left - 0.1));
          missed += !holds(grounds[i], inside) || !holds(ground, inside);
          Point const outside = at(sides.left + 0.5);
          if (map.lanes_near(outside, 0.3).empty()) beyond += holds(grounds[i], outside) || holds(ground, outside);
        }
      }
      CHECK(missed == 0);
      CHECK(beyond == 0);
    });
  });
}

TEST_CASE("the ground of a lane leaves out the inner fold of a curve tighter than half the lane's width") {
  std::vector<Lane> lanes;
  auto samples = arc({0, 0, 0}, 0.0, 10, 0.5);
  auto const bend = arc({10, 0, 0}, 1.0, 0.5 * geometry::pi, 0.05),
             rest = arc({11, 1, 0.5 * geometry::pi}, 0.0, 10, 0.5);
  samples.insert(samples.end(), bend.begin() + 1, bend.end());
  samples.insert(samples.end(), rest.begin() + 1, rest.end());
  auto const id = add_lane(lanes, samples);
  auto const ground = area_of(lanes[index_of(id)]);
  REQUIRE(ground.size() == 1);
  CHECK(ground[0].is_simple());
  CHECK(is_valid_polygon(ground[0], {}));
  // Two straight parts and the outer quarter disc; the inner corner, 0.75 m square, is in both straight parts.
  double const expected = 2 * 10 * 3.5 + 0.25 * geometry::pi * 2.75 * 2.75 - 0.75 * 0.75;
  CHECK(ground[0].area() == doctest::Approx(expected).epsilon(0.02));
}

TEST_CASE("a lane that runs over itself has several polygons, a stretch of it one, and no stretch none") {
  std::vector<Lane> lanes;
  auto const id = add_lane(lanes, arc({0, 0, 0}, 1.0 / 30, 2.5 * geometry::pi * 30, 1.0));
  auto const& lane = lanes[index_of(id)];
  auto const ground = area_of(lane);
  REQUIRE(ground.size() == 2);
  double area = 0.0;
  for (auto const& polygon : ground) {
    CHECK(is_valid_polygon(polygon, {}));
    area += polygon.area();
  }
  CHECK(area == doctest::Approx(lane.length() * 3.5).epsilon(1e-3));
  auto const part = area_of(lane, {10, 20});
  REQUIRE(part.size() == 1);
  CHECK(part[0].area() == doctest::Approx(35).epsilon(1e-2));
  CHECK(area_of(lane, {20, 20}).empty());
  CHECK(area_of(lane, {30, 20}).empty());
  CHECK_THROWS_AS((void)area_of(lane, {std::nan(""), 20}), MapError);
  // The union has a hole in its middle.
  auto const all = geometry::union_of(ground);
  REQUIRE(all.size() == 1);
  CHECK(all[0].holes.size() == 1);
  CHECK_FALSE(all[0].contains({0, 30}));
  CHECK(all[0].contains({0, 0}));
}

TEST_CASE("the nearest corridor is the one that holds a place, by direction where several do, and else the nearest") {
  std::vector<Lane> lanes;
  auto const left = add_straight(lanes, {0, 0, 0}, 100), right = add_straight(lanes, {0, -3.5, 0}, 100);
  put_beside(lanes, left, right);
  auto const map = make_map(lanes);
  auto const road = build_road_corridor(*map, straight_route(*map, left));
  auto const at = nearest_corridor(*road, Pose{50, -1.5, 0.1});
  CHECK(index_of(at.corridor) == 0);
  CHECK(at.s == doctest::Approx(50));
  CHECK(at.lateral == doctest::Approx(-1.5));
  CHECK(at.heading_error == doctest::Approx(0.1));
  CHECK(index_of(nearest_corridor(*road, Point(50, -2.0)).corridor) == 1);
  CHECK(index_of(nearest_corridor(*road, Point(50, 30.0)).corridor) == 0);
  CHECK(index_of(nearest_corridor(*road, Point(-7, -30.0)).corridor) == 1);
  CHECK(nearest_corridor(*road, Point(50, -2.0)).heading_error == 0.0);
  CHECK(nearest_corridor(RoadCorridor{}, Point(0, 0)).corridor == none<CorridorId>);
  CHECK(road->lanes() == std::vector<LaneId>{left, right});
  // Two ways from one place: the direction decides.
  std::vector<Lane> fork;
  auto const a = add_straight(fork, {0, 0, 0}, 50), straight = add_straight(fork, {50, 0, 0}, 50),
             turns = add_straight(fork, {50, 0, 0.3}, 50);
  link(fork, a, straight);
  link(fork, a, turns);
  auto const forked = make_map(fork);
  RoadCorridor both;
  for (auto const next : {straight, turns})
    both.corridors.push_back(build_road_corridor(*forked, route_of(*forked, {a, next}))->corridors[0]);
  CHECK(index_of(nearest_corridor(both, Pose{53, 0.3, 0.02}).corridor) == 0);
  CHECK(index_of(nearest_corridor(both, Pose{53, 0.3, 0.31}).corridor) == 1);
}

TEST_CASE("a road corridor is found from a pose to a point or a polygon") {
  auto const map = support::own_map("merging.xodr");
  auto const ramp = map->find_lane("2", 10, -1);
  auto const start = map->lane(ramp).path.pose(5.0);
  auto const way = straight_route(*map, ramp);
  auto const& last = map->lane(way.lanes.back());
  auto const goal = last.path.pose(0.5 * last.length()).position();
  auto const to_point = build_road_corridor(*map, start, goal);
  CHECK(to_point->route.front() == ramp);
  CHECK(to_point->route.back() == last.id);
  geometry::Polygon const area({goal + Point(-3, -3), goal + Point(3, -3), goal + Point(3, 3), goal + Point(-3, 3)});
  auto const to_area = build_road_corridor(*map, start, area);
  CHECK(map->lane(to_area->route.back()).road == last.road);
  CHECK_THROWS_AS((void)build_road_corridor(*map, Pose{1e5, 1e5, 0}, goal), MapError);
  CHECK_THROWS_AS((void)build_road_corridor(*map, start, Point(1e5, 1e5)), MapError);
  CHECK_THROWS_AS((void)build_road_corridor(*map, map->lane(last.id).path.pose(10), start.position()), MapError);
}

TEST_CASE("a start in the polygon of its goal is there already") {
  std::vector<Lane> lanes;
  auto const lane = add_straight(lanes, {0, 0, 0}, 100);
  Map::Parts parts;
  parts.lanes = lanes;
  parts.roads.emplace_back().id = lanes.front().road;
  Map const map(std::move(parts));
  geometry::Polygon const area({{40, -3}, {60, -3}, {60, 3}, {40, 3}});
  for (double const x : {20.0, 40.5, 50.0, 59.5})
    CHECK(build_road_corridor(map, Pose{x, 0.5, 0}, area)->route == std::vector<LaneId>{lane});
  CHECK_THROWS_AS((void)build_road_corridor(map, Pose{61, 0, 0}, area), MapError);
}

TEST_CASE("a road corridor is found along roads in either direction") {
  int several = 0, backward = 0;
  for_each_real_map([&](Map const& map, Numbers& random) {
    for_some_routes(map, random, [&](RoadCorridor const& road) {
      // What a route from end to end passes is found again by its roads' names.
      auto const names = road_names(map, road.route);
      std::set<std::string> const distinct(names.begin(), names.end());
      if (distinct.size() != names.size() || names.size() > 6) return;
      auto const direction = map.lane(road.route.front()).along_road ? RoadDirection::forward : RoadDirection::backward;
      std::shared_ptr<RoadCorridor const> found;
      try {
        found = build_road_corridor(map, names, direction);
      } catch (MapError const&) {  // a lane that begins or ends amid its road
        return;
      }
      CHECK(road_names(map, found->route) == names);
      several += names.size() > 2;
      backward += direction == RoadDirection::backward;
      CHECK(map.lane(found->route.front()).along_road == (direction == RoadDirection::forward));
    });
  });
  if (corpus::root()) {
    CHECK(several > 20);
    CHECK(backward > 20);
  }
  auto const map = support::own_map("merging.xodr");
  std::vector<std::string> const none_there{"77"}, back{"1", "2"};
  CHECK_THROWS_AS((void)build_road_corridor(*map, none_there, RoadDirection::forward), MapError);
  CHECK_THROWS_AS((void)build_road_corridor(*map, back, RoadDirection::forward), MapError);
  CHECK_THROWS_AS((void)build_road_corridor(*map, std::vector<std::string>{}, RoadDirection::forward), MapError);
}

TEST_CASE("a route that leads round to its start's lane has a corridor, too") {
  auto const map = make_map(ring_of(3, 100));
  std::vector<LaneId> const ring{LaneId{0}, LaneId{1}, LaneId{2}, LaneId{0}};
  auto const road = build_road_corridor(*map, route_of(*map, ring));
  CHECK(road->corridors[0].length() == doctest::Approx(400).epsilon(1e-3));
  CHECK(*road->corridors[0].position_of({ring[0], 20}) == doctest::Approx(20).epsilon(1e-3));
  CHECK(road->corridors[0].lane_at(320).lane == ring[0]);
  CHECK(road->corridors[0].lane_at(320).s == doctest::Approx(20).epsilon(1e-2));
  CHECK(area_of(road->corridors[0]).size() == 2);
}

TEST_CASE("on the merging map the on-ramp's traffic is seen from the main road, and the other way round") {
  auto const map = support::own_map("merging.xodr");
  auto const main = map->find_lane("1", 10, -2), ramp = map->find_lane("2", 10, -1);
  auto const from_main = build_road_corridor(*map, straight_route(*map, main));
  auto const from_ramp = build_road_corridor(*map, straight_route(*map, ramp));
  auto const& main_corridor = from_main->corridors[from_main->main];
  auto const merges = [](LaneCorridor const& c) {
    return std::find_if(c.feeders.begin(), c.feeders.end(), [](Feeder const& f) { return f.free_until == f.begin; });
  };
  auto const& ramp_corridor = from_ramp->corridors[from_ramp->main];
  auto const on_main = merges(main_corridor), on_ramp = merges(ramp_corridor);
  REQUIRE(on_main != main_corridor.feeders.end());
  REQUIRE(on_ramp != ramp_corridor.feeders.end());
  CHECK(from_ramp->corridor_of(on_ramp->lane) != none<CorridorId>);
  CHECK(map->lane(on_main->lane).merges_into == on_ramp->lane);
  // The same place seen from both: where each one's overlap begins, the paths are the clearance apart.
  auto const a = main_corridor.center.pose(on_main->begin), b = ramp_corridor.center.pose(on_ramp->begin);
  CHECK((a.position() - b.position()).norm() == doctest::Approx(map->options().overlap_clearance).epsilon(0.02));
}

TEST_CASE("a list of roads may come to a road again") {
  auto const map = support::own_map("roundabout.xodr");
  using Names = std::vector<std::string>;
  auto const forward = cambium::map::RoadDirection::forward;
  for (auto const& names : {Names{"11", "201", "12", "301", "13", "401", "14", "101", "11"},
                            Names{"1", "103", "11", "201", "12", "301", "13", "401", "14", "101", "11", "202", "2"},
                            Names{"11", "201", "12", "301", "13", "401", "14", "101"}, Names{"11"}}) {
    auto const road = build_road_corridor(*map, names, forward);
    CHECK(road_names(*map, road->route) == names);
    check_laws(*map, *road);
    for (auto const& corridor : road->corridors) check_feeder_laws(*map, corridor);
    double length = 0.0;
    for (auto const lane : road->route) length += map->lane(lane).length();
    CHECK(road->corridors[road->main].length() == doctest::Approx(length).epsilon(0.01));
  }
  CHECK_THROWS_AS((void)build_road_corridor(*map, Names{"11", "12"}, forward), MapError);
  CHECK_THROWS_AS((void)build_road_corridor(*map, Names{"11", "11"}, forward), MapError);
}

TEST_CASE("centre lines do not go back where a lane is shorter than the file's rounding") {
  using namespace road_text;
  auto const linked = [](road_text::Road road, std::string const& before, std::string const& behind) {
    road.before = before;
    road.behind = behind;
    road.sections[0].lanes[0].before = {-1};
    road.sections[0].lanes[0].behind = {-1};
    return road;
  };
  auto const map = load(file({linked({.id = "1"}, "", to_start("2")),
                              linked({.id = "2", .x = 99.999, .length = 2e-5}, to_end("1"), to_start("3")),
                              linked({.id = "3", .x = 100.0}, to_end("2"), "")}))
                       .map;
  auto const road = build_road_corridor(*map, straight_route(*map, map->find_lane("1", 50, -1)));
  REQUIRE(road->corridors[0].pieces.size() == 3);
  CHECK(road->corridors[0].length() == doctest::Approx(200.0));
  for (auto const& segment : road->corridors[0].center.segments()) CHECK(segment.ux > 0.99);
}

TEST_CASE("centre lines on the corpus' maps go forward everywhere") {
  int segments = 0;
  bool const is_there = for_each_corpus_map([&segments](auto const& file, Map const& map) {
    for (auto const& lane : map.lanes()) {
      // Of lanes that others lead to, which are mostly in the roads of those, a fifth as a sample; all of them by
      // CAMBIUM_SCALE=5.
      bool const is_sampled = index_of(lane.id) % 25 < support::runs(lane.predecessors.empty() ? 25 : 5);
      if (!lane.drivable() || !is_sampled) continue;
      auto const road = build_road_corridor(map, straight_route(map, lane.id));
      for (auto const& segment : road->corridors[road->main].center.segments()) {
        ++segments;
        double const forward = segment.ux * std::cos(segment.heading) + segment.uy * std::sin(segment.heading);
        if (forward <= 0.0) FAIL_CHECK(file.filename().string() << ": " << map.describe(lane.id));
      }
    }
  });
  if (is_there) CHECK(segments > 0.2 * std::min(support::runs(500'000), 500'000u));
}
