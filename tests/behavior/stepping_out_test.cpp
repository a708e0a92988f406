// Drivers brake for pedestrians who are about to step onto the road, and for nobody else beside it.

#include "cambium/behavior/law/stepping_out.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <vector>

#include "../support/scale.hpp"
#include "lane_traffic_fixtures.hpp"

using namespace lane_traffic;
using cb::geometry::Point;

namespace {

using Sim = Traffic<cb::ConstantAcceleration, cb::Pedestrian, ALL_DRIVERS>;

auto const road = support::straight_road(1, 600.0);  // y from 0 to -3.5, along +x

/// A pedestrian who goes from one point towards another at constant speed, from `set_off` on.
cb::AgentId walker(Sim& world, Point const& from, Point const& to, double speed = 0.0) {
  std::vector<Point> const points{from, to};
  return world.add({.position = from,
                    .speed = speed,
                    .shape = cb::geometry::pedestrian(),
                    .behavior = cb::ConstantAcceleration{},
                    .road = cb::map::build_free_corridor(world.map(), points)});
}

void set_off(Sim& world, cb::AgentId id, double speed) {
  auto state = world.state(id);
  state.speed = speed;
  world.set_state(id, state);
}

/// Whether a vehicle and a body that both go on evenly come to the same place within the margins of
/// `stop_before_crossing`, found by trying out all times.
bool meet_by_trial(cb::detail::LaneReach const& own, double speed, cb::detail::LaneReach const& other, double along,
                   double across, double horizon) {
  double const fast = std::max(speed, 2.0), h = 0.005;
  auto const in_way = [&](double t) {
    return other.right + across * t < own.left + 0.3 && other.left + across * t > own.right - 0.3;
  };
  auto const beside = [&](double t) {
    return own.begin + fast * t < other.end + along * t && own.end + fast * t > other.begin + along * t;
  };
  bool enters = false;
  for (double t = 0.0; t <= horizon; t += h) enters = enters || in_way(t);
  if (!enters) return false;
  std::vector<double> crossing, passing;
  for (double t = 0.0; t <= 60.0; t += h) {
    if (in_way(t)) crossing.push_back(t);
    if (beside(t)) passing.push_back(t);
  }
  return !crossing.empty() && !passing.empty() && crossing.front() <= passing.back() + 0.5 &&
         crossing.back() + 1.0 >= passing.front();
}

}  // namespace

TEST_CASE("a driver brakes for those who will be in its way, as found by trying out all times") {
  int met = 0, different = 0;
  for (std::uint32_t seed = 0; seed < 3000; ++seed) {
    CAPTURE(seed);
    cb::RandomStream random(seed, 21, 0);
    double const speed = between(0.0, 16.0, random), along = between(-2.0, 1.5, random), x = between(4.0, 60.0, random),
                 y = between(-9.0, 9.0, random);
    double across = between(-2.5, 2.5, random);
    if (std::abs(across) < 0.15) across = 0.15;
    cb::detail::LaneReach const own{-0.9, 3.6, -0.9, 0.9}, other{x - 0.3, x + 0.3, y - 0.3, y + 0.3};
    double const stop = cb::detail::stop_before_crossing(own, speed, other, along, across, 4.0);
    bool const meets = meet_by_trial(own, speed, other, along, across, 4.0);
    if (std::isfinite(stop)) CHECK(stop <= other.begin + std::abs(along) * 8.0 + 1e-9);
    met += meets;
    different += meets != std::isfinite(stop);
  }
  CHECK(met > 300);
  CHECK(met < 2700);
  CHECK(different < 30);  // where a time misses a limit by less than the step of the trial, or the stop is behind
}

