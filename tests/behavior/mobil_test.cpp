#include "cambium/behavior/drivers.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "lane_traffic_fixtures.hpp"

using namespace lane_traffic;

namespace {

using Sim = Traffic<cb::Mobil, cb::IdmClassic, cb::ConstantAcceleration>;

cb::Mobil mobil(double desired_speed) { return {.law = {.desired_speed = desired_speed}}; }

cb::LaneChange change_of(Sim const& world, auto slot) {
  return std::get<0>(world.frame().agents[slot].memory).lateral.change;
}

bool begins(Sim const& before, Sim const& world, auto slot) {
  return !change_of(before, slot).active() && change_of(world, slot).active();
}

/// Largest deviation between `mirrored` and the mirror image of `world` at `axis` over `steps`; counts lane changes.
double mirror_error(Sim& world, Sim& mirrored, double axis, int steps, int& changes) {
  double worst = 0.0;
  for (int k = 0; k < steps; ++k) {
    changes += step_and_count_changes(world);
    REQUIRE(mirrored.step(0.2));
    for (std::size_t i = 0; i < world.size(); ++i) {
      auto const &a = world.frame().agents[i].state, &b = mirrored.frame().agents[i].state;
      worst = std::max({worst, std::abs(a.x - b.x), std::abs(a.y + b.y - 2.0 * axis)});
    }
  }
  return worst;
}

/// Number of lane changes in dense traffic, and how many of them lead back to the previous lane within 12 s.
std::pair<int, int> changes_and_returns(double threshold, double rest) {
  int changes = 0, returns = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    Sim world(support::straight_road(3, 3000.0), {.seed = seed});
    fill(world, 3, 5.0, 700.0, 2.0, seed, [&](double v) {
      return cb::Mobil{.law = {.desired_speed = v}, .lateral = {.rule = {.threshold = threshold}, .rest = rest}};
    });
    struct Last {
      cb::CorridorId from = cb::none<cb::CorridorId>;
      double time = -1e9;
    };
    std::vector<Last> last(world.size());
    for (int k = 0; k < 300; ++k) {
      auto const before = lanes(world);
      REQUIRE(world.step(0.2));
      auto const after = lanes(world);
      for (std::size_t i = 0; i < world.size(); ++i) {
        if (before[i] == after[i]) continue;
        ++changes;
        returns += after[i] == last[i].from && world.time() - last[i].time < 12.0;
        last[i] = {before[i], world.time()};
      }
    }
  }
  return {changes, returns};
}

/// A goal on a lane of a straight road, counted from the left, from `s` [m] on.
cb::Goal goal_on(cb::Map const& map, int number, double s = 590.0) { return cb::ReachLane{lane_of(map, number).id, s}; }

}  // namespace

TEST_CASE_TEMPLATE(
    "drivers who change lanes do not collide in dense traffic, nor in slow traffic of cars, trucks and buses", Driver,
    cb::Mobil, cb::LaneChangeRuleBased) {
  for (bool const slow : {false, true}) {
    int changes = 0;
    for (std::uint64_t seed = 1; seed <= 18; ++seed) {
      int const lanes = slow || seed % 2 == 0 ? 3 : 4;
      Traffic<Driver> world(support::straight_road(lanes, 1500.0, seed % 3 == 0 ? 0.002 : 0.0), {.seed = seed});
      if (slow)
        fill_slow(world, lanes, seed, [](bool is_long) {
          return Driver{.law = is_long ? cb::presets::kesting_2010_truck() : cb::presets::kesting_2010_car()};
        });
      else
        fill(world, lanes, 5.0, 600.0, 1.0 + static_cast<double>(seed % 4), seed,
             [](double v) { return Driver{.law = {.desired_speed = v}}; });
      CAPTURE(seed);
      for (int k = 0; k < (slow ? 450 : 300); ++k) {
        changes += step_and_count_changes(world, !slow && seed % 2 == 1 ? 0.1 : 0.2);
        CHECK(collisions(world) == 0);
      }
    }
    MESSAGE(changes << " changes");
    CHECK(changes > (slow ? 350 : 100));
  }
}

