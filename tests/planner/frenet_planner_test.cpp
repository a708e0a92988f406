#include "cambium/planner/frenet/frenet_planner.hpp"

#include <utility>

#include "planner/planner_fixtures.hpp"
#include "support/who_yields.hpp"

using namespace planner_fixtures;

TEST_CASE("it follows at its time headway") {
  auto const gap_at = [](double headway) {
    auto world = road(1, 8.0, Frenet{.time_headway = headway});
    auto const leader = world.add({.position = {90, -1.75}, .speed = 8.0, .behavior = ConstantAcceleration{}});
    drive(world, 200);
    CHECK(world.state(ego).speed == doctest::Approx(8.0).epsilon(0.02));
    return world.state(leader).x - world.state(ego).x;
  };
  CHECK(gap_at(2.4) - gap_at(0.8) == doctest::Approx(1.6 * 8.0).epsilon(0.1));
}

TEST_CASE("it drives as smoothly as its courses, in curves too") {
  for (double const curvature : {0.0, 0.01, -0.01}) {
    CAPTURE(curvature);
    auto world = road(2, 10.0, Frenet{}, curvature);
    double last_speed = 10.0, last_acceleration = 0.0, last_heading = world.state(ego).heading;
    for (int i = 0; i < 100; ++i) {
      drive(world, 1, 0.1);
      auto const& now = world.state(ego);
      double const acceleration = (now.speed - last_speed) / 0.1;
      CHECK(std::abs(acceleration - last_acceleration) < 0.5);
      CHECK(std::abs(now.heading - last_heading) / 0.1 * now.speed < 4.1);
      last_speed = now.speed;
      last_acceleration = acceleration;
      last_heading = now.heading;
    }
    CHECK(last_speed == doctest::Approx(15.0).epsilon(0.05));
    CHECK(std::abs(world.record(ego).lane.lateral) < 0.1);
  }
}

TEST_CASE("all courses are checked, cheapest first, and the first valid one is driven") {
  auto world = road(2, 12.0, Frenet{});
  world.add({.position = {75, -5.25}, .speed = 4, .behavior = ConstantAcceleration{}});
  auto const report = report_of(Frenet{}, world);
  int const tight = 2 * 4 * 3;  // into the left lane, to less than 4 m/s
  CHECK(report.details.size() == 2 * 4 * 6 * 3 + 4 * 3 + tight);
  REQUIRE(report.chosen);
  for (std::size_t i = 0; i < report.details.size(); ++i) {
    auto const& c = report.details[i];
    CHECK(c.verdict != FrenetVerdict::unchecked);
    if (i > 0) CHECK(c.cost >= report.details[i - 1].cost);
    CHECK((i < *report.chosen ? c.verdict != FrenetVerdict::valid : true));
    CHECK(report.candidates[i].score == -c.cost);
    CHECK((report.candidates[i].refused.empty()) == (c.verdict == FrenetVerdict::valid));
    CHECK(c.at(c.duration).offset == doctest::Approx(c.offset).epsilon(1e-6).scale(c.by_way ? 10.0 : 1.0));
  }
  CHECK(report.details[*report.chosen].verdict == FrenetVerdict::valid);
}

TEST_CASE("courses into a vehicle alongside are not valid") {
  for (bool const beside : {false, true}) {
    auto world = road(2, 12.0, Frenet{});
    if (beside) world.add({.position = {37, -1.75}, .speed = 12, .behavior = ConstantAcceleration{}});
    Frenet planner;
    planner.speed_shares = {0.8};  // as fast as the other
    auto const view = world.observe(ego);
    auto const report = report_of(planner, world);
    int collisions = 0, changes = 0;
    for (auto const& c : report.details) {
      collisions += c.verdict == FrenetVerdict::collision ? 1 : 0;
      changes += c.verdict == FrenetVerdict::valid && c.corridor != view.place().corridor ? 1 : 0;
    }
    CHECK((collisions > 0) == beside);
    CHECK((changes > 0) == !beside);
  }
}

TEST_CASE("it enters no lane where a follower would have to brake hard") {
  for (double const speed : {12.0, 24.0}) {
    CAPTURE(speed);
    auto world = road(2, 12.0, Frenet{});
    world.add({.position = {world.state(ego).x - 25.0, -1.75}, .speed = speed, .behavior = ConstantAcceleration{}});
    for (double const bound : {4.0, 50.0}) {
      Frenet planner;
      planner.safe_deceleration = bound;
      int refused = 0;
      for (auto const& c : report_of(planner, world).details) refused += c.verdict == FrenetVerdict::follower ? 1 : 0;
      CHECK((refused > 0) == (speed > 12.0 && bound < 50.0));
    }
  }
}

TEST_CASE("beside somebody too close for its clearance it drives on, and does not brake") {
  for (double const clearance : {0.3, 0.1}) {
    CAPTURE(clearance);
    auto world = road(2, 12.0, Frenet{});
    world.add({.position = {40.0, -3.25}, .speed = 12.0, .behavior = ConstantAcceleration{}});  // 0.2 m beside
    Frenet planner;
    planner.limits.clearance = clearance;
    auto const report = report_of(planner, world);
    REQUIRE(report.chosen);
    CHECK((report.details[*report.chosen].verdict == FrenetVerdict::close) == (clearance > 0.2));
    CHECK(report.candidates[*report.chosen].refused.empty());
    CHECK(report.course[1].agents[0].state.speed > 11.0);
  }
}

