#include "cambium/behavior/pedestrian/pedestrian.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "../support/allocations.hpp"
#include "lane_traffic_fixtures.hpp"

using namespace lane_traffic;
using cb::geometry::Point;

namespace {

using Sim = Traffic<cb::Pedestrian, cb::IdmClassic, cb::ConstantAcceleration>;
using Way = std::shared_ptr<cb::map::RoadCorridor const>;

auto const road = support::straight_road(2, 600.0);  // from y = 0 to y = -7, along +x

Way way(std::vector<Point> const& points, double width = 2.0) {
  return cb::map::build_free_corridor(*road, points, {.width = width});
}

cb::AgentId walk(Sim& world, Way const& on, Point const& from, cb::Pedestrian const& behavior = {}, double speed = 0.0,
                 std::optional<double> heading = {}) {
  return world.add({.position = from,
                    .heading = heading,
                    .speed = speed,
                    .shape = cb::geometry::pedestrian(),
                    .behavior = behavior,
                    .road = on});
}

bool drives(Sim const& world, cb::AgentId id) { return world.status(id) == cb::AgentStatus::driving; }

/// Distance of two bodies, as circles [m].
double apart(Sim const& world, cb::AgentId a, cb::AgentId b) {
  return std::hypot(world.state(a).x - world.state(b).x, world.state(a).y - world.state(b).y) - 0.6;
}

/// Vehicles at constant speed, or IDM drivers, on both lanes.
template <class Driver>
void add_vehicles(Sim& world, cb::RandomStream& random, double mean_gap, double least, double most,
                  Driver const& driver) {
  for (double const y : {-1.75, -5.25}) {
    double const speed = between(least, most, random);  // the same in a lane, so that nobody need follow
    for (double x = between(5.0, 60.0, random); x < 300.0; x += 6.0 + between(0.0, 2.0, random) * mean_gap * speed)
      world.add({.position = {x, y}, .speed = speed, .behavior = driver(speed)});
  }
}

/// Shortest time [s] in which a vehicle in the lane that the body has just entered would reach it.
double time_left(Sim const& world, cb::AgentId walker) {
  auto const& own = world.state(walker);
  double least = 1e9;
  for (std::size_t i = 0; i < world.size(); ++i) {
    auto const& agent = world.roster().agents[i];
    auto const& state = world.frame().agents[i].state;
    if (agent.shape.length() < 1.0 || std::abs(state.y - own.y) > 1.75 + 0.3) continue;
    double const way = own.x - 0.3 - (state.x + agent.shape.front);
    if (way > -5.1) least = std::min(least, std::max(0.0, way) / std::max(0.1, state.speed));
  }
  return least;
}

/// How uniformly pedestrians walk (after Rex and Löwen 2007): mean of (same - other) / (same + other) direction over
/// the neighbours within 6 m in a stripe 1 m wide, for those between x = 15 and 45 m.
double order(Sim const& world) {
  double sum = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < world.size(); ++i) {
    auto const& one = world.frame().agents[i].state;
    if (one.x < 15 || one.x > 45) continue;
    int same = 0, other = 0;
    for (std::size_t k = 0; k < world.size(); ++k) {
      auto const& two = world.frame().agents[k].state;
      if (k == i || std::abs(two.y - one.y) > 0.5 || std::abs(two.x - one.x) > 6.0) continue;
      ++(world.roster().agents[k].road == world.roster().agents[i].road ? same : other);
    }
    if (same + other == 0) continue;
    sum += static_cast<double>(same - other) / (same + other);
    ++count;
  }
  return sum / std::max(1, count);
}