TEST_CASE("in a bend of narrow lanes a slow long vehicle changes lanes beside trucks in the lane beyond") {
  for (bool const to_right : {true, false})
    for (auto const& shape : {cb::geometry::truck(), cb::geometry::bus()}) {
      double const curvature = to_right ? 0.005 : -0.005;  // the front swings out to the side of the change
      Sim world(support::map_of({.id = "1",
                                 .line = cb::map::lay_from({}, {{600.0, curvature, curvature}}),
                                 .sections = {{.right = cb::map::equal_lanes(3, 3.0)}}}));
      int const from = to_right ? 1 : 3, beyond = to_right ? 3 : 1;
      auto const id = add(world, from, 100.0, 6.0, mobil(6.0), {}, shape);
      add(world, from, 140.0, 3.0, cb::ConstantAcceleration{});
      for (double s = 20.0; s < 300.0; s += 12.0)
        add(world, beyond, s, 6.0, cb::ConstantAcceleration{}, {}, cb::geometry::truck());
      drive_safely(world, 100);
      CHECK(world.frame().agents[world.slot_of(id)].lane.corridor == cb::CorridorId{1});
    }
}

TEST_CASE("of two drivers that enter the same gap from both sides in the same step, at most one continues") {
  int both_began = 0, aborted = 0, collided = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    cb::RandomStream random(seed, 1, 0);
    Sim world(support::straight_road(3, 1500.0, seed % 2 == 0 ? 0.0 : 0.001), {.seed = seed});
    double const v = between(8, 20, random), gap = between(8, 14, random);
    // Slow leaders in the outer lanes; the middle lane is free.
    add(world, 1, 212 + gap, 0.6 * v, cb::ConstantAcceleration{});
    add(world, 3, 212 + gap + between(-3, 3, random), 0.6 * v, cb::ConstantAcceleration{});
    double const apart = seed % 4 == 0 ? 0.0 : between(-12, 12, random);
    auto const a = world.slot_of(add(world, 1, 190, v, mobil(1.3 * v))),
               b = world.slot_of(add(world, 3, 190 + apart, v * between(0.97, 1.03, random), mobil(1.3 * v)));
    for (int k = 0; k < 100; ++k) {
      Sim const before = world;
      REQUIRE(world.step(seed % 3 == 0 ? 0.1 : 0.2));
      both_began += begins(before, world, a) && begins(before, world, b);
      for (auto const slot : {a, b}) {
        auto const was = change_of(before, slot), now = change_of(world, slot);
        aborted += was.active() && now.active() && was.target != now.target;
      }
      collided += collisions(world);
    }
  }
  MESSAGE(both_began << " times both began in the same step; " << aborted << " aborted");
  CHECK(both_began > 100);
  CHECK(aborted > 30);
  CHECK(collided == 0);
}

TEST_CASE("a bend behind the vehicle does not slow it down for a gentler one ahead") {
  auto const map = support::map_of(
      {.id = "1",
       .line = cb::map::lay_from({}, {{100.0}, {10.0, 0.1, 0.1}, {300.0}, {100.0, 0.01, 0.01}, {300.0}}),
       .sections = {{.right = cb::map::equal_lanes(1)}}});
  Sim world(map);
  auto const id = add(world, 1, 250.0, 16.9, mobil(16.9));  // 2.86 m/s^2 in the gentle bend
  for (int k = 0; k < 100; ++k) {
    REQUIRE(world.step(0.2));
    REQUIRE(world.state(id).speed == doctest::Approx(16.9));
  }
}

