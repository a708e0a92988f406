#include "cambium/behavior/open_loop/static_trajectory.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>
#include "lane_traffic_fixtures.hpp"

using namespace lane_traffic;

namespace {

using World = Traffic<cb::IdmClassic, cb::StaticTrajectory>;

World::AgentSpec replay(std::vector<cb::State> const& states) {
  return {.position = {states.front().x, states.front().y},
          .heading = states.front().heading,
          .speed = states.front().speed,
          .behavior = cb::StaticTrajectory(states)};
}

/// Drives along y = -1.75 m from `x` at time `begin` [s], with one state every `spacing` [s].
std::vector<cb::State> recorded(double begin, double x, int count, double spacing) {
  std::vector<cb::State> states;
  for (int i = 0; i < count; ++i) states.push_back({begin + spacing * i, x + 10.0 * spacing * i, -1.75, 0.0, 10.0});
  return states;
}

double distance(cb::State const& a, cb::State const& b) {
  return std::abs(a.time - b.time) + std::hypot(a.x - b.x, a.y - b.y) +
         std::abs(std::remainder(a.heading - b.heading, 2 * cb::geometry::pi)) + std::abs(a.speed - b.speed);
}

}  // namespace

TEST_CASE("a replay reproduces recorded traffic at any step length that meets its samples") {
  cb::RandomStream random(3, 0, 0);
  World world(straight_road(2, 2000.0, 0.002));
  auto const& lane = world.map().lanes()[0];
  for (int i = 0; i < 6; ++i) {
    enter(world, lane, 40.0 + 40.0 * i, {.speed = 5 + 10 * cb::uniform01(random)});
  }
  constexpr double dt = 0.1;
  std::vector<std::vector<cb::State>> recordings(world.size());
  for (int k = 0; k <= 60; ++k) {
    for (std::size_t i = 0; i < world.size(); ++i) recordings[i].push_back(world.frame().agents[i].state);
    REQUIRE(world.step(dt));
  }
  for (int const stride : {1, 2, 3}) {
    World again(world.shared_map());
    for (auto const& recording : recordings) again.add(replay(recording));
    double worst = 0.0;
    for (int k = stride; k <= 60; k += stride) {
      CHECK(again.step(dt * stride));
      for (std::size_t i = 0; i < again.size(); ++i) {
        CHECK(again.frame().agents[i].status == cb::AgentStatus::driving);
        worst = std::max(worst, distance(again.frame().agents[i].state, recordings[i][static_cast<std::size_t>(k)]));
      }
    }
    CHECK(worst < 1e-9);
  }
}

TEST_CASE("a replay interpolates between samples, the heading along the shorter arc") {
  cb::StaticTrajectory const replay({{1.0, 0, 0, 3.0, 4}, {3.0, 10, -2, -3.0, 8}});
  auto const middle = replay.at(2.0);
  CHECK(middle.time == 2.0);
  CHECK(middle.x == doctest::Approx(5));
  CHECK(middle.y == doctest::Approx(-1));
  CHECK(std::abs(std::remainder(middle.heading - cb::geometry::pi, 2 * cb::geometry::pi)) < 1e-12);
  CHECK(middle.speed == doctest::Approx(6));
  CHECK(replay.at(1.0) == cb::State{1.0, 0, 0, 3.0, 4});
  CHECK(replay.at(3.0) == cb::State{3.0, 10, -2, -3.0, 8});
  CHECK(replay.at(0.0).x == 0);
  CHECK(replay.at(9.0).x == 10);
}

TEST_CASE("a replay enters traffic when its recording begins and leaves when it ends") {
  World world(straight_road(1, 1000.0));
  auto const follower = world.add({.position = {50, -1.75}, .speed = 10});
  auto const late = world.add(replay(recorded(1.0, 100, 6, 0.4)));  // 1 to 3 s
  CHECK(world.status(late) == cb::AgentStatus::not_started);
  CHECK_FALSE(world.observe(follower).ahead());  // from the first frame on
  int seen = 0;
  world.observe(follower).around(std::numeric_limits<double>::infinity(), [&](auto const&) { ++seen; });
  CHECK(seen == 0);
  for (int k = 1; k <= 16; ++k) {
    CHECK(world.step(0.2));
    double const time = 0.2 * k;
    CAPTURE(time);
    auto const expected = time < 0.99   ? cb::AgentStatus::not_started
                          : time < 3.01 ? cb::AgentStatus::driving
                                        : cb::AgentStatus::expired;
    CHECK(world.status(late) == expected);
    CHECK(world.observe(follower).ahead().has_value() == (expected == cb::AgentStatus::driving));
    if (expected == cb::AgentStatus::driving) CHECK(world.state(late).x == doctest::Approx(100 + 10 * (time - 1.0)));
  }
  CHECK(world.state(late).x == doctest::Approx(120));
  CHECK(world.remove_departed() == 1);
}

TEST_CASE("a replay that begins within a step enters at the end of the step") {
  World world(straight_road(1, 1000.0));
  auto const id = world.add(replay(recorded(0.5, 100, 10, 0.2)));
  REQUIRE(world.step(0.4));
  CHECK(world.status(id) == cb::AgentStatus::not_started);
  REQUIRE(world.step(0.4));
  CHECK(world.status(id) == cb::AgentStatus::driving);
  CHECK(world.state(id).x == doctest::Approx(103));
  CHECK(world.record(id).action.acceleration == doctest::Approx(0));
}

TEST_CASE(
    "a replay that has begun is in traffic at once; agents that wait are copied and not removed with departed ones") {
  World world(straight_road(1, 1000.0), {.time = 5.0});
  auto const now = world.add(replay(recorded(5.0, 100, 6, 0.4)));
  auto const later = world.add(replay(recorded(8.0, 200, 6, 0.4)));
  CHECK(world.status(now) == cb::AgentStatus::driving);
  CHECK(world.status(later) == cb::AgentStatus::not_started);
  CHECK(world.remove_departed() == 0);
  World copy = world;
  for (int k = 0; k < 4; ++k) REQUIRE(copy.step(1.0));
  CHECK(copy.status(later) == cb::AgentStatus::driving);
  CHECK(world.status(later) == cb::AgentStatus::not_started);
}

TEST_CASE("recordings without states, with descending times or with invalid numbers are errors") {
  World world(straight_road(1, 1000.0));
  auto const bad = [&](cb::StaticTrajectory const& behavior) {
    CHECK_THROWS_AS(world.add({.position = {100, -1.75}, .behavior = behavior}), cb::ParameterError);
  };
  bad(cb::StaticTrajectory{});
  bad(cb::StaticTrajectory(std::vector<cb::State>{}));
  bad(cb::StaticTrajectory({{1, 0, 0, 0, 0}, {1, 1, 0, 0, 0}}));
  bad(cb::StaticTrajectory({{1, 0, 0, 0, 0}, {2, std::nan(""), 0, 0, 0}}));
}

TEST_CASE("replays of different recordings are different parameters, however shared") {
  auto const states = recorded(0.0, 100.0, 5, 0.5);
  auto other = states;
  other.back().speed += 1e-9;
  cb::StaticTrajectory const one(states), same(states), changed(other);
  CHECK(cb::equal_parameters(one, same));
  CHECK(cb::hash_parameters(one) == cb::hash_parameters(same));
  CHECK_FALSE(cb::equal_parameters(one, changed));
  CHECK(cb::hash_parameters(one) != cb::hash_parameters(changed));
  CHECK(cb::to_string(one) != cb::to_string(changed));
  CHECK_FALSE(cb::equal_parameters(one, cb::StaticTrajectory{}));
}
