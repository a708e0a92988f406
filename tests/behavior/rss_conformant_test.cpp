// A property: RSS-conformant agents never collide with each other, however reckless their nominal behaviour.
#include "cambium/behavior/wrap/rss_conformant.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>
#include "lane_traffic_fixtures.hpp"

using namespace lane_traffic;

namespace {

template <class Nominal>
using Safe = cb::RssConformant<Nominal>;
using Behaviors =
    cb::BehaviorSet<cb::RandomMacroActions, cb::Mobil, cb::ConstantAcceleration, cb::IdmClassic,
                    Safe<cb::RandomMacroActions>, Safe<cb::Mobil>, Safe<cb::ConstantAcceleration>, Safe<cb::IdmClassic>,
                    cb::MacroActions, Safe<cb::MacroActions>, Safe<cb::IdmStochastic>>;
using World = cb::World<Behaviors, cb::InterpolateExecution, cb::SingleTrack>;

/// `nominal`, or `nominal` made safe.
template <class Nominal>
Behaviors::Any driver(Nominal const& nominal, cb::RssParameters const& rss, bool safe) {
  if (safe) return Safe<Nominal>{nominal, rss};
  return nominal;
}

/// A driver that ignores everybody, changes lanes wildly, brakes as hard as permitted, or drives normally.
Behaviors::Any sample_driver(cb::RssParameters const& rss, bool safe, cb::RandomStream& random) {
  switch (cb::uniform_index(random, 5)) {
    case 0:
    case 1:
      return driver(cb::RandomMacroActions{.interval = 2.0}, rss, safe);
    case 2:
      return driver(
          cb::Mobil{.law = {.desired_speed = between(10, 35, random)}, .lateral = {.rule = {.politeness = 0.0}}}, rss,
          safe);
    case 3:
      return driver(cb::ConstantAcceleration{.acceleration = between(-rss.maximum_deceleration, 3, random)}, rss, safe);
    default:
      return driver(cb::IdmClassic{.law = {.desired_speed = between(10, 35, random)}}, rss, safe);
  }
}

struct Tally {
  int collisions = 0, vehicles = 0, lane_changes = 0;
};

/// Nine vehicles on three lanes, each at least at its safe distance from the one ahead.
World sample(World const& empty, bool safe, cb::RandomStream& random) {
  World world = empty;
  cb::RssParameters rss;
  auto const kind = cb::uniform_index(random, 3);
  if (kind == 0)  // as BARK's
    rss = {.response_time = 0.5, .maximum_acceleration = 1.7, .maximum_deceleration = 5.0, .minimum_deceleration = 4.0};
  if (kind == 1) rss.response_time = 0.1;  // shorter than a step
  for (int lane = 0; lane < 3; ++lane) {
    double rear = between(300, 400, random), speed = between(5, 30, random);
    for (int i = 0; i < 3; ++i) {
      bool const is_truck = cb::uniform_index(random, 5) == 0;
      auto const shape = is_truck ? cb::geometry::truck() : cb::geometry::car();
      double const ahead = speed;
      speed = std::clamp(ahead + between(-5, 5, random), 0.0, 30.0);
      double const spare = cb::uniform_index(random, 2) == 0 ? 1e-6 : between(0, 30, random);
      double const x = i == 0 ? rear : rear - shape.front - cb::rss_same_direction(rss, speed, ahead) - spare;
      if (x < 10) break;
      world.add({.position = {x, -1.75 - 3.5 * lane},
                 .heading = 0.0,
                 .speed = speed,
                 .shape = shape,
                 .behavior = sample_driver(rss, safe, random)});
      rear = x - shape.rear;
    }
  }
  return world;
}

Tally drive(bool safe, std::uint32_t scenarios, std::uint64_t seed) {
  World empty(straight_road(3, 1500.0));
  for (int lane = 0; lane < 3; ++lane) empty.remove(empty.add({.position = {10, -1.75 - 3.5 * lane}}));
  Tally tally;
  World world = empty;
  for (std::uint32_t number = 0; number < scenarios; ++number) {
    cb::RandomStream random(seed, number, 0);
    double const dt = 0.1 * (2 + cb::uniform_index(random, 4));
    world = sample(empty, safe, random);
    bool collided = false;
    for (double t = 0; t < 8.0 && !collided; t += dt) {
      INFO("number ", number, ", t ", t);
      tally.lane_changes += step_and_count_changes(world, dt);
      collided = cb::AnyCollision{}(world);
      if (safe && collided) FAIL_CHECK("a collision");
    }
    tally.vehicles += static_cast<int>(world.size());
    tally.collisions += collided;
  }
  MESSAGE(tally.vehicles << " vehicles, " << tally.lane_changes << " lane changes, " << tally.collisions
                         << " scenarios with a collision");
  return tally;
}

constexpr std::size_t change_left = 5;  // of the default macro actions

/// A box of 4 m from `x` on, in the lane around `y`.
cb::geometry::Polygon box_at(double x, double y) {
  return cb::geometry::Polygon({{x, y - 1}, {x + 4, y - 1}, {x + 4, y + 1}, {x, y + 1}});
}

}  // namespace

