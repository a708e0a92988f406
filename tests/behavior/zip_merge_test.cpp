#include "cambium/behavior/drivers.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "lane_traffic_fixtures.hpp"

using namespace lane_traffic;

namespace {

using Sim = Traffic<cb::ZipMerge, cb::IdmClassic>;

/// Two queues before the lane drop: alternately `block` vehicles of each lane, `spacing` [m] apart.
template <class Driver>
std::map<cb::AgentId, int> queues(Sim& world, std::uint64_t seed, int block, double spacing, Driver const& driver) {
  cb::RandomStream random(seed, 0, 0);
  std::map<cb::AgentId, int> from;
  double s = 380.0;
  for (int i = 0; i < 40 && s > 5.0; ++i) {
    int const lane = (i / block + static_cast<int>(seed)) % 2 == 0 ? 2 : 3;
    from[add(world, lane, s, 4.0, driver(between(12, 16, random)))] = lane;
    s -= spacing + between(0.0, 1.0, random);
  }
  return from;
}

cb::ZipMerge zip(double desired_speed) { return {.law = {.desired_speed = desired_speed}}; }

/// The lanes from which vehicles pass position x, in this order.
struct Passed {
  std::string lanes;
  int collisions = 0;

  /// How often two vehicles of one lane pass in succession.
  [[nodiscard]] int same() const {
    int count = 0;
    for (std::size_t i = 1; i < lanes.size(); ++i) count += lanes[i] == lanes[i - 1];
    return count;
  }
};

Passed run(Sim& world, std::map<cb::AgentId, int> const& from, double x, int steps) {
  Passed passed;
  for (int k = 0; k < steps; ++k) {
    auto const before = world.frame();
    REQUIRE(world.step(0.2));
    std::vector<std::pair<double, int>> now;  // within a step, the vehicle ahead passed first
    for (std::size_t i = 0; i < world.size(); ++i) {
      auto const at = from.find(world.roster().agents[i].id);
      if (at == from.end()) continue;
      double const was = before.agents[i].state.x, is = world.frame().agents[i].state.x;
      if (was < x && is >= x) now.emplace_back(-is, at->second);
    }
    std::sort(now.begin(), now.end());
    for (auto const& [place, lane] : now) passed.lanes += std::to_string(lane);
    passed.collisions += collisions(world);
  }
  return passed;
}

}  // namespace

TEST_CASE("on a saturated lane drop vehicles alternate between the lanes, and all pass without collisions") {
  auto const map = support::own_map("lane_drop.xodr");
  int pairs = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed)
    for (int const block : {seed % 2 == 0 ? 2 : 1, 5}) {  // 5: one lane is sparser for a while
      Sim world(map, {.seed = seed});
      auto const from = queues(world, seed, block, block == 1 ? 7.0 : block == 2 ? 10.0 : 9.0, zip);
      auto const passed = run(world, from, 640.0, 700);
      INFO("seed ", seed, ", block ", block, ", order ", passed.lanes);
      CHECK(passed.collisions == 0);
      CHECK(passed.lanes.size() == from.size());
      if (block == 5) continue;
      CHECK(passed.same() < block);  // the last vehicles have nobody left to alternate with
      pairs += static_cast<int>(passed.lanes.size()) - 1;
    }
  CHECK(pairs > 400);
}

TEST_CASE("IDM drivers merge in no alternating order") {
  auto const map = support::own_map("lane_drop.xodr");
  int same = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Sim world(map, {.seed = seed});
    auto const from =
        queues(world, seed, 2, 10.0, [](double v) { return cb::IdmClassic{.law = {.desired_speed = v}}; });
    auto const passed = run(world, from, 640.0, 700);
    CHECK(passed.lanes.size() == from.size());
    same += passed.same();
  }
  CHECK(same >= 12);
}

