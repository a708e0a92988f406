#include "cambium/evaluation/infeasible.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "../support/maps.hpp"
#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/drivers.hpp"
#include "cambium/core/state.hpp"
#include "cambium/dynamics/dynamic_set.hpp"
#include "cambium/dynamics/kinematic_point.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/dynamics/single_track_steering.hpp"
#include "cambium/dynamics/triple_integrator.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/execution/lqr.hpp"
#include "cambium/execution/stanley.hpp"
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
  Infeasible::Drift drift;
  return Infeasible{}.between(seen({.speed = speed}, 7.0), seen(end, 7.0 + dt), SingleTrack{}, drift);
}

/// The agents' steps in `duration` that were found impossible, of all.
template <class World>
std::pair<std::size_t, std::size_t> impossible_steps(World world, double dt, double duration) {
  std::size_t found = 0, all = 0;
  std::map<AgentId, Infeasible::Drift> drifts;
  while (world.time() < duration) {
    REQUIRE(world.step(dt));
    for (Slot slot{}; index_of(slot) < world.size(); ++slot) {
      if (world.frame().agents[slot].status != AgentStatus::driving) continue;
      auto const one = Infeasible{}.finding(world, slot, drifts[world.roster().agents[slot].id]);
      ++all;
      if (one.flaw == Flaw::none) continue;
      if (++found == 1) MESSAGE("agent " << index_of(slot) << " at " << world.time() << " s " << to_string(one));
    }
  }
  return {found, all};
}

/// Looks at the traffic of scenarios as `make` turns it into a world, in steps of any length.
template <class Make>
void check_traffic(std::uint32_t samples, Make const& make,
                   std::vector<double> const& step_lengths = {0.05, 0.2, 0.5}) {
  static auto const merging = find_merging_site(support::own_map("merging.xodr"));
  static auto const highway = find_highway_site(support::own_map("highway.xodr"));
  static auto const junction = find_junction_site(support::own_map("intersection_4way.xodr"));
  static auto const roundabout = find_junction_site(support::own_map("roundabout.xodr"));
  for (double const dt : step_lengths) {
    CAPTURE(dt);
    std::size_t steps = 0;
    auto const check = [&](std::string const& name, auto const& scenario) {
      CAPTURE(name);
      auto const [found, all] = impossible_steps(make(scenario), dt, 20.0);
      CHECK(found == 0);
      steps += all;
    };
    for (std::uint32_t i = 0; i < samples; ++i) {
      check("merging", merging.sample(5, i));
      check("highway", highway.sample(5, i));
      check("junction", junction.sample(5, i));
      check("roundabout", roundabout.sample(5, i));
    }
    CHECK(steps > 400 * samples);
  }
}

/// The vehicles of a scenario, driven by MOBIL through other executions and dynamics.
template <class Execution, class Dynamics>
auto with_mobil(Dynamics const& dynamics = {}, Execution const& execution = {}) {
  using Own = World<BehaviorSet<Mobil>, Execution, Dynamics>;
  return [dynamics, execution](auto const& scenario) {
    Own world(scenario.map, {.seed = scenario.seed});
    for (auto const& agent : scenario.agents) {
      typename Own::AgentSpec spec{.position = agent.position, .heading = agent.heading, .speed = agent.speed};
      spec.shape = agent.shape;
      spec.route = agent.route;
      spec.goal = agent.goal.given();
      spec.dynamics = dynamics;
      spec.execution = execution;
      spec.behavior = Mobil{};
      world.add(spec);
    }
    return world;
  };
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
  check_traffic(2, [](auto const& scenario) {
    return with_behaviors<Sim>(scenario,
                               [](auto const& spec) -> Sim::Behavior {
                                 return std::visit([](auto const& driver) -> Sim::Behavior { return driver; },
                                                   spec.behavior.given());
                               })
        .make_world();
  });
}