/// Order of an initially mixed crowd that walks both ways for 40 s; whoever reaches the end starts anew.
double order_of_crowd(std::uint32_t seed, cb::Pedestrian behavior) {
  cb::RandomStream random(seed, 4, 0);
  Sim world(road, {.seed = seed});
  auto const there = way({{0, 50}, {60, 50}}, 5.0), back = way({{60, 50}, {0, 50}}, 5.0);
  for (int i = 0; i < 60; ++i) {
    behavior.social.desired_speed = std::max(0.6, cb::Normal{1.34, 0.26}(random));
    bool const goes = i % 2 == 0;
    walk(world, goes ? there : back, {between(10, 50, random), between(48.1, 51.9, random)}, behavior, 1.0,
         goes ? 0.0 : cb::geometry::pi);
  }
  for (int i = 0; i < 400; ++i) {
    REQUIRE(world.step(0.1));
    for (std::size_t k = 0; k < world.size(); ++k) {
      auto state = world.frame().agents[k].state;
      double const shift = k % 2 == 0 && state.x > 50 ? -40.0 : k % 2 == 1 && state.x < 10 ? 40.0 : 0.0;
      state.x += shift;
      if (shift != 0.0) world.set_state(world.roster().agents[k].id, state);
    }
  }
  return order(world);
}

}  // namespace

TEST_CASE("alone on its way a pedestrian reaches its desired speed with tau, and arrives") {
  Sim world(road);
  auto const id = walk(world, way({{0, 50}, {60, 50}}), {1, 50}, {.fluctuation = 0.0});
  for (int i = 1; i <= 20; ++i) {
    REQUIRE(world.step(0.1));
    CHECK(world.state(id).speed == doctest::Approx(1.34 * (1 - std::exp(-0.1 * i / 0.5))).epsilon(1e-6));
    CHECK(world.state(id).y == doctest::Approx(50.0));
  }
  for (int i = 0; i < 450; ++i) REQUIRE(world.step(0.1));
  CHECK(world.status(id) == cb::AgentStatus::arrived);
}

TEST_CASE("a pedestrian stays on its way in bends") {
  Sim world(road);
  auto const bent = way({{0, 50}, {10, 50}, {10, 60}, {20, 60}, {12, 70}});
  auto const id = walk(world, bent, {0, 50});
  double farthest = 0.0;
  for (int i = 0; i < 600 && drives(world, id); ++i) {
    REQUIRE(world.step(0.1));
    farthest = std::max(farthest, std::abs(world.record(id).lane.lateral));
  }
  CHECK(world.status(id) == cb::AgentStatus::arrived);
  CHECK(farthest < 1.5);
}

TEST_CASE("two pedestrians whose ways meet or cross evade each other") {
  for (bool const cross : {false, true}) {
    double smallest = 1e9;
    for (std::uint32_t seed = 0; seed < 100; ++seed) {
      CAPTURE(seed);
      cb::RandomStream random(seed, 0, 0);
      Sim world(road, {.seed = seed});
      double const width = cross ? 2.0 : 3.0, v = between(0.8, 1.8, random), w = cross ? v : between(0.8, 1.8, random);
      double const shift = between(-0.3, 0.3, random),
                   other = cross ? between(-1, 1, random) : between(-0.3, 0.3, random);
      auto const a = walk(world, way({{0, 50}, {20, 50}}, width), {0, 50 + shift}, {.social = {.desired_speed = v}}, v);
      auto const b =
          cross ? walk(world, way({{10, 40}, {10, 60}}), {10, 40 + other}, {.social = {.desired_speed = w}}, w)
                : walk(world, way({{20, 50}, {0, 50}}, width), {20, 50 + other}, {.social = {.desired_speed = w}}, w);
      for (int i = 0; i < 400; ++i) {
        REQUIRE(world.step(0.1));
        if (drives(world, a) && drives(world, b)) smallest = std::min(smallest, apart(world, a, b));
      }
      CHECK(world.status(a) == cb::AgentStatus::arrived);
      CHECK(world.status(b) == cb::AgentStatus::arrived);
    }
    CHECK(smallest > 0.0);
  }
}

