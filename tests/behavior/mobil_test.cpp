#include "cambium/behavior/lane_change/mobil.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "../support/maps.hpp"
#include "cambium/map/building/road_plan.hpp"
#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/map/road/curve_layout.hpp"
#include "cambium/scenario/merging_site.hpp"
#include "lane_traffic_fixtures.hpp"

using namespace lane_traffic;

namespace {

using Sim = Traffic<cb::Mobil, cb::IdmClassic, cb::ConstantAcceleration>;

cb::Mobil mobil(double desired_speed) { return {.idm = {.desired_speed = desired_speed}}; }

cb::LaneChange change_of(Sim const& world, auto slot) { return std::get<0>(world.frame().agents[slot].memory).change; }

bool begins(Sim const& before, Sim const& world, auto slot) {
  return !change_of(before, slot).active() && change_of(world, slot).active();
}

/// Steps and calls `f(before, slot, target)` for each MOBIL driver that begins a change; `before` is the world before
/// the step.
template <class F>
void step_and_visit_changes(Sim& world, F const& f) {
  Sim const before = world;
  REQUIRE(world.step(0.2));
  for (std::size_t i = 0; i < world.size(); ++i)
    if (begins(before, world, i)) f(before, i, change_of(world, i).target);
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

/// Lane changes by their outcome, and collisions.
struct Counts {
  int begun = 0, done = 0, aborted = 0, collisions = 0;
};

/// Steps `world` and counts.
Counts run(Sim& world, int steps, double dt) {
  Counts counts;
  std::vector<cb::CorridorId> home(world.size(), cb::none<cb::CorridorId>);  // where a change in progress began
  for (int k = 0; k < steps; ++k) {
    Sim const before = world;
    REQUIRE(world.step(dt));
    for (std::size_t i = 0; i < world.size(); ++i) {
      if (world.roster().agents[i].behavior.index() != 0) continue;
      auto const was = change_of(before, i), now = change_of(world, i);
      if (!was.active() && now.active()) {
        ++counts.begun;
        home[i] = before.frame().agents[i].lane.corridor;
      }
      if (was.active() && now.active() && now.target == home[i] && was.target != home[i]) ++counts.aborted;
      if (was.active() && !now.active()) ++counts.done;
    }
    counts.collisions += collisions(world);
  }
  return counts;
}

/// Number of lane changes in dense traffic, and how many of them lead back to the previous lane within 12 s.
std::pair<int, int> changes_and_returns(double threshold, double rest) {
  int changes = 0, returns = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    Sim world(support::straight_road(3, 3000.0), {.seed = seed});
    fill(world, 3, 5.0, 700.0, 2.0, seed, [&](double v) {
      return cb::Mobil{.idm = {.desired_speed = v}, .changing = {.rest = rest}, .threshold = threshold};
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
cb::Goal goal_on(cb::Map const& map, int number, double s = 590.0) {
  for (auto const& entry : map.roads()[0].sections[0].lanes)
    if (map.lane(entry.id).number == -number) return cb::ReachLane{entry.id, s};
  return {};
}

}  // namespace

TEST_CASE("MOBIL drivers do not collide in dense traffic, on straight and curved roads") {
  Counts all;
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    auto const map = support::straight_road(seed % 2 == 0 ? 3 : 4, 1500.0, seed % 3 == 0 ? 0.002 : 0.0);
    Sim world(map, {.seed = seed});
    fill(world, seed % 2 == 0 ? 3 : 4, 5.0, 600.0, 1.0 + static_cast<double>(seed % 4), seed,
         [](double v) { return mobil(v); });
    auto const counts = run(world, 300, seed % 2 == 0 ? 0.2 : 0.1);
    CAPTURE(seed);
    CHECK(counts.collisions == 0);
    all.begun += counts.begun;
    all.done += counts.done;
    all.aborted += counts.aborted;
  }
  MESSAGE(all.begun << " changes, " << all.aborted << " aborted");
  CHECK(all.begun > 200);
  CHECK(all.done > 9 * (all.begun - all.aborted) / 10);
}

TEST_CASE("MOBIL drivers do not collide in slow traffic of cars, trucks and buses") {
  int begun = 0;
  for (std::uint64_t seed = 1; seed <= 36; ++seed) {
    Sim world(support::straight_road(3, 1500.0, seed % 3 == 0 ? 0.002 : 0.0), {.seed = seed});
    fill_slow(world, 3, seed, [](bool is_long) {
      return cb::Mobil{.idm = is_long ? cb::presets::kesting_2010_truck() : cb::presets::kesting_2010_car()};
    });
    auto const counts = run(world, 450, 0.2);
    CAPTURE(seed);
    CHECK(counts.collisions == 0);
    begun += counts.begun;
  }
  MESSAGE(begun << " changes");
  CHECK(begun > 1000);
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

TEST_CASE("no change begins into an unsafe gap, by brute force over all vehicles") {
  int begun = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Sim world(support::straight_road(3, 1500.0), {.seed = seed});
    fill(world, 3, 5.0, 600.0, 2.0, seed, [](double v) { return mobil(v); });
    for (int k = 0; k < 200; ++k)
      step_and_visit_changes(world, [&](Sim const& before, std::size_t i, cb::CorridorId target) {
        ++begun;
        auto const& me = before.frame().agents[i];
        auto const& shape = world.roster().agents[i].shape;
        auto const& driver = std::get<0>(world.roster().agents[i].behavior);
        double const center = -3.5 * (static_cast<double>(index_of(target)) + 0.5);
        for (std::size_t j = 0; j < world.size(); ++j) {
          auto const& other = before.frame().agents[j];
          auto const& its = world.roster().agents[j].shape;
          if (j == i || std::abs(other.state.y - center) > 1.75 - 0.9) continue;
          bool const ahead = other.state.x > me.state.x;
          double const gap = ahead ? other.state.x - its.rear - me.state.x - shape.front
                                   : me.state.x - shape.rear - other.state.x - its.front;
          REQUIRE(gap > 0.0);
          auto follower = its.length() > driver.changing.truck_length ? driver.changing.trucks : driver.changing.others;
          follower.desired_speed = std::max(follower.desired_speed, other.state.speed);
          double const a = ahead ? cb::idm_acceleration(driver.idm, me.state.speed, gap, other.state.speed)
                                 : cb::idm_acceleration(follower, other.state.speed, gap, me.state.speed);
          CHECK(a >= -driver.changing.safe_deceleration - 1e-3);
        }
      });
  }
  MESSAGE(begun << " changes");
  CHECK(begun > 100);
}

TEST_CASE("drivers slow down for bends and for limits if the rules say so") {
  enum class What { neither, bends, limits };
  for (auto const what : {What::neither, What::bends, What::limits})
    for (double const radius : {10.0, 30.0, 100.0})
      for (double const braking : {1.67, 3.0}) {
        auto const map = support::map_of(
            {.id = "1",
             .line = cb::map::lay_from({}, {{400.0}, {1.5 * radius, 1.0 / radius, 1.0 / radius}, {300.0}}),
             .sections = {{.right = cb::map::equal_lanes(1)}},
             .speed_limit = 20.0});
        Sim world(map);
        auto driver = mobil(28.0);
        driver.idm.comfortable_deceleration = braking;
        driver.rules.slow_for_bends = what == What::bends;
        driver.rules.obey_speed_limits = what == What::limits;
        auto const id = add(world, 1, 20.0, 28.0, driver);
        double across = 0.0, hardest = 0.0, fastest = 0.0;
        for (int k = 0; k < 200 && world.record(id).status == cb::AgentStatus::driving; ++k) {
          auto const before = world.state(id);
          REQUIRE(world.step(0.2));
          auto const& now = world.state(id);
          double const turn = std::abs(cb::geometry::angle_difference(now.heading, before.heading));
          across = std::max(across, turn / 0.2 * now.speed);
          hardest = std::max(hardest, (before.speed - now.speed) / 0.2);
          if (now.x > 200.0) fastest = std::max(fastest, now.speed);
        }
        INFO("what ", static_cast<int>(what), ", radius ", radius, ", braking ", braking, ", across ", across);
        CHECK((across < 3.2) == (what == What::bends));  // the bend is known to 5 %
        if (what == What::limits) CHECK(fastest < 20.5);
        if (what == What::bends) CHECK(hardest < 1.5 * braking);
        if (what == What::bends) CHECK(across > 1.8);
      }
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

TEST_CASE("the more polite drivers are, the less deceleration they impose on others") {
  std::vector<double> imposed;
  for (double const politeness : {0.0, 0.5, 2.0}) {
    double total = 0.0;
    for (std::uint64_t seed = 1; seed <= 16; ++seed) {
      Sim world(support::straight_road(3, 2500.0), {.seed = seed});
      fill(world, 3, 5.0, 900.0, 2.0, seed,
           [&](double v) { return cb::Mobil{.idm = {.desired_speed = v}, .politeness = politeness}; });
      for (int k = 0; k < 150; ++k)
        step_and_visit_changes(world, [&](Sim const& before, std::size_t i, cb::CorridorId target) {
          auto here = before;
          auto const view = here.observe(world.roster().agents[i].id);
          auto const there = view.place(target);
          auto const front = view.ahead(there), rear = view.behind(there);
          if (!rear) return;
          auto const law = std::get<0>(world.roster().agents[i].behavior).changing.law_of(*rear);
          double const alone = front ? rear->gap + view.shape().length() + front->gap : 1e9;
          total += std::max(0.0, law(alone, front ? front->speed : 0.0) - law(rear->gap, view.state().speed));
        });
    }
    imposed.push_back(total);
  }
  MESSAGE("imposed at politeness 0, 0.5, 2: " << imposed[0] << ", " << imposed[1] << ", " << imposed[2] << " m/s^2");
  CHECK(imposed[1] < 0.8 * imposed[0]);
  CHECK(imposed[2] < 0.8 * imposed[1]);
}

TEST_CASE("under the keep-right rule traffic drives on the right") {
  int on_right[2] = {0, 0}, total = 0;
  for (int const rule : {0, 1}) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      Sim world(support::straight_road(3, 4000.0), {.seed = seed});
      fill(world, 3, 5.0, 1500.0, 0.05, seed, [&](double v) {
        return cb::Mobil{.idm = {.desired_speed = 20.0 + 0.2 * v}, .bias = 0.3 * rule, .keep_right = rule == 1};
      });
      for (int k = 0; k < 300; ++k) REQUIRE(world.step(0.2));
      for (auto const& record : world.frame().agents) on_right[rule] += record.lane.corridor == cb::CorridorId{2};
      if (rule == 1) total += static_cast<int>(world.size());
    }
  }
  MESSAGE("of " << total << ", " << on_right[0] << " on the right without the rule, " << on_right[1] << " with it");
  CHECK(on_right[1] > 0.6 * total);
  CHECK(on_right[0] < 0.45 * total);
}

TEST_CASE("under the keep-right rule a fast driver does not pass a slower one on the right") {
  for (bool const rule : {false, true}) {
    Sim world(support::straight_road(2, 2000.0));
    auto const slow = add(world, 1, 150.0, 20.0, cb::ConstantAcceleration{});
    cb::Mobil const driver{.idm = {.desired_speed = 30.0}, .threshold = 5.0, .keep_right = rule};  // stays on the right
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
        return cb::Mobil{.idm = {.desired_speed = desired}, .bias = left_hand ? 0.3 : 0.0, .keep_right = left_hand};
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

TEST_CASE("a follower is judged by the parameters for its length and by its present speed") {
  for (bool const is_truck : {false, true})
    for (bool const truck_is_hindered : {false, true}) {
      Sim world(support::straight_road(2, 2000.0));
      add(world, 1, 230.0, 8.0, cb::ConstantAcceleration{});
      cb::Mobil driver = mobil(20.0);
      auto& wary = truck_is_hindered ? driver.changing.trucks : driver.changing.others;
      wary.time_headway = 8.0;
      auto const id = add(world, 1, 200.0, 14.0, driver);
      auto const shape = is_truck ? cb::geometry::truck() : cb::geometry::car();
      add(world, 2, 160.0 - shape.front, 14.0, cb::ConstantAcceleration{}, {}, shape);
      REQUIRE(world.step(0.2));
      CHECK(world.memory<cb::Mobil>(id).change.active() == (is_truck != truck_is_hindered));
    }
  cb::LaneChanging const changing;
  CHECK(changing.law_of({.front = 4.5, .speed = 40.0}).free() == doctest::Approx(0.0));
  CHECK(changing.law_of({.front = 4.5, .speed = 10.0}).free() > changing.law_of({.front = 12.0, .speed = 10.0}).free());
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
      auto const was = world.memory<cb::Mobil>(driver).change;
      auto const home = world.record(driver).lane.corridor;
      REQUIRE(world.step(0.2));
      auto const now = world.memory<cb::Mobil>(driver).change;
      began = began || now.active();
      aborted += was.active() && was.target == cb::CorridorId{1} && now.active() && now.target == cb::CorridorId{} &&
                 home == cb::CorridorId{};
      CHECK(collisions(world) == 0);
    }
    CHECK(began);
  }
  CHECK(aborted >= 2);
}

TEST_CASE("a vehicle that leaves its lane hides its leader from its follower, but not long enough for a collision") {
  int hidden = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    cb::RandomStream random(seed, 1, 0);
    Sim world(support::straight_road(2, 2500.0, seed % 3 == 0 ? 0.002 : 0.0), {.seed = seed});
    double const v = between(6, 22, random), slow = seed % 5 == 0 ? 0.0 : v * between(0.0, 0.8, random);
    cb::IdmClassic const idm{.desired_speed = 1.2 * v};
    auto const follower = add(world, 1, 100.0, v, seed % 2 == 0 ? Sim::Behavior(mobil(1.2 * v)) : Sim::Behavior(idm));
    for (double const behind : {10.0, 30.0}) add(world, 2, 100.0 - behind, v, cb::IdmClassic{.desired_speed = v});
    double const at = 104.5 + cb::idm_equilibrium_gap(idm, v) * between(0.7, 1.2, random);
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
                cb::idm_acceleration(idm, own.state.speed, gap, slow) <
                    cb::idm_acceleration(idm, own.state.speed, leader->gap, leader->speed);
    }
  }
  CHECK(hidden > 50);
}