TEST_CASE("under the keep-right rule a fast driver does not pass a slower one on the right") {
  for (bool const rule : {false, true}) {
    Sim world(support::straight_road(2, 2000.0));
    auto const slow = add(world, 1, 150.0, 20.0, cb::ConstantAcceleration{});
    cb::Mobil const driver{.law = {.desired_speed = 30.0},
                           .lateral = {.rule = {.threshold = 5.0, .keep_right = rule}}};  // stays on the right
    auto const fast = add(world, 2, 50.0, 28.0, driver);
    for (int k = 0; k < 150; ++k) REQUIRE(world.step(0.2));
    CHECK((world.state(fast).x > world.state(slow).x) == !rule);
  }
}

TEST_CASE("mirrored traffic, and left-hand traffic that keeps to its side, change lanes as the mirror image") {
  auto const left_hand_road = support::map_of({.id = "1",
                                               .line = cb::map::lay_from({}, {{3000.0}}),
                                               .sections = {{.left = cb::map::equal_lanes(3)}},
                                               .rule = cb::map::opendrive::DrivingSide::left_hand});
  for (bool const left_hand : {false, true}) {
    int changes = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      auto const road = support::straight_road(3, 3000.0);
      Sim world(road, {.seed = seed}), mirrored(left_hand ? left_hand_road : road, {.seed = seed});
      fill(world, 3, 5.0, left_hand ? 900.0 : 400.0, left_hand ? 0.2 : 2.0, seed, [left_hand](double v) {
        double const desired = left_hand ? 18.0 + 0.5 * v : v;
        return cb::Mobil{.law = {.desired_speed = desired},
                         .lateral = {.rule = {.bias = left_hand ? 0.3 : 0.0, .keep_right = left_hand}}};
      });
      double const axis = left_hand ? 0.0 : -5.25;
      for (std::size_t i = 0; i < world.size(); ++i) {
        auto const& agent = world.roster().agents[i];
        auto const& state = world.frame().agents[i].state;
        mirrored.add({.position = {state.x, 2.0 * axis - state.y},
                      .heading = -state.heading,
                      .speed = state.speed,
                      .shape = agent.shape,
                      .behavior = agent.behavior});
      }
      CAPTURE(seed);
      CHECK(mirror_error(world, mirrored, axis, left_hand ? 200 : 150, changes) < 1e-6);
    }
    CHECK(changes > 50);
  }
}

TEST_CASE("the threshold and the rest after a change prevent changing back and forth") {
  auto const [changes, returns] = changes_and_returns(0.2, 3.0);
  auto const [restless_changes, restless_returns] = changes_and_returns(0.0, 0.0);
  MESSAGE(returns << " of " << changes << " lead back; without threshold and rest " << restless_returns << " of "
                  << restless_changes);
  CHECK(changes > 100);
  CHECK(returns * 12 < changes);
  CHECK(restless_returns > 3 * returns);
}

TEST_CASE("a change is aborted when a vehicle approaches in the new lane") {
  int aborted = 0;
  for (double const at : {60.0, 70.0, 80.0, 90.0, 100.0}) {
    Sim world(support::straight_road(2, 2000.0));
    add(world, 1, 175.0, 8.0, cb::ConstantAcceleration{});
    auto const driver = add(world, 1, 130.0, 15.0, mobil(20.0));
    add(world, 2, at, 15.0, cb::ConstantAcceleration{.acceleration = 7.0});  // nobody expects that
    bool began = false;
    for (int k = 0; k < 60; ++k) {
      auto const was = world.memory<cb::Mobil>(driver).lateral.change;
      auto const home = world.record(driver).lane.corridor;
      REQUIRE(world.step(0.2));
      auto const now = world.memory<cb::Mobil>(driver).lateral.change;
      began = began || now.active();
      aborted += was.active() && was.target == cb::CorridorId{1} && now.active() && now.target == cb::CorridorId{} &&
                 home == cb::CorridorId{};
      CHECK(collisions(world) == 0);
    }
    CHECK(began);
  }
  CHECK(aborted >= 2);
}