TEST_CASE(
    "among drivers who follow whoever is ahead, zip merging vehicles of any length do not collide, and all get on") {
  using cb::geometry::car, cb::geometry::truck, cb::geometry::bus;
  auto const map = support::own_map("lane_drop.xodr");
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    CAPTURE(seed);
    Sim world(map, {.seed = seed});
    cb::RandomStream random(seed, 0, 0);
    double place[2] = {380.0, 380.0 - between(0.0, 12.0, random)};
    std::size_t entered = 0;
    for (int i = 0; i < 40; ++i) {
      int const lane = i % 2;
      auto const shape = cb::uniform01(random) < 0.4 ? truck() : cb::uniform01(random) < 0.2 ? bus() : car();
      double const desired = between(10.0, 16.0, random), s = place[lane] - shape.front;
      if (s - shape.rear < 5.0) continue;
      if (cb::uniform01(random) < 0.5)
        add(world, 2 + lane, s, 6.0, zip(desired), {}, shape);
      else
        add(world, 2 + lane, s, 6.0, cb::IdmClassic{.law = {.desired_speed = desired}}, {}, shape);
      place[lane] = s - shape.rear - between(6.0, 14.0, random);
      ++entered;
    }
    std::size_t passed = 0;
    int hits = 0;
    for (int k = 0; k < 1500 && passed < entered; ++k) {
      REQUIRE(world.step(0.2));
      hits += collisions(world);
      passed = 0;
      for (auto const& agent : world.frame().agents) passed += agent.state.x > 640.0;
    }
    CHECK(hits == 0);
    CHECK(passed == entered);
  }
}

TEST_CASE("beside a fast lane nobody brakes to a standstill for vehicles that pass anyway") {
  auto const map = support::own_map("lane_drop.xodr");
  for (double gap = 40.0; gap < 85.0; gap += 5.0) {
    CAPTURE(gap);
    Sim world(map, {.seed = 1});
    std::vector<cb::AgentId> slow;
    for (double s = 400.0; s > 300.0; s -= 36.0) slow.push_back(add(world, 3, s, 13.8, zip(30.0)));
    for (double s = 410.0; s > 100.0; s -= gap) add(world, 2, s, 26.0, zip(30.0));
    double slowest = 100.0;
    for (int k = 0; k < 150; ++k) {
      drive_safely(world, 1);
      for (auto const id : slow) slowest = std::min(slowest, world.state(id).speed);
    }
    CHECK(slowest > 2.0);
  }
}

TEST_CASE("ramp and main road alternate at a merge in a junction, without collisions") {
  auto const map = support::own_map("merging.xodr");
  auto const road = [&map](std::string const& name) -> cb::map::Road const& {
    for (auto const& candidate : map->roads())
      if (candidate.name == name) return candidate;
    FAIL("no road " << name);
    return map->roads()[0];
  };
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    cb::RandomStream random(seed, 0, 0);
    Sim world(map, {.seed = seed});
    std::map<cb::AgentId, int> from;
    for (int const number : {1, 2}) {
      for (auto const& entry : road(std::to_string(number)).sections[0].lanes) {
        auto const& lane = map->lane(entry.id);
        if (!lane.drivable() || (number == 1 && entry.number != -2)) continue;
        for (double s = lane.length() - 10.0 * cb::uniform01(random); s > 5.0;
             s -= 12.0 + 6.0 * cb::uniform01(random)) {
          from[enter(world, lane, s, {.speed = 5.0, .behavior = zip(14.0)})] = number;
        }
      }
    }
    auto const passed = run(world, from, 800.0, 900);
    auto const& order = passed.lanes;
    CAPTURE(seed);
    CAPTURE(order);
    CHECK(passed.collisions == 0);
    // Except for the first two, which start at the merge, and the last ones, which have nobody left to alternate with.
    auto const last = std::min(order.rfind('1'), order.rfind('2'));
    for (std::size_t i = 2; i <= last; ++i) CHECK(order[i] != order[i - 1]);
    CHECK(last > 15);
    CHECK(passed.lanes.size() + 2 >= from.size());
  }
}

TEST_CASE("a driver loses its patience with a vehicle that stands, and only then goes") {
  using Blocked = Traffic<cb::ZipMerge, cb::IdmClassic, cb::ConstantAcceleration>;
  auto const start_of = [](double patience) {
    Blocked world(own_map("lane_drop.xodr"));
    auto driver = zip(14.0);
    driver.heed<cb::Zip>().patience = patience;
    add(world, 2, 438.0, 8.0, cb::IdmClassic{.law = {.desired_speed = 14.0}});
    auto const id = add(world, 2, 428.0, 0.0, driver);
    add(world, 3, 424.0, 0.0, cb::ConstantAcceleration{});  // its turn, but it never starts
    while (world.time() < 40.0 && world.state(id).speed < 1.0) REQUIRE(world.step(0.2));
    return world.time();
  };
  double const soon = start_of(2.0), late = start_of(12.0);
  CHECK(soon > 2.0);
  CHECK(soon < 8.0);
  CHECK(late > 12.0);
  CHECK(late < 18.0);
}
