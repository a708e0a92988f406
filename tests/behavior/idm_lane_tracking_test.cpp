#include "cambium/behavior/drivers.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <array>

#include "lane_traffic_fixtures.hpp"

using namespace lane_traffic;
using cb::IdmLaneTracking;

namespace {

template <class Dynamics>
using World = cb::World<cb::BehaviorSet<IdmLaneTracking, cb::ConstantAcceleration>, cb::InterpolateExecution, Dynamics>;

/// One vehicle beside the middle lane of a road with this curvature, with a heading error.
template <class Dynamics>
World<Dynamics> beside_lane(double curvature, double lateral, double turn, double speed, Dynamics const& dynamics = {},
                            IdmLaneTracking const& driver = {}) {
  double const length = curvature == 0.0 ? 1000.0 : std::min(1000.0, 5.5 / std::abs(curvature));
  World<Dynamics> world(straight_road(3, length, curvature));
  enter(world, lane_of(world.map(), 2), 5.0,
        {.heading = turn, .speed = speed, .behavior = driver, .dynamics = dynamics}, lateral);
  return world;
}

}  // namespace

TEST_CASE("from any reasonable start the front axle converges to the centre line, also on curves, for any step") {
  double worst = 0.0;
  int arrived = 0;
  for (std::uint32_t seed = 0; seed < 150; ++seed) {
    cb::RandomStream random(seed, 0, 0);
    double const curvature = seed % 3 == 0 ? 0.0 : between(-0.05, 0.05, random);
    double const lateral = between(-1.2, 1.2, random), turn = between(-0.3, 0.3, random);
    double const fastest = std::min(20.0, std::sqrt(3.0 / std::max(1e-3, std::abs(curvature))));
    double const dt = std::array{0.05, 0.1, 0.2, 0.5}[cb::uniform_index(random, 4)];
    auto world = beside_lane<cb::SingleTrack>(curvature, lateral, turn, between(1.0, fastest, random));
    INFO("seed ", seed, ", curvature ", curvature, ", dt ", dt);
    double driven = 0.0, time = 0.0;
    while (world.frame().agents[0].status == cb::AgentStatus::driving && driven < 150.0) {
      time += dt;
      REQUIRE(world.step(dt));
      auto const& record = world.frame().agents[0];
      driven += record.state.speed * dt;
      if (record.status != cb::AgentStatus::driving || driven < 60.0 || time < 6.0) continue;
      std::uint32_t segment = record.lane.segment;
      auto const& road = *world.roster().agents[0].road;
      auto const& corridor = road.corridors[record.lane.corridor];
      if (corridor.length_until_end(record.lane.s) < 5.0) continue;  // beyond its end the line is straight
      auto const at = cb::front_axle(corridor.center, record.state, 2.7, segment);
      CHECK(std::abs(at.offset) < 0.06);
      worst = std::max(worst, std::abs(at.offset));
    }
    arrived += driven >= 60.0;
  }
  MESSAGE("largest offset of the front axle after 60 m and 6 s: " << worst << " m, in " << arrived << " starts");
  CHECK(arrived > 120);
}

TEST_CASE_TEMPLATE("any vehicle model is kept on its lane", Model, cb::SingleTrack, cb::SingleTrackSteering,
                   cb::TripleIntegrator, cb::KinematicPoint, cb::DynamicSet<cb::SingleTrack, cb::KinematicPoint>) {
  Model model{};
  if constexpr (std::is_same_v<Model, cb::KinematicPoint>) model.highest_speed = 50;
  for (double const curvature : {0.0, 0.01, -0.02}) {
    auto world = beside_lane<Model>(curvature, 0.5, 0.1, 8.0, model);
    for (int i = 0; i < 60; ++i) REQUIRE(world.step(0.2));
    auto const& record = world.frame().agents[0];
    CHECK(std::abs(record.lane.lateral) < 0.15);
    CHECK(record.state.speed > 8.0);
  }
}

TEST_CASE("the vehicle stays calm at speeds at which a held Stanley law would oscillate") {
  for (double const dt : {0.1, 0.2}) {
    IdmLaneTracking const driver{.law = {.desired_speed = 60.0}, .lateral = {.longest_substep = dt}};
    auto world = beside_lane<cb::SingleTrack>(0.0, 0.5, 0.0, 50.0, {}, driver);
    double previous = 0.6;
    for (int i = 0; i < 15 && world.frame().agents[0].status == cb::AgentStatus::driving; ++i) {
      REQUIRE(world.step(dt));
      double const lateral = world.frame().agents[0].lane.lateral;
      CHECK(lateral > -0.05);
      CHECK(lateral < previous + 1e-3);
      previous = lateral;
    }
  }
}

TEST_CASE("before a bend it brakes comfortably and enters as fast as the tyres allow") {
  for (double const radius : {15.0, 20.0, 40.0})
    for (double const dt : {0.05, 0.2, 0.4}) {
      Traffic<IdmLaneTracking> world(road_with_bend(radius));
      auto const id = world.add({.position = {10, -1.75}, .speed = 15.0});
      double const allowed = std::sqrt(4.0 * (radius + 1.75));
      double hardest = 0.0, entered = 0.0, fastest = 0.0;
      while (world.state(id).x < 240 && world.record(id).lane.s < 245) {
        REQUIRE(world.step(dt));
        hardest = std::min(hardest, world.record(id).action.acceleration);
        if (world.record(id).lane.s < 200) continue;
        if (entered == 0.0) entered = world.state(id).speed;
        fastest = std::max(fastest, world.state(id).speed);
      }
      INFO("radius ", radius, ", dt ", dt);
      CHECK(fastest < allowed);
      CHECK(entered > 0.7 * allowed);
      CHECK(hardest > -1.3 * cb::Idm{}.comfortable_deceleration);
    }
}

TEST_CASE("steering stays within the vehicle's limit and the driver's lateral acceleration") {
  IdmLaneTracking const driver;
  cb::RandomStream random(5, 0, 0);
  for (int i = 0; i < 20000; ++i) {
    double const v = between(0, 50, random), h = between(0.01, 1.0, random);
    cb::FrontAxle const at{between(-5, 5, random), between(-3.1, 3.1, random), between(-0.2, 0.2, random)};
    double const angle = driver.lateral.steering(at, v, 2.7, h);
    REQUIRE(std::isfinite(angle));
    CHECK(v * v * std::abs(std::tan(angle)) <= driver.lateral.lateral_acceleration_limit * 2.7 * (1 + 1e-9) + 1e-9);
  }
  CHECK(driver.lateral.steering({}, 0.0, 2.7, 0.2) == 0.0);
}

TEST_CASE("in dense traffic on a curve nobody collides") {
  World<cb::SingleTrack> world(straight_road(3, 600, 0.005));
  cb::RandomStream random(6, 0, 0);
  for (int i = 0; i < 30; ++i)
    enter(world, lane_of(world.map(), 1 + i % 3), 10.0 + 25.0 * (i / 3) + 3.0 * cb::uniform01(random),
          {.speed = 8.0, .behavior = IdmLaneTracking{.law = {.desired_speed = between(10, 20, random)}}});
  drive_safely(world, 70);
}