TEST_CASE("who gives up a change at a standstill swings into nobody beside it, and gets away") {
  auto const truck = cb::geometry::truck();
  for (double const side : {1.0, -1.0})
    for (double const end : {100.0, 102.0, 104.0, 106.0}) {  // front end of the truck beside [m]
      CAPTURE(side);
      CAPTURE(end);
      Sim world(support::straight_road(2, 500.0));
      double const lane = -3.5 - 1.75 * side;
      auto const driver = add(world, side > 0.0 ? 2 : 1, 100.0, 0.0, mobil(14.0));
      world.add({.position = {end - truck.front, -3.5 + 1.75 * side},
                 .speed = 0.0,
                 .shape = truck,
                 .behavior = cb::ConstantAcceleration{}});
      auto state = world.state(driver);
      state.y = lane + 0.25 * side;
      state.heading = 0.22 * side;
      world.set_state(driver, state);
      cb::Mobil::Memory memory;
      auto const home = world.observe(driver).place().corridor;
      memory.lateral.change = {.target = side > 0.0 ? cb::CorridorId{0} : cb::CorridorId{1},
                               .left = 12.0f,
                               .bend = static_cast<float>(0.09 * side)};
      for (int k = 0; k < 100; ++k) {
        auto const plan = mobil(14.0).plan(world.observe(driver), memory, 0.2);
        REQUIRE(plan.status == cb::PlanStatus::valid);
        if (k == 0) REQUIRE(memory.lateral.change.target == home);
        world.set_state(driver, plan.trajectory.back());
        REQUIRE(collisions(world) == 0);
        if (world.state(driver).x > 130.0) break;
      }
      CHECK(world.state(driver).x > 130.0);
    }
}

TEST_CASE("a cyclist who gives up a change at a standstill turns back within its lane") {
  auto const truck = cb::geometry::truck();
  for (double const side : {1.0, -1.0})
    for (double const end : {104.0, 106.0, 108.0}) {  // front end of the truck beside [m]
      CAPTURE(side);
      CAPTURE(end);
      Sim world(support::straight_road(2, 500.0));
      auto const cyclist = world.add({.position = {100.0, -3.5 - 0.85 * side},
                                      .heading = 0.36 * side,
                                      .speed = 0.0,
                                      .shape = cb::geometry::bicycle(),
                                      .behavior = mobil(6.0)});
      world.add({.position = {end - truck.front, -3.5 + 1.75 * side},
                 .speed = 0.0,
                 .shape = truck,
                 .behavior = cb::ConstantAcceleration{}});
      auto const home = world.observe(cyclist).place().corridor;
      cb::Mobil::Memory memory;
      memory.lateral.change = {.target = side > 0.0 ? cb::CorridorId{0} : cb::CorridorId{1},
                               .left = 9.5f,
                               .bend = static_cast<float>(0.06 * side)};
      for (int k = 0; k < 100 && world.state(cyclist).x < 130.0; ++k) {
        auto const plan = mobil(6.0).plan(world.observe(cyclist), memory, 0.2);
        REQUIRE(plan.status == cb::PlanStatus::valid);
        if (k == 0) REQUIRE(memory.lateral.change.target == home);
        world.set_state(cyclist, plan.trajectory.back());
        REQUIRE(collisions(world) == 0);
        CHECK(std::abs(world.state(cyclist).y + 3.5 + 1.75 * side) < 1.75);
      }
      CHECK(world.state(cyclist).x > 130.0);
    }
}

