#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/following/constant_acceleration.hpp"
#include "cambium/behavior/following/idm_classic.hpp"
#include "cambium/behavior/lane_change/lane_change_rule_based.hpp"
#include "cambium/behavior/lane_change/mobil.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/geometry/collision.hpp"
#include "cambium/geometry/oriented_box.hpp"
#include "cambium/world/world.hpp"

#include "../support/maps.hpp"

/// Traffic on several lanes, for the tests of behaviours that change between them.
namespace lane_traffic {

namespace cb = cambium;

template <class... Behaviors>
using Traffic = cb::World<cb::BehaviorSet<Behaviors...>, cb::InterpolateExecution, cb::SingleTrack>;

/// The agents that drive, as boxes.
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

/// How many pairs of agents overlap, and agents with static objects.
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

/// Puts an agent onto a lane of the first road, `number` counted from the left of those in its direction.
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

/// Random traffic on lanes 1 to `lanes`: speeds, gaps and sizes drawn, gaps so that nobody need brake hard.
/// `driver(desired_speed)` makes a behaviour.
template <class World, class Driver>
void fill(World& world, int lanes, double begin, double end, double density, std::uint64_t seed, Driver const& driver) {
  cb::RandomStream random(seed, 0, 0);
  auto const between = [&random](double low, double high) { return low + (high - low) * cb::uniform01(random); };
  for (int lane = 1; lane <= lanes; ++lane) {
    double speed = between(6.0, 14.0);
    for (double s = begin + between(0.0, 30.0); s < end;) {
      bool const is_truck = cb::uniform01(random) < 0.1;
      auto const shape = is_truck ? cb::geometry::truck() : cb::geometry::car();
      add(world, lane, s + shape.rear, speed, driver(between(is_truck ? 8.0 : 9.0, is_truck ? 14.0 : 22.0)), {}, shape);
      double const next = between(6.0, 14.0);
      s += shape.length() + 4.0 + (1.0 + 3.0 * cb::uniform01(random) / density) * speed +
           std::max(0.0, speed - next) * 3.0;
      speed = next;
    }
  }
}

/// Slow traffic on lanes 1 to `lanes` with many trucks and buses, behind somebody on each lane who stays slow.
/// `driver(is_long)` makes a behaviour.
template <class World, class Driver>
void fill_slow(World& world, int lanes, std::uint64_t seed, Driver const& driver) {
  cb::RandomStream random(seed, 26, 5);
  auto const between = [&random](double low, double high) { return low + (high - low) * cb::uniform01(random); };
  for (int lane = 1; lane <= lanes; ++lane) {
    double speed = between(1.0, 6.0);
    for (double s = 20.0 + between(0.0, 20.0); s < 400.0;) {
      bool const is_long = cb::uniform01(random) < 0.25;
      auto const shape = !is_long                      ? cb::geometry::car()
                         : cb::uniform01(random) < 0.5 ? cb::geometry::bus()
                                                       : cb::geometry::truck();
      add(world, lane, s + shape.rear, speed, driver(is_long), {}, shape);
      double const next = between(1.0, 6.0);
      s += shape.length() + 4.0 + between(1.0, 3.0) * speed + 6.0 * std::max(0.0, speed - next);
      speed = next;
    }
    auto slow = driver(false);
    slow.idm.desired_speed = between(2.0, 5.0);
    add(world, lane, 470.0 + 8.0 * lane, between(1.0, 4.0), slow);
  }
}

/// Lane corridors that the agents are in, by slot.
template <class World>
std::vector<cb::CorridorId> lanes(World const& world) {
  std::vector<cb::CorridorId> result;
  for (auto const& record : world.frame().agents) result.push_back(record.lane.corridor);
  return result;
}

/// Steps; how many agents are in another lane than before.
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
