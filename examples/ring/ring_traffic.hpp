#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/drivers.hpp"
#include "cambium/behavior/law/linear_stability.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/scenario/ring_road.hpp"
#include "cambium/world/world.hpp"

/// Traffic on a ring: initial state, theory and measurement.
namespace ring {

namespace cb = cambium;

using Sim = cb::World<cb::BehaviorSet<cb::IdmClassic>, cb::InterpolateExecution, cb::SingleTrack>;

/// Equilibrium of identical vehicles on a ring: all follow with the same gap and speed.
struct Equilibrium {
  double gap{}, speed{};  ///< [m], [m/s]
  double flow{};          ///< [1/s]
  double growth{};        ///< growth rate of the fastest growing small wave on the ring; below 0 if all decay [1/s]
  bool is_stable{};       ///< whether traffic is string stable, on a road of any length
};

inline Equilibrium equilibrium(cb::Idm const& driver, double length, int vehicles) {
  Equilibrium e;
  e.gap = length / vehicles - cb::geometry::car().length();
  e.speed = cb::idm_equilibrium_speed(driver, e.gap);
  e.flow = vehicles / length * e.speed;
  auto const law = [&driver](double v, double s, double l) { return cb::idm_acceleration(driver, v, s, l); };
  auto const linear = cb::linear_following(law, e.speed, e.gap);
  e.is_stable = linear.is_string_stable();
  e.growth = -std::numeric_limits<double>::infinity();
  for (int m = 1; m < vehicles; ++m)  // m = 0 would change the number of vehicles
    e.growth = std::max(e.growth, linear.growth_rate(2 * cb::geometry::pi * m / vehicles));
  return e;
}

/// A ring of vehicles in equilibrium, each shifted ahead by `ahead(number)` [m] and faster by `faster(number)` [m/s].
/// Vehicle i + 1 follows vehicle i.
template <class Ahead, class Faster>
Sim start(cb::RingRoad const& road, cb::Idm const& driver, int vehicles, Ahead const& ahead, Faster const& faster) {
  Sim world(road.map);
  double const speed = equilibrium(driver, road.length, vehicles).speed;
  for (int i = 0; i < vehicles; ++i) {
    auto const pose = road.pose(road.length * (vehicles - 1 - i + 0.5) / vehicles + ahead(i));
    world.add({.position = pose.position(),
               .heading = pose.heading,
               .speed = std::max(0.0, speed + faster(i)),
               .behavior = cb::IdmClassic{.law = driver},
               .route = road.route});
  }
  return world;
}

/// A ring of vehicles in equilibrium, except that one is 1 m/s slower than the others.
inline Sim start_disturbed(cb::RingRoad const& road, cb::Idm const& driver, int vehicles) {
  return start(
      road, driver, vehicles, [](int) { return 0.0; }, [](int i) { return i == 0 ? -1.0 : 0.0; });
}

/// Measurements of a ring's traffic over some time.
struct Measured {
  double flow{};                ///< mean over the ring [1/s] (Edie 1963: total distance driven over length and time)
  double slowest{}, fastest{};  ///< speeds at the end [m/s]
  bool drove = true;            ///< no vehicle failed, left the ring or touched its leader
};

/// Simulates `duration` [s] in steps of `dt` [s], and calls `watch(world)` after each step.
template <class Watch>
Measured measure(Sim& world, double length, double duration, double dt, Watch const& watch) {
  auto const total_way = [&world] {
    double sum = 0.0;
    for (auto const& agent : world.frame().agents) sum += agent.lane.s;
    return sum;
  };
  Measured result;
  double const before = total_way(), begin = world.time();
  auto const steps = static_cast<std::int64_t>(std::ceil(duration / dt - 1e-9));
  for (std::int64_t i = 0; i < steps; ++i) {
    result.drove = world.step(dt) && result.drove;
    watch(world);
  }
  result.flow = (total_way() - before) / length / (world.time() - begin);
  auto const& agents = world.frame().agents;
  result.slowest = result.fastest = agents.front().state.speed;
  for (std::size_t i = 0; i < agents.size(); ++i) {
    result.slowest = std::min(result.slowest, agents[i].state.speed);
    result.fastest = std::max(result.fastest, agents[i].state.speed);
    auto const front = world.observe(world.roster().agents[i].id).ahead();
    result.drove = result.drove && agents[i].status == cb::AgentStatus::driving && (!front || front->gap > 0.0);
  }
  return result;
}

inline Measured measure(Sim& world, double length, double duration, double dt) {
  return measure(world, length, duration, dt, [](Sim const&) {});
}

}  // namespace ring