TEST_CASE("whatever a single track does within its limits is possible, at steps of up to 0.25 s") {
  // Exact motions: throttle and steering over time, integrated in steps of 1 ms.
  auto const check = [](SingleTrack const& vehicle, double speed, auto const& inputs) {
    for (int const each : {10, 20, 50, 100, 200, 250}) {  // [ms]
      State now{.speed = speed}, seen = now;
      Infeasible::Drift drift;
      for (int ms = 1; ms <= 12'000; ++ms) {
        auto const [throttle, steering] = inputs(now.time, now.speed);
        auto action = vehicle.limited({throttle, steering}, now);
        action.acceleration = std::max(action.acceleration, -now.speed / 1e-3);
        now = rk4_step(vehicle, now, action, 1e-3);
        now.speed = std::max(0.0, now.speed);
        if (ms % each != 0) continue;
        now.time = 1e-3 * ms;
        auto const finding = Infeasible{}.between(seen, now, vehicle, drift);
        CAPTURE(each);
        CAPTURE(now.time);
        CAPTURE(to_string(finding));
        REQUIRE(finding.flaw == Flaw::none);
        seen = now;
      }
    }
  };
  for (double const speed : {2.0, 10.0, 30.0})
    check({}, speed, [](double t, double) { return std::pair(t < 0.37 ? 0.0 : -8.0, 0.0); });
  for (double const period : {1.0, 2.0, 4.0})  // stop and go
    check({}, 0.0, [&](double t, double) { return std::pair(std::fmod(t, period) < period / 2 ? 4.0 : -4.0, 0.0); });
  for (double const base : {2.8, 6.0})
    for (double const speed : {2.0, 4.0, 7.0})
      for (double const rate : {0.3, 2.0}) {  // turns, and stops in the turn; slaloms
        CAPTURE(speed);
        CAPTURE(rate);
        auto const steering = [&](double t) { return std::clamp((t - 1.13) * rate, 0.0, 0.6); };
        check({.wheel_base = base}, speed,
              [&](double t, double) { return std::pair(t > 2.7 ? -4.0 : 0.0, steering(t)); });
        check({.wheel_base = base}, speed, [&](double t, double) { return std::pair(0.0, 0.6 * std::sin(rate * t)); });
      }
  for (double const lateral : {3.0, 5.0, 7.0})  // evades, and brakes
    for (double const period : {2.0, 5.0})
      check({}, 20.0, [&](double t, double speed) {
        double const bend = lateral * std::sin(2.0 * geometry::pi * t / period) / std::max(speed * speed, 20.0);
        return std::pair(t > 4.0 ? -6.0 : 0.0, std::atan(bend * 2.8));
      });
}

TEST_CASE("what drivers do is possible by all executions and dynamics") {
  check_traffic(1, with_mobil<StanleyExecution, SingleTrack>());
  check_traffic(1, with_mobil<LqrExecution, SingleTrackSteering>());
  check_traffic(1, with_mobil<InterpolateExecution, TripleIntegrator>());
  using Set = DynamicSet<SingleTrack, KinematicPoint>;
  check_traffic(1, with_mobil<StanleyExecution, Set>(SingleTrack{.wheel_base = 6.0}));
  check_traffic(1, with_mobil<LqrExecution, SingleTrackSteering>({}, {.actuation = {.delay = 0.2}}), {0.05, 0.1});
}

TEST_CASE("lane changes in bends are possible, in steps of any length") {
  for (double const curvature : {0.02, 0.05})
    for (double const dt : {0.02, 0.05, 0.2, 0.5}) {
      CAPTURE(curvature);
      CAPTURE(dt);
      double const speed = 0.3 / curvature;
      for (auto const& shape : {geometry::car(), geometry::truck()}) {
        Sim world(support::straight_road(2, 600, curvature));
        auto const place = [&](double s) {  // in the right lane
          double const radius = 1.0 / curvature + 5.25, turn = s * curvature;
          return Sim::AgentSpec{.position = {radius * std::sin(turn), 1.0 / curvature - radius * std::cos(turn)},
                                .heading = turn,
                                .speed = speed,
                                .shape = shape};
        };
        auto fast = place(10), slow = place(60);
        fast.behavior = Mobil{.law = {.desired_speed = speed}};
        slow.behavior = IdmClassic{.law = {.desired_speed = 0.4 * speed}};
        slow.speed = 0.4 * speed;
        world.add(fast);
        world.add(slow);
        CHECK(impossible_steps(world, dt, 40.0).first == 0);
      }
    }
}