TEST_CASE("a pedestrian crosses in gaps and is never hit by vehicles that ignore it") {
  int crossed = 0, waited = 0;
  double least = 1e9;
  for (std::uint32_t seed = 0; seed < 80; ++seed) {
    CAPTURE(seed);
    cb::RandomStream random(seed, 2, 0);
    Sim world(road, {.seed = seed});
    bool const back = seed % 2 == 1;
    auto const across = back ? way({{320, -14}, {320, 8}}) : way({{320, 8}, {320, -14}});
    auto const id =
        walk(world, across, {320, back ? -14.0 : 8.0},
             {.social = {.desired_speed = between(0.9, 1.8, random)}, .crossing = {.assumed_acceleration = 0}});
    add_vehicles(world, random, between(1.0, 10.0, random), 8.0, 20.0,
                 [](double) { return cb::ConstantAcceleration{}; });
    double entered = 1e9;
    for (int i = 0; i < 500 && drives(world, id); ++i) {
      bool const was_beside = world.state(id).y > 0.3 || world.state(id).y < -7.3;
      drive_safely(world, 1, 0.1);
      bool const is_in = world.state(id).y < 0.3 && world.state(id).y > -7.3;
      if (was_beside && is_in) entered = world.time(), least = std::min(least, time_left(world, id));
    }
    crossed += !drives(world, id);
    waited += entered > 12.0;
  }
  CHECK(crossed == 80);
  CHECK(waited > 20);
  CHECK(least > 3.0);
}

TEST_CASE("a pedestrian enters if it clears the lane a time margin before the next vehicle; on its way, no margin") {
  double const walking = 1.34, speed = 20.0;  // of the vehicle, which comes in the farther lane
  // Time [s] until the latest vehicle arrives for which the pedestrian slows down.
  auto const latest = [&](double y) {
    for (double distance = 220.0; distance > 20.0; distance -= 0.5) {
      Sim world(road);
      auto const id = walk(world, way({{320, 8}, {320, -14}}), {320, y},
                           {.crossing = {.time_margin = 3.0, .assumed_acceleration = 0}, .fluctuation = 0.0}, walking);
      world.add({.position = {320 - 0.3 - cb::geometry::car().front - distance, -5.25},
                 .speed = speed,
                 .behavior = cb::ConstantAcceleration{}});
      REQUIRE(world.step(0.1));
      if (world.state(id).speed < walking - 0.04) return distance / speed;
    }
    return 0.0;
  };
  for (double const y : {0.4, -1.0, -2.0, -3.0}) {
    double const clearance = (y + 0.3 + 7.0) / walking, margin = y > 0.0 ? 3.0 : 0.0;
    CAPTURE(y);
    CHECK(std::abs(latest(y) - (clearance + margin)) < 0.06);
  }
}

TEST_CASE("a pedestrian that relies on braking drivers gets across unhurt") {
  int crossed = 0;
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    CAPTURE(seed);
    cb::RandomStream random(seed, 3, 0);
    Sim world(road, {.seed = seed});
    auto const across = way({{320, 6}, {320, -12}}, 4.0);
    std::vector<cb::AgentId> walkers;
    for (int i = 0; i < 3; ++i)
      walkers.push_back(walk(world, across, {319.0 + i, 6.0 + between(0.0, 1.0, random)},
                             {.crossing = {.demanded_deceleration = 2.0}}));
    add_vehicles(world, random, 1.5, 8.0, 14.0,
                 [](double speed) { return cb::IdmClassic{.law = {.desired_speed = speed}}; });
    drive_safely(world, 900, 0.1);
    for (auto const id : walkers) crossed += world.status(id) == cb::AgentStatus::arrived;
  }
  CHECK(crossed == 120);
}

TEST_CASE("two pedestrians who meet on a way too narrow for both pass each other") {
  int passed = 0;
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    Sim world(road, {.seed = seed});
    cb::RandomStream random(seed, 6, 0);
    cb::Pedestrian const one{.social = {.desired_speed = between(1.0, 1.6, random)}};
    cb::Pedestrian const two{.social = {.desired_speed = between(1.0, 1.6, random)}};
    auto const a = walk(world, way({{0, 50}, {20, 50}}, 1.0), {0, 50}, one);
    auto const b = walk(world, way({{20, 50}, {0, 50}}, 1.0), {20, 50}, two);
    for (int i = 0; i < 600; ++i) REQUIRE(world.step(0.1));
    passed += world.status(a) == cb::AgentStatus::arrived && world.status(b) == cb::AgentStatus::arrived;
  }
  CHECK(passed == 40);
}

