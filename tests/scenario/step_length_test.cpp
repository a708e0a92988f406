// Traffic at steps of any length: the table in behavior/README.md.
#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "../support/maps.hpp"
#include "cambium/behavior/drivers.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/scenario/traffic_inflow.hpp"
#include "cambium/world/world.hpp"

using namespace cambium;

namespace {

using Sim = World<BehaviorSet<UrbanDriver, Mobil>, InterpolateExecution, SingleTrack>;

struct Count {
  std::size_t vehicles = 0, collisions = 0, hidden = 0;  ///< hidden: between two frames

  Count& operator+=(Count const& other) {
    vehicles += other.vehicles;
    collisions += other.collisions;
    hidden += other.hidden;
    return *this;
  }
};

/// Drives 600 s of traffic; who collides leaves.
template <class Driver>
Count drive(char const* file, double per_hour, double speed, double dt, std::uint64_t seed) {
  auto const map = support::own_map(file);
  Sim world(map, {.seed = seed});
  auto sources = find_sources(*map);
  for (auto& source : sources) source.per_hour = per_hour;
  TrafficInflow<Sim> inflow(*map, sources, seed);
  Count count;
  while (world.time() < 600.0) {
    inflow.enter(world, [&](TrafficSource const& source, RandomStream& random) {
      Driver driver;
      driver.law.desired_speed = speed * (0.8 + 0.4 * uniform01(random));
      auto const route = random_route(*map, source.lane, random, 3000.0);
      bool const is_truck = uniform01(random) < 0.15;
      return Sim::AgentSpec{.speed = 0.8 * speed,
                            .shape = is_truck ? geometry::truck() : geometry::car(),
                            .behavior = driver,
                            .route = route};
    });
    (void)world.step(dt);
    std::vector<AgentId> hit;
    for (Slot b{}; AnyCollision{}(world) && index_of(b) < world.size(); ++b)
      for (Slot a{}; a < b; ++a) {
        if (!in_traffic(world, a) || !in_traffic(world, b)) continue;
        if (!geometry::intersects(motion_at(world, a), motion_at(world, b))) continue;
        ++count.collisions;
        count.hidden += !geometry::intersects(box_at(world, a), box_at(world, b));
        for (auto const slot : {a, b}) hit.push_back(world.roster().agents[slot].id);
      }
    for (auto const id : hit)
      if (world.roster().slot_of(id)) world.remove(id);
    count.vehicles += inflow.leave(world).size();
  }
  return count;
}

}  // namespace

TEST_CASE("drivers do not collide in steps shorter than their time headway; in longer ones, frames may hide it") {
  Count beyond;
  for (double const dt : {0.2, 0.5, 1.0, 2.0}) {
    Count count;
    for (std::uint64_t const seed : {1u, 2u}) {
      count += drive<Mobil>("highway.xodr", 1200.0, 30.0, dt, seed);
      count += drive<UrbanDriver>("merging.xodr", 600.0, 15.0, dt, seed);
      count += drive<UrbanDriver>("intersection_4way.xodr", 400.0, 13.0, dt, seed);
      count += drive<UrbanDriver>("roundabout.xodr", 300.0, 12.0, dt, seed);
    }
    MESSAGE("steps of " << dt << " s: " << count.collisions << " collisions of " << count.vehicles << " vehicles, "
                        << count.hidden << " between two frames");
    CHECK(count.vehicles > 2000);
    if (dt < IdmClassic{}.law.time_headway)
      CHECK(count.collisions == 0);
    else
      beyond += count;
  }
  CHECK(beyond.hidden > 0);
}
