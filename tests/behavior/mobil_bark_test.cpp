// BARK's rule-based MOBIL compared with ours, where it decides correctly and where it does not.
#include <doctest/doctest.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "../support/corpus.hpp"
#include "lane_traffic_fixtures.hpp"

using namespace lane_traffic;

namespace {

/// BARK requires free space in addition to the safety criterion.
using Driver = cb::BasicMobil<cb::FreeSpace>;
using Sim = Traffic<Driver, cb::ConstantAcceleration>;

constexpr cb::geometry::Shape bark_car{1.75, 2.25, 1.0, 1.0};

/// BARK's defaults: politeness 0.2, threshold 0.2, safe deceleration 4; every driver is assumed to drive like oneself.
Driver bark_driver(double desired_speed) {
  Driver driver;
  driver.law.desired_speed = driver.lateral.others.desired_speed = desired_speed;
  driver.lateral.rule.minimum_remaining = 60.0;
  driver.lateral.rule.route_bias = 0.0;
  return driver;
}

double const desired[] = {0.0, 20.0, 8.0, 14.0, 12.0};  // by agent

/// The agents of one step of the file as a world.
Sim world_at(std::vector<std::vector<std::string>> const& rows, int step) {
  Sim world(support::straight_road(2, 1000.0));
  for (auto const& row : rows) {
    if (std::stoi(row[0]) != step) continue;
    int const agent = std::stoi(row[2]);
    world.add({.position = {std::stod(row[4]), std::stod(row[5])},
               .speed = std::stod(row[7]),
               .shape = bark_car,
               .behavior = bark_driver(desired[agent]),
               .id = static_cast<cb::AgentId>(agent)});
  }
  return world;
}

}  // namespace

TEST_CASE("MOBIL decides as BARK's where BARK sees the follower, and as published where it does not") {
  auto const file = corpus::find("oracle/bark/bark_mobil_highway.csv");
  if (!file) return;
  auto const rows = corpus::table(*file);
  auto const wants = [&](int step, int agent) {
    auto world = world_at(rows, step);
    REQUIRE(world.step(0.2));
    return world.memory<Driver>(static_cast<cb::AgentId>(agent)).lateral.change.active();
  };
  auto const bark_moves = [&](int step, int agent) {
    std::optional<double> now, next;
    for (auto const& row : rows) {
      if (std::stoi(row[2]) != agent) continue;
      if (std::stoi(row[0]) == step) now = std::stod(row[5]);
      if (std::stoi(row[0]) == step + 1) next = std::stod(row[5]);
    }
    return std::abs(*next - *now) > 0.01;
  };
  std::string ours, theirs;
  for (int step = 0; step <= 3; ++step) {
    ours += wants(step, 1) ? '1' : '0';
    theirs += bark_moves(step, 1) ? '1' : '0';
    CHECK(!wants(step, 4));
    CHECK(!bark_moves(step, 4));
    // Agent 1 closes up behind agent 2, so a polite agent 2 changes; BARK ignores the old follower.
    CHECK(wants(step, 2));
    CHECK(!bark_moves(step, 2));
  }
  CHECK(theirs == "0001");
  CHECK(ours == theirs);
}

TEST_CASE("in BARK's traffic our drivers change lanes with hysteresis, not back and forth") {
  auto const file = corpus::find("oracle/bark/bark_mobil_highway.csv");
  if (!file) return;
  auto const rows = corpus::table(*file);
  auto world = world_at(rows, 0);
  std::vector<int> ours(5), theirs(5);
  for (int k = 0; k < 50; ++k) {
    auto const before = lanes(world);
    REQUIRE(world.step(0.2));
    for (std::size_t i = 0; i < 4; ++i) ours[i + 1] += world.frame().agents[i].lane.corridor != before[i];
    CHECK(collisions(world) == 0);
  }
  std::vector<std::string> last(5);
  for (auto const& row : rows) {
    auto const agent = static_cast<std::size_t>(std::stoi(row[2]));
    theirs[agent] += !last[agent].empty() && last[agent] != row[10];
    last[agent] = row[10];
  }
  MESSAGE("lane changes of agents 1 to 4: ours " << ours[1] << ours[2] << ours[3] << ours[4] << ", BARK " << theirs[1]
                                                 << theirs[2] << theirs[3] << theirs[4]);
  CHECK(theirs[4] == 2);  // over and back, without hysteresis
  CHECK(ours[4] <= 1);
}