TEST_CASE("a slow change into a lane that opens does not swing over the middle of the road") {
  cb::map::RoadPlan road{.id = "1", .line = cb::map::lay_from({}, {{600.0}})};
  for (double const begin : {0.0, 150.0, 170.0})
    road.sections.push_back({begin, cb::map::equal_lanes(1), cb::map::equal_lanes(begin > 0.0 ? 2 : 1)});
  auto& opening = road.sections[1].right.back();  // within 20 m
  opening.end_width = opening.width;
  opening.width = 0.0;
  auto const map = support::map_of(road);
  int changed = 0;
  for (double place = 40.0; place < 140.0; place += 5.0) {
    CAPTURE(place);
    auto driver = mobil(32.0);
    driver.lateral.course.duration = 6.5;
    Sim world(map);
    auto const id = world.add({.position = {place, -1.75}, .speed = 30.0, .behavior = driver});
    world.add({.position = {place + 110.0, -1.75}, .speed = 20.0, .behavior = cb::ConstantAcceleration{}});
    for (int k = 0; k < 60 && world.record(id).status == cb::AgentStatus::driving; ++k) {
      REQUIRE(world.step(0.2));
      CHECK(world.state(id).y < -0.85);  // half of its width
    }
    changed += world.state(id).y < -3.5 ? 1 : 0;
  }
  CHECK(changed > 5);
}

TEST_CASE("a vehicle that changes lanes drives evenly past a kink of the road") {
  for (double const turn : {0.1, -0.1})
    for (double const begin : {50.0, 60.0, 70.0, 80.0})
      for (auto const target : {cb::CorridorId{0}, cb::CorridorId{1}}) {
        CAPTURE(turn);
        CAPTURE(begin);
        double const sharp = std::copysign(1.0 / 7.0, turn);  // [1/m]
        Sim world(support::map_of({.id = "1",
                                   .line = cb::map::lay_from({}, {{100.0}, {turn / sharp, sharp, sharp}, {200.0}}),
                                   .sections = {{.right = cb::map::equal_lanes(2)}}}));
        auto const driver = add(world, target == cb::CorridorId{0} ? 2 : 1, begin, 15.0, mobil(15.0));
        cb::Mobil::Memory memory;
        memory.lateral.change = mobil(15.0).lateral.course.begin(target, cb::geometry::car(), 15.0);
        for (int k = 0; k < 60; ++k) {
          auto const before = world.state(driver);
          auto const plan = mobil(15.0).plan(world.observe(driver), memory, 0.1);
          REQUIRE(plan.status == cb::PlanStatus::valid);
          auto const& after = plan.trajectory.back();
          double const way = std::hypot(after.x - before.x, after.y - before.y);
          CHECK(way == doctest::Approx(0.05 * (before.speed + after.speed)).epsilon(0.1));
          world.set_state(driver, after);
        }
        CHECK_FALSE(memory.lateral.change.active());
      }
}

TEST_CASE("a slow change stays on the road where the two lanes become one") {
  auto const map = support::own_map("lane_drop.xodr");
  auto const ends = std::ranges::find_if(map->lanes(), [](auto const& lane) { return is_valid(lane.merges_into); });
  int changes = 0;
  for (double const speed : {10.0, 20.0})
    for (double const begin : {0.0, 5.0, 10.0, 15.0, 20.0}) {
      CAPTURE(speed);
      CAPTURE(begin);
      Sim world(map);
      auto const add = [&](double s, double v, auto const& driver) {
        auto const pose = ends->path.pose(s);
        world.add({.position = pose.position(), .heading = pose.heading, .speed = v, .behavior = driver});
      };
      auto driver = mobil(1.2 * speed);
      driver.lateral.course.duration = 10.0;
      add(begin, speed, driver);
      add(begin + 40.0, 0.5 * speed, mobil(0.5 * speed));
      for (int k = 0; k < 80; ++k) {
        REQUIRE(world.step(0.1));
        auto const& changer = world.frame().agents[cb::Slot{0}];
        changes += change_of(world, cb::Slot{0}).active();
        for (auto const& corner : cb::geometry::box_of(cb::geometry::car(), changer.state).corners())
          CHECK(map->on_drivable_lane(corner));
      }
    }
  CHECK(changes > 0);
}

