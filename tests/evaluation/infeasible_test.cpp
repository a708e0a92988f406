#include "cambium/evaluation/infeasible.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <variant>

#include "../support/maps.hpp"
#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/drivers.hpp"
#include "cambium/core/state.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/scenario/highway_site.hpp"
#include "cambium/scenario/junction_site.hpp"
#include "cambium/scenario/merging_site.hpp"
#include "cambium/world/world.hpp"

using namespace cambium;

namespace {

using Flaw = Infeasible::Flaw;
using Sim = World<BehaviorSet<IdmClassic, Mobil, Intersection, UrbanDriver>, InterpolateExecution, SingleTrack>;

/// What is wrong with a motion from the origin along +x in `dt` to (x, y, heading, speed), seen from `turn` and `far`.
Infeasible::Finding finding(double speed, State const& end, double dt, double turn = 0.0, double far = 0.0) {
  auto const seen = [&](State state, double time) {
    State result = state;
    result.x = far + std::cos(turn) * state.x - std::sin(turn) * state.y;
    result.y = -far + std::sin(turn) * state.x + std::cos(turn) * state.y;
    result.heading = std::remainder(turn + state.heading, 6.283185307179586);
    result.time = time;
    return result;
  };
  return Infeasible{}.between(seen({.speed = speed}, 7.0), seen(end, 7.0 + dt), SingleTrack{});
}

/// The agents' steps in `duration` that were found impossible, of all.
template <class Scenario>
std::pair<std::size_t, std::size_t> impossible_steps(Scenario const& scenario, double dt, double duration) {
  auto world = with_behaviors<Sim>(scenario, [](auto const& spec) -> Sim::Behavior {
                 return std::visit([](auto const& driver) -> Sim::Behavior { return driver; }, spec.behavior.given());
               }).make_world();
  std::size_t found = 0, all = 0;
  while (world.time() < duration) {
    REQUIRE(world.step(dt));
    for (Slot slot{}; index_of(slot) < world.size(); ++slot) {
      if (world.frame().agents[slot].status != AgentStatus::driving) continue;
      auto const one = Infeasible{}.finding(world, slot);
      ++all;
      if (one.flaw == Flaw::none) continue;
      if (++found == 1) MESSAGE("agent " << index_of(slot) << " at " << world.time() << " s " << to_string(one));
    }
  }
  return {found, all};
}

}  // namespace

TEST_CASE("a motion is possible or not, whichever way the vehicle heads and wherever it is") {
  struct Motion {
    double speed;
    State end;
    double dt;
    Flaw flaw;
  };
  double const along = 4.0 * std::sin(0.1) / 0.1;  // 4 m of an arc that turns by 0.2
  Motion const motions[] = {
      {20, {.x = 4, .speed = 20}, 0.2, Flaw::none},
      {20, {.x = 4.1, .speed = 20}, 0.2, Flaw::none},  // it accelerated, then braked
      {20, {.x = 4.3, .speed = 20}, 0.2, Flaw::way},
      {20, {.x = 3.7, .speed = 20}, 0.2, Flaw::way},
      {20, {.x = 12, .speed = 20}, 0.2, Flaw::way},
      {20, {.x = -4, .speed = 20}, 0.2, Flaw::way},
      {22, {.x = 3.6, .speed = 14}, 0.2, Flaw::acceleration},
      {8, {.x = 3.2, .speed = 0}, 1.0, Flaw::none},  // it stands before the end of the step
      {8, {.x = 1.0, .speed = 0}, 1.0, Flaw::way},
      {20, {.x = 20, .speed = 20}, 1.0, Flaw::none},
      {10, {.x = 2, .y = 0.1, .speed = 10}, 0.2, Flaw::none},
      {10, {.x = 2, .y = 0.4, .speed = 10}, 0.2, Flaw::sideways},
      {10, {.x = 2, .y = -0.4, .speed = 10}, 0.2, Flaw::sideways},
      {0, {.y = 0.3}, 0.2, Flaw::sideways},
      {0, {.heading = 0.3}, 0.2, Flaw::turn},
      {1, {.x = 0.2, .heading = 0.4, .speed = 1}, 0.2, Flaw::turn},
      {5, {.x = 1, .heading = 0.1, .speed = 5}, 0.2, Flaw::none},
      {20, {.x = along * std::cos(0.1), .y = along * std::sin(0.1), .heading = 0.2, .speed = 20}, 0.2, Flaw::grip},
      {20, {.x = 4, .y = 0.16, .heading = 0.08, .speed = 20}, 0.2, Flaw::none},
      {20, {.x = 3.85, .y = 0.173, .heading = 0.09, .speed = 18.5}, 0.2, Flaw::none},   // as its dynamics permits
      {20, {.x = 3.84, .y = 0.201, .heading = 0.105, .speed = 18.5}, 0.2, Flaw::grip},  // it brakes, too
  };
  for (auto const& motion : motions)
    for (double const turn : {0.0, 0.7, -2.9, 3.1})
      for (double const far : {0.0, 1e6}) {
        auto const found = finding(motion.speed, motion.end, motion.dt, turn, far);
        CAPTURE(motion.speed);
        CAPTURE(motion.end.x);
        CAPTURE(motion.end.y);
        CAPTURE(to_string(found));
        CHECK(found.flaw == motion.flaw);
      }
  CHECK(to_string(finding(22, {.x = 3.6, .speed = 14}, 0.2)) == "changes its speed by -40 m/s^2, possible are -8");
}

TEST_CASE("what drivers do is possible, in steps of any length") {
  auto const merging = find_merging_site(support::own_map("merging.xodr"));
  auto const highway = find_highway_site(support::own_map("highway.xodr"));
  auto const junction = find_junction_site(support::own_map("intersection_4way.xodr"));
  auto const roundabout = find_junction_site(support::own_map("roundabout.xodr"));
  std::size_t steps = 0;
  for (double const dt : {0.05, 0.2, 0.5}) {
    CAPTURE(dt);
    auto const check = [&](std::string const& name, auto const& scenario) {
      CAPTURE(name);
      auto const [found, all] = impossible_steps(scenario, dt, 20.0);
      CHECK(found == 0);
      steps += all;
    };
    for (std::uint32_t i = 0; i < 2; ++i) {
      check("merging", merging.sample(5, i));
      check("highway", highway.sample(5, i));
      check("junction", junction.sample(5, i));
      check("roundabout", roundabout.sample(5, i));
    }
  }
  CHECK(steps > 10'000);
}
