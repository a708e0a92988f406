#include <cambium/evaluation/metrics/closed_loop_score.hpp>
#include <cambium/evaluation/metrics/displacement.hpp>
#include <cambium/evaluation/metrics/over_time.hpp>
#include <cambium/evaluation/metrics/per_agent.hpp>
#include <cambium/evaluation/metrics/post_encroachment_time.hpp>
#include <cambium/evaluation/metrics/rss_compliance.hpp>
#include <cambium/evaluation/rules/safe_distance.hpp>
#include <cambium/cambium.hpp>
#include <cambium/map/opendrive.hpp>
#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

using namespace cambium;

namespace {

using Sim = World<BehaviorSet<IdmClassic, ConstantAcceleration, StaticTrajectory>, InterpolateExecution, SingleTrack>;
static_assert(MetricFor<Least<Gap>, Sim> && MetricFor<PostEncroachmentTime, Sim> && MetricFor<Displacement, Sim> &&
              MetricFor<RssCompliance, Sim> && MetricFor<ClosedLoopScore, Sim>);

std::shared_ptr<Map const> merging() { return load_opendrive(CAMBIUM_SOURCE_DIR "/maps/merging.xodr").map; }

/// Two vehicles on the main road; the second follows.
Sim following(double gap, double leader_speed, double follower_speed, Sim::Behavior follower) {
  Sim world(merging());
  world.keep_history(2);
  world.add({.position = {100, -1.75}, .speed = leader_speed, .behavior = ConstantAcceleration{}, .id = AgentId{1}});
  world.add({.position = {100 - gap - 4.5, -1.75}, .speed = follower_speed, .behavior = follower, .id = AgentId{2}});
  return world;
}

template <class Metric>
Metric observed(Sim world, AgentId id, Metric metric, int steps, double dt = 0.1) {
  auto const slot = world.slot_of(id);
  metric.observe(world, slot, 0.0);
  for (int i = 0; i < steps; ++i) {
    REQUIRE(world.step(dt));
    metric.observe(world, slot, dt);
  }
  return metric;
}

}  // namespace

TEST_CASE("folds agree with the values of each step") {
  auto world = following(30.0, 8.0, 15.0, IdmClassic{});
  auto const slot = world.slot_of(AgentId{2});
  auto copy = world;
  std::vector<double> gaps{Gap{}(copy, slot)};
  double braked = 0.0;
  bool was_hard = false;
  for (int i = 0; i < 80; ++i) {
    REQUIRE(copy.step(0.1));
    gaps.push_back(Gap{}(copy, slot));
    bool const is_hard = HardBraking{2.0}(copy, slot);
    braked += is_hard && !was_hard;
    was_hard = is_hard;
  }
  double sum = 0.0;
  for (std::size_t i = 1; i < gaps.size(); ++i) sum += gaps[i];
  CHECK(observed(world, AgentId{2}, Least<Gap>{}, 80).value() == *std::min_element(gaps.begin(), gaps.end()));
  CHECK(observed(world, AgentId{2}, Most<Gap>{}, 80).value() == *std::max_element(gaps.begin(), gaps.end()));
  CHECK(observed(world, AgentId{2}, MeanOf<Gap>{}, 80).value() == doctest::Approx(sum / 80));
  CHECK(observed(world, AgentId{2}, Integral<Gap>{}, 80).value() == doctest::Approx(sum * 0.1));
  CHECK(braked > 0.0);
  CHECK(observed(world, AgentId{2}, Times<HardBraking>(HardBraking{2.0}), 80).value() == braked);
}

TEST_CASE("a metric of each agent: of all, of those given, of those that come and leave") {
  auto world = following(30.0, 8.0, 15.0, IdmClassic{});
  AgentId const second[] = {AgentId{2}};
  PerAgent<Least<Gap>> all;
  PerAgent<Least<Gap>> one(second, Least<Gap>{});
  auto const watch = [&](int steps, double dt) {
    for (int i = 0; i < steps; ++i) {
      if (dt > 0.0) REQUIRE(world.step(dt));
      all.observe(world, dt);
      one.observe(world, dt);
    }
  };
  watch(1, 0.0);
  watch(10, 0.1);
  world.add({.position = {60, -1.75}, .speed = 15.0, .behavior = IdmClassic{}, .id = AgentId{3}});
  watch(10, 0.1);
  double const before = all.each().at(AgentId{2}).value();
  world.remove(AgentId{1});  // slots move up
  watch(60, 0.1);

  CHECK(all.each().size() == 3);
  REQUIRE(one.each().size() == 1);
  CHECK(one.each().at(AgentId{2}).value() == before);  // nobody is ahead of it any more
  CHECK(all.each().at(AgentId{1}).value() == Gap{}.farthest);
  CHECK(all.each().at(AgentId{2}).value() == before);
  CHECK(before < 30.0);
  double const third = all.each().at(AgentId{3}).value();
  CHECK(third < Gap{}.farthest);
  CHECK(third != before);
}

