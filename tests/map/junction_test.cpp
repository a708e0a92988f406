#include "cambium/map/lanes/junction.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "cambium/map/lanes/right_of_way.hpp"
#include "corpus_maps.hpp"
#include "lanes_by_hand.hpp"
#include "../support/maps.hpp"

using namespace by_hand;

namespace {

/// A crossing of two lanes, and a third that merges into the first, in junction 0.
struct Crossing {
  LaneId across, along, joins, after;
  std::shared_ptr<Map const> map;

  Crossing() {
    std::vector<Lane> lanes;
    along = add_straight(lanes, {-50, 0, 0}, 100);
    across = add_straight(lanes, {0, -30, 0.5 * geometry::pi}, 60);
    auto samples = arc({50, 0, geometry::pi}, 1.0 / 100, 40, 0.5);  // backwards from where it joins
    std::reverse(samples.begin(), samples.end());
    for (auto& p : samples) p.heading -= geometry::pi;
    joins = add_lane(lanes, samples);
    after = add_straight(lanes, {50, 0, 0}, 50);
    link(lanes, along, after);
    link(lanes, joins, after);
    find_overlaps(lanes, {}, 2.5);
    Map::Parts parts;
    Junction junction{static_cast<JunctionId>(0), "j", {}, {along, across, joins}, {}};
    for (std::size_t i = 0; i < lanes.size(); ++i) {
      Road road;
      road.id = static_cast<RoadId>(i);
      if (i < 3) {
        road.junction = junction.id;
        junction.roads.push_back(road.id);
      }
      parts.roads.push_back(std::move(road));
    }
    junction.priorities.push_back({map_road(lanes, along), map_road(lanes, joins)});
    parts.lanes = std::move(lanes);
    parts.junctions = {junction, {static_cast<JunctionId>(1), "empty", {}, {}, {}}};
    map = std::make_shared<Map const>(std::move(parts));
  }

  static RoadId map_road(std::vector<Lane> const& lanes, LaneId lane) { return lanes[index_of(lane)].road; }
};

}  // namespace

TEST_CASE("lanes of a junction conflict where they cross and merge, on the ground that both cover") {
  Crossing const crossing;
  auto const conflicts = conflict_areas(*crossing.map, static_cast<JunctionId>(0));
  REQUIRE(conflicts.size() == 2);
  auto const& cross = conflicts[0];
  CHECK(cross.first == crossing.along);
  CHECK(cross.second == crossing.across);
  CHECK(cross.kind == OverlapKind::crossing);
  CHECK(cross.on_first.begin == doctest::Approx(47.5).epsilon(1e-3));
  CHECK(cross.on_second.end == doctest::Approx(32.5).epsilon(1e-3));
  REQUIRE(cross.area.has_value());
  CHECK(cross.area->area() == doctest::Approx(3.5 * 3.5));
  CHECK(cross.area->contains({1.7, -1.7}));
  auto const& merge = conflicts[1];
  CHECK(merge.second == crossing.joins);
  CHECK(merge.kind == OverlapKind::merge);
  CHECK(merge.on_first.end == doctest::Approx(100));
  REQUIRE(merge.area.has_value());
  CHECK(merge.area->contains({49.9, 0}));
  CHECK_FALSE(merge.area->contains({20, 0}));
}

TEST_CASE("priorities say who goes first, or nothing where there are none") {
  Crossing const crossing;
  auto const& junction = crossing.map->junctions()[0];
  auto const road = [&](LaneId lane) { return crossing.map->lane(lane).road; };
  CHECK(goes_first(junction, road(crossing.joins), road(crossing.along)) == road(crossing.along));
  CHECK(goes_first(junction, road(crossing.along), road(crossing.joins)) == road(crossing.along));
  CHECK_FALSE(goes_first(junction, road(crossing.along), road(crossing.across)).has_value());
}

TEST_CASE("a junction without connecting roads has no area and no conflicts; one that is not there is an error") {
  Crossing const crossing;
  auto const empty = static_cast<JunctionId>(1);
  CHECK_FALSE(junction_area(*crossing.map, empty).has_value());
  CHECK(conflict_areas(*crossing.map, empty).empty());
  CHECK_THROWS_AS((void)junction_area(*crossing.map, static_cast<JunctionId>(2)), MapError);
  CHECK_THROWS_AS((void)conflict_areas(*crossing.map, none<JunctionId>), MapError);
}

TEST_CASE("on real maps junctions know their roads, and their area holds every border point of these") {
  std::size_t junctions = 0, without = 0;
  bool const is_there = for_each_corpus_map([&](auto const&, Map const& map) {
    std::set<std::string> names;
    for (auto const& junction : map.junctions()) {
      ++junctions;
      CHECK(&map.junction(junction.id) == &junction);
      CHECK(names.insert(junction.name).second);
      std::size_t lanes = 0, outside = 0;
      for (auto const road : junction.roads) CHECK(map.road(road).junction == junction.id);
      for (auto const& lane : map.lanes()) lanes += map.road(lane.road).junction == junction.id;
      CHECK(lanes == junction.lanes.size());
      auto const area = junction_area(map, junction.id);
      CHECK(area.has_value() == !junction.lanes.empty());
      without += !area;
      for (auto const id : junction.lanes)
        for (auto const* border : {&map.lane(id).left, &map.lane(id).right})
          for (auto const& p : border->points()) outside += !area->contains(p) && area->distance_to_border(p) > 1e-6;
      CHECK(outside == 0);
    }
  });
  if (is_there) {
    CHECK(junctions > 50);
    CHECK(without > 0);
  }
}

TEST_CASE("on real maps conflicts are those overlaps of lanes that lie in one junction, with ground of both lanes") {
  std::size_t crossings = 0, merges = 0, splits = 0;
  bool const is_there = for_each_corpus_map([&](auto const&, Map const& map) {
    for (auto const& junction : map.junctions()) {
      auto const conflicts = conflict_areas(map, junction.id);
      std::size_t overlaps = 0, wrong = 0;
      for (auto const& lane : map.lanes())
        for (auto const& o : lane.overlaps)
          overlaps +=
              map.road(lane.road).junction == junction.id && map.road(map.lane(o.other).road).junction == junction.id;
      CHECK(2 * conflicts.size() == overlaps);  // each is entered in both lanes
      for (auto const& c : conflicts) {
        crossings += c.kind == OverlapKind::crossing;
        merges += c.kind == OverlapKind::merge;
        splits += c.kind == OverlapKind::split;
        wrong += !(c.on_first.begin <= c.on_first.end) || c.on_first.begin < 0.0 ||
                 c.on_first.end > map.lane(c.first).length() + 1e-9;
        if (!c.area) continue;
        wrong += !c.area->is_convex();
        // Its corners are in both lanes.
        for (auto const& corner : c.area->points()) {
          auto const hits = map.lanes_near(corner, 0.3);
          for (auto const id : {c.first, c.second})
            wrong += std::none_of(hits.begin(), hits.end(), [id](LaneHit const& hit) { return hit.lane == id; });
        }
      }
      CHECK(wrong == 0);
    }
  });
  if (is_there) {
    CHECK(crossings > 100);
    CHECK(merges > 100);
    CHECK(splits > 100);
  }
}