TEST_CASE("a vehicle that leaves its lane hides its leader from its follower, but not long enough for a collision") {
  int hidden = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    cb::RandomStream random(seed, 1, 0);
    Sim world(support::straight_road(2, 2500.0, seed % 3 == 0 ? 0.002 : 0.0), {.seed = seed});
    double const v = between(6, 22, random), slow = seed % 5 == 0 ? 0.0 : v * between(0.0, 0.8, random);
    cb::IdmClassic const idm{.law = {.desired_speed = 1.2 * v}};
    auto const follower = add(world, 1, 100.0, v, seed % 2 == 0 ? Sim::Behavior(mobil(1.2 * v)) : Sim::Behavior(idm));
    for (double const behind : {10.0, 30.0})
      add(world, 2, 100.0 - behind, v, cb::IdmClassic{.law = {.desired_speed = v}});
    double const at = 104.5 + cb::idm_equilibrium_gap(idm.law, v) * between(0.7, 1.2, random);
    auto const leaving = add(world, 1, at, v, mobil(1.5 * v));
    double const way_to_brake = 6.5 + 1.5 * v + v * (v - slow) / 4;
    auto const ahead = add(world, 1, at + way_to_brake * between(0.7, 1.5, random), slow, cb::ConstantAcceleration{});
    for (int k = 0; k < 150; ++k) {
      REQUIRE(world.step(0.2));
      CAPTURE(seed);
      REQUIRE(collisions(world) == 0);
      auto const leader = world.observe(follower).ahead();
      if (!leader || leader->agent != leaving || world.record(leaving).lane.corridor == cb::CorridorId{}) continue;
      auto const& own = world.record(follower);
      double const gap = world.record(ahead).lane.s - own.lane.s - 4.5;
      hidden += own.lane.corridor == cb::CorridorId{} &&
                cb::idm_acceleration(idm.law, own.state.speed, gap, slow) <
                    cb::idm_acceleration(idm.law, own.state.speed, leader->gap, leader->speed);
    }
  }
  CHECK(hidden > 50);
}

TEST_CASE("a vehicle off its lane's middle or direction returns smoothly") {
  for (double const curvature : {0.0, 0.003})
    for (double const turn : {-0.3, 0.0, 0.15})
      for (double const speed : {0.5, 8.0, 30.0}) {
        Sim world(support::straight_road(1, 1500.0, curvature));
        auto const id = enter(world, lane_of(world.map(), 1), 100.0,
                              {.heading = turn, .speed = speed, .behavior = mobil(speed)}, 0.6);
        double before = turn;
        for (int k = 0; k < 400 && world.status(id) == cb::AgentStatus::driving; ++k) {
          REQUIRE(world.step(0.1));
          auto const& at = world.record(id).lane;
          INFO("curvature ", curvature, ", turn ", turn, ", speed ", speed, ", k ", k);
          CHECK(std::abs(at.heading_error - before) < 0.1);
          before = at.heading_error;
        }
        if (speed > 1.0) CHECK(std::abs(world.record(id).lane.lateral) < 0.01);
      }
}

TEST_CASE("drivers go around a standing object even if the other lane is busy") {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    cb::RandomStream random(seed, 0, 0);
    Sim world(support::straight_road(2, 2500.0, seed % 2 == 0 ? 0.001 : 0.0), {.seed = seed});
    auto const& lane = world.map().lanes()[world.map().lanes().size() - 1];
    auto const pose = lane.path.pose(400.0);
    int const number = -lane.number;
    std::vector<cb::geometry::Point> corners{{-2, -1}, {2, -1}, {2, 1}, {-2, 1}};
    for (auto& corner : corners) corner = cb::geometry::to_map(pose, corner);
    world.add_object(cb::geometry::Polygon(corners));
    auto const driver =
        add(world, number, 150.0 + 100.0 * cb::uniform01(random), 8 + 10 * cb::uniform01(random), mobil(18.0));
    for (double s = 60.0; s < 440.0; s += 16.0 + 6.0 * cb::uniform01(random))
      add(world, 3 - number, s, 10.0, cb::IdmClassic{.law = {.desired_speed = 10.0}});
    drive_safely(world, 700);
    CAPTURE(seed);
    CHECK(world.state(driver).x > pose.x + 50.0);
  }
}

