// IDM on a single lane from safe gaps does not collide: a property, over thousands of sampled scenarios.
#include <doctest/doctest.h>

#include "../world/fixtures.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/evaluation/collision.hpp"
#include "platoon.hpp"

using namespace fixtures;

namespace {

/// What the first vehicle meets.
enum class Ahead {
  free_road,
  brakes,    ///< it brakes to standstill itself, as hard as IDM would at most
  obstacle,  ///< something stands in its lane, far enough to stop comfortably
};

struct Course {
  int vehicles = 0;
  bool collided = false, reversed = false, invalid = false;
  double standing = 0.0;  ///< part of the vehicles at the end
  double hardest = 0.0;   ///< braking [m/s^2]
};

/// About 8 vehicles.
Sim sample(Sim const& empty, cb::map::LaneCorridor const& corridor, Ahead ahead, cb::RandomStream& random) {
  Sim world = empty;
  auto const vehicles = draw_platoon(random, 270.0).traffic.sample(random);
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    auto const& v = vehicles[i];
    auto const pose = corridor.center.pose(v.s);
    Sim::AgentSpec spec{
        .position = pose.position(), .heading = pose.heading, .speed = v.speed, .shape = v.shape, .behavior = v.driver};
    if (i == 0 && ahead == Ahead::brakes)
      spec.behavior =
          cb::ConstantAcceleration{.acceleration = cb::Uniform{v.driver.law.lowest_acceleration, -0.5}(random)};
    if (i == 0 && ahead == Ahead::obstacle) {
      double const headway = cb::Uniform{0.8, 3.0}(random);
      auto const at = v.s + v.shape.front + cb::LaneTraffic::safe_gap(v.driver, v.speed, 0.0, headway);
      world.add_object(cb::geometry::polygon_of(
          cb::geometry::box_of(cb::geometry::Shape{1.0, 0.0, 1.0, 1.0}, corridor.center.pose(at))));
    }
    world.add(spec);
  }
  return world;
}

Course drive(Sim world, double dt) {
  constexpr double horizon = 15.0;  // [s]
  Course course;
  course.vehicles = static_cast<int>(world.size());
  for (int i = 0; i * dt < horizon; ++i) {
    course.invalid = course.invalid || !world.step(dt);
    course.collided = course.collided || cb::AnyCollision{}(world);
    for (auto const& record : world.frame().agents) {
      course.reversed = course.reversed || record.state.speed < 0.0;
      course.hardest = std::min(course.hardest, record.action.acceleration);
    }
  }
  for (auto const& record : world.frame().agents)
    course.standing += (record.state.speed < 0.1) / static_cast<double>(world.size());
  return course;
}

/// Drives `scenarios` of them on one road, and reports.
void check_safe(double curvature, Ahead ahead, std::uint32_t scenarios, std::uint64_t seed) {
  Sim empty(straight_road(1, 1000.0, curvature));
  auto const first = empty.add({.position = {0.5, -1.75}});
  auto const shared = empty.roster().agents[0].road;
  auto const& road = *shared;
  empty.remove(first);
  int vehicles = 0;
  double standing = 0.0, hardest = 0.0;
  for (std::uint32_t number = 0; number < scenarios; ++number) {
    cb::RandomStream random(seed, number, 0);
    double const dt = 0.1 * (1 + cb::uniform_index(random, 5));
    auto const course = drive(sample(empty, road.corridors[road.main], ahead, random), dt);
    CAPTURE(number);
    CAPTURE(dt);
    CHECK_FALSE(course.collided);
    CHECK_FALSE(course.reversed);
    CHECK_FALSE(course.invalid);
    vehicles += course.vehicles;
    standing += course.standing;
    hardest = std::min(hardest, course.hardest);
  }
  MESSAGE(scenarios << " scenarios of " << vehicles / static_cast<double>(scenarios) << " vehicles, at the end "
                    << 100 * standing / scenarios << " % stand; hardest braking " << -hardest << " m/s^2");
  CHECK(vehicles > 5 * static_cast<int>(scenarios));
}

}  // namespace

TEST_CASE("IDM from safe gaps does not collide on a free lane") { check_safe(0.0, Ahead::free_road, 2500, 1); }

TEST_CASE("IDM from safe gaps does not collide behind a leader that brakes to standstill") {
  check_safe(0.0, Ahead::brakes, 3000, 2);
}

TEST_CASE("IDM from safe gaps does not collide where something stands ahead") {
  check_safe(0.0, Ahead::obstacle, 2500, 3);
}

TEST_CASE("IDM from safe gaps does not collide in bends") {
  check_safe(0.003, Ahead::free_road, 600, 4);
  check_safe(-0.003, Ahead::brakes, 800, 5);
  check_safe(0.003, Ahead::obstacle, 600, 6);
}
