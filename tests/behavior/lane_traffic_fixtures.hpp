#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "cambium/cambium.hpp"
#include "cambium/map/road/curve_layout.hpp"

#include "../support/maps.hpp"

/// Traffic on straight roads, in particular on several lanes.
namespace lane_traffic {

namespace cb = cambium;

using support::corpus_map;
using support::own_map;
using support::straight_road;

template <class... Behaviors>
using Traffic = cb::World<cb::BehaviorSet<Behaviors...>, cb::InterpolateExecution, cb::SingleTrack>;

inline double between(double low, double high, cb::RandomStream& random) { return cb::Uniform{low, high}(random); }

/// A road of one lane: 200 m straight, then a bend.
inline std::shared_ptr<cb::Map const> road_with_bend(double radius) {
  return support::map_of({.id = "1",
                          .line = cb::map::lay_from({}, {{200.0}, {60.0, 1 / radius, 1 / radius}}),
                          .sections = {{.right = cb::map::equal_lanes(1)}}});
}

/// The driving agents as boxes.
template <class World>
std::vector<cb::geometry::OrientedBox> boxes(World const& world) {
  std::vector<cb::geometry::OrientedBox> result;
  for (std::size_t i = 0; i < world.size(); ++i) {
    auto const& record = world.frame().agents[i];
    if (record.status != cb::AgentStatus::driving) continue;
    result.push_back(
        cb::geometry::box_of(world.roster().agents[i].shape, {record.state.x, record.state.y, record.state.heading}));
  }
  return result;
}

/// Number of overlapping pairs, of two agents or of an agent and a static object.
template <class World>
int collisions(World const& world) {
  auto const all = boxes(world);
  int count = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t k = i + 1; k < all.size(); ++k) count += cb::geometry::intersects(all[i], all[k]);
    for (auto const& object : world.roster().objects) count += cb::geometry::intersects(object.outline, all[i]);
  }
  return count;
}

/// Drives some steps and requires that nothing fails or collides.
template <class World>
void drive_safely(World& world, int steps, double dt = 0.2) {
  for (int k = 0; k < steps; ++k) {
    REQUIRE(world.step(dt));
    REQUIRE(collisions(world) == 0);
  }
}

/// Adds an agent on a lane of the first road; `number` counts the lanes of its direction from the left.
template <class World>
cb::AgentId add(World& world, int number, double s, double speed, typename World::Behavior const& behavior,
                cb::Goal const& goal = {}, cb::geometry::Shape const& shape = {}) {
  for (auto const& entry : world.map().roads()[0].sections[0].lanes) {
    auto const& lane = world.map().lane(entry.id);
    if (!lane.drivable() || lane.number != -number) continue;
    auto const pose = lane.path.pose(s);
    return world.add({.position = pose.position(),
                      .heading = pose.heading,
                      .speed = speed,
                      .shape = shape,
                      .behavior = behavior,
                      .goal = goal});
  }
  return cb::none<cb::AgentId>;
}

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
    slow.idm.desired_speed = between(2.0, 5.0, random);
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