TEST_CASE("a driver who starts close behind a parked vehicle, or two, pulls out before, amid or after those who come") {
  for (double const gap : {4.5, 8.0, 20.0})
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      cb::RandomStream random(seed, 0, 0);
      Sim world(support::straight_road(2, 600.0), {.seed = seed});
      auto const driver = world.add({.position = {100.0, -5.25}, .behavior = mobil(13.0)});
      auto const van = cb::geometry::van();
      double const at = 100.0 + cb::geometry::car().front + gap + van.rear;
      for (int i = 0; i < (seed % 2 == 0 ? 2 : 1); ++i)
        world.add({.position = {at + 20.0 * i, -5.25}, .shape = van, .behavior = cb::ConstantAcceleration{}});
      for (double s = 80.0; s > 0.0; s -= 12.0 + 20.0 * cb::uniform01(random))
        add(world, 1, s, 10.0, cb::IdmClassic{.law = {.desired_speed = 10.0}});
      drive_safely(world, 250);
      CAPTURE(gap);
      CAPTURE(seed);
      CHECK(world.state(driver).x > at + 50.0);
    }
}

TEST_CASE("a driver stops before the end of a lane without its goal, and changes as soon as it can") {
  for (double const spacing : {9.0, 14.0, 60.0}) {
    auto const map = support::straight_road(2, 600.0);
    Sim world(map);
    auto const driver = add(world, 2, 60.0, 15.0, mobil(15.0), goal_on(*map, 1, 560.0));
    for (double s = 20.0; s < 590.0; s += spacing) add(world, 1, s, 6.0, cb::IdmClassic{.law = {.desired_speed = 6.0}});
    bool reached = false;
    for (int k = 0; k < 1600 && !reached; ++k) {
      drive_safely(world, 1);
      auto const status = world.status(driver);
      REQUIRE((status == cb::AgentStatus::driving || status == cb::AgentStatus::arrived));
      reached = world.reached_goal(driver);
    }
    CAPTURE(spacing);
    CHECK(reached);
  }
}

TEST_CASE("nobody passes in a lane that leaves its route and from which the marks forbid the way back") {
  using Permission = cb::map::opendrive::LaneChangePermission;
  auto const passes = [](Permission permission) {
    cb::map::SectionPlan section{.right = cb::map::equal_lanes(2)};
    section.right[0].mark = cb::map::make_mark("broken", permission);
    auto const map = support::map_of({.id = "1", .line = cb::map::lay_from({}, {{2000.0}}), .sections = {section}});
    Sim world(map);
    auto const id = add(world, 2, 50.0, 20.0, mobil(30.0), goal_on(*map, 2, 1990.0));
    add(world, 2, 100.0, 10.0, cb::ConstantAcceleration{});
    drive_safely(world, 20);
    return world.frame().agents[world.slot_of(id)].lane.corridor == cb::CorridorId{0};
  };
  CHECK(passes(Permission::both));
  CHECK(!passes(Permission::increase));  // lane ids increase to the left
  CHECK(!passes(Permission::none));
}

TEST_CASE("from rest on an empty road a driver reaches the lane of its goal from every lane") {
  for (int const goal : {1, 4})
    for (int lane = 1; lane <= 4; ++lane) {
      double const shortest = 15.0 * (std::abs(goal - lane) + 0.5) + 7.0;
      for (double const before : {300.0, 150.0, 80.0, shortest}) {
        auto const map = support::straight_road(4, 600.0);
        Sim world(map);
        auto const driver = add(world, lane, 600.0 - before, 0.0, mobil(30.0), goal_on(*map, goal));
        for (int k = 0; k < 600 && !world.reached_goal(driver); ++k) REQUIRE(world.step(0.2));
        INFO("goal ", goal, ", lane ", lane, ", before ", before);
        CHECK(world.reached_goal(driver));
      }
    }
}

