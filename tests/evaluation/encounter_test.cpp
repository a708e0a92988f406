// Situations worked out by hand: two vehicles of 5 x 2 m, reference points 1.5 m behind their middles. The ego is in
// the origin and heads along +x; lanes of 3.5 m run along +x through the origin and along +y through x = 20 m.
#include "cambium/evaluation/encounter.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <memory>
#include <utility>

#include "../support/maps.hpp"
#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/open_loop/constant_acceleration.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/evaluation/driving.hpp"
#include "cambium/evaluation/metrics/exposure.hpp"
#include "cambium/evaluation/metrics/post_encroachment_time.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/map/building/map_builder.hpp"
#include "cambium/map/road/curve_layout.hpp"
#include "cambium/world/world.hpp"

using namespace cambium;

namespace {

using Sim = World<BehaviorSet<ConstantAcceleration>, InterpolateExecution, SingleTrack>;

constexpr double right = geometry::pi / 2;
constexpr geometry::Shape body{.front = 4.0, .rear = 1.0, .left = 1.0, .right = 1.0};

/// A vehicle by its middle.
struct Vehicle {
  double x, y, heading, speed;
};

/// A situation, seen from a frame that is turned and far away.
struct Stage {
  double turn, far;
  std::shared_ptr<Map const> map;

  Stage(double seen_turned, double seen_far) : turn(seen_turned), far(seen_far) {
    MapBuilder builder;
    auto const add = [&](char const* id, double x, double y, double heading) {
      auto const from = at(x, y);
      builder.add_road({.id = id,
                        .line = map::lay_from({from.x(), from.y(), turn + heading}, {{400.0}}),
                        .sections = {{.right = map::equal_lanes(2)}}});
    };
    add("1", -200.0, 1.75, 0.0);
    add("2", 20.0 - 1.75, -200.0, right);
    map = builder.build();
  }

  [[nodiscard]] geometry::Point at(double x, double y) const {
    return {far + std::cos(turn) * x - std::sin(turn) * y, -far + std::sin(turn) * x + std::cos(turn) * y};
  }

  /// The ego at slot 0, and another one.
  [[nodiscard]] Sim world(Vehicle const& ego, Vehicle const& other) const {
    Sim made(map);
    for (auto const& vehicle : {ego, other}) add(made, vehicle);
    return made;
  }

  void add(Sim& world, Vehicle const& vehicle) const {
    auto const place = at(vehicle.x - 1.5 * std::cos(vehicle.heading), vehicle.y - 1.5 * std::sin(vehicle.heading));
    world.add({.position = place,
               .heading = turn + vehicle.heading,
               .speed = vehicle.speed,
               .shape = body,
               .behavior = ConstantAcceleration{}});
  }
};

/// Calls `f` with the stage seen from some frames.
template <class F>
void from_anywhere(F const& f) {
  for (double const turn : {0.0, 0.7, -2.4, 3.0})
    for (double const far : {0.0, 1e6}) {
      CAPTURE(turn);
      CAPTURE(far);
      f(Stage(turn, far));
    }
}

}  // namespace

TEST_CASE("behind a slower leader: 24.5 m at 20 and 10 m/s") {
  from_anywhere([](Stage const& stage) {
    auto world = stage.world({0, 0, 0, 20}, {29.5, 0, 0, 10});
    CHECK(TimeToCollision{}(world, Slot{0}) == doctest::Approx(2.45).epsilon(0.002));
    CHECK(TimeToCollision{.longest = 2.0}(world, Slot{0}) == 2.0);
    CHECK(RequiredDeceleration{}(world, Slot{0}) == doctest::Approx(100.0 / 49.0).epsilon(0.03));
    CHECK(RequiredDeceleration{.most = 1.0}(world, Slot{0}) == 1.0);
    CHECK(TimeHeadway{}(world, Slot{0}) == doctest::Approx(24.5 / 20.0));
    CHECK(TimeHeadway{.longest = 1.0}(world, Slot{0}) == 1.0);
    CHECK(TimeHeadway{}(world, Slot{1}) == 10.0);  // nobody is ahead
    CHECK(BrakeThreatNumber{.possible = 11.5}(world, Slot{0}) == doctest::Approx(0.177).epsilon(0.03));
    CHECK(Clearance{}(world, Slot{0}) == doctest::Approx(24.5));
    CHECK(Clearance{.farthest = 20.0}(world, Slot{0}) == 20.0);
    CHECK(TimeToCollision{}(world, Slot{1}) == 10.0);  // what comes from behind does not count
    CHECK(RequiredDeceleration{}(world, Slot{1}) == 0.0);
    auto const steady = stage.world({0, 0, 0, 20}, {15, 0, 0, 20});
    CHECK(TimeToCollision{}(steady, Slot{0}) == 10.0);
  });
}

