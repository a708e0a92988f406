#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include <doctest/doctest.h>

#include "cambium/cambium.hpp"
#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/map/road/curve_layout.hpp"
#include "cambium/scenario/merging_site.hpp"

#include "../support/maps.hpp"

/// Traffic on straight roads, in particular on several lanes.
namespace lane_traffic {

namespace cb = cambium;

using support::corpus_map;
using support::own_map;
using support::straight_road;

template <class... Behaviors>
using Traffic = cb::World<cb::BehaviorSet<Behaviors...>, cb::InterpolateExecution, cb::SingleTrack>;

/// The shipped drivers that follow the rules of the road.
#define ALL_DRIVERS                                                                             \
  cb::IdmClassic, cb::IdmLaneTracking, cb::AdaptiveCruiseControl, cb::IdmStochastic, cb::Mobil, \
      cb::LaneChangeRuleBased, cb::ZipMerge, cb::Intersection

inline double between(double low, double high, cb::RandomStream& random) { return cb::Uniform{low, high}(random); }

/// A road of one lane: 200 m straight, then a bend.
inline std::shared_ptr<cb::Map const> road_with_bend(double radius) {
  return support::map_of({.id = "1",
                          .line = cb::map::lay_from({}, {{200.0}, {60.0, 1 / radius, 1 / radius}}),
                          .sections = {{.right = cb::map::equal_lanes(1)}}});
}

/// Number of overlapping pairs, of two driving agents or of an agent and a static object.
template <class World>
int collisions(World const& world) {
  std::vector<cb::geometry::OrientedBox> all;
  for (cb::Slot i{}; index_of(i) < world.size(); ++i)
    if (world.frame().agents[i].status == cb::AgentStatus::driving) all.push_back(cb::box_at(world, i));
  int count = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t k = i + 1; k < all.size(); ++k) count += cb::geometry::intersects(all[i], all[k]);
    for (auto const& object : world.roster().objects) count += cb::geometry::intersects(object.outline, all[i]);
  }
  return count;
}

/// Steps each of the worlds `steps` times by `dt` [s].
template <class... Worlds>
void step_all(int steps, double dt, Worlds&... worlds) {
  for (int k = 0; k < steps; ++k) REQUIRE((static_cast<bool>(worlds.step(dt)) && ...));
}

/// Drives some steps and requires that nothing fails or collides.
template <class World>
void drive_safely(World& world, int steps, double dt = 0.2) {
  for (int k = 0; k < steps; ++k) {
    REQUIRE(world.step(dt));
    REQUIRE(collisions(world) == 0);
  }
}

/// Adds an agent on a lane, `s` [m] after its begin and `lateral` [m] to the left of its middle. Its heading counts
/// from the lane's.
template <class World>
cb::AgentId enter(World& world, cb::map::Lane const& lane, double s, typename World::AgentSpec spec,
                  double lateral = 0.0) {
  auto const pose = lane.path.pose(s);
  spec.position = cb::geometry::to_map(pose, {0.0, lateral});
  spec.heading = spec.heading.value_or(0.0) + pose.heading;
  return world.add(spec);
}

/// A lane of the first road, counted from the left among those of its direction.
inline cb::map::Lane const& lane_of(cb::Map const& map, int number) {
  for (auto const& entry : map.roads()[0].sections[0].lanes)
    if (auto const& lane = map.lane(entry.id); lane.drivable() && lane.number == -number) return lane;
  FAIL("no such lane");
  return map.lanes()[0];
}

/// Adds an agent on that lane.
template <class World>
cb::AgentId add(World& world, int number, double s, double speed, typename World::Behavior const& behavior,
                cb::Goal const& goal = {}, cb::geometry::Shape const& shape = {}) {
  return enter(world, lane_of(world.map(), number), s,
               {.speed = speed, .shape = shape, .behavior = behavior, .goal = goal});
}

/// The merge of merging.xodr.
struct MergingRoad {
  using Entrance = cb::MergingSite::Entrance;

