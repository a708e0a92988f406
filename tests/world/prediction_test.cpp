// What a prediction shares with the world that it is made from, and what not: randomness.
#include "cambium/world/prediction.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "cambium/core/distributions.hpp"
#include "fixtures.hpp"

using namespace fixtures;

namespace {

/// Drives with an acceleration that it draws anew in each step.
struct Moody {
  template <class View>
  [[nodiscard]] cb::Plan<View> plan(View const& view, cb::NoMemory&, double dt) const {
    auto random = view.random(3);
    double const speed = std::max(0.0, view.state().speed + (cb::uniform01(random) - 0.5) * dt);
    return cb::plan_along_lane(view, {dt * (view.state().speed + speed) / 2, speed}, dt);
  }
};

using Set = cb::BehaviorSet<Moody>;
using Chance = cb::World<Set, cb::InterpolateExecution, cb::SingleTrack>;

std::vector<cb::State> course(Chance world) {
  std::vector<cb::State> states;
  for (int i = 0; i < 20; ++i) {
    REQUIRE(world.step(0.2));
    for (auto const& record : world.frame().agents) states.push_back(record.state);
  }
  return states;
}

}  // namespace

TEST_CASE("a prediction does not know the dice: it takes another course than the world, unless given the seed") {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Chance world(straight_road(), {.seed = seed});
    auto const first = world.add({.position = {50, -1.75}, .speed = 10});
    auto const second = world.add({.position = {90, -5.25}, .speed = 10});
    for (std::uint64_t i = 0; i < seed % 4; ++i) REQUIRE(world.step(0.2));
    auto prediction = cb::predict_all_as<Set>(Moody{});
    auto const truth = course(world), guess = course(world.observe(first).predict(prediction));
    REQUIRE(guess.size() == truth.size());
    for (std::size_t i = 0; i < truth.size(); ++i) CHECK(guess[i].speed != truth[i].speed);
    CHECK(guess == course(world.observe(first).predict(prediction)));  // the same when it asks again
    CHECK(guess != course(world.observe(second).predict(prediction)));
    prediction.seed = seed;
    CHECK(course(world.observe(first).predict(prediction)) == truth);
    CHECK(course(world.observe(second).predict(prediction)) == truth);
    prediction.seed = seed + 1;
    CHECK(course(world.observe(first).predict(prediction)) != truth);
  }
}

TEST_CASE("a prediction made a step later is drawn anew") {
  Chance world(straight_road(), {.seed = 4});
  auto const id = world.add({.position = {50, -1.75}, .speed = 10});
  auto const prediction = cb::predict_all_as<Set>(Moody{});
  auto const before = world.observe(id).predict(prediction).roster().seed;
  REQUIRE(world.step(0.2));
  CHECK(world.observe(id).predict(prediction).roster().seed != before);
}