TEST_CASE("a vehicle that crosses: they meet, or one passes before the other") {
  from_anywhere([](Stage const& stage) {
    auto const meets = stage.world({0, 0, 0, 10}, {20, -16, right, 8});
    CHECK(TimeToCollision{}(meets, Slot{0}) == doctest::Approx(1.65).epsilon(0.002));
    CHECK(TimeToCollision{.bearing = geometry::pi / 6}(meets, Slot{0}) == 10.0);  // it is 37 degrees off
    double const required = RequiredDeceleration{}(meets, Slot{0});
    // It may stop before the other's way, or let it pass: the other's rear is past the ego's way after 2.4375 s.
    double const way = 16.5;
    CHECK(10.0 * 2.4375 - 0.5 * required * 2.4375 * 2.4375 == doctest::Approx(way).epsilon(0.01));
    CHECK(Clearance{}(meets, Slot{0}) == doctest::Approx(std::hypot(16.5, 12.5)));

    auto passes = stage.world({0, 0, 0, 10}, {20, -30, right, 8});
    CHECK(TimeToCollision{}(passes, Slot{0}) == 10.0);
    CHECK(RequiredDeceleration{}(passes, Slot{0}) == 0.0);
    PostEncroachmentTime own, its;
    for (int i = 0; i < 400; ++i) {
      REQUIRE(passes.step(0.0125));
      own.observe(passes, Slot{0}, 0.0125);
      its.observe(passes, Slot{1}, 0.0125);
    }
    CHECK(own.value() == doctest::Approx(0.9625).epsilon(0.015));
    CHECK(its.value() == own.value());
  });
}

TEST_CASE("a car that cuts in 2 m ahead, and a leader that brakes from the same speed") {
  from_anywhere([](Stage const& stage) {
    auto cut = stage.world({0, 0, 0, 20}, {7, 0, 0, 15});
    CHECK(TimeToCollision{}(cut, Slot{0}) == doctest::Approx(0.4).epsilon(0.01));
    CHECK(RequiredDeceleration{}(cut, Slot{0}) == doctest::Approx(6.25).epsilon(0.03));
    auto equal = stage.world({0, 0, 0, 20}, {15, 0, 0, 20});  // at present speeds they never meet
    CHECK(TimeToCollision{}(equal, Slot{0}) == 10.0);
    CHECK(RequiredDeceleration{}(equal, Slot{0}) == 0.0);
  });
}

TEST_CASE("who touches has no time left, wherever; who comes later asks for nothing") {
  from_anywhere([](Stage const& stage) {
    auto struck = stage.world({0, 0, 0, 10}, {-4.9, 0, 0, 15});
    CHECK(Collision{}(struck, Slot{0}));
    CHECK(TimeToCollision{}(struck, Slot{0}) == 0.0);
    CHECK(Clearance{}(struck, Slot{0}) == 0.0);
  });
}

TEST_CASE("the required deceleration does not depend on the order of the others") {
  Stage const stage(0.7, 0.0);
  Vehicle const ego{0, 0, 0, 20}, leader{29.5, 0, 0, 10}, crosser{20, -15.4, right, 10};
  auto const alone = [&](Vehicle const& other) { return RequiredDeceleration{}(stage.world(ego, other), Slot{0}); };
  double const most = std::max(alone(leader), alone(crosser));
  for (bool const is_first : {true, false}) {
    auto world = stage.world(ego, is_first ? leader : crosser);
    stage.add(world, is_first ? crosser : leader);
    CHECK(RequiredDeceleration{}(world, Slot{0}) == most);
  }
}

TEST_CASE("exposure to a collision: for how long the time to it is short, and by how much") {
  from_anywhere([](Stage const& stage) {
    // The time is 2.45 s at first, and 1 s at the end.
    auto world = stage.world({0, 0, 0, 20}, {29.5, 0, 0, 10});
    Exposure exposure, strict;
    strict.threshold = 0.5;
    constexpr double step = 0.0125;
    for (int i = 0; i < 116; ++i) {
      REQUIRE(world.step(step));
      exposure.observe(world, Slot{0}, step);
      strict.observe(world, Slot{0}, step);
    }
    CHECK(exposure.value() == doctest::Approx(1.0).epsilon(0.03));
    CHECK(exposure.integrated() == doctest::Approx(0.5).epsilon(0.03));
    CHECK(exposure.least() == doctest::Approx(1.0).epsilon(0.01));
    CHECK(strict.value() == 0.0);
    CHECK(strict.integrated() == 0.0);
  });
  CHECK(Exposure{}.least() == 10.0);
}

TEST_CASE("post-encroachment times are seen at any speed, however far the vehicles are by then") {
  from_anywhere([](Stage const& stage) {
    // The ego's rear leaves the other's way after 23.5 m, when the other's front is 66 m before the ego's.
    double const later = 3.3, way = 1.0 + 2.5 + 20.0 * (23.5 / 20.0 + later);
    auto world = stage.world({0, 0, 0, 20}, {20, -way, right, 20});
    PostEncroachmentTime time;
    for (int i = 0; i < 500; ++i) {
      REQUIRE(world.step(0.0125));
      time.observe(world, Slot{0}, 0.0125);
    }
    CHECK(time.value() == doctest::Approx(later).epsilon(0.01));
  });
}

