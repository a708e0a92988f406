#include "cambium/planner/frenet/frenet_planner.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "cambium/behavior/following/idm_classic.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/world/world.hpp"
#include "support/allocations.hpp"
#include "support/maps.hpp"

using namespace cambium;

namespace {

using PredictionWorld = World<BehaviorSet<ConstantAcceleration>, InterpolateExecution, SingleTrack>;
using Planner = FrenetPlanner<PredictionWorld>;
using Sim = World<BehaviorSet<Planner, IdmClassic, ConstantAcceleration>, InterpolateExecution, SingleTrack>;
static_assert(BehaviorModel<Planner>);

constexpr AgentId ego{0};

/// A road of `lanes` lanes with ego, agent 0, in the right one.
Sim road(int lanes, std::uint64_t seed, double speed = 12.0, double curvature = 0.0, Planner const& planner = {}) {
  Sim world(support::straight_road(lanes, 600.0, curvature), {.seed = seed});
  double const radius = curvature == 0.0 ? 0.0 : 1.0 / curvature, y = -3.5 * lanes + 1.75, turn = 40.0 * curvature;
  geometry::Point const start =
      curvature == 0.0 ? geometry::Point(40, y)
                       : geometry::Point((radius - y) * std::sin(turn), radius - (radius - y) * std::cos(turn));
  world.add({.position = start, .speed = speed, .behavior = planner});
  return world;
}

/// A rectangle in the lane whose middle is at `y`, from `right` to `left` relative to it.
geometry::Polygon obstacle(double x, double y, double right, double left) {
  return geometry::Polygon({{x, y + right}, {x + 4, y + right}, {x + 4, y + left}, {x, y + left}});
}

/// Steps the world for a while and checks that no agent fails and ego touches nothing and stays on the road.
void drive(Sim& world, int steps, double dt = 0.2) {
  for (int i = 0; i < steps; ++i) {
    auto const result = world.step(dt);
    CHECK(result.failed == 0);
    REQUIRE_FALSE(Collision{}(world, world.slot_of(ego)));
    REQUIRE_FALSE(OffRoad{}(world, world.slot_of(ego)));
  }
}

}  // namespace

TEST_CASE("it follows a slower leader and stops behind a standing one") {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    CAPTURE(seed);
    double const slow = 2.0 * static_cast<double>(seed);
    auto world = road(1, seed, 10.0 + static_cast<double>(seed));
    world.add({.position = {110, -1.75}, .speed = slow, .behavior = ConstantAcceleration{}});
    drive(world, 150);
    CHECK(std::abs(world.state(ego).speed - slow) < 0.3);
    CHECK(world.state(AgentId{1}).x - world.state(ego).x < 40.0);
  }
}

TEST_CASE("it stops at an object that blocks the road and passes one that leaves room") {
  auto blocked = road(1, 0);
  blocked.add_object(obstacle(140, -1.75, -1.75, 1.75));
  drive(blocked, 150);
  CHECK(blocked.state(ego).speed < 0.05);
  CHECK(blocked.state(ego).x > 115.0);
  for (double const side : {-1.0, 1.0}) {
    CAPTURE(side);
    auto world = road(1, 0);
    world.add_object(side < 0.0 ? obstacle(140, -1.75, -1.75, -0.6) : obstacle(140, -1.75, 0.6, 1.75));
    double farthest = 0.0;
    for (int i = 0; i < 20; ++i) {
      drive(world, 5);
      farthest = std::max(farthest, -side * (world.state(ego).y + 1.75));
    }
    CHECK(world.state(ego).x > 180.0);
    CHECK(farthest > 0.3);
    CHECK(std::abs(world.state(ego).y + 1.75) < 0.2);
  }
}

TEST_CASE("it follows at its time headway") {
  auto const gap_at = [](double headway) {
    auto world = road(1, 0, 8.0, 0.0, {.time_headway = headway});
    auto const leader = world.add({.position = {90, -1.75}, .speed = 8.0, .behavior = ConstantAcceleration{}});
    drive(world, 200);
    CHECK(world.state(ego).speed == doctest::Approx(8.0).epsilon(0.02));
    return world.state(leader).x - world.state(ego).x;
  };
  CHECK(gap_at(2.4) - gap_at(0.8) == doctest::Approx(1.6 * 8.0).epsilon(0.1));
}

TEST_CASE("it overtakes a slower leader") {
  auto world = road(2, 0);
  world.add({.position = {90, -5.25}, .speed = 5, .behavior = ConstantAcceleration{}});
  drive(world, 100);
  CHECK(world.state(ego).x > world.state(AgentId{1}).x + 20.0);
}