TEST_CASE("two vehicles that stand side by side and need each other's lanes both get there") {
  auto const come_there = [](cb::geometry::Shape const& shape, double at) {
    for (double const apart : {-3.0, 0.0, 3.0}) {
      auto const map = support::straight_road(2, 600.0);
      Sim world(map);
      auto const a = add(world, 1, at, 0.0, mobil(15.0), goal_on(*map, 2), shape),
                 b = add(world, 2, at + apart, 0.0, mobil(15.0), goal_on(*map, 1), shape);
      bool reached_a = false, reached_b = false;
      for (int k = 0; k < 900 && !(reached_a && reached_b); ++k) {
        drive_safely(world, 1);
        reached_a = reached_a || world.reached_goal(a);
        reached_b = reached_b || world.reached_goal(b);
      }
      INFO("apart ", apart, ", at ", at);
      CHECK(reached_a);
      CHECK(reached_b);
    }
  };
  for (double const at : {300.0, 450.0, 530.0, 560.0}) come_there(cb::geometry::car(), at);
  for (double const at : {300.0, 450.0, 500.0}) come_there(cb::geometry::bus(), at);
}

TEST_CASE("a merging vehicle never hides an object, whatever the ids") {
  MergingRoad const merge;
  auto const acceleration = [&](cb::AgentId merging) {
    Sim world(merge.site.map);
    auto const at = merge.corridor(merge.through).center.pose(merge.through.merge_at - 25.0);
    world.add_object(cb::geometry::Polygon(
        {{at.x - 1, at.y - 1}, {at.x + 1, at.y - 1}, {at.x + 1, at.y + 1}, {at.x - 1, at.y + 1}}));
    auto const id = merge.add(world, merge.through, 60.0,
                              {.speed = 12.0,
                               .behavior = cb::Mobil{.lateral = {.rule = {.threshold = 10.0}}},
                               .id = cb::AgentId{5}});  // stays in its lane
    merge.add(world, merge.ramp, 34.0, {.speed = 12.0, .behavior = cb::ConstantAcceleration{}, .id = merging});
    REQUIRE(world.step(0.2));
    return world.record(id).action.acceleration;
  };
  CHECK(acceleration(cb::AgentId{1}) == acceleration(cb::AgentId{9}));
  CHECK(acceleration(cb::AgentId{1}) < -4.0);
}

TEST_CASE("a vehicle that merges never hides a faster follower from a driver who wants to change lanes") {
  MergingRoad const merge;
  auto const changes = [&](bool has_follower, bool has_ramp_vehicle) {
    Sim world(merge.site.map);
    auto const add_left_of_through = [&](double before, double speed, auto const& behavior) {
      auto const pose = merge.corridor(merge.through).center.pose(merge.through.merge_at - before);
      Sim::AgentSpec const spec{.position = cb::geometry::to_map(pose, {0.0, 3.75}),
                                .heading = pose.heading,
                                .speed = speed,
                                .behavior = behavior};
      return world.add(spec);
    };
    auto const id = add_left_of_through(60.0, 6.0, mobil(20.0));
    add_left_of_through(40.0, 3.0, cb::ConstantAcceleration{});
    if (has_follower)
      merge.add(world, merge.through, 85.0,
                {.speed = 25.0, .behavior = cb::IdmClassic{.law = {.desired_speed = 25.0}}});
    if (has_ramp_vehicle) merge.add(world, merge.ramp, 48.0, {.speed = 0.0, .behavior = cb::ConstantAcceleration{}});
    REQUIRE(world.step(0.2));
    return change_of(world, world.slot_of(id)).active();
  };
  CHECK(changes(false, false));
  CHECK(changes(false, true));
  CHECK_FALSE(changes(true, false));
  CHECK_FALSE(changes(true, true));
}