TEST_CASE("a collision is none of: safe, unknown") {
  from_anywhere([](Stage const& stage) {
    auto world = stage.world({0, 0, 0, 10}, {20, -16, right, 8});
    PostEncroachmentTime time;
    double least = TimeToCollision{}(world, Slot{0});
    while (world.time() < 1.8) {
      REQUIRE(world.step(0.1));
      time.observe(world, Slot{0}, 0.1);
      least = std::min(least, TimeToCollision{}(world, Slot{0}));
    }
    REQUIRE(Collision{}(world, Slot{0}));
    CHECK(least == 0.0);
    CHECK(time.value() == 0.0);
    CHECK(Clearance{}(world, Slot{0}) == 0.0);
    CHECK(RequiredDeceleration{}(world, Slot{0}) == 50.0);
    auto const alone = stage.world({0, 0, 0, 10}, {20, -150, right, 0});
    CHECK(TimeToCollision{}(alone, Slot{0}) == 10.0);
    CHECK(std::isnan(PostEncroachmentTime{}.value()));
  });
}

TEST_CASE("static objects count where the agent drives into them") {
  Sim world(support::straight_road(2, 500));
  world.add({.position = {100, -1.75}, .speed = 10, .shape = body, .behavior = ConstantAcceleration{}});
  world.add_object(geometry::Polygon({{129, -3}, {131, -3}, {131, -1}, {129, -1}}));
  CHECK(TimeToCollision{}(world, Slot{0}) == doctest::Approx(2.5).epsilon(0.002));
  CHECK(RequiredDeceleration{}(world, Slot{0}) == doctest::Approx(2.0).epsilon(0.03));
  CHECK(Clearance{}(world, Slot{0}) == doctest::Approx(25.0));
  world.set_state(world.roster().agents[0].id, {.x = 100, .y = -5.25, .speed = 10});
  CHECK(TimeToCollision{}(world, Slot{0}) == 10.0);
}

TEST_CASE("vehicles in a bend, and beside each other, do not meet; one that moves over does") {
  auto const bend = support::straight_road(2, 500, 0.02);
  Sim round(bend);
  for (double const s : {20.0, 45.0, 70.0})
    for (auto const& lane : bend->lanes()) {
      auto const pose = lane.path.pose(s);
      round.add(
          {.position = pose.position(), .heading = pose.heading, .speed = 10, .behavior = ConstantAcceleration{}});
    }
  for (Slot slot{}; index_of(slot) < round.size(); ++slot) CHECK(TimeToCollision{}(round, slot) == 10.0);

  Sim merging(support::straight_road(2, 500));
  merging.add({.position = {100, -1.75}, .speed = 20, .behavior = ConstantAcceleration{}});
  auto const over =
      merging.add({.position = {130, -5.25}, .heading = 0.04, .speed = 15, .behavior = ConstantAcceleration{}});
  double const gap = 30.0 - geometry::car().length();
  CHECK(TimeToCollision{}(merging, Slot{0}) == doctest::Approx(gap / 5.0).epsilon(0.02));  // it has come over by then
  CHECK(TimeToCollision{}(merging, Slot{1}) == 10.0);
  merging.set_state(over, {.x = 110, .y = -5.25, .heading = 0.04, .speed = 15});
  CHECK(TimeToCollision{}(merging, Slot{0}) == 10.0);  // the ego has passed it by then
}

TEST_CASE("who is at fault, by nuPlan's rules") {
  struct Case {
    Vehicle ego, other;
    bool is_at_fault;
  };
  Case const cases[] = {
      {{0, 0, 0, 5}, {-4.9, 0, 0, 12}, false},      // hit squarely from behind
      {{0, 0, 0, 5}, {-4.9, 1.9, 0, 8}, false},     // a corner, 151 degrees off: from behind
      {{0, 0, 0, 5}, {-4.5, 1.9, 0, 8}, false},     // 148 degrees off: a side, in lane
      {{0, 0.9, 0, 5}, {-4.5, 2.8, 0, 8}, true},    // the same, over the border of its lane
      {{0, 0, 0, 0.04}, {3.8, 0, 1.2, 10}, false},  // it stands
      {{0, 0, 0, 0.06}, {3.8, 0, 1.2, 10}, true},   // it creeps, and is hit on its front
      {{0, 0, 0, 20}, {4.9, 0.5, 0, 15}, true},     // one cut in
      {{0, 0, 0, 5}, {-4.9, 0, 0, 0}, true},        // one that stands, wherever it is
  };
  from_anywhere([&](Stage const& stage) {
    for (auto const& [ego, other, is_at_fault] : cases) {
      CAPTURE(other.x);
      CAPTURE(other.y);
      CAPTURE(ego.speed);
      auto world = stage.world(ego, {-100, 0, 0, 0});
      auto const place = stage.at(other.x - 1.5 * std::cos(other.heading), other.y - 1.5 * std::sin(other.heading));
      world.set_state(world.roster().agents[1].id,
                      {.x = place.x(), .y = place.y(), .heading = stage.turn + other.heading, .speed = other.speed});
      REQUIRE(Collision{}(world, Slot{0}));
      CHECK(AtFaultCollision{}(world, Slot{0}) == is_at_fault);
    }
  });
}
