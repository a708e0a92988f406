#include "cambium/observer/delayed.hpp"

#include <doctest/doctest.h>

#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include "observed_traffic.hpp"
#include "cambium/core/json.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/observer/observer_chain.hpp"
#include "cambium/observer/observer_set.hpp"
#include "cambium/observer/occluded.hpp"
#include "cambium/observer/parametric.hpp"

using namespace fixtures;

namespace {

using Everything = cb::ObserverChain<cb::DelayedObserver<3>, cb::OccludedObserver, cb::ParametricObserver>;
Everything const everything{
    cb::DelayedObserver<3>{.others = 2, .own = 1}, cb::OccludedObserver{.range = 80.0},
    cb::ParametricObserver{.own = {.along = 0.2}, .others = {.along = 0.5, .speed = 0.3}, .lasting = 4}};

/// A stage that does not describe its parameters.
struct Undescribed {
  static constexpr bool perfect = false;
  cb::State observe(cb::State const& truth, bool, cb::RandomStream const&) const { return truth; }
};

}  // namespace

TEST_CASE("worlds that need no past keep none") {
  CHECK(sizeof(Observed<cb::PerfectObserver>::Record) == sizeof(Observed<cb::ParametricObserver>::Record));
  CHECK(sizeof(Observed<cb::PerfectObserver>::Record) == sizeof(Observed<cb::OccludedObserver>::Record));
  CHECK(sizeof(Observed<cb::DelayedObserver<2>>::Record) == sizeof(Observed<cb::PerfectObserver>::Record) + 96);
}

TEST_CASE("others are seen exactly as they were some steps ago, and the agent itself likewise where asked for") {
  auto world = traffic(cb::DelayedObserver<5>{.others = 3, .own = 1});
  world.keep_history(10);
  for (std::size_t k = 0; k < 8; ++k) {
    std::size_t const late = std::min<std::size_t>(k, 3), own_late = std::min<std::size_t>(k, 1);
    auto const& then = late > 0 ? world.history(late) : world.frame();
    auto const& own_then = own_late > 0 ? world.history(own_late) : world.frame();
    auto const seen = seen_by(world, traffic_ego);
    CHECK(seen.size() == 7);
    for (auto const& [id, state] : seen) CHECK(state == then.agents[world.slot_of(id)].state);
    CHECK(world.observe(traffic_ego).state() == own_then.agents[2].state);
    auto const view = world.observe(traffic_ego);
    view.around(std::numeric_limits<double>::infinity(), [&](auto const& other) {
      CHECK(view.acceleration(other) == double{then.agents[world.slot_of(other.agent)].acceleration});
    });
    auto const front = view.ahead();
    REQUIRE(front);
    auto const& leader = then.agents[front->slot].state;
    CHECK(front->gap == doctest::Approx(leader.x - own_then.agents[2].state.x - 4.5));
    CHECK(front->speed == doctest::Approx(leader.speed));
    CHECK(world.step(0.2));
  }
}

TEST_CASE("an agent that has just entered, or come back, is seen as it entered") {
  auto world = traffic(cb::DelayedObserver<3>{});
  for (int i = 0; i < 5; ++i) REQUIRE(world.step(0.2));
  auto const late = world.add({.position = {400, -1.75}, .speed = 3});
  CHECK(seen_by(world, traffic_ego).at(late) == world.state(late));
  auto const entered = world.state(late);
  REQUIRE(world.step(0.2));
  CHECK(seen_by(world, traffic_ego).at(late) == entered);
}

TEST_CASE("a prediction takes delayed observations for the present") {
  auto world = traffic(cb::DelayedObserver<3>{});
  for (int i = 0; i < 5; ++i) REQUIRE(world.step(0.2));
  auto const seen = seen_by(world, traffic_ego);
  auto future =
      world.observe(traffic_ego).predict(cb::predict_all_as<decltype(world)::Behaviors>(cb::ConstantAcceleration{}));
  for (auto const& [id, state] : seen) {
    CHECK(future.state(id).x == state.x);
    CHECK(future.state(id).time == world.time());
  }
  CHECK(future.step(0.2));
}

TEST_CASE(
    "with delayed, noisy and limited observers, copies and worlds stepped on other threads are equal bit by bit") {
  auto world = traffic(everything);
  for (int i = 0; i < 5; ++i) REQUIRE(world.step(0.2));
  auto copy = world;
  auto assigned = traffic(everything, 7);
  assigned = world;
  CHECK(copy.frame() == world.frame());
  std::vector<Observed<Everything>> others(4, world);
  std::vector<std::thread> threads;
  for (auto& other : others)
    threads.emplace_back([&other] {
      for (int i = 0; i < 50; ++i) REQUIRE(other.step(0.2));
    });
  for (auto& thread : threads) thread.join();
  for (int i = 0; i < 50; ++i) {
    CHECK(world.step(0.2));
    REQUIRE(copy.step(0.2));
    REQUIRE(assigned.step(0.2));
  }
  CHECK(copy.frame() == world.frame());
  CHECK(assigned.frame() == world.frame());
  for (auto const& other : others) CHECK(other.frame() == world.frame());
  CHECK(seen_by(copy, cb::AgentId{3}) == seen_by(world, cb::AgentId{3}));
  auto other_seed = traffic(everything, 2);
  CHECK(seen_by(other_seed, cb::AgentId{3}) != seen_by(copy, cb::AgentId{3}));
}