TEST_CASE("how often an agent came too close: the static and the dynamic safe distance") {
  auto const close = following(1.2, 8.0, 8.0, ConstantAcceleration{});
  auto const apart = following(7.0, 8.0, 8.0, ConstantAcceleration{});
  AgentId const id{2};
  Times<Collision> const within(Collision{.margin = 1.5});
  CHECK(observed(close, id, within, 10).value() == 1.0);
  CHECK(observed(apart, id, within, 10).value() == 0.0);
  Least<SafeDistance> const keeps(SafeDistance{.reaction_time = 1.0});
  CHECK(observed(apart, id, keeps, 10).value() == 0.0);
  CHECK(observed(following(9.0, 8.0, 8.0, ConstantAcceleration{}), id, keeps, 10).value() == 1.0);
}

TEST_CASE("post-encroachment time is the time between two vehicles at a crossing") {
  Sim world(load_opendrive(CAMBIUM_SOURCE_DIR "/maps/intersection_4way.xodr").map);
  // Recorded vehicles cross at the origin, `later` seconds one after the other.
  for (double const later : {1.0, 2.5, 4.0}) {
    auto crossing = world;
    auto const along = [](double from_x, double from_y, double to_x, double to_y, double begin) {
      double const heading = std::atan2(to_y - from_y, to_x - from_x);
      return StaticTrajectory({{0.0, from_x, from_y, heading, 10.0},
                               {begin + 0.01, from_x, from_y, heading, 10.0},
                               {begin + 4.0, to_x, to_y, heading, 10.0}});
    };
    crossing.add({.position = {-20, -1.75},
                  .heading = 0.0,
                  .speed = 10.0,
                  .behavior = along(-20, -1.75, 20, -1.75, 0.0),
                  .id = AgentId{1}});
    crossing.add({.position = {1.75, -20},
                  .heading = geometry::pi / 2,
                  .speed = 10.0,
                  .behavior = along(1.75, -20, 1.75, 20, later),
                  .id = AgentId{2}});
    auto const one = observed(crossing, AgentId{1}, PostEncroachmentTime{}, 150, 0.05).value();
    auto const other = observed(crossing, AgentId{2}, PostEncroachmentTime{}, 150, 0.05).value();
    // At 10 m/s the first one's rear is past the second one's way after 2.36 s, the second one's front reaches the
    // first one's way 1.38 s after it has started.
    CHECK(one == other);
    CHECK(std::abs(one - (later - 0.98)) < 0.06);
  }
  CHECK(observed(following(10.0, 10.0, 10.0, ConstantAcceleration{}), AgentId{2}, PostEncroachmentTime{}, 60).value() ==
        std::numeric_limits<double>::infinity());
}

TEST_CASE("displacement is the distance from the recording") {
  auto world = following(50.0, 10.0, 10.0, ConstantAcceleration{.acceleration = 1.0});
  auto const& state = world.state(AgentId{2});
  Displacement const metric(StaticTrajectory(
      {{0.0, state.x, state.y, state.heading, 10.0}, {5.0, state.x + 50.0, state.y, state.heading, 10.0}}));
  auto const result = observed(world, AgentId{2}, metric, 30);
  CHECK(result.last() == doctest::Approx(0.5 * 3.0 * 3.0));
  CHECK(result.most() == result.last());
  CHECK(result.mean() == doctest::Approx(1.5).epsilon(0.05));
  CHECK(observed(world, AgentId{2}, Displacement{}, 5).mean() == 0.0);
}

TEST_CASE("RSS compliance tells a driver who brakes from one who does not") {
  auto const reckless = observed(following(25.0, 5.0, 20.0, ConstantAcceleration{}), AgentId{2}, RssCompliance{}, 10);
  CHECK(reckless.dangers() > 0);
  CHECK(reckless.violations() == 10);
  CHECK(reckless.value() == 0.0);
  auto const careful =
      observed(following(25.0, 5.0, 20.0, ConstantAcceleration{.acceleration = -5.0}), AgentId{2}, RssCompliance{}, 10);
  CHECK(careful.dangers() > 0);
  CHECK(careful.value() == 1.0);
  CHECK(observed(following(80.0, 10.0, 10.0, IdmClassic{}), AgentId{2}, RssCompliance{}, 30).value() == 1.0);
}

TEST_CASE("the closed-loop score punishes each fault") {
  auto const score = [](Sim const& world, double expected = 0.0, int steps = 50) {
    return observed(world, AgentId{2}, ClosedLoopScore(expected), steps).value();
  };
  auto const calm = following(80.0, 10.0, 10.0, ConstantAcceleration{});
  CHECK(score(calm) == 1.0);
  CHECK(score(calm, 50.0) == doctest::Approx(1.0));
  CHECK(score(calm, 100.0) == doctest::Approx((16.0 - 2.5) / 16.0));
  CHECK(score(calm, 1000.0) == 0.0);
  CHECK(score(following(10.0, 5.0, 20.0, ConstantAcceleration{})) == 0.0);  // hits the leader
  CHECK(score(following(10.0, 10.0, 20.0, ConstantAcceleration{}), 0.0, 5) == doctest::Approx(11.0 / 16.0));  // close
  CHECK(score(following(90.0, 10.0, 10.0, ConstantAcceleration{.acceleration = 3.0}), 0.0, 5) ==
        doctest::Approx(14.0 / 16.0));  // uncomfortable
}
