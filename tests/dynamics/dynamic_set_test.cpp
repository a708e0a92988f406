#include "cambium/dynamics/dynamic_set.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "../world/fixtures.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/dynamics/kinematic_point.hpp"
#include "cambium/dynamics/single_track_steering.hpp"
#include "cambium/dynamics/triple_integrator.hpp"

using namespace fixtures;

namespace {

/// A user's own model: a tracked vehicle that turns at a rate of its own and has no name, parameters or wheel base.
struct Tank {
  using State = cb::State;
  struct Input {
    double acceleration, turn;
  };
  State derivative(State const& x, Input const& u) const {
    return {1.0, x.speed * std::cos(x.heading), x.speed * std::sin(x.heading), u.turn, u.acceleration};
  }
  Input limited(Input const& u, State const&) const {
    return {std::clamp(u.acceleration, -3.0, 1.0), std::clamp(u.turn, -0.5, 0.5)};
  }
  Input input(cb::Action const& action, State const& x) const {
    return limited({action.acceleration, 2.0 * action.steering}, x);
  }
};
static_assert(cb::DynamicModel<Tank>);

template <class Dynamics>
using World = cb::World<cb::BehaviorSet<cb::ExternalInput>, cb::InterpolateExecution, Dynamics>;

template <class Dynamics>
cb::AgentId enter(World<Dynamics>& world, double speed, Dynamics const& dynamics, double y = -100) {
  return world.add({.position = {150, y}, .heading = 0.0, .speed = speed, .dynamics = dynamics});
}

}  // namespace

TEST_CASE_TEMPLATE("a driver brakes, stands, starts and turns left with any vehicle model", Model, cb::SingleTrack,
                   cb::SingleTrackSteering, cb::TripleIntegrator, cb::KinematicPoint, Tank) {
  World<Model> world(straight_road(60, 400));
  auto const id = enter(world, 2.5, Model{});
  auto& memory = world.template memory<cb::ExternalInput>(id);
  memory = {0.0, 0.2};
  for (int i = 0; i < 10; ++i) REQUIRE(world.step(0.1));
  CHECK(world.state(id).heading > 0.1);
  CHECK(world.state(id).y > -100);
  world.template memory<cb::ExternalInput>(id) = {-3.0, 0.0};
  for (int i = 0; i < 30; ++i) {
    REQUIRE(world.step(0.1));
    CHECK(world.state(id).speed >= 0.0);
  }
  CHECK(world.state(id).speed == 0.0);
  world.template memory<cb::ExternalInput>(id) = {1.0, 0.0};
  for (int i = 0; i < 20; ++i) REQUIRE(world.step(0.1));
  CHECK(world.state(id).speed > 1.0);
}

TEST_CASE_TEMPLATE("no sequence of actions makes a vehicle reverse, or its state no number", Model, cb::SingleTrack,
                   cb::SingleTrackSteering, cb::TripleIntegrator, cb::KinematicPoint, Tank) {
  cb::RandomStream random(4, 0, 0);
  Model const model;
  typename Model::State x{};
  x.speed = 3.0;
  for (int i = 0; i < 20000; ++i) {
    cb::Action const action{0.5 * (static_cast<double>(cb::uniform_index(random, 33)) - 16.0),
                            2.0 * cb::uniform01(random) - 1.0};
    x = cb::drive(model, x, action, 0.01 + 0.2 * cb::uniform01(random));
    REQUIRE(cb::is_finite(x));
    REQUIRE(x.speed >= 0.0);
    REQUIRE(x.speed < 60.0);
  }
}

TEST_CASE_TEMPLATE("a vehicle that brakes becomes no faster, however it is steered, and stands in the end", Model,
                   cb::SingleTrack, cb::SingleTrackSteering, cb::TripleIntegrator, cb::KinematicPoint,
                   cb::DynamicSet<cb::TripleIntegrator>) {
  Model const model{};
  int growing = 0, standing = 0, runs = 0;
  for (double const speed : {0.3, 1.0, 2.0, 3.0, 5.0, 10.0, 25.0})
    for (double const steering : {0.0, 0.05, -0.25, 0.5, 1.2})
      for (double const braking : {-0.2, -1.0, -2.0, -8.0})
        for (double const dt : {0.01, 0.05, 0.2, 0.5}) {
          typename Model::State x{};
          x.speed = speed;
          while (x.time < 1.0 - 1e-9) x = cb::drive(model, x, {0.0, steering}, dt);
          double const long_enough = x.time + 2.0 * speed / -braking + 6.0;
          bool grows = false;
          while (x.time < long_enough) {
            double const before = x.speed;
            x = cb::drive(model, x, {braking, steering}, dt);
            grows = grows || !(x.speed <= before + 1e-12);
          }
          ++runs;
          growing += grows;
          standing += x.speed == 0.0;
        }
  CHECK(growing == 0);
  CHECK(standing == runs);
}