TEST_CASE("a vehicle off its lane's middle or direction returns smoothly") {
  for (double const curvature : {0.0, 0.003})
    for (double const turn : {-0.3, 0.0, 0.15})
      for (double const speed : {0.5, 8.0, 30.0}) {
        Sim world(support::straight_road(1, 1500.0, curvature));
        auto const& lane = *std::find_if(world.map().lanes().begin(), world.map().lanes().end(),
                                         [](auto const& candidate) { return candidate.drivable(); });
        auto const pose = lane.path.pose(100.0);
        auto const id = world.add({.position = cb::geometry::to_map(pose, {0.0, 0.6}),
                                   .heading = pose.heading + turn,
                                   .speed = speed,
                                   .behavior = mobil(speed)});
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
    auto const corner = [&](double dx, double dy) {
      return cb::geometry::Point{pose.x + dx * std::cos(pose.heading) - dy * std::sin(pose.heading),
                                 pose.y + dx * std::sin(pose.heading) + dy * std::cos(pose.heading)};
    };
    std::vector<cb::geometry::Point> const corners{corner(-2, -1), corner(2, -1), corner(2, 1), corner(-2, 1)};
    world.add_object(cb::geometry::Polygon(corners));
    auto const driver =
        add(world, number, 150.0 + 100.0 * cb::uniform01(random), 8 + 10 * cb::uniform01(random), mobil(18.0));
    for (double s = 60.0; s < 440.0; s += 16.0 + 6.0 * cb::uniform01(random))
      add(world, 3 - number, s, 10.0, cb::IdmClassic{.desired_speed = 10.0});
    drive_safely(world, 700);
    CAPTURE(seed);
    CHECK(world.state(driver).x > pose.x + 50.0);
  }
}