TEST_CASE("a pedestrian between two lanes does not wait for a queue of traffic to end, and is not hit") {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    CAPTURE(seed);
    Sim world(road, {.seed = seed});
    auto const id = walk(world, way({{320, 8}, {320, -14}}), {320, -2.7});  // in the first lane, before the second
    double const speed = 4.0 + 0.1 * seed;
    for (double x = 315.0 - 0.5 * seed; x > 5.0; x -= 6.5 + 1.6 * speed)
      world.add({.position = {x, -5.25}, .speed = speed, .behavior = cb::IdmClassic{.law = {.desired_speed = speed}}});
    double crossed = 1e9;
    for (int i = 0; i < 300 && crossed > 1e8; ++i) {
      drive_safely(world, 1, 0.1);
      if (world.state(id).y < -7.3) crossed = world.time();
    }
    CHECK(crossed < 15.0);
  }
}

TEST_CASE("a crowd forms lanes of one direction, but not with the forces of 1995 or without forces") {
  double formed = 0.0, mixed = 0.0, published = 0.0;
  for (std::uint32_t seed = 0; seed < 3; ++seed) {
    formed += order_of_crowd(seed, {}) / 3;
    mixed += order_of_crowd(seed, {.social = {.repulsion = 0.0, .contact_acceleration = 0.0}}) / 3;
    published += order_of_crowd(seed, {.social = {.relative_stride = false}}) / 3;
  }
  CHECK(std::abs(mixed) < 0.2);
  CHECK(std::abs(published) < 0.2);
  CHECK(formed > 0.5);
}

TEST_CASE("pedestrians stop before a static object, or go round it") {
  for (std::uint32_t seed = 0; seed < 30; ++seed) {
    CAPTURE(seed);
    cb::RandomStream random(seed, 5, 0);
    Sim world(road, {.seed = seed});
    auto const along = way({{0, 50}, {30, 50}}, 4.0);
    double const x = between(10, 20, random), y = 50 + between(-1.5, 1.5, random), half = between(0.1, 1.0, random);
    world.add_object(cb::geometry::Polygon({{x, y - half}, {x + 0.6, y - half}, {x + 0.6, y + half}, {x, y + half}}));
    auto const id = walk(world, along, {1, 50}, {}, 1.34);
    for (int i = 0; i < 300 && drives(world, id); ++i) drive_safely(world, 1, 0.1);
    if (std::abs(y - 50) > half + 0.4) CHECK(world.status(id) == cb::AgentStatus::arrived);
  }
}

TEST_CASE("steps, copies and the order of entering do not change a bit; no step allocates") {
  auto const across = way({{320, 6}, {320, -12}}, 4.0), along = way({{310, 3}, {330, 3}}, 3.0);
  auto const fill = [&](bool turned) {
    Sim world(road, {.seed = 5});
    for (int k = 0; k < 12; ++k) {
      int const i = turned ? 11 - k : k;
      auto const id = static_cast<cb::AgentId>(i);
      if (i % 3 == 2)
        world.add({.position = {200.0 + 10 * i, -1.75}, .speed = 8, .behavior = cb::IdmClassic{}, .id = id});
      else
        world.add({.position = i % 3 ? Point{311.0 + i, 3.0 + 0.1 * i} : Point{320 + 0.2 * i, 5.0},
                   .shape = cb::geometry::pedestrian(),
                   .behavior = cb::Pedestrian{},
                   .road = i % 3 ? along : across,
                   .id = id});
    }
    return world;
  };
  auto a = fill(false), b = fill(true);
  for (int i = 0; i < 40; ++i) REQUIRE(a.step(0.1));
  auto c = fill(true);
  for (int i = 0; i < 40; ++i) {
    c = b;
    step_all(1, 0.1, b, c);
    REQUIRE(b.frame() == c.frame());
  }
  for (std::size_t i = 0; i < a.size(); ++i) CHECK(a.frame().agents[i].state == b.frame().agents[i].state);
  auto const before = support::allocations();
  for (int i = 0; i < 100; ++i) REQUIRE(b.step(0.1));
  CHECK(support::allocations() == before);
}

