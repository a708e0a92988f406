// People on foot beside vehicles and objects, into which they must not walk, nor be pushed.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "cambium/behavior/pedestrian/surroundings.hpp"
#include "cambium/geometry/collision.hpp"

#include "lane_traffic_fixtures.hpp"

using namespace lane_traffic;
using cb::geometry::Point;

namespace {

using Sim = Traffic<cb::Pedestrian, cb::UrbanDriver, cb::ConstantAcceleration>;
using Way = std::shared_ptr<cb::map::RoadCorridor const>;

auto const road = support::straight_road(2, 600.0);  // from y = 0 to y = -7, along +x

Way way(Point const& from, Point const& to, double width) {
  return cb::map::build_free_corridor(*road, std::vector{from, to}, {.width = width});
}

bool walks(Sim const& world, cb::Slot slot) {
  return std::holds_alternative<cb::Pedestrian>(world.roster().agents[slot].behavior);
}

/// Pedestrians who touch a vehicle or an object.
int contacts(Sim const& world) {
  int count = 0;
  for (cb::Slot i{}; index_of(i) < world.size(); ++i) {
    if (!walks(world, i) || world.frame().agents[i].status != cb::AgentStatus::driving) continue;
    auto const body = cb::box_at(world, i);
    bool touches = false;
    for (cb::Slot k{}; index_of(k) < world.size(); ++k)
      touches = touches || (!walks(world, k) && cb::geometry::intersects(body, cb::box_at(world, k)));
    for (auto const& object : world.roster().objects)
      touches = touches || cb::geometry::intersects(object.outline, body);
    count += touches;
  }
  return count;
}

/// Adds up to `most` pedestrians on the way between two points and on the way back, 0.5 m or more from vehicles and
/// objects; returns how many.
int add_people(Sim& world, cb::RandomStream& random, Point const& from, Point const& to, double width, int most,
               double demanded = 0.0) {
  Way const there = way(from, to, width), back = way(to, from, width);
  Point const along = (to - from).normalized(), left{-along.y(), along.x()};
  double const aside = std::max(0.0, 0.5 * width - 0.3), length = (to - from).norm();
  int count = 0;
  for (int i = 0; i < most; ++i) {
    bool const goes = cb::uniform01(random) < 0.5;
    double const s = between(0.0, 5.0, random), lateral = between(-aside, aside, random);
    double const speed = std::max(0.6, cb::Normal{1.34, 0.26}(random));
    Point const at = from + (goes ? s : length - s) * along + lateral * left;
    bool is_free = true;
    for (cb::Slot k{}; index_of(k) < world.size(); ++k)
      is_free = is_free && cb::geometry::distance(cb::box_at(world, k), at) > (walks(world, k) ? 0.2 : 0.5);
    for (auto const& object : world.roster().objects)
      is_free = is_free && cb::geometry::distance(object.outline, at) > 0.5;
    if (!is_free) continue;
    world.add({.position = at,
               .heading = std::atan2(along.y(), along.x()) + (goes ? 0.0 : cb::geometry::pi),
               .speed = 1.0,
               .shape = cb::geometry::pedestrian(),
               .behavior =
                   cb::Pedestrian{.social = {.desired_speed = speed}, .crossing = {.demanded_deceleration = demanded}},
               .road = goes ? there : back});
    ++count;
  }
  return count;
}

void park(Sim& world, Point const& at, double heading = 0.0, cb::geometry::Shape const& shape = {}) {
  world.add({.position = at, .heading = heading, .shape = shape, .behavior = cb::ConstantAcceleration{}});
}

int arrived(Sim const& world) {
  int count = 0;
  for (cb::Slot i{}; index_of(i) < world.size(); ++i)
    count += walks(world, i) && world.frame().agents[i].status == cb::AgentStatus::arrived;
  return count;
}

/// Walks until `end` [s] without a contact.
void walk_safely(Sim& world, double end, double dt) {
  while (world.time() < end) {
    REQUIRE(world.step(dt));
    REQUIRE(contacts(world) == 0);
  }
}

constexpr double steps[] = {0.05, 0.1, 0.2, 0.5};  // [s]

}  // namespace

