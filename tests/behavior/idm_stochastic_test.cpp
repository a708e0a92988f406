#include "cambium/behavior/wrap/idm_stochastic.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <set>
#include <vector>

#include "cambium/behavior/drivers.hpp"
#include "lane_traffic_fixtures.hpp"

using namespace lane_traffic;
using cb::IdmStochastic;

namespace {

using Yielding = cb::BasicIdmStochastic<cb::Uniform, cb::IdmClassic::Also<cb::Yielding<>>>;
using World = Traffic<IdmStochastic, Yielding, cb::ConstantAcceleration>;

Yielding yielding_driver(cb::Yielding<> const& yielding = {}) {
  Yielding driver;
  driver.driver = driver.driver.with(yielding);
  return driver;
}

bool yields(World& world, std::uint32_t agent) {
  return world.memory<Yielding>(static_cast<cb::AgentId>(agent)).driver.heeds.get<cb::Yielding<>>().yields;
}

World free_drivers(World::Behavior const& driver, int agents, std::uint64_t seed) {
  World world(straight_road(8, 3000), {.seed = seed});
  for (int i = 0; i < agents; ++i)
    world.add({.position = {20.0 + 150.0 * (i / 8), -1.75 - 3.5 * (i % 8)}, .speed = 14, .behavior = driver});
  return world;
}

}  // namespace

TEST_CASE("draws follow their distributions and stay within IDM's ranges") {
  IdmStochastic const driver;
  double sum = 0.0, low = 1e9, high = 0.0;
  for (std::uint32_t i = 0; i < 20000; ++i) {
    cb::RandomStream random(i, 0, 0);
    auto const p = driver.draw(random);
    sum += p.law.time_headway;
    low = std::min(low, p.law.time_headway);
    high = std::max(high, p.law.time_headway);
    REQUIRE_NOTHROW(cb::check_parameters(p));
  }
  CHECK(sum / 20000 == doctest::Approx(1.5).epsilon(0.01));
  CHECK(low < 1.001);
  CHECK(low >= 1.0);
  CHECK(high > 1.999);
  cb::BasicIdmStochastic<cb::Normal, cb::IdmClassic> normal;
  normal.desired_speed = {10.0, 1000.0};
  normal.maximum_acceleration = {0.0, 5.0};
  for (std::uint32_t i = 0; i < 2000; ++i) {
    cb::RandomStream random(i, 0, 0);
    CHECK_NOTHROW(cb::check_parameters(normal.draw(random)));
  }
}

TEST_CASE("with parameters drawn once, each agent settles at its own speed on a free road") {
  auto world = free_drivers(IdmStochastic{}, 40, 3);
  for (int i = 0; i < 150; ++i) REQUIRE(world.step(0.2));
  std::set<double> speeds;
  for (auto const& record : world.frame().agents) {
    if (record.status != cb::AgentStatus::driving) continue;
    CHECK(record.state.speed < 18.1);
    speeds.insert(record.state.speed);
    CHECK(std::abs(record.action.acceleration) < 0.5);
  }
  CHECK(speeds.size() > 30);
  CHECK(*speeds.rbegin() - *speeds.begin() > 2.0);
}

TEST_CASE("with parameters drawn in every step, the acceleration is noisy") {
  IdmStochastic driver;
  driver.drawn = IdmStochastic::Drawn::per_step;
  auto world = free_drivers(driver, 8, 3);
  double changes = 0.0;
  for (int i = 0; i < 100; ++i) {
    double const before = world.frame().agents[0].action.acceleration;
    REQUIRE(world.step(0.2));
    if (i > 50) changes += std::abs(world.frame().agents[0].action.acceleration - before);
  }
  CHECK(changes > 5.0);
}

TEST_CASE("equal seeds give equal traffic, and different seeds differ") {
  auto const driver = yielding_driver();
  auto a = free_drivers(driver, 24, 3), b = free_drivers(driver, 24, 3), c = free_drivers(driver, 24, 4);
  step_all(50, 0.2, a, b, c);
  CHECK(a.frame() == b.frame());
  CHECK(a.frame() != c.frame());
}

TEST_CASE("yielding and insisting alternate with durations from their distributions") {
  auto world = free_drivers(yielding_driver({.yields = {2.0, 4.0}, .insists = {6.0, 8.0}}), 16, 5);
  double yielding = 0.0, all = 0.0;
  int changes = 0;
  std::vector<bool> before(16, false);
  for (int i = 0; i < 900; ++i) {
    REQUIRE(world.step(0.1));
    for (std::uint32_t k = 0; k < 16; ++k) {
      if (world.frame().agents[k].status != cb::AgentStatus::driving) continue;
      bool const now = yields(world, k);
      changes += now != before[k];
      before[k] = now;
      yielding += now;
      all += 1.0;
    }
  }
  CHECK(yielding / all == doctest::Approx(0.3).epsilon(0.1));
  CHECK(all * 0.1 / changes == doctest::Approx(5.0).epsilon(0.1));
}

TEST_CASE("drivers do not yield in unison: at any time their number fits the durations") {
  auto const driver = yielding_driver({.yields = {4.0, 4.0}, .insists = {6.0, 6.0}});
  constexpr std::uint32_t count = 40;
  for (std::uint64_t const seed : {5u, 6u, 7u}) {
    auto world = free_drivers(driver, count, seed);
    for (int i = 0; i < 120; ++i) {
      REQUIRE(world.step(0.1));
      int yielding = 0;
      for (std::uint32_t k = 0; k < count; ++k) yielding += yields(world, k);
      CHECK(yielding > 4);  // 16 expected, with a standard deviation of 3.1
      CHECK(yielding < 28);
    }
  }
}

TEST_CASE("a yielding driver leaves room for a vehicle in the neighbouring lane that ends") {
  auto const map = own_map("lane_drop.xodr");
  // The lane beside one that leads into a lane with the same successor as its neighbour.
  for (auto const& lane : map->lanes()) {
    if (!lane.drivable() || !cb::is_valid(lane.left_neighbor) || lane.successors.empty()) continue;
    auto const& through = map->lane(lane.left_neighbor);
    auto const &narrow = map->lane(lane.successors[0]), &beside = map->lane(through.successors[0]);
    if (narrow.id == beside.id || narrow.successors.empty() || narrow.successors != beside.successors) continue;
    auto const rolling = [&](bool yields) {
      World world(map, {.seed = 3});
      World::Behavior driver = IdmStochastic{};
      if (yields) driver = yielding_driver({.yields = {100.0, 100.0}, .insists = {0.1, 0.1}});
      auto const id = enter(world, through, through.length() - 80.0, {.speed = 12, .behavior = driver});
      enter(world, lane, lane.length() - 10.0, {.speed = 9, .behavior = cb::ConstantAcceleration{}});
      for (int i = 0; i < 15; ++i) REQUIRE(world.step(0.2));
      return world.state(id).speed;
    };
    double const yielding = rolling(true), insisting = rolling(false);
    MESSAGE("after 3 s: " << yielding << " m/s while it yields, else " << insisting << " m/s");
    CHECK(yielding < insisting - 0.3);
    return;
  }
  FAIL("the map has no lane that ends");
}
