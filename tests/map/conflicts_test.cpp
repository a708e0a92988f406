// Laws of what corridors say of conflicts, on all junctions of some maps.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "../support/corpus.hpp"
#include "../support/maps.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/core/random.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/collision.hpp"
#include "cambium/map/building/map_builder.hpp"
#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/map/corridor/detail/conflict_ways.hpp"
#include "cambium/map/map.hpp"

using namespace cambium;

namespace {

std::vector<std::pair<std::string, std::shared_ptr<Map const>>> junction_maps() {
  std::vector<std::pair<std::string, std::shared_ptr<Map const>>> maps;
  for (std::string const name : {"intersection_3way", "intersection_4way", "roundabout"})
    maps.emplace_back(name, support::own_map(name + ".xodr"));
  for (std::string const name : {"4way_intersection", "fabriksgatan", "multi_intersections", "parking_demo",
                                 "route_strategy_test_road", "simple_3way_intersection_lht", "threeway_intersection"})
    if (auto map = support::corpus_map(name + ".xodr")) maps.emplace_back(name, std::move(map));
  return maps;
}

/// A junction's lane within a corridor straight through the junction.
struct Passage {
  std::shared_ptr<map::RoadCorridor const> road;
  map::LaneCorridor const* corridor = nullptr;
  map::CorridorPiece const* piece = nullptr;

  /// The conflicts of the lane.
  [[nodiscard]] std::vector<map::Conflict const*> conflicts() const {
    std::vector<map::Conflict const*> found;
    for (auto const& conflict : corridor->conflicts)
      if (conflict.lane_end == piece->end && conflict.kind == map::OverlapKind::crossing) found.push_back(&conflict);
    return found;
  }
};

std::map<LaneId, Passage> passages(Map const& map) {
  std::map<LaneId, Passage> all;
  for (auto const& lane : map.lanes()) {
    if (!lane.drivable() || !is_valid(map.road(lane.road).junction)) continue;
    map::Route route{{lane.id}, lane.length()};
    for (double back = 0.0; back < 60.0 && !map.lane(route.lanes.front()).predecessors.empty();) {
      auto const before = map.lane(route.lanes.front()).predecessors.front();
      if (std::find(route.lanes.begin(), route.lanes.end(), before) != route.lanes.end()) break;
      route.lanes.insert(route.lanes.begin(), before);
      back += map.lane(before).length();
    }
    auto const ahead = map::straight_route(map, lane.id, lane.length() + 60.0);
    for (std::size_t i = 1; i < ahead.lanes.size(); ++i) {
      if (std::find(route.lanes.begin(), route.lanes.end(), ahead.lanes[i]) != route.lanes.end()) break;
      route.lanes.push_back(ahead.lanes[i]);
    }
    Passage passage{map::build_road_corridor(map, route)};
    for (auto const& corridor : passage.road->corridors)
      for (auto const& piece : corridor.pieces)
        if (piece.lane == lane.id) passage.corridor = &corridor, passage.piece = &piece;
    REQUIRE(passage.piece);
    all.emplace(lane.id, std::move(passage));
  }
  return all;
}

/// How far two vehicles' ideas of one zone are apart: `zone` of a corridor in which the lane begins at `begin`, and
/// `theirs` of the other's, in which theirs begins at `their_begin` [m].
double apart(map::ConflictZone const& zone, double begin, map::ConflictZone const& theirs, double their_begin) {
  return std::max({std::abs(zone.begin - begin - theirs.other_begin), std::abs(zone.end - begin - theirs.other_end),
                   std::abs(zone.other_begin - (theirs.begin - their_begin)),
                   std::abs(zone.other_end - (theirs.end - their_begin))});
}

}  // namespace

TEST_CASE("two vehicles whose ways cross know of the same zones") {
  for (auto const& [name, map] : junction_maps()) {
    CAPTURE(name);
    auto const all = passages(*map);
    std::size_t zones = 0;
    for (auto const& [lane, passage] : all)
      for (auto const* conflict : passage.conflicts()) {
        auto const other = all.find(conflict->other);
        if (other == all.end()) continue;  // outside of junctions
        auto const theirs = other->second.conflicts();
        for (std::size_t sizes = 0; sizes < 4; ++sizes) {
          auto const& zone = conflict->zones[sizes / 2][sizes % 2];
          if (zone.empty()) continue;
          double best = std::numeric_limits<double>::infinity();
          for (auto const* candidate : theirs)
            if (candidate->other == lane)
              best = std::min(best, apart(zone, -passage.piece->lane_offset, candidate->zones[sizes % 2][sizes / 2],
                                          -other->second.piece->lane_offset));
          CAPTURE(index_of(lane));
          CAPTURE(index_of(conflict->other));
          CHECK(best < 1.1);  // they are found in steps of 0.5 m
          ++zones;
        }
      }
    if (name != "roundabout") CHECK(zones > 20);
  }
}