TEST_CASE("RSS-conformant agents among RSS-conformant agents never collide") {
  auto const tally = drive(true, 10'000, 1);
  CHECK(tally.collisions == 0);
  CHECK(tally.lane_changes > 2000);
  CHECK(tally.vehicles > 60'000);
}

TEST_CASE("the same agents without RSS do collide") { CHECK(drive(false, 300, 1).collisions > 30); }

TEST_CASE("without danger the nominal behaviour drives, to the bit") {
  World safe(straight_road(3, 1500.0)), nominal(safe.shared_map());
  cb::Mobil const mobil{.law = {.desired_speed = 20}};
  for (int i = 0; i < 3; ++i) {
    double const x = 100 + 300.0 * i;
    safe.add({.position = {x, -5.25}, .speed = 20, .behavior = Safe<cb::Mobil>{mobil, {}}});
    nominal.add({.position = {x, -5.25}, .speed = 20, .behavior = mobil});
  }
  for (int i = 0; i < 20; ++i) {
    step_all(1, 0.2, safe, nominal);
    for (std::size_t a = 0; a < 3; ++a) CHECK(safe.frame().agents[a].state == nominal.frame().agents[a].state);
  }
}

TEST_CASE("an RSS-conformant agent stops for an object in its lane") {
  World world(straight_road(2, 1500.0));
  auto const blind = world.add({.position = {100, -1.75}, .speed = 20, .behavior = Safe<cb::ConstantAcceleration>{}});
  world.add_object(cb::geometry::Polygon({{250, -3}, {251, -3}, {251, -0.5}, {250, -0.5}}));
  for (int i = 0; i < 60; ++i) CHECK(world.step(0.25));
  CHECK(world.state(blind).speed == 0.0);
  CHECK(world.state(blind).x < 250 - 3.6);
  CHECK(world.state(blind).x > 200);
}

TEST_CASE("a vehicle that must brake during a lane change stays on its course and keeps its heading") {
  double const dt = 0.1;
  World safe(straight_road(3, 1500.0)), nominal(safe.shared_map());
  auto const one = safe.add({.position = {100, -5.25}, .speed = 20, .behavior = Safe<cb::MacroActions>{}});
  auto const other = nominal.add({.position = {100, -5.25}, .speed = 20, .behavior = cb::MacroActions{}});
  safe.memory<Safe<cb::MacroActions>>(one).choose(change_left);
  nominal.memory<cb::MacroActions>(other).choose(change_left);
  std::vector<cb::State> course;
  for (int i = 0; i < 100; ++i) {
    CHECK(nominal.step(dt));
    course.push_back(nominal.state(other));
  }
  safe.add_object(box_at(175, -5.25));  // in the old lane, too far to be reached before the change is complete
  double slowest = 20.0, farthest_off = 0.0;
  for (int i = 0; i < 100 && safe.state(one).y < -1.8; ++i) {
    CHECK(safe.step(dt));
    auto const at = safe.state(one);
    auto const after =
        std::find_if(course.begin() + 1, course.end(), [&](cb::State const& state) { return state.x >= at.x; });
    REQUIRE(after != course.end());
    auto const before = after - 1;
    double const u = (at.x - before->x) / (after->x - before->x);
    farthest_off = std::max(farthest_off, std::abs(at.y - (before->y + u * (after->y - before->y))));
    CHECK(std::abs(at.heading - (before->heading + u * (after->heading - before->heading))) < 2e-3);
    slowest = std::min(slowest, at.speed);
  }
  CHECK(slowest < 17.0);
  CHECK(farthest_off < 0.02);
  CHECK(safe.state(one).y > -1.8);
}

TEST_CASE("a vehicle that must keep off a side delays its lane change, and then changes without a jump") {
  World world(straight_road(2, 1500.0));
  auto const one = world.add({.position = {100, -5.25}, .speed = 15, .behavior = Safe<cb::MacroActions>{}});
  world.memory<Safe<cb::MacroActions>>(one).choose(change_left);
  REQUIRE(world.step(0.2));  // begins the change before anybody is there
  auto const beside = world.add({.position = {world.state(one).x, -1.75},
                                 .speed = 15,
                                 .behavior = cb::ConstantAcceleration{.acceleration = 0.0}});
  for (int i = 0; i < 50; ++i) {
    CHECK(world.step(0.2));
    CHECK(world.state(one).y < -3.9);
    CHECK(world.memory<Safe<cb::MacroActions>>(one).change.active());
  }
  CHECK(world.state(one).speed == 15.0);
  world.remove(beside);
  double farthest = 0.0;
  for (int i = 0; i < 30; ++i) {
    double const y = world.state(one).y;
    CHECK(world.step(0.2));
    farthest = std::max(farthest, world.state(one).y - y);
  }
  CHECK(world.state(one).y == doctest::Approx(-1.75).epsilon(1e-3));
  CHECK(farthest < 0.4);  // 3.5 m aside over 60 m
}

TEST_CASE("the memory of the nominal behaviour advances while it is overridden") {
  World world(straight_road(2, 1500.0));
  Safe<cb::IdmStochastic> const driver{.nominal = {.desired_speed = {30, 40}, .time_headway = {0.1, 0.1}}};
  auto const one = world.add({.position = {100, -1.75}, .speed = 20, .behavior = driver});
  world.add_object(box_at(189, -1.75));  // closer than RSS permits
  CHECK(world.step(0.1));
  auto const first = world.memory<Safe<cb::IdmStochastic>>(one);
  CHECK(world.record(one).action.acceleration == doctest::Approx(-4.0));
  CHECK(first.person != 0);
  CHECK(world.step(0.1));
  auto const second = world.memory<Safe<cb::IdmStochastic>>(one);
  CHECK(second.person == first.person);
}