TEST_CASE("people on a pavement get past parked vehicles and objects, and touch none of them") {
  int people = 0, there = 0;
  for (std::uint32_t seed = 0; seed < 24; ++seed) {
    CAPTURE(seed);
    cb::RandomStream random(seed, 1, 0);
    Sim world(road, {.seed = seed});
    double const width = between(2.0, 4.0, random), y = 2.5;
    for (double x = 107.0; x < 130.0; x += between(8.0, 14.0, random))
      park(world, {x, std::min(4.7, y + between(-0.5, 0.5, random) * (width + 1.6))}, between(-0.3, 0.3, random),
           seed % 3 == 0 ? cb::geometry::van() : cb::geometry::car());
    double const x = between(105, 130, random), half = between(0.1, 0.6, random);
    world.add_object(cb::geometry::Polygon({{x, y - half}, {x + 0.6, y - half}, {x + 0.6, y + half}, {x, y + half}}));
    people += add_people(world, random, {95, y}, {140, y}, width, 12);
    walk_safely(world, 50.0, steps[seed % 4]);
    there += arrived(world);
  }
  CHECK(people > 200);
  CHECK(there > people / 2);
}

TEST_CASE("two groups that meet between two parked cars are not pushed into them") {
  for (std::uint32_t seed = 0; seed < 24; ++seed) {
    CAPTURE(seed);
    cb::RandomStream random(seed, 2, 0);
    Sim world(road, {.seed = seed});
    double const gap = between(1.0, 2.0, random), y = 1.85 + 0.5 * gap;
    park(world, {100, y + 0.5 * gap + 0.9});
    park(world, {100, y - 0.5 * gap - 0.9});
    add_people(world, random, {92, y}, {110, y}, 3.0, 10);
    walk_safely(world, 30.0, steps[seed % 4]);
  }
}

TEST_CASE("people cross between vehicles that queue, start and stop, and touch none") {
  int people = 0, there = 0;
  for (std::uint32_t seed = 0; seed < 12; ++seed) {
    CAPTURE(seed);
    cb::RandomStream random(seed, 3, 0);
    Sim world(road, {.seed = seed});
    for (double const y : {-1.75, -5.25}) {
      double x = 345.0 + between(0.0, 6.0, random), desired = between(0.3, 3.0, random);  // the first one dawdles
      for (int i = 0; i < 8; ++i, desired = 8.0) {
        x -= cb::geometry::car().front;
        cb::UrbanDriver driver;
        driver.law.desired_speed = desired;
        world.add({.position = {x, y}, .behavior = driver});
        x -= cb::geometry::car().rear + between(1.2, 3.0, random);
      }
    }
    double const x = between(315, 325, random);
    people += add_people(world, random, {x, 5}, {x, -12}, 3.0, 8, between(1.0, 3.0, random));
    walk_safely(world, 60.0, steps[seed % 4]);
    there += arrived(world);
  }
  CHECK(people > 80);
  CHECK(there > 0.9 * people);
}

TEST_CASE("a crowd does not push those who wait over the kerb") {
  for (std::uint32_t seed = 0; seed < 12; ++seed) {
    CAPTURE(seed);
    cb::RandomStream random(seed, 4, 0);
    Sim world(road, {.seed = seed});
    for (double x = 310.0; x > 10.0; x -= 16.0)
      world.add({.position = {x, -1.75}, .speed = 10.0, .behavior = cb::ConstantAcceleration{}});
    Way const across = way({320, 8}, {320, -12}, 1.6);
    for (int i = 0; i < 14; ++i)
      world.add({.position = {320 + between(-0.8, 0.8, random), between(0.5, 6.0, random)},
                 .shape = cb::geometry::pedestrian(),
                 .behavior = cb::Pedestrian{},
                 .road = across});
    while (world.time() < 20.0) {
      REQUIRE(world.step(steps[seed % 4]));
      for (auto const& record : world.frame().agents) REQUIRE(std::max(record.state.y, -record.state.y - 1.0) > 0.299);
    }
  }
}

TEST_CASE("no step is so long that it leads through a standing vehicle or an object") {
  cb::geometry::Polygon const wall({{110, -5}, {111, -5}, {111, 11}, {110, 11}});
  for (double const dt : {2.0, 4.0, 7.0}) {
    CAPTURE(dt);
    Sim world(road);
    park(world, {100, 3});
    world.add_object(wall);
    auto const id = world.add({.position = {95, 3},
                               .shape = cb::geometry::pedestrian(),
                               .behavior = cb::Pedestrian{.longest_substep = 10},
                               .road = way({95, 3}, {200, 3}, 1.0)});
    Point last{95, 3};
    for (int i = 0; i < 20; ++i) {
      REQUIRE(world.step(dt));
      Point const now{world.state(id).x, world.state(id).y};
      CHECK_FALSE(cb::geometry::detail::segment_meets_box<true>(last, now, cb::box_at(world, cb::Slot{})));
      CHECK(now.x() < 110.0);
      last = now;
    }
    CHECK(contacts(world) == 0);
  }
}