TEST_CASE("a chain perceives one after the other, each stage with numbers of its own") {
  using Noise = cb::ParametricObserver;
  Noise const noise{.others = {.along = 1.0}};
  cb::ObserverChain<Noise, Noise> const twice{noise, noise};
  cb::RandomStream const random(1, 2, 3);
  cb::State const truth{0, 0, 0, 0, 10};
  double const first = noise.observe(truth, false, random.part(0)).x,
               second = noise.observe(truth, false, random.part(1)).x;
  CHECK(first != second);
  CHECK(twice.observe(truth, false, random).x == doctest::Approx(first + second));
  static_assert(cb::ObserverChain<cb::PerfectObserver, cb::PerfectObserver>::perfect);
  static_assert(Everything::past_steps == 3 && !Everything::perfect);
}

TEST_CASE("a chain's parameters have keys by the place of their stage, and are checked") {
  auto chain = cb::from_json<Everything>(cb::to_json(everything));
  CHECK(cb::equal_parameters(chain, everything));
  cb::set_parameter(chain, "second.range", 50.0);
  CHECK(chain.stage<1>().range == 50.0);
  chain.stage<0>().own = 2;
  CHECK(std::as_const(chain).stage<0>().own == 2);
  static_assert(!std::is_convertible_v<cb::ParametricObserver, cb::ObserverChain<cb::ParametricObserver>>);
  CHECK_FALSE(cb::equal_parameters(chain, everything));
  Observed<Everything> world(straight_road(2, 1000.0));
  CHECK_THROWS_WITH_AS(
      world.add({.position = {100, -1.75}, .observer = Everything{{}, cb::OccludedObserver{.range = -1.0}, {}}}),
      doctest::Contains("second.range"), cb::ParameterError);
}

TEST_CASE("a chain may have a stage without a description; the others are still checked") {
  using Mixed = cb::ObserverChain<Undescribed, cb::OccludedObserver>;
  static_assert(!cb::Described<Mixed> && cb::Described<Everything>);
  Observed<Mixed> world(straight_road(2, 1000.0));
  auto const ego = world.add({.position = {100, -1.75}, .observer = Mixed{{}, cb::OccludedObserver{.range = 50.0}}});
  world.add({.position = {300, -1.75}});
  CHECK(seen_by(world, ego).empty());
  CHECK_THROWS_WITH_AS(
      world.add({.position = {500, -1.75}, .observer = Mixed{{}, cb::OccludedObserver{.range = -1.0}}}),
      doctest::Contains("range"), cb::ParameterError);
}

TEST_CASE("agents of one world perceive by observers of their own kinds") {
  using Set = cb::ObserverSet<cb::PerfectObserver, cb::DelayedObserver<2>, cb::OccludedObserver>;
  static_assert(Set::past_steps == 2);
  static_assert(cb::ObserverSet<cb::PerfectObserver, cb::OccludedObserver>::past_steps == 0);
  Observed<Set> world(straight_road(1, 1000.0));
  auto const sharp = world.add({.position = {100, -1.75}, .speed = 10});
  auto const late = world.add({.position = {150, -1.75}, .speed = 10, .observer = {cb::DelayedObserver<2>{}}});
  auto const near =
      world.add({.position = {250, -1.75}, .speed = 10, .observer = {cb::OccludedObserver{.range = 50.0}}});
  for (int i = 0; i < 5; ++i) REQUIRE(world.step(0.2));
  CHECK(seen_by(world, sharp).at(late) == world.state(late));
  CHECK(seen_by(world, late).at(sharp) != world.state(sharp));
  CHECK(seen_by(world, near).empty());
  CHECK_THROWS_AS(world.add({.position = {300, -1.75}, .observer = {cb::OccludedObserver{.range = -1.0}}}),
                  cb::ParameterError);
}

TEST_CASE("a chain that changes nothing shows the truth itself, as a perfect observer does") {
  Observed<cb::ObserverChain<cb::PerfectObserver, cb::PerfectObserver>> world(straight_road(2, 1000.0));
  auto const ego = world.add({.position = {100, -1.75}, .speed = 10});
  world.add({.position = {130, -1.75}, .speed = 8});
  auto const view = world.observe(ego);
  CHECK(&view.state() == &world.state(ego));
  CHECK(view.ahead()->gap == 30 - 4.5);
  Observed<cb::ObserverChain<cb::ParametricObserver, cb::DelayedObserver<2>>> blind(world.shared_map());
  blind.add({.position = {100, -1.75},
             .speed = 10,
             .observer = {cb::ParametricObserver{}, cb::DelayedObserver<2>{.others = 0}}});
  blind.add({.position = {130, -1.75}, .speed = 8});
  for (int i = 0; i < 20; ++i) {  // neither noise nor delay, but not known at compile time
    REQUIRE(world.step(0.2));
    REQUIRE(blind.step(0.2));
    CHECK(blind.state(ego) == world.state(ego));
  }
}
