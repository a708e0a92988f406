#include "cambium/planner/policy/proposal_planner.hpp"

#include "cambium/map/building/road_plan.hpp"
#include "cambium/map/road/curve_layout.hpp"
#include "planner/planner_fixtures.hpp"

using namespace planner_fixtures;

TEST_CASE("it brakes in time for a bend, whatever the score") {
  auto const map = support::map_of({.id = "1",
                                    .line = map::lay_from({}, {{150.0}, {30.0, 0.05, 0.05}, {150.0}}),
                                    .sections = {{.right = map::equal_lanes(1)}}});
  for (double const comfortable : {2.5, 50.0}) {
    Proposal planner;
    planner.driver.heeds.get<Bends>().lateral_acceleration = comfortable;
    planner.scoring.comfort = 0.0;
    CandidateSim world(map);
    world.add({.position = {20, -1.75}, .speed = 14, .behavior = planner});
    double across = 0.0, hardest = 0.0;
    for (int i = 0; i < 120; ++i) {
      auto const before = world.state(ego);
      drive(world, 1);
      auto const& now = world.state(ego);
      across = std::max(across, std::abs(geometry::angle_difference(now.heading, before.heading)) / 0.2 * now.speed);
      hardest = std::max(hardest, (before.speed - now.speed) / 0.2);
    }
    CAPTURE(comfortable);
    CHECK((across < 3.0) == (comfortable == 2.5));
    CHECK(hardest < 3.0);
    CHECK(world.state(ego).y > 20.0);
  }
}

TEST_CASE("where its road ends, it drives on to the end of the step, although it leaves the prediction before") {
  for (double const ahead : {1.0, 2.0, 3.0, 4.0}) {  // of 3 m in a step
    CandidateSim world(support::straight_road(2, 200));
    world.add({.position = {200.0 - ahead, -1.75}, .speed = 15, .behavior = Proposal{}});
    while (world.status(ego) == AgentStatus::driving) {
      auto const before = world.state(ego);
      REQUIRE(world.step(0.2));
      CHECK(world.state(ego).x - before.x ==
            doctest::Approx(0.1 * (before.speed + world.state(ego).speed)).epsilon(0.02));
    }
    CHECK(world.status(ego) == AgentStatus::left_map);
  }
}

TEST_CASE("it stops once at a stop sign, and remembers that it did") {
  Proposal const planner;
  CandidateSim world(support::road_with_signal("206"));
  world.add({.position = {100, -1.75}, .speed = 12, .behavior = planner});
  int stops = 0;
  for (int i = 0; i < 500 && world.state(ego).x < 300.0; ++i) {
    bool const stood = world.state(ego).speed < standing_speed;
    drive(world, 1, planner.step);
    stops += !stood && world.state(ego).speed < standing_speed;
  }
  CHECK(stops == 1);
  CHECK(world.state(ego).x >= 300.0);
}

TEST_CASE("in a roundabout it does not wait for those who wait for it") {
  CandidateSim world(support::own_map("roundabout.xodr"));
  ReachLane const west{world.map().nearest_lane({-60.0, 2.0, 3.14})->lane};
  world.add({.position = {60.0, 1.75}, .heading = 3.14, .speed = 7.0, .behavior = Proposal{}, .goal = west});
  world.add({.position = {-2.8, 37.0}, .heading = -1.57, .behavior = ConstantAcceleration{}});
  drive(world, 100);
  CHECK(world.state(ego).x < -10.0);
}

TEST_CASE("it passes a standing vehicle in the lane beside, and waits with room for a gap there") {
  for (double const spacing : {1e3, 24.0}) {
    CAPTURE(spacing);
    auto world = road(2, 12.0, Proposal{});
    world.add({.position = {200, -5.25}, .speed = 0, .behavior = ConstantAcceleration{}});
    double const first = spacing < 100.0 ? 140.0 : -1e3;
    for (double x = first; x > 0.0; x -= spacing)
      world.add({.position = {x, -1.75},
                 .speed = 15,
                 .behavior = IdmClassic{.law = {.desired_speed = 15, .time_headway = 1.0}}});
    double slowest = 1e9, closest = 1e9, hardest = 0.0;
    for (int i = 0; i < 250 && world.state(ego).x < 260.0; ++i) {
      drive(world, 1);
      slowest = std::min(slowest, world.state(ego).speed);
      for (auto const& agent : world.frame().agents) hardest = std::max(hardest, -agent.action.acceleration);
      if (world.state(ego).y < -4.25) closest = std::min(closest, 200.0 - world.state(ego).x);
    }
    CHECK(world.state(ego).x >= 260.0);
    CHECK(closest > 12.0);
    CHECK(hardest < 4.5);
    if (spacing > 100.0) CHECK(slowest > 9.0);
  }
}

