#include "cambium/behavior/mobil.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "lane_traffic_fixtures.hpp"

using namespace lane_traffic;

namespace {

using Sim = Traffic<cb::Mobil, cb::IdmClassic, cb::ConstantAcceleration>;

cb::Mobil mobil(double desired_speed) { return {.idm = {.desired_speed = desired_speed}}; }

/// Steps that an agent spent in each state of a change, and what came of it.
struct Counts {
  int begun = 0, done = 0, aborted = 0, collisions = 0;
};

/// Steps `world` and counts.
template <class World>
Counts run(World& world, int steps, double dt) {
  Counts counts;
  std::vector<std::uint16_t> home(world.size(), cb::map::no_corridor);  // where a change in progress began
  auto const memory = [&](std::size_t i) { return std::get<0>(world.frame().agents[i].memory); };
  for (int k = 0; k < steps; ++k) {
    auto const before = world.frame();
    world.step(dt);
    for (std::size_t i = 0; i < world.size(); ++i) {
      if (world.roster().agents[i].behavior.index() != 0) continue;
      auto const& was = std::get<0>(before.agents[i].memory).change;
      auto const now = memory(i).change;
      if (!was.active() && now.active()) {
        ++counts.begun;
        home[i] = before.agents[i].lane.corridor;
      }
      if (was.active() && now.active() && now.target == home[i] && was.target != home[i]) ++counts.aborted;
      if (was.active() && !now.active()) ++counts.done;
    }
    counts.collisions += collisions(world);
  }
  return counts;
}

}  // namespace

TEST_CASE("nobody collides in dense traffic of MOBIL drivers, on straight and curved roads") {
  Counts all;
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    auto const map = support::straight_road(seed % 2 == 0 ? 3 : 4, 1500.0, seed % 3 == 0 ? 0.002 : 0.0);
    Sim world(map, {.seed = seed});
    fill(world, seed % 2 == 0 ? 3 : 4, 5.0, 600.0, 1.0 + static_cast<double>(seed % 4), seed,
         [](double v) { return mobil(v); });
    auto const counts = run(world, 300, seed % 2 == 0 ? 0.2 : 0.1);
    CAPTURE(seed);
    CHECK(counts.collisions == 0);
    all.begun += counts.begun;
    all.done += counts.done;
    all.aborted += counts.aborted;
  }
  MESSAGE(all.begun << " changes, " << all.aborted << " aborted");
  CHECK(all.begun > 200);
  CHECK(all.done > 9 * (all.begun - all.aborted) / 10);
}

TEST_CASE("of two who change into the same gap from both sides in the same step, at most one goes on") {
  int both_began = 0, aborted = 0, collided = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    cb::RandomStream random(seed, 1, 0);
    auto const between = [&random](double low, double high) { return low + (high - low) * cb::uniform01(random); };
    Sim world(support::straight_road(3, 1500.0, seed % 2 == 0 ? 0.0 : 0.001), {.seed = seed});
    double const v = between(8, 20), gap = between(8, 14);
    // Slow leaders in the outer lanes, the middle lane free.
    add(world, 1, 200 + gap + 5, 0.6 * v, cb::ConstantAcceleration{});
    add(world, 3, 200 + gap + 5 + between(-3, 3), 0.6 * v, cb::ConstantAcceleration{});
    double const apart = seed % 4 == 0 ? 0.0 : between(-12, 12);
    auto const a = add(world, 1, 190, v, mobil(1.3 * v)), b = add(world, 3, 190 + apart, v * between(0.97, 1.03), mobil(1.3 * v));
    for (int k = 0; k < 100; ++k) {
      auto const before = world.frame();
      world.step(seed % 3 == 0 ? 0.1 : 0.2);
      auto const began = [&](cb::AgentId id) {
        auto const slot = world.slot_of(id);
        return !std::get<0>(before.agents[slot].memory).change.active() &&
               std::get<0>(world.frame().agents[slot].memory).change.active();
      };
      both_began += began(a) && began(b);
      for (auto const id : {a, b}) {
        auto const slot = world.slot_of(id);
        auto const &was = std::get<0>(before.agents[slot].memory).change, &now = std::get<0>(world.frame().agents[slot].memory).change;
        aborted += was.active() && now.active() && was.target != now.target;
      }
      collided += collisions(world);
    }
  }
  MESSAGE(both_began << " times both began in the same step; " << aborted << " aborted");
  CHECK(both_began > 100);
  CHECK(aborted > 30);
  CHECK(collided == 0);
}