TEST_CASE("it slows down for a gap in the lane that it needs") {
  auto const fastest = [](bool is_beside) {
    auto world = road(2, 12.0, Frenet{});
    world.add({.position = {140.0, -5.25}, .speed = 0.0, .behavior = ConstantAcceleration{}});  // parked
    if (is_beside) world.add({.position = {38.0, -1.75}, .speed = 12.0, .behavior = ConstantAcceleration{}});
    auto const here = world.observe(ego).place().corridor;
    double result = 0.0;
    for (auto const& c : report_of(Frenet{}, world).details)
      if (c.corridor == here) result = std::max(result, c.speed);
    return result;
  };
  CHECK(fastest(false) == doctest::Approx(15.0));
  CHECK(fastest(true) == doctest::Approx(9.0));  // 3 m/s slower than the one beside
}

TEST_CASE("a course that is not finite is not valid, and another one is driven") {
  Frenet planner;
  planner.costs.jerk = 1e308;  // the cost of a course that changes speed or offset overflows
  planner.desired_speed = 12.0;
  auto world = road(1, 12.0, planner);
  auto const report = report_of(planner, world);
  int not_finite = 0;
  for (auto const& c : report.details) not_finite += c.verdict == FrenetVerdict::not_finite ? 1 : 0;
  CHECK(not_finite > 10);
  REQUIRE(report.chosen);
  CHECK(report.candidates.back().refused == "not finite");
  drive(world, 10);
  CHECK(world.state(ego).speed == doctest::Approx(12.0));
  CHECK(drivable(planner.limits, {0.0, std::nan(""), 10.0, 0.0}, {}, 20.0) == FrenetVerdict::not_finite);
}

TEST_CASE("it stops at a red light and at a stop sign, and goes on at green and after its stop") {
  for (auto const& [type, speed] : {std::pair{"1000001", 14.0}, {"1000001", 6.0}, {"206", 12.0}}) {
    CAPTURE(type);
    CAPTURE(speed);
    auto const map = support::road_with_signal(type);
    CandidateSim world(map);
    bool const is_light = !map->lights().empty();
    if (is_light) world.set_light(map->lights().front().id, {.cycle = 100, .green_begin = 30, .green_end = 90});
    auto const id = world.add({.position = {100, -1.75}, .speed = speed, .behavior = Frenet{.desired_speed = speed}});
    double const line = 200.0 - geometry::car().front;
    double hardest = 0.0, stood = 0.0;
    while (world.time() < 60.0) {
      double const before = world.state(id).speed;
      REQUIRE(world.step(0.1));
      hardest = std::max(hardest, (before - world.state(id).speed) / 0.1);
      if (world.state(id).speed < standing_speed) {
        ++stood;
        CHECK(world.state(id).x > line - 8.0);
      }
      if (is_light && world.time() < 30.0) CHECK(world.state(id).x < line);
    }
    CHECK(stood > 0.0);
    CHECK(hardest < 4.0);
    CHECK(world.state(id).x > 230.0);
  }
  // A light that has just turned yellow is passed where it could not stop.
  auto const map = support::road_with_signal("1000001");
  CandidateSim world(map);
  world.set_light(map->lights().front().id, {.cycle = 100, .green_begin = -50, .green_end = 1, .yellow = 4});
  auto const id = world.add({.position = {170, -1.75}, .speed = 15, .behavior = Frenet{}});
  while (world.time() < 4.0) REQUIRE(world.step(0.1));
  CHECK(world.state(id).x > 210.0);
}

TEST_CASE("it gives way to a vehicle that has the right of way, and goes on behind it") {
  for (double const other_way : {14.0, 18.0, 22.0}) {
    CAPTURE(other_way);
    support::WhoYields const at;
    CandidateSim world(at.map);
    auto const add = [&](std::pair<LaneId, double> const& place, map::Route const& route, double speed,
                         CandidateSim::Behavior const& behavior) {
      auto const pose = at.map->lane(place.first).path.pose(place.second);
      return world.add(
          {.position = pose.position(), .heading = pose.heading, .speed = speed, .behavior = behavior, .route = route});
    };
    auto const own = add(at.own_place(20.0), at.own, 5.0, Frenet{.desired_speed = 8.0});
    auto const other = add(at.other_place(other_way), at.other, 5.5, ConstantAcceleration{});
    while (world.time() < 20.0 && world.status(own) == AgentStatus::driving) {
      REQUIRE(world.step(0.1));
      bool const is_past = world.status(other) != AgentStatus::driving ||
                           world.record(other).lane.s > at.map->lane(at.other.lanes[0]).length() + at.zone.other_end;
      if (!is_past) CHECK(world.record(own).lane.s < at.zone.begin);
      REQUIRE_FALSE(Collision{}(world, world.slot_of(own)));
    }
    bool const is_through = world.status(own) != AgentStatus::driving || world.record(own).lane.s > at.zone.end;
    CHECK(is_through);
  }
}
