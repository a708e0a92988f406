#include "cambium/behavior/zip_merge.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "lane_traffic_fixtures.hpp"

using namespace lane_traffic;

namespace {

using Sim = Traffic<cb::ZipMerge, cb::IdmClassic>;

/// Two queues before the lane drop, lane 3 (it ends) `sparser` times as sparse as lane 2.
template <class Driver>
std::map<cb::AgentId, int> queues(Sim& world, std::uint64_t seed, double sparser, Driver const& driver) {
  cb::RandomStream random(seed, 0, 0);
  auto const between = [&random](double low, double high) { return low + (high - low) * cb::uniform01(random); };
  std::map<cb::AgentId, int> from;
  for (int const lane : {2, 3}) {
    double s = 380.0 - between(0, 12);
    for (int i = 0; i < 20 && s > 5.0; ++i) {
      from[add(world, lane, s, 5.0, driver(between(12, 16)))] = lane;
      s -= 4.5 + (lane == 3 ? sparser : 1.0) * (2.0 + between(5.0, 12.0));
    }
  }
  return from;
}

cb::ZipMerge zip(double desired_speed) { return {.idm = {.desired_speed = desired_speed}}; }

/// The lanes, by number, from which vehicles came past position x, in the order in which they did.
struct Passed {
  std::vector<int> lanes;
  int collisions = 0;

  /// How often two from one lane came one after the other.
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
    world.step(0.2);
    std::vector<std::pair<double, int>> now;  // in one step the one ahead was first
    for (std::size_t i = 0; i < world.size(); ++i) {
      auto const at = from.find(world.roster().agents[i].id);
      if (at == from.end()) continue;
      double const was = before.agents[i].state.x, is = world.frame().agents[i].state.x;
      if (was < x && is >= x) now.emplace_back(-is, at->second);
    }
    std::sort(now.begin(), now.end());
    for (auto const& [place, lane] : now) passed.lanes.push_back(lane);
    passed.collisions += collisions(world);
  }
  return passed;
}

}  // namespace

TEST_CASE("on a saturated lane drop vehicles go in alternate order, one from each lane, and nobody collides") {
  auto const map = support::own_map("lane_drop.xodr");
  int pairs = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Sim world(map, {.seed = seed});
    auto const from = queues(world, seed, 1.0, zip);
    auto const passed = run(world, from, 640.0, 700);
    std::string order;
    for (int const lane : passed.lanes) order += std::to_string(lane);
    CAPTURE(seed);
    CAPTURE(order);
    CHECK(passed.collisions == 0);
    CHECK(passed.lanes.size() == from.size());
    CHECK(passed.same() == 0);
    pairs += static_cast<int>(passed.lanes.size()) - 1;
  }
  CHECK(pairs > 400);
}

TEST_CASE("IDM drivers merge as they come, not in alternate order") {
  Sim world(support::own_map("lane_drop.xodr"), {.seed = 1});
  auto const from = queues(world, 1, 1.6, [](double v) { return cb::IdmClassic{.desired_speed = v}; });
  auto const passed = run(world, from, 640.0, 700);
  CHECK(passed.same() > 2);
}

TEST_CASE("where one lane is sparser, all pass, none collides, and nobody waits for those far behind") {
  auto const map = support::own_map("lane_drop.xodr");
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Sim world(map, {.seed = seed});
    auto const from = queues(world, seed, 3.0, zip);
    auto const passed = run(world, from, 640.0, 700);
    CAPTURE(seed);
    CHECK(passed.collisions == 0);
    CHECK(passed.lanes.size() == from.size());
  }
}