TEST_CASE("it changes into the lane of its goal, for which nobody has to brake hard") {
  for (double const gap : {200.0, 60.0, 40.0}) {
    CAPTURE(gap);
    auto const map = support::straight_road(2, 600.0);
    CandidateSim world(map);
    auto const left = map->find_lane("1", 500.0, -1);
    world.add({.position = {40, -5.25}, .speed = 12.0, .behavior = Proposal{}, .goal = ReachLane{left, 500.0}});
    for (double x = 190.0; x > 0.0; x -= gap)
      world.add({.position = {x, -1.75},
                 .speed = 15,
                 .behavior = IdmClassic{.law = {.desired_speed = 16, .time_headway = 1.0}}});
    double hardest = 0.0;
    for (int i = 0; i < 200 && !world.reached_goal(world.slot_of(ego)); ++i) {
      drive(world, 1);
      for (auto const& agent : world.frame().agents) hardest = std::max(hardest, -agent.action.acceleration);
    }
    CHECK(world.reached_goal(world.slot_of(ego)));
    CHECK(hardest < 4.5);
  }
}

TEST_CASE("it expects those who brake in its direction to go on, and the others to keep their speed") {
  enum class Braking { driven, added, set };
  auto const speed_at_the_end = [](Braking braking, bool oncoming) {
    CandidateSim world(support::two_way_road(600.0));
    world.add({.position = {40, -1.75}, .speed = 12, .behavior = Proposal{}});
    auto const other =
        world.add({.position = {oncoming ? 400.0 : 140.0, oncoming ? 1.75 : -1.75},
                   .heading = oncoming ? M_PI : 0.0,
                   .speed = 12,
                   .acceleration = braking == Braking::added ? -3.0 : 0.0,
                   .behavior = ConstantAcceleration{.acceleration = braking == Braking::driven ? -3.0 : 0.0}});
    if (braking == Braking::driven) REQUIRE(world.step(0.2));
    if (braking == Braking::set) world.set_state(other, world.state(other), Reroute::no, -3.0);
    CHECK(world.record(other).action.acceleration == doctest::Approx(-3.0));
    return report_of(Proposal{}, world).course.back().agents[Slot{1}].state.speed;
  };
  for (auto const braking : {Braking::driven, Braking::added, Braking::set})
    CHECK(speed_at_the_end(braking, false) == 0.0);
  CHECK(speed_at_the_end(Braking::driven, true) == doctest::Approx(11.4));
}

TEST_CASE("a change under way is the first proposal, and goes on if nothing is better") {
  auto world = road(2, 12.0, Proposal{});
  auto memory = Proposal::Memory{};
  world.set_state(ego, {.x = 100, .y = -4.5, .heading = 0.08, .speed = 12.0});
  auto const at = world.record(ego).lane;
  memory.lateral.change = {world.observe(ego).corridor().pieces[at.piece].left, 30.0f, 0.0f};
  auto const report = report_of(Proposal{}, world, memory);
  CHECK(report.details[0].towards == memory.lateral.change.target);
  CHECK(report.details[0].left);
  CHECK(report.details[0].changes);
  CHECK(report.chosen == 0);
}

TEST_CASE("a scored proposal reports its outcome, and the best is driven") {
  auto world = road(2, 12.0, Proposal{});
  world.add({.position = {75, -5.25}, .speed = 4, .behavior = ConstantAcceleration{}});
  world.add_object(obstacle(90, -5.25, -3.5, -1.0));
  auto const report = report_of(Proposal{}, world);
  REQUIRE(report.details.size() == 24);  // 6 speeds at 3 offsets, and into the left lane
  auto const& best = report.details[*report.chosen];
  for (auto const& p : report.details) {
    CHECK(p.score <= best.score + Proposal{}.scoring.indifference);
    CHECK((p.score == 0.0) == (p.collides || p.leaves_road));
    CHECK(std::isfinite(p.time_to_infraction) == (p.collides || p.leaves_road));
    CHECK(p.score <= 1.0);
  }
  CHECK(best.score > 0.0);
  CHECK_FALSE(report.is_emergency(ego));
}

TEST_CASE("an offset towards a vehicle alongside is a collision at fault; a hit from behind is not") {
  auto world = road(2, 12.0, Proposal{});
  world.add({.position = {41, -3.4}, .speed = 12, .behavior = ConstantAcceleration{}});
  for (auto const& p : report_of(Proposal{}, world).details)
    if (p.speed_share == 1.0) CHECK(p.collides == (p.offset > 0.0));
  auto pushed = road(2, 5.0, Proposal{});
  pushed.add({.position = {25, -5.25}, .speed = 20, .behavior = ConstantAcceleration{}});
  for (auto const& p : report_of(Proposal{}, pushed).details) CHECK_FALSE(p.collides);
}

TEST_CASE("whatever its indifference, it avoids a collision that it can avoid") {
  auto world = road(2, 12.0, Proposal{});
  world.add({.position = {41, -3.4}, .speed = 12, .behavior = ConstantAcceleration{}});
  Proposal planner;
  planner.scoring.indifference = 1.0;
  planner.offsets = {1.0, 0.0};  // towards the other vehicle first
  auto const report = report_of(planner, world);
  CHECK(report.details[0].collides);
  CHECK_FALSE(report.details[*report.chosen].collides);
  CHECK(report.details[*report.chosen].offset == 0.0);
}

TEST_CASE("a proposal that leads off the road scores 0") {
  auto world = road(2, 12.0, Proposal{});
  Proposal planner;
  planner.offsets = {0.0, -2.0};
  for (auto const& p : report_of(planner, world).details) {
    CHECK(p.leaves_road == (p.offset < 0.0));
    CHECK_FALSE(p.collides);
  }
}
