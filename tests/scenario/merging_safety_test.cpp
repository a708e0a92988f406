// Dense traffic with many trucks merges, and follows leaders that brake and swing, without a collision, whatever the
// driver model and the step.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <type_traits>
#include <variant>

#include "../support/maps.hpp"
#include "../support/scale.hpp"
#include "cambium/behavior/law/acc.hpp"
#include "cambium/behavior/drivers.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/scenario/merging_site.hpp"
#include "platoon.hpp"

using namespace cambium;

namespace {

/// The sampled driver as another model.
template <class Behavior>
Behavior driver(IdmClassic const& idm) {
  if constexpr (std::is_same_v<Behavior, IdmClassic>) {
    return idm;
  } else {
    Behavior behavior;
    behavior.law = {.desired_speed = idm.law.desired_speed,
                    .time_headway = idm.law.time_headway,
                    .minimum_gap = idm.law.minimum_gap,
                    .maximum_acceleration = idm.law.maximum_acceleration,
                    .comfortable_deceleration = idm.law.comfortable_deceleration};
    return behavior;
  }
}

/// The first vehicle of a platoon: after 2 s it brakes to a standstill, or its speed swings, or it changes its
/// acceleration at random every 2 s.
struct Leader {
  std::uint32_t number = 0;
  double hardest = 5.0, period = 10.0, top_speed = 15.0;  // [m/s^2], [s], [m/s]
  template <class View>
  Plan<View> plan(View const& view, NoMemory&, double dt) const {
    double const t = view.time(), speed = view.state().speed;
    RandomStream random(number, static_cast<std::uint32_t>(t / 2.0 + 1e-9), 1);
    double const a = number % 3 == 0   ? (t < 2.0 ? 0.0 : -hardest)
                     : number % 3 == 1 ? 0.6 * hardest * std::sin(2.0 * 3.141592653589793 * t / period)
                                       : Uniform{-hardest, 2.0}(random);
    double const next = std::clamp(speed + a * dt, 0.0, top_speed);
    double const way =
        next > 0.0 || a >= 0.0 ? 0.5 * (speed + next) * dt : std::min(speed * dt, -speed * speed / a / 2);
    return plan_along_lane(view, {way, next}, dt);
  }
};

}  // namespace

TEST_CASE_TEMPLATE(
    "platoons of cars and trucks do not collide behind a leader that brakes, swings or drives erratically", Behavior,
    IdmClassic, AdaptiveCruiseControl, IdmLaneTracking, Mobil, LaneChangeRuleBased, ZipMerge) {
  using Sim = World<BehaviorSet<Behavior, Leader>, InterpolateExecution, SingleTrack>;
  auto const map = support::straight_road(1, 3000.0);
  for (double const dt : {0.1, 0.2, 0.5}) {
    std::uint32_t collisions = 0;
    double slowest = 100.0;
    for (std::uint32_t number = 0; number < support::runs(150); ++number) {
      RandomStream random(21, number, 0);
      auto const [free_speed, traffic] = draw_platoon(random, 320.0, {.truck_share = 0.35});
      Sim world(map);
      for (auto const& vehicle : traffic.sample(random)) {
        typename Sim::AgentSpec spec{.position = {vehicle.s, -1.75}, .speed = vehicle.speed, .shape = vehicle.shape};
        if (world.size() == 0)
          spec.behavior = Leader{number, Uniform{0.5, 5.0}(random), Uniform{4.0, 30.0}(random),
                                 std::max(free_speed, vehicle.speed)};
        else
          spec.behavior = driver<Behavior>(vehicle.driver);
        world.add(spec);
      }
      bool hit = false;
      for (int step = 0; step * dt < 60.0 && !hit; ++step) {
        REQUIRE(world.step(dt));
        hit = AnyCollision{}(world);
        for (auto const& agent : world.frame().agents) slowest = std::min(slowest, agent.state.speed);
      }
      collisions += hit;
    }
    CAPTURE(dt);
    CHECK(collisions == 0);
    CHECK(slowest == 0.0);  // some had to stop
  }
}

TEST_CASE_TEMPLATE("dense traffic with a third of trucks merges without a collision", Behavior, IdmClassic,
                   AdaptiveCruiseControl, IdmLaneTracking, Mobil, ZipMerge) {
  using Sim = World<BehaviorSet<Behavior>, InterpolateExecution, SingleTrack>;
  for (std::string const name : {"merging.xodr", "lane_drop.xodr"}) {
    auto const site = find_merging_site(support::own_map(name));
    for (double const dt : {0.1, 0.2, 0.5}) {
      std::uint32_t collisions = 0, merged = 0;
      for (std::uint32_t number = 0; number < support::runs(150); ++number) {
        auto const scenario = with_behaviors<Sim>(
            site.sample(20, number, {.mix = {.truck_share = 0.35}}),
            [](auto const& agent) { return driver<Behavior>(std::get<IdmClassic>(agent.behavior)); });
        auto world = scenario.make_world();
        bool hit = false;
        for (int step = 0; step * dt < 40.0 && !hit; ++step) {
          REQUIRE(world.step(dt));
          hit = AnyCollision{}(world);
        }
        collisions += hit;
        merged += world.status(scenario.ego) != AgentStatus::driving || world.state(scenario.ego).speed > 1.0;
      }
      CAPTURE(name);
      CAPTURE(dt);
      CHECK(collisions == 0);
      CHECK(merged > 0.8 * support::runs(150));
    }
  }
}