TEST_CASE("what a dynamics permits is asked of the one that an agent has") {
  using Set = DynamicSet<SingleTrack, KinematicPoint>;
  auto const flaw = [](auto const& dynamics, State const& end) {
    Infeasible::Drift drift;
    State to = end;
    to.time = 0.2;
    return Infeasible{}.between(State{.speed = 1.0}, to, dynamics, drift).flaw;
  };
  State const turns{.x = 0.2, .heading = 0.4, .speed = 1.0}, brakes{.x = 0.13, .heading = 0.0, .speed = 0.0};
  CHECK(flaw(Set(SingleTrack{}), turns) == Flaw::turn);
  CHECK(flaw(Set(KinematicPoint{}), turns) == Flaw::none);  // a pedestrian turns on the spot
  CHECK(flaw(TripleIntegrator{}, turns) == Flaw::none);     // it has no steering
  CHECK(flaw(Set(SingleTrack{.lowest_acceleration = -3.0}), brakes) == Flaw::acceleration);
  CHECK(flaw(Set(SingleTrack{}), brakes) == Flaw::none);
  State const aside{.x = 0.165, .y = 0.113, .heading = 0.6, .speed = 1.0};
  CHECK(flaw(Set(KinematicPoint{}), aside) == Flaw::none);
  CHECK(flaw(Set(SingleTrack{}), aside) != Flaw::none);
}

TEST_CASE("lower grip is asked across, too") {
  auto const flaw = [](Infeasible const& judge, double turn) {
    Infeasible::Drift drift;
    State const to{.time = 0.2, .x = 4.0, .y = 2.0 * turn, .heading = turn, .speed = 20.0};
    return judge.between(State{.speed = 20.0}, to, SingleTrack{}, drift).flaw;
  };
  CHECK(flaw({}, 0.085) == Flaw::none);  // 7.5 m/s^2 beyond the tolerance
  CHECK(flaw({}, 0.095) == Flaw::grip);  // 8.5 m/s^2: its dynamics permits 8
  CHECK(flaw({.grip = 6.0}, 0.085) == Flaw::grip);
}

TEST_CASE("small errors of each step add up, and fade") {
  Infeasible::Drift drift;
  State now{.speed = 20.0};
  auto const flaw_after = [&](int steps, double along, double across) {
    auto found = Flaw::none;
    for (int i = 0; i < steps && found == Flaw::none; ++i) {
      State next = now;
      next.x += 4.0 + along;
      next.y += across;
      next.time += 0.2;
      found = Infeasible{}.between(now, next, SingleTrack{}, drift).flaw;
      now = next;
    }
    return found;
  };
  CHECK(flaw_after(100, 0.01, 0.01) == Flaw::none);
  drift = {};
  CHECK(flaw_after(100, 0.0, 0.013) == Flaw::side_drift);
  drift = {};
  CHECK(flaw_after(1, 0.1, 0.0) == Flaw::none);
  CHECK(flaw_after(1, 0.1, 0.0) == Flaw::drift);
  drift = {};
  CHECK(flaw_after(1, 0.0, -0.1) == Flaw::none);
  CHECK(flaw_after(20, 0.0, 0.0) == Flaw::none);
  CHECK(flaw_after(1, 0.0, -0.1) == Flaw::none);
  CHECK(flaw_after(1, 0.0, -0.1) == Flaw::side_drift);
}

TEST_CASE("small errors are as small in short steps as in long ones") {
  // Each in its direction per second; a step of 1 s permits more only for what a stop within it adds.
  auto const flaw = [](double dt, double along, double across, double turning, double braking) {
    Infeasible::Drift drift;
    State now{.speed = braking > 0.0 ? 40.0 : 0.0};
    while (now.time < 4.0) {
      State next = now;
      next.time += dt;
      next.speed = std::max(0.0, now.speed - braking * dt);
      next.x += along * dt + 0.5 * (now.speed + next.speed) * dt;
      next.y += across * dt;
      next.heading += turning * dt;
      auto const found = Infeasible{}.between(now, next, SingleTrack{}, drift).flaw;
      if (found != Flaw::none) return found;
      now = next;
    }
    return Flaw::none;
  };
  for (double const dt : {0.01, 0.05, 0.1, 0.2, 0.25}) {
    CAPTURE(dt);
    CHECK(flaw(dt, 0.04, 0.04, 0.0, 8.0) == Flaw::none);
    CHECK(flaw(dt, 0.0, 0.0, 0.009, 0.0) == Flaw::none);
    CHECK(flaw(dt, 0.12, 0.0, 0.0, 0.0) == Flaw::drift);
    CHECK(flaw(dt, 0.0, 0.03, 0.0, 0.0) == Flaw::sideways);  // it stands
    CHECK(flaw(dt, 0.0, 0.09, 0.0, 1.0) == Flaw::side_drift);
    CHECK(flaw(dt, 0.0, 0.0, 0.05, 0.0) == Flaw::turn_drift);
    CHECK(flaw(dt, 0.0, 0.0, 0.0, 8.08) == Flaw::speed_drift);
  }
}