  cb::MergingSite site = cb::find_merging_site(support::own_map("merging.xodr"));
  Entrance ramp = site.entrances[site.ramp];
  Entrance through =
      *std::ranges::find_if(site.entrances, [](auto const& e) { return e.merges() && !e.gives_up_lane; });

  /// The lane corridor from an entrance to the end of its road.
  [[nodiscard]] cb::map::LaneCorridor corridor(Entrance const& from) const {
    auto const road = cb::map::build_road_corridor(*site.map, from.route);
    return road->corridors[road->main];
  }
  /// Adds an agent `before` [m] before the place where its way begins to merge.
  template <class World>
  cb::AgentId add(World& world, Entrance const& from, double before, typename World::AgentSpec spec) const {
    auto const pose = corridor(from).center.pose(from.merge_at - before);
    spec.position = pose.position();
    spec.heading = pose.heading;
    spec.route = from.route;
    return world.add(spec);
  }
};

/// Adds random traffic on lanes 1 to `lanes`, with gaps large enough that nobody has to brake hard.
/// `driver(desired_speed)` makes a behaviour.
template <class World, class Driver>
void fill(World& world, int lanes, double begin, double end, double density, std::uint64_t seed, Driver const& driver) {
  cb::RandomStream random(seed, 0, 0);
  for (int lane = 1; lane <= lanes; ++lane) {
    double speed = between(6.0, 14.0, random);
    for (double s = begin + between(0.0, 30.0, random); s < end;) {
      bool const is_truck = cb::uniform01(random) < 0.1;
      auto const shape = is_truck ? cb::geometry::truck() : cb::geometry::car();
      add(world, lane, s + shape.rear, speed, driver(between(is_truck ? 8.0 : 9.0, is_truck ? 14.0 : 22.0, random)), {},
          shape);
      double const next = between(6.0, 14.0, random);
      s += shape.length() + 4.0 + (1.0 + 3.0 * cb::uniform01(random) / density) * speed +
           std::max(0.0, speed - next) * 3.0;
      speed = next;
    }
  }
}

/// Adds slow traffic with many trucks and buses on lanes 1 to `lanes`, each behind a driver that stays slow.
/// `driver(is_long)` makes a behaviour.
template <class World, class Driver>
void fill_slow(World& world, int lanes, std::uint64_t seed, Driver const& driver) {
  cb::RandomStream random(seed, 26, 5);
  for (int lane = 1; lane <= lanes; ++lane) {
    double speed = between(1.0, 6.0, random);
    for (double s = 20.0 + between(0.0, 20.0, random); s < 400.0;) {
      bool const is_long = cb::uniform01(random) < 0.25;
      auto const shape = !is_long                      ? cb::geometry::car()
                         : cb::uniform01(random) < 0.5 ? cb::geometry::bus()
                                                       : cb::geometry::truck();
      add(world, lane, s + shape.rear, speed, driver(is_long), {}, shape);
      double const next = between(1.0, 6.0, random);
      s += shape.length() + 4.0 + between(1.0, 3.0, random) * speed + 6.0 * std::max(0.0, speed - next);
      speed = next;
    }
    auto slow = driver(false);
    slow.law.desired_speed = between(2.0, 5.0, random);
    add(world, lane, 470.0 + 8.0 * lane, between(1.0, 4.0, random), slow);
  }
}

/// Lane corridors of the agents, by slot.
template <class World>
std::vector<cb::CorridorId> lanes(World const& world) {
  std::vector<cb::CorridorId> result;
  for (auto const& record : world.frame().agents) result.push_back(record.lane.corridor);
  return result;
}

/// Steps and returns how many agents have changed lanes.
template <class World>
int step_and_count_changes(World& world, double dt = 0.2) {
  auto const before = lanes(world);
  REQUIRE(world.step(dt));
  auto const after = lanes(world);
  int changes = 0;
  for (std::size_t i = 0; i < after.size(); ++i) changes += before[i] != after[i];
  return changes;
}

}  // namespace lane_traffic