namespace {

using Surroundings = cb::detail::Surroundings;
using Vector = cb::PlaneVector<double>;

constexpr cb::detail::KerbLine no_kerb{{1.0, 0.0}, 1e9};

Surroundings::Other vehicle(double x, double y, double heading, double speed = 0.0) {
  cb::State state;
  state.x = x, state.y = y, state.heading = heading;
  auto const box = cb::geometry::box_of(cb::geometry::car(), state);
  return {box, {speed * box.cos, speed * box.sin}, 0.0, 0.0};
}

double distance(Surroundings::Other const& other, Vector const& p) {
  return cb::geometry::distance(other.box, Point{p.x, p.y});
}

}  // namespace

TEST_CASE("a stride ends beside all vehicles, objects and the kerb, or where it began, however far the origin is") {
  constexpr double body = 0.4, rounding = 2e-7;
  for (double const x0 : {0.0, 5.4e6}) {
    CAPTURE(x0);
    cb::RandomStream random(1, 5, 0);
    int slid = 0, stayed = 0;
    for (int i = 0; i < 4000; ++i) {
      CAPTURE(i);
      Surroundings around;
      for (int k = 0; k < 3; ++k)
        around.add(vehicle(x0 + between(-4, 4, random), between(-3, 3, random), between(-3, 3, random)));
      double const x = x0 + between(-3, 3, random), y = between(-3, 3, random);
      cb::geometry::Polygon const object({{x, y - 1}, {x + 2, y - 1}, {x + 0.5, y - 0.5}, {x, y + 1}});  // not convex
      around.objects[around.object_count++] = &object;
      Vector const from{x0 + between(-5, 5, random), between(-5, 5, random)};
      double const length = i % 4 == 0 ? 4.0 : 0.1, turn = between(-3.2, 3.2, random);
      Vector const to = from + length * Vector{std::cos(turn), std::sin(turn)};
      cb::detail::KerbLine const kerb{{0.6, 0.8}, between(-0.1, 0.1, random)};
      auto const end = around.way_past(from, to, body, kerb);
      for (std::size_t k = 0; k < around.other_count; ++k)
        CHECK(distance(around.others[k], end) > std::min(body, distance(around.others[k], from)) - rounding);
      CHECK(cb::geometry::distance(object, Point{end.x, end.y}) >
            std::min(body, cb::geometry::distance(object, Point{from.x, from.y})) - rounding);
      CHECK(dot(end - from, kerb.across) < std::max(0.0, kerb.room) + rounding);
      if (length < body) CHECK((end - from).norm() < 1.15 * length);
      slid += (end - to).norm() > 1e-6 && (end - from).norm() > 1e-6;
      stayed += end.x == from.x && end.y == from.y;
    }
    CHECK(slid > 400);
    CHECK(stayed > 50);
    CHECK(stayed < slid);
  }
}

TEST_CASE("who is inside of a vehicle may walk out; long strides do not cut through its corners") {
  Surroundings around;
  around.add(vehicle(0, 0, 0));  // from x = -0.9 to 3.6, y = -0.9 to 0.9
  auto const go = [&](Vector const& from, Vector const& to) { return around.way_past(from, to, 0.4, no_kerb); };
  CHECK(go({1, 0.8}, {1, 0.95}).y == 0.95);
  CHECK(go({1, 1.0}, {1.1, 0.95}).y == doctest::Approx(1.0));  // 0.1 m from it: along its side
  CHECK(go({1, 1.0}, {1.1, 0.95}).x == doctest::Approx(1.1));
  CHECK(go({1, 2.0}, {1, -2.0}).y == 2.0);
  CHECK(go({1, 2.0}, {1, 1.95}).y == 1.95);
  CHECK(go({3.9, 1.2}, {3.85, 1.15}).x == doctest::Approx(3.6 + 0.4 * std::sqrt(0.5)));  // round its corner
}

TEST_CASE("nobody steps in front of a vehicle that cannot stop, but who is there already may go on") {
  Surroundings around;
  around.add(vehicle(0, 0, 0, 5.0));  // stops 2.5 m ahead of x = 3.6
  auto const go = [&](Vector const& from, Vector const& to) { return around.way_past(from, to, 0.4, no_kerb); };
  CHECK(go({5.0, 1.3}, {5.0, 1.2}).y == doctest::Approx(1.3));
  CHECK(go({6.6, 1.3}, {6.6, 1.2}).y == 1.2);
  CHECK(go({5.0, 0.5}, {5.0, 0.4}).y == 0.4);
  CHECK(go({6.6, 0.0}, {6.5, 0.0}).x == doctest::Approx(6.5));
  CHECK(go({6.6, 0.0}, {6.4, 0.0}).x == doctest::Approx(6.5));
  // Behind it the place is not free before the step is over: it may brake.
  around.advance(0.2);
  CHECK(go({-1.3, 0.0}, {-1.2, 0.0}).x == doctest::Approx(-1.3));
}