TEST_CASE("it drives as smoothly as its courses, in curves too") {
  for (double const curvature : {0.0, 0.01, -0.01}) {
    CAPTURE(curvature);
    auto world = road(2, 0, 10.0, curvature);
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
  auto world = road(2, 3);
  world.add({.position = {75, -5.25}, .speed = 4, .behavior = ConstantAcceleration{}});
  Planner::Workspace workspace;
  auto const report = Planner{}.think(world.observe(ego), {}, workspace);
  CHECK(report.courses.size() == 2 * 4 * 6 * 3 + 4 * 3);
  REQUIRE(report.chosen);
  for (std::size_t i = 0; i < report.courses.size(); ++i) {
    auto const& c = report.courses[i];
    CHECK(c.verdict != FrenetVerdict::unchecked);
    if (i > 0) CHECK(c.cost >= report.courses[i - 1].cost);
    CHECK((i < *report.chosen ? c.verdict != FrenetVerdict::valid : true));
    CHECK(report.candidates[i].score == -c.cost);
    CHECK((report.candidates[i].refused.empty()) == (c.verdict == FrenetVerdict::valid));
    CHECK(c.at(c.duration).offset == doctest::Approx(c.offset).epsilon(1e-6).scale(c.by_way ? 10.0 : 1.0));
  }
  CHECK(report.courses[*report.chosen].verdict == FrenetVerdict::valid);
}

TEST_CASE("courses into an oncoming lane are not valid") {
  Sim world(support::two_way_road(600.0));
  world.add({.position = {40, -1.75}, .speed = 12, .behavior = IdmClassic{}});
  Planner planner;
  planner.offsets = {0.0, 3.5};
  Planner::Workspace workspace;
  int oncoming = 0;
  for (auto const& c : planner.think(world.observe(ego), {}, workspace).courses) {
    if (c.offset == 0.0) continue;
    CHECK(c.verdict != FrenetVerdict::valid);
    oncoming += c.verdict == FrenetVerdict::road;
  }
  CHECK(oncoming > 5);
}

TEST_CASE("courses into a vehicle alongside are not valid") {
  for (bool const beside : {false, true}) {
    auto world = road(2, 0);
    if (beside) world.add({.position = {37, -1.75}, .speed = 12, .behavior = ConstantAcceleration{}});
    Planner planner;
    planner.speed_shares = {0.8};  // as fast as the other
    Planner::Workspace workspace;
    auto const view = world.observe(ego);
    auto const report = planner.think(view, {}, workspace);
    int collisions = 0, changes = 0;
    for (auto const& c : report.courses) {
      collisions += c.verdict == FrenetVerdict::collision ? 1 : 0;
      changes += c.verdict == FrenetVerdict::valid && c.corridor != view.place().corridor ? 1 : 0;
    }
    CHECK((collisions > 0) == beside);
    CHECK((changes > 0) == !beside);
  }
}

TEST_CASE("a course that is not finite is not valid, and another one is driven") {
  Planner planner;
  planner.costs.jerk = 1e308;  // the cost of a course that changes speed or offset overflows
  planner.desired_speed = 12.0;
  auto world = road(1, 0, 12.0, 0.0, planner);
  Planner::Workspace workspace;
  auto const report = planner.think(world.observe(ego), {}, workspace);
  int not_finite = 0;
  for (auto const& c : report.courses) not_finite += c.verdict == FrenetVerdict::not_finite ? 1 : 0;
  CHECK(not_finite > 10);
  REQUIRE(report.chosen);
  CHECK(report.candidates.back().refused == "not finite");
  drive(world, 10);
  CHECK(world.state(ego).speed == doctest::Approx(12.0));
  CHECK(drivable(planner.limits, {0.0, std::nan(""), 10.0, 0.0}, {}, 20.0) == FrenetVerdict::not_finite);
}

TEST_CASE("it brakes as hard as it may if no course is valid") {
  auto world = road(1, 0, 20.0);
  world.add_object(obstacle(70, -1.75, -1.75, 1.75));
  Planner::Workspace workspace;
  auto const report = Planner{}.think(world.observe(ego), {}, workspace);
  CHECK_FALSE(report.chosen);
  CHECK(report.course.back().agents[0].state.speed == 0.0);
  for (auto const& frame : report.course) {  // it is where its state says
    auto const &now = frame.agents[0], &start = report.course[0].agents[0];
    CHECK(now.lane.s - start.lane.s == doctest::Approx(now.state.x - start.state.x));
    CHECK(now.action.acceleration <= 0.0);
  }
  REQUIRE(world.step(0.2));
  CHECK(world.record(ego).action.acceleration == doctest::Approx(-6.0));
}

TEST_CASE("faulty parameters are reported") {
  auto world = road(1, 0);
  Planner planner;
  planner.durations.clear();
  CHECK_THROWS_AS(world.add({.position = {300, -1.75}, .behavior = planner}), ParameterError);
  planner = {};
  planner.costs.jerk = std::nan("");
  Planner::Workspace workspace;
  CHECK_THROWS_AS((void)planner.think(world.observe(ego), {}, workspace), ParameterError);
}