TEST_CASE_TEMPLATE("in a set every vehicle model does what it does alone, to the bit and whatever the step", Model,
                   cb::SingleTrack, cb::SingleTrackSteering, cb::TripleIntegrator, cb::KinematicPoint, Tank) {
  Model const model;
  cb::DynamicSet<Model> const set(model);
  for (double const dt : {0.05, 0.2, 1.0}) {
    CAPTURE(dt);
    typename Model::State alone{};
    alone.speed = 2.5;
    auto in_set = alone;
    auto euler_alone = alone, euler_in_set = alone;
    for (int i = 0; i < 40; ++i) {
      cb::Action const action{i % 13 < 9 ? 0.4 : -3.0, i % 7 < 4 ? 0.05 : -0.3};
      alone = cb::drive(model, alone, action, dt);
      in_set = cb::drive(set, in_set, action, dt);
      CHECK(in_set == alone);
      euler_alone = cb::drive<true>(model, euler_alone, action, dt);
      euler_in_set = cb::drive<true>(set, euler_in_set, action, dt);
      CHECK(euler_in_set == euler_alone);
    }
  }
}

TEST_CASE("a set's steering comes to the angle that is asked for, in steps longer than its response time too") {
  cb::DynamicSet<cb::SingleTrackSteering> const set;
  for (double const dt : {0.05, 0.2, 0.5, 1.0}) {
    cb::SingleTrackSteering::State x{.speed = 10.0};
    while (x.time < 3.0) {
      x = cb::drive(set, x, {0.0, 0.05}, dt);
      CHECK(x.steering >= 0.0);
      CHECK(x.steering <= 0.05 + 1e-12);
    }
    CHECK(x.steering == doctest::Approx(0.05).epsilon(1e-6));
  }
}

TEST_CASE("a truck, a pedestrian and a user's own vehicle move in one world, each as it does alone") {
  using Set = cb::DynamicSet<cb::SingleTrack, cb::KinematicPoint, Tank>;
  World<Set> mixed(straight_road(60, 400));
  cb::SingleTrack const truck{.wheel_base = 5.8, .highest_acceleration = 1.0};
  cb::KinematicPoint const pedestrian;
  cb::ExternalInput::Memory const input{1.2, 0.1};
  auto const t = enter<Set>(mixed, 8.0, truck, -30), p = enter<Set>(mixed, 1.0, pedestrian, -60),
             own = enter<Set>(mixed, 3.0, Tank{}, -90);
  for (auto const id : {t, p, own}) mixed.memory<cb::ExternalInput>(id) = input;
  for (int i = 0; i < 10; ++i) REQUIRE(mixed.step(0.1));
  auto const alone = [&]<class Model>(Model const& model, double speed, double y) {
    World<Model> world(straight_road(60, 400));
    auto const id = enter(world, speed, model, y);
    world.template memory<cb::ExternalInput>(id) = input;
    for (int i = 0; i < 10; ++i) REQUIRE(world.step(0.1));
    return world.state(id);
  };
  CHECK(mixed.state(t) == alone(truck, 8.0, -30));
  CHECK(mixed.state(p) == alone(pedestrian, 1.0, -60));
  CHECK(mixed.state(own) == alone(Tank{}, 3.0, -90));
  CHECK(mixed.roster().agents[0].dynamics.wheel_base() == 5.8);
  CHECK(mixed.record(t).action.acceleration == 1.0);
}

TEST_CASE("a parameter out of range of a set's model is refused by name") {
  using Set = cb::DynamicSet<cb::SingleTrack, cb::KinematicPoint>;
  World<Set> world(straight_road(60, 400));
  CHECK_THROWS_WITH_AS(enter<Set>(world, 1.0, cb::KinematicPoint{.yaw_rate_limit = -1}),
                       doctest::Contains("yaw_rate_limit"), cb::ParameterError);
}