TEST_CASE("bodies touch only within the zones of a conflict, and each place where they touch has one") {
  RandomStream random(5, 0, 0);
  for (auto const& [name, map] : junction_maps()) {
    CAPTURE(name);
    auto const all = passages(*map);
    int touching = 0;
    for (auto const& [lane, passage] : all) {
      auto const conflicts = passage.conflicts();
      for (auto const* conflict : conflicts)
        for (int i = 0; i < 60; ++i) {
          bool const large = i % 2 == 1, other_large = i % 4 > 1;
          auto const shape = large ? geometry::truck() : geometry::car(),
                     other_shape = other_large ? geometry::bus() : geometry::van();
          auto const& other = map->lane(conflict->other);
          double const s = passage.piece->begin + uniform01(random) * (passage.piece->end - passage.piece->begin);
          double const at = uniform01(random) * other.length();
          if (!geometry::intersects(geometry::box_of(shape, passage.corridor->center.pose(s)),
                                    geometry::box_of(other_shape, other.path.pose(at))))
            continue;
          ++touching;
          CHECK(std::any_of(conflicts.begin(), conflicts.end(), [&](map::Conflict const* c) {
            auto const& zone = c->zones[large][other_large];
            return c->other == other.id && s >= zone.begin && s <= zone.end && at >= zone.other_begin &&
                   at <= zone.other_end;
          }));
        }
    }
    if (name != "roundabout") CHECK(touching > 50);
  }
}

TEST_CASE("where smaller bodies touch at places apart within the zone of the largest, each place is a zone") {
  auto const map = support::corpus_map("libopendrive_test.xodr");
  if (!map) return;
  int places = 0;
  for (auto const& lane : map->lanes()) {
    if (!lane.drivable() || !is_valid(map->road(lane.road).junction)) continue;
    auto const road = map::build_road_corridor(*map, map::Route{{lane.id}, lane.length()});
    auto const& conflicts = road->corridors[road->main].conflicts;
    for (std::size_t j = 0; j < conflicts.size(); ++j)
      for (std::size_t i = 0; i < j; ++i) {
        auto const &a = conflicts[i], &b = conflicts[j];
        if (a.other != b.other || a.hull().begin != b.hull().begin || a.hull().end != b.hull().end) continue;
        for (auto const& [own, other] : {std::pair(0u, 0u), {0u, 1u}, {1u, 0u}}) {
          auto const &first = a.zones[own][other], &second = b.zones[own][other];
          if (first.empty() || second.empty()) continue;
          ++places;
          CHECK(std::max(second.begin - first.end, first.begin - second.end) >= 5.0);
          CHECK(std::max(second.other_begin - first.other_end, first.other_begin - second.other_end) >= 5.0);
        }
      }
  }
  CHECK(places > 0);
}

TEST_CASE("where lanes cross before they end in one, the right of way decides who follows whom") {
  // Two lanes turn sharply, from the left and from the right, into one.
  map::MapBuilder builder;
  constexpr double quarter = 0.5 * geometry::pi;
  auto const turn = [](double radius, double sign) {
    return std::vector<map::Geometry>(
        map::lay_to({0.0, 0.0, quarter}, {{40.0}, {radius * quarter, sign / radius, sign / radius}}));
  };
  auto const lane = map::equal_lanes(1, 2.5);
  builder.add_road({.id = "left", .line = turn(0.75, 1.0), .sections = {{.right = lane}}});
  builder.add_road({.id = "right", .line = turn(3.25, -1.0), .sections = {{.right = lane}}});
  builder.add_road({.id = "out", .line = map::lay_from({0.0, 0.0, quarter}, {{60.0}}), .sections = {{.right = lane}}});
  for (char const* from : {"left", "right"})
    builder.connect({from, map::opendrive::ContactPoint::end}, {"out", map::opendrive::ContactPoint::start});
  auto const map = builder.build();
  auto const left = map->find_lane("left", 1.0, -1), right = map->find_lane("right", 1.0, -1);
  for (auto const& [own, other] : {std::pair(left, right), {right, left}}) {
    auto const road = map::build_road_corridor(*map, map::straight_route(*map, own));
    auto const& corridor = road->corridors[road->main];
    CHECK(std::ranges::any_of(corridor.conflicts, [&, other = other](map::Conflict const& conflict) {
      return conflict.other == other && conflict.kind == map::OverlapKind::crossing;
    }));
    CHECK(std::ranges::any_of(corridor.feeders, [&, other = other](map::Feeder const& feeder) {
      return feeder.lane == other && feeder.is_still_to_merge() && feeder.by_rule;
    }));
  }
}