TEST_CASE("a driver stops before the end of a lane without its goal, and changes as soon as it can") {
  for (double const spacing : {9.0, 14.0, 60.0}) {
    auto const map = support::straight_road(2, 600.0);
    Sim world(map);
    auto const driver = add(world, 2, 60.0, 15.0, mobil(15.0), goal_on(*map, 1, 560.0));
    for (double s = 20.0; s < 590.0; s += spacing) add(world, 1, s, 6.0, cb::IdmClassic{.desired_speed = 6.0});
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

TEST_CASE("on a lane drop MOBIL drivers leave the lane that ends") {
  auto const drop = support::own_map("lane_drop.xodr");
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    Sim world(drop, {.seed = seed});
    fill(world, 3, 5.0, 250.0, 1.5, seed, [](double v) { return mobil(v); });
    CAPTURE(seed);
    drive_safely(world, 500);
    for (auto const& record : world.frame().agents) CHECK(record.status != cb::AgentStatus::off_route);
  }
}

TEST_CASE("a merging vehicle never hides an object, whatever the ids") {
  using Sim =
      cb::World<cb::BehaviorSet<cb::Mobil, cb::ConstantAcceleration>, cb::InterpolateExecution, cb::SingleTrack>;
  auto const map = support::own_map("merging.xodr");
  auto const site = cb::find_merging_site(map);
  auto const through =
      *std::ranges::find_if(site.entrances, [](auto const& e) { return e.merges() && !e.gives_up_lane; });
  auto const pose_before = [&](auto const& entrance, double distance) {
    auto const road = cb::map::build_road_corridor(*map, entrance.route);
    return road->corridors[road->main].center.pose(entrance.merge_at - distance);
  };
  auto const acceleration = [&](cb::AgentId merging) {
    Sim world(map);
    auto const at = pose_before(through, 25.0);
    world.add_object(cb::geometry::Polygon(
        {{at.x - 1, at.y - 1}, {at.x + 1, at.y - 1}, {at.x + 1, at.y + 1}, {at.x - 1, at.y + 1}}));
    auto const add = [&](auto const& entrance, double distance, Sim::Behavior const& behavior, cb::AgentId id) {
      auto const pose = pose_before(entrance, distance);
      return world.add({.position = pose.position(),
                        .heading = pose.heading,
                        .speed = 12.0,
                        .behavior = behavior,
                        .route = entrance.route,
                        .id = id});
    };
    cb::Mobil driver;
    driver.threshold = 10.0;  // it stays in its lane
    auto const id = add(through, 60.0, driver, cb::AgentId{5});
    add(site.entrances[site.ramp], 34.0, cb::ConstantAcceleration{}, merging);
    REQUIRE(world.step(0.2));
    return world.record(id).action.acceleration;
  };
  CHECK(acceleration(cb::AgentId{1}) == acceleration(cb::AgentId{9}));
  CHECK(acceleration(cb::AgentId{1}) < -4.0);
}