TEST_CASE("whoever is told by speed and place alone to stay away crosses nobody's way") {
  std::vector<Point> const points{{0.0, 0.0}, {50.0, 0.0}, {80.0, 20.0}, {80.0, 80.0}};
  auto const line = cb::geometry::Line::from_points(points);
  int away = 0, crossing = 0;
  for (std::uint32_t seed = 0; seed < 20'000; ++seed) {
    CAPTURE(seed);
    cb::RandomStream random(seed, 23, 0);
    cb::State const state{0.0, between(-30.0, 110.0, random), between(-30.0, 110.0, random), between(-3.2, 3.2, random),
                          between(0.0, 8.0, random)};
    auto const shape = cb::uniform01(random) < 0.5 ? cb::geometry::pedestrian() : cb::geometry::car();
    double const s = between(0.0, 90.0, random), horizon = between(0.5, 5.0, random);
    cb::detail::LaneReach const own{s - 0.9, s + 3.6, -0.9, 0.9};
    auto const at = line.project({state.x, state.y}, line.find(s));
    double const farthest = std::max(shape.front, shape.rear) + std::max(shape.left, shape.right);
    auto const frenet = cb::geometry::to_frenet(line, state, at);
    double const stop = cb::detail::stop_before_crossing(own, between(0.0, 16.0, random),
                                                         cb::detail::lane_reach(line, state, shape, at.segment),
                                                         frenet.longitudinal_speed, frenet.lateral_speed, horizon);
    bool const stays_away = cb::detail::CrossingBound{at, state.speed, farthest}.stays_away(own, horizon);
    if (stays_away || state.speed < cb::detail::least_crossing_speed)
      CHECK(stop == std::numeric_limits<double>::infinity());
    away += stays_away;
    crossing += std::isfinite(stop);
  }
  CHECK(away > 10'000);
  CHECK(crossing > 200);
}

TEST_CASE_TEMPLATE("a driver who can stop does not hit a pedestrian who steps onto the road", Behavior, ALL_DRIVERS) {
  int could_stop = 0, braked = 0;
  for (std::uint32_t seed = 0; seed < support::runs(60); ++seed) {
    CAPTURE(seed);
    cb::RandomStream random(seed, 22, 0);
    Sim world(road, {.seed = seed});
    bool const from_right = cb::uniform01(random) < 0.5;
    double const x = 150.0, kerb = between(0.4, 3.0, random), slant = between(-3.0, 3.0, random);
    auto const id = add(world, 1, between(5.0, 40.0, random), between(3.0, 14.0, random), Behavior{});
    Point const from{x, from_right ? -3.5 - kerb : kerb}, to{x + slant, from_right ? 8.0 : -11.5};
    auto const pedestrian = walker(world, from, to);
    double const trigger = between(3.0, 60.0, random), pace = between(0.6, 2.2, random), dt = 0.1;
    bool walks = false, can_stop = false;
    double hardest = 0.0;
    for (int i = 0; i < 400; ++i) {
      auto const& state = world.state(id);
      double const gap = x - std::max(0.0, -slant) - 0.5 - state.x - 3.6;
      if (!walks && gap < trigger) {
        walks = true;
        set_off(world, pedestrian, pace);
        double const speed = state.speed;
        can_stop = gap > speed * speed / (2.0 * 5.0) + 0.5;
      }
      REQUIRE(world.step(dt));
      if (walks) hardest = std::min(hardest, world.record(id).action.acceleration);
      if (can_stop) REQUIRE(collisions(world) == 0);
      if (world.state(id).x > x + 20.0) break;
    }
    could_stop += can_stop;
    braked += can_stop && hardest < -0.5;
    CHECK(world.state(id).x > x + 20.0);  // and drives on afterwards
  }
  CHECK(2 * could_stop > static_cast<int>(support::runs(60)));
  CHECK(6 * braked > static_cast<int>(support::runs(60)));
}

TEST_CASE("a driver brakes comfortably for a pedestrian still beside the road, and less hard when it is in the lane") {
  auto const hardest = [](double crossing_time) {
    Sim world(road);
    auto const id =
        add(world, 1, 20.0, 10.0, cb::IdmClassic{.law = {.desired_speed = 10.0}}.with(cb::Pedestrians{crossing_time}));
    auto const pedestrian = walker(world, {100.0, 3.0}, {100.0, -10.0});
    std::pair<double, double> result;
    for (int i = 0; i < 300; ++i) {
      if (!(world.state(pedestrian).speed > 0.0) && world.state(id).x > 100.0 - 3.6 - 38.0)
        set_off(world, pedestrian, 1.0);
      bool const is_beside = world.state(pedestrian).y > 0.3;  // the kerb is at 0
      REQUIRE(world.step(0.1));
      double& least = is_beside ? result.first : result.second;
      least = std::min(least, world.record(id).action.acceleration);
    }
    CHECK(world.state(id).x > 120.0);
    return result;
  };
  auto const with = hardest(4.0), without = hardest(0.0);
  CHECK(with.first < -1.0);
  CHECK(with.first > -1.75);
  CHECK(without.first > -0.01);
  CHECK(with.second > without.second + 0.5);
}

TEST_CASE("nobody brakes for a pedestrian who waits, walks along the kerb, walks away, or crosses much later") {
  auto const drives_freely = [](Point const& from, Point const& to, double speed) {
    Sim world(road);
    auto const id = add(world, 1, 20.0, 12.0, cb::IdmClassic{.law = {.desired_speed = 12.0}});
    walker(world, from, to, speed);
    for (int i = 0; i < 100; ++i) {
      REQUIRE(world.step(0.1));
      if (world.record(id).action.acceleration < -0.01) return false;
    }
    return true;
  };
  CHECK(drives_freely({100.0, 0.5}, {100.0, -10.0}, 0.0));   // waits, facing the road
  CHECK(drives_freely({100.0, 0.5}, {140.0, 0.5}, 0.0));     // waits, facing along it
  CHECK(drives_freely({90.0, 0.5}, {140.0, 0.5}, 1.3));      // walks along it
  CHECK(drives_freely({140.0, 0.5}, {90.0, 0.5}, 1.3));      // and towards the vehicle
  CHECK(drives_freely({100.0, 0.5}, {100.0, 20.0}, 1.3));    // walks away
  CHECK(drives_freely({100.0, 30.0}, {100.0, -10.0}, 1.3));  // far away
  CHECK_FALSE(drives_freely({100.0, 8.5}, {100.0, -10.0}, 1.3));
}

TEST_CASE_TEMPLATE("a driver goes on past pedestrians who stand beside it, and still follows the next vehicle", Driver,
                   cb::IdmClassic, cb::Mobil, cb::UrbanDriver) {
  Traffic<Driver, cb::ConstantAcceleration> world(road);
  auto const truck =
      world.add({.position = {20.0, -1.75}, .heading = 0.0, .shape = cb::geometry::truck(), .behavior = Driver{}});
  for (double const x : {23.0, 24.5}) {
    std::vector<Point> const points{{x, -0.15}, {x, -10.0}};
    world.add({.position = points.front(),
               .shape = cb::geometry::pedestrian(),
               .behavior = cb::ConstantAcceleration{},
               .road = cb::map::build_free_corridor(world.map(), points)});
  }
  world.add({.position = {60.0, -1.75}, .heading = 0.0, .behavior = cb::ConstantAcceleration{}});
  for (int i = 0; i < 200; ++i) REQUIRE(world.step(0.2));
  CHECK(world.state(truck).x > 45.0);
  CHECK(world.state(truck).x < 60.0 - 0.9 - 7.2);
}

TEST_CASE("a pedestrian and a driver do not wait for each other for good") {
  for (std::uint32_t seed = 0; seed < support::runs(20); ++seed) {
    CAPTURE(seed);
    cb::RandomStream random(seed, 23, 0);
    Sim world(road, {.seed = seed});
    std::vector<Point> const points{{150.0, between(1.0, 12.0, random)}, {150.0, -12.0}};
    auto const pedestrian = world.add({.position = points.front(),
                                       .shape = cb::geometry::pedestrian(),
                                       .behavior = cb::Pedestrian{},
                                       .road = cb::map::build_free_corridor(*road, points)});
    for (double s = 5.0; s < 130.0; s += between(12.0, 30.0, random)) add(world, 1, s, 7.0, cb::IdmClassic{});
    drive_safely(world, 600, 0.1);
    CHECK(world.status(pedestrian) != cb::AgentStatus::driving);
    for (auto const& record : world.frame().agents) CHECK(record.state.x > 150.0 - 1.0);
  }
}

TEST_CASE("without the rule, drivers heed pedestrians only in their lane") {
  auto const drive = [](double crossing_time, bool has_pedestrian) {
    Sim world(road);
    auto const id = add(world, 1, 20.0, 12.0, cb::IdmClassic{}.with(cb::Pedestrians{crossing_time}));
    if (has_pedestrian) walker(world, {100.0, 7.0}, {100.0, 0.8}, 1.2);  // ends beside the lane
    std::vector<cb::State> states;
    for (int i = 0; i < 70; ++i) {
      REQUIRE(world.step(0.1));
      states.push_back(world.state(id));
    }
    return states;
  };
  CHECK(drive(0.0, true) == drive(4.0, false));
  CHECK_FALSE(drive(4.0, true) == drive(4.0, false));
}