TEST_CASE("conflicts are in the order in which one has to wait for them, and know how far those before reach") {
  for (auto const& [name, map] : junction_maps())
    for (auto const& [lane, passage] : passages(*map)) {
      double hold = -std::numeric_limits<double>::infinity(), end = hold;
      for (auto const& conflict : passage.corridor->conflicts) {
        end = std::max(end, conflict.hull().end);
        CHECK(conflict.first_hold() >= hold);
        CHECK(conflict.first_hold() <= conflict.hull().begin);
        CHECK(conflict.farthest_end == end);
        hold = conflict.first_hold();
      }
    }
}

// A section's place is clear of all zones, of those of other sections, too; and so is a refuge of those that are
// yielded to oncoming traffic.
TEST_CASE("where one waits for a section one is in nobody's way") {
  int sections = 0, refuges = 0;
  for (auto const& [name, map] : junction_maps())
    for (auto const& [lane, passage] : passages(*map)) {
      CAPTURE(name);
      auto const& conflicts = passage.corridor->conflicts;
      for (std::size_t own : {0u, 1u})
        for (std::size_t others : {0u, 1u}) {
          double const front = own ? geometry::truck().front : geometry::car().front;
          auto const zone = [=](map::Conflict const& c) {
            auto whole = c.zones[own][0];
            if (others == 0 || c.zones[own][1].empty()) return whole;
            whole.begin = std::min(whole.begin, c.zones[own][1].begin);
            whole.end = std::max(whole.end, c.zones[own][1].end);
            return whole;
          };
          for (auto const& conflict : conflicts) {
            auto const& section = conflict.section[own][others];
            if (section.number == map::ConflictSection::none) {
              CHECK((conflict.kind == map::OverlapKind::split || zone(conflict).empty()));
              continue;
            }
            ++sections;
            double const place = section.place_to_wait(front, false), refuge = section.place_to_wait(front, true);
            CHECK(refuge >= place);
            refuges += refuge > place;
            CHECK(refuge <= zone(conflict).begin);
            for (auto const& c : conflicts) {
              if (c.section[own][others].number == map::ConflictSection::none) continue;
              CHECK_FALSE((place > zone(c).begin && place < zone(c).end));
              bool const is_same = c.section[own][others].number == section.number;
              if (is_same) CHECK(c.section[own][others].place_to_wait(front, false) == place);
            }
          }
        }
    }
  CHECK(sections > 100);
  CHECK(refuges > 0);
}

TEST_CASE("nobody comes to a conflict faster than the bends before it permit") {
  for (auto const& [name, map] : junction_maps())
    for (auto const& [lane, passage] : passages(*map))
      for (auto const* const conflict : passage.conflicts())
        for (auto const& way : conflict->ways) {
          CAPTURE(name);
          double const length = way.index_end - way.index_begin;
          CHECK(way.time_from_begin >= way.time_from_end);
          CHECK(way.time_from_begin <= way.time_from_end + length / 1.5);  // the sharpest bends of 0.75 m
          CHECK(way.time_from(way.begin) == doctest::Approx(std::max(0.0, way.time_from_begin)));
          CHECK(way.time_from(way.begin + length) == doctest::Approx(std::max(0.0, way.time_from_end)));
        }
}

TEST_CASE("from each place on a conflict's lane the shortest time there is that of the fastest, to 0.2 s") {
  double most = 0.0, longest = 0.0;
  for (auto const& [name, map] : junction_maps())
    for (auto const& [lane, passage] : passages(*map))
      for (auto const* const conflict : passage.conflicts()) {
        auto const& other = map->lane(conflict->other);
        auto const& way = conflict->ways.front();
        double const meets = std::clamp(conflict->hull().other_begin, 0.0, other.length());
        for (double s = way.begin; s < other.length(); s += 2.0) {
          map::detail::FastestArrival fastest;
          fastest.go_back(other.path, s, meets);
          most = std::max(most, way.time_from(s) - fastest.time);
          longest = std::max(longest, fastest.time);
          if (s >= meets) CHECK(way.time_from(s) == 0.0);
        }
      }
  CHECK(most < 0.2);
  CHECK(longest > 1.0);
}

// Signs or priorities of a street with traffic both ways; a roundabout's ring is no such street.
TEST_CASE("who comes from a minor road waits for longer gaps, who enters a roundabout does not") {
  auto const count = [](char const* name) {
    auto const map = support::own_map(name);
    std::size_t minor = 0, yields = 0;
    for (auto const& [lane, passage] : passages(*map))
      for (auto const& conflict : passage.corridor->conflicts) {
        minor += conflict.from_minor_road;
        yields += conflict.right_of_way == map::RightOfWay::yields;
        if (conflict.from_minor_road) CHECK(conflict.right_of_way == map::RightOfWay::yields);
      }
    REQUIRE(yields > 0);
    return minor;
  };
  CHECK(count("intersection_3way.xodr") > 0);
  CHECK(count("roundabout.xodr") == 0);
}