TEST_CASE("predictions include pedestrians, and a car is predicted to stop for one that stands in its lane") {
  Sim world(road);
  auto const across = way({{320, 6}, {320, -12}});
  auto const walker = walk(world, across, {320, 1.0}, {.social = {.desired_speed = 0.1}});
  auto const car = world.add({.position = {270, -1.75}, .speed = 10, .behavior = cb::IdmClassic{}});
  using Set = cb::BehaviorSet<cb::Pedestrian, cb::IdmClassic>;
  auto future = world.observe(car).predict(cb::predict_as<Set>(cb::IdmClassic{}, cb::Pedestrian{}));
  for (int i = 0; i < 150; ++i) REQUIRE(future.step(0.1));
  CHECK(future.status(walker) == cb::AgentStatus::arrived);
  CHECK(future.state(car).x > 320.0);

  world.set_state(walker, {.x = 320, .y = -1.75, .heading = -1.57, .speed = 0.0});
  auto stopping = world.observe(car).predict(
      cb::predict_as<Set>(cb::IdmClassic{}, cb::Pedestrian{.social = {.desired_speed = 0.1}}));
  auto const front = world.observe(car).ahead();
  REQUIRE(front);
  CHECK(front->agent == walker);
  CHECK(front->gap == doctest::Approx(50 - 3.6 - 0.3).epsilon(0.01));
  for (int i = 0; i < 110; ++i) REQUIRE(stopping.step(0.1));
  CHECK(stopping.state(car).speed < 0.5);
  CHECK(stopping.state(car).x + 3.6 < 319.7);
}

TEST_CASE("a pedestrian's state stays finite for any input") {
  auto const along = way({{0, 50}, {30, 50}});
  for (double const dt : {1e-6, 0.2, 7.0, 3600.0}) {
    Sim world(road, {.seed = 1});
    for (int i = 0; i < 6; ++i)  // several in one place
      walk(world, along, {1.0 + 0.2 * (i / 2), 50.0},
           {.social = {.desired_speed = 20,
                       .relaxation_time = 0.01,
                       .repulsion = 1000,
                       .repulsion_range = 0.01,
                       .border_repulsion = 1000,
                       .border_range = 0.01,
                       .contact_range = 0.001},
            .range = 50,
            .fluctuation = 10,
            .longest_substep = 10},
           100.0, 1.0 * i);
    for (int i = 0; i < 20; ++i) {
      CHECK(world.step(dt).failed == 0);
      for (auto const& record : world.frame().agents) CHECK(cb::is_finite(record.state));
    }
  }
}

TEST_CASE("a query in the plane finds all neighbours in any lane, as brute force does") {
  Sim world(road, {.seed = 3});
  cb::RandomStream random(3, 6, 0);
  auto const along = way({{300, 3}, {340, 3}}, 20.0);
  std::vector<cb::AgentId> ids;
  for (int i = 0; i < 30; ++i) ids.push_back(walk(world, along, {between(300, 340, random), between(-8, 12, random)}));
  for (int i = 0; i < 4; ++i)
    ids.push_back(world.add({.position = {300.0 + 12 * i, -1.75},
                             .shape = i % 2 ? cb::geometry::articulated_truck() : cb::geometry::car(),
                             .behavior = cb::IdmClassic{}}));
  int found = 0;
  for (auto const id : ids) {
    auto const view = world.observe(id);
    for (double const distance : {0.0, 1.0, 5.0, 30.0}) {
      std::vector<cb::AgentId> near, expected;
      view.around(distance, [&](auto const& other) { near.push_back(other.agent); });
      view.around(std::numeric_limits<double>::infinity(), [&](auto const& other) {
        auto const& [shape, state] = std::tie(view.shape(other), view.state(other));
        double const reach = distance + std::max(shape.front, shape.rear) + std::max(shape.left, shape.right);
        if (std::hypot(state.x - view.state().x, state.y - view.state().y) <= reach) expected.push_back(other.agent);
      });
      std::sort(near.begin(), near.end());
      CHECK(near == expected);
      found += static_cast<int>(near.size());
    }
  }
  CHECK(found > 1000);
}
