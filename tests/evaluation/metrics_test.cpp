#include <cambium/evaluation/metrics/closed_loop_score.hpp>
#include <cambium/evaluation/metrics/displacement.hpp>
#include <cambium/evaluation/metrics/over_time.hpp>
#include <cambium/evaluation/metrics/per_agent.hpp>
#include <cambium/evaluation/metrics/post_encroachment_time.hpp>
#include <cambium/evaluation/metrics/rss_compliance.hpp>
#include <cambium/evaluation/rules.hpp>
#include <cambium/cambium.hpp>
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <vector>

#include "../support/maps.hpp"

using namespace cambium;

namespace {

using Sim = World<BehaviorSet<IdmClassic, ConstantAcceleration, StaticTrajectory>, InterpolateExecution, SingleTrack>;
static_assert(MetricFor<Least<Gap>, Sim> && MetricFor<PostEncroachmentTime, Sim> && MetricFor<Displacement, Sim> &&
              MetricFor<RssCompliance, Sim> && MetricFor<ClosedLoopScore, Sim>);

/// Two vehicles on the main road; the second follows.
Sim following(double gap, double leader_speed, double follower_speed, Sim::Behavior follower) {
  Sim world(support::own_map("merging.xodr"));
  world.add({.position = {100, -1.75}, .speed = leader_speed, .behavior = ConstantAcceleration{}, .id = AgentId{1}});
  world.add({.position = {100 - gap - 4.5, -1.75}, .speed = follower_speed, .behavior = follower, .id = AgentId{2}});
  return world;
}

template <class Metric>
Metric observed(Sim world, AgentId id, Metric metric, int steps, double dt = 0.1) {
  auto const slot = world.slot_of(id);
  world.keep_history(1);  // a copy has none
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

TEST_CASE("post-encroachment time is the time between two vehicles at a crossing, up to 5 s, where ways cross") {
  constexpr double infinite = std::numeric_limits<double>::infinity(), right = geometry::pi / 2;
  // Recorded vehicles cross at `angle`, the second one `later` seconds after the first. At 10 m/s and a right angle the
  // first one's rear is past the second one's way after 2.18 s, the second one's front reaches the first one's way
  // 1.55 s after it has started.
  struct Case {
    double later, angle, expected;
  };
  for (auto const& [later, angle, expected] :
       {Case{1.0, right, 0.42}, Case{2.5, right, 1.92}, Case{4.0, right, 3.42}, Case{5.5, right, 4.92},
        Case{5.7, right, infinite}, Case{4.0, 0.52, 3.55}, Case{4.0, 0.48, infinite}}) {
    CAPTURE(later);
    CAPTURE(angle);
    bool const is_junction = angle == right;
    Sim crossing(is_junction ? support::own_map("intersection_4way.xodr") : support::straight_road(12, 300));
    geometry::Point const middle = is_junction ? geometry::Point(1.75, -1.75) : geometry::Point(100.0, -21.0);
    auto const add = [&](double heading, double begin, AgentId id) {
      geometry::Pose const pose{middle.x(), middle.y(), heading};
      auto const from = geometry::to_map(pose, {-20.0, 0}), to = geometry::to_map(pose, {20.0, 0});
      crossing.add({.position = from,
                    .heading = heading,
                    .speed = 10.0,
                    .behavior = StaticTrajectory({{0.0, from.x(), from.y(), heading, 10.0},
                                                  {begin + 0.01, from.x(), from.y(), heading, 10.0},
                                                  {begin + 4.0, to.x(), to.y(), heading, 10.0}}),
                    .id = id});
    };
    add(0.0, 0.0, AgentId{1});
    add(angle, later, AgentId{2});
    auto const one = observed(crossing, AgentId{1}, PostEncroachmentTime{}, 190, 0.05).value();
    auto const other = observed(crossing, AgentId{2}, PostEncroachmentTime{}, 190, 0.05).value();
    if (expected == infinite) {
      CHECK(std::isnan(one));
      CHECK(std::isnan(other));
    } else {
      CHECK(one == other);
      CHECK(std::abs(one - expected) < 0.06);
    }
  }
  // However long the steps are, and wherever the frames lie.
  auto const wide = support::straight_road(12, 300);
  for (double const step : {0.05, 0.2, 0.5, 1.0})
    for (int i = 0; i < 40; ++i) {
      CAPTURE(step);
      CAPTURE(i);
      double const speed = 15.0 + i % 2 * 10.0, off = 0.025 * i * step * speed;
      Sim fast(wide);
      fast.add({.position = {20.0 - off, -21.0}, .speed = speed, .behavior = ConstantAcceleration{}, .id = AgentId{1}});
      Sim::AgentSpec crosses{.position = {80.0, -81.0 - 1.2 * speed - off},
                             .heading = right,
                             .speed = speed,
                             .behavior = ConstantAcceleration{},
                             .id = AgentId{2}};
      crosses.way = {{80.0, -200.0}, {80.0, 200.0}};
      fast.add(crosses);
      auto const found =
          observed(fast, AgentId{1}, PostEncroachmentTime{}, static_cast<int>(std::ceil(9.0 / step)), step).value();
      double const apart = 1.2 - (geometry::car().length() + geometry::car().width()) / speed;
      CHECK(found >= apart - 0.02);
      CHECK(found <= apart + 2.0 * geometry::car().length() / speed);
    }
  auto const after = [](Sim const& world) { return observed(world, AgentId{2}, PostEncroachmentTime{}, 60).value(); };
  CHECK(std::isnan(after(following(10.0, 10.0, 10.0, ConstantAcceleration{}))));
  CHECK(after(following(10.0, 5.0, 20.0, ConstantAcceleration{})) == 0.0);  // they touch
}

TEST_CASE("displacement is the distance from the recording, in its time") {
  auto world = following(50.0, 10.0, 10.0, ConstantAcceleration{});
  auto const& state = world.state(AgentId{2});
  auto const at = [&](double time, double x) { return State{time, state.x + x, state.y, state.heading, 10.0}; };
  Displacement const metric(StaticTrajectory({at(0.0, 0.0), at(1.0, 13.0), at(2.0, 20.0)}));  // 3 m ahead at 1 s
  auto const result = observed(world, AgentId{2}, metric, 20, 0.125);
  CHECK(result.last() == doctest::Approx(0.0));
  CHECK(result.most() == doctest::Approx(3.0));
  CHECK(result.mean() == doctest::Approx(24.0 / 17.0));  // of 17 frames
  CHECK(result.value() == result.mean());
  CHECK(observed(world, AgentId{2}, metric, 4, 0.125).last() == doctest::Approx(1.5));
  CHECK(observed(world, AgentId{2}, Displacement{}, 5).mean() == 0.0);
}

TEST_CASE("RSS compliance tells a driver who brakes as hard as he must from one who does not") {
  double const must = RssParameters{}.minimum_deceleration;
  struct Case {
    double gap, leader_speed, speed, acceleration;
    int violations;
  };
  for (auto const& [gap, leader_speed, speed, acceleration, violations] :
       {Case{25, 5, 20, 0, 10}, Case{25, 5, 20, -5, 0}, Case{25, 5, 20, -must + 5e-4, 0},
        Case{25, 5, 20, -must + 2e-3, 10}, Case{0.3, 0, 0.04, 0, 0},
        Case{0.3, 0, 0.06, 0, 10}}) {  // slower than 0.05 m/s is standing
    CAPTURE(speed);
    CAPTURE(acceleration);
    auto const result =
        observed(following(gap, leader_speed, speed, ConstantAcceleration{.acceleration = acceleration}), AgentId{2},
                 RssCompliance{}, 10);
    CHECK(result.dangers() > 0);
    CHECK(result.violations() == violations);
    CHECK(result.value() == doctest::Approx(1.0 - violations / 10.0));
  }
  auto const calm = observed(following(80.0, 10.0, 10.0, IdmClassic{}), AgentId{2}, RssCompliance{}, 30);
  CHECK(calm.dangers() == 0);
  CHECK(calm.value() == 1.0);
}

namespace {

double score_of(Sim const& world, double expected = 0.0, int steps = 50, double dt = 0.1) {
  return observed(world, AgentId{2}, ClosedLoopScore(expected), steps, dt).value();
}

/// A world in which agent 2 drives as recorded: these accelerations and yaw rates, step by step, in the middle lane.
Sim driven(double speed, std::vector<double> const& accelerations, std::vector<double> const& yaw_rates) {
  State state{0.0, 100.0, -5.25, 0.0, speed};
  std::vector<State> states{state};
  for (std::size_t i = 0; i < accelerations.size(); ++i) {
    state.speed += 0.1 * accelerations[i];
    state.heading += 0.1 * yaw_rates[i];
    state.time += 0.1;
    state.x += 0.1 * state.speed;
    states.push_back(state);
  }
  Sim world(support::straight_road(3, 500));
  world.add({.position = {100.0, -5.25}, .speed = speed, .behavior = StaticTrajectory(states), .id = AgentId{2}});
  return world;
}

}  // namespace

TEST_CASE("the closed-loop score punishes each fault by nuPlan's bounds and weights") {
  auto const calm = following(80.0, 10.0, 10.0, ConstantAcceleration{});  // 50 m in 5 s
  auto const closing = [](double gap, double speed, double leader_speed) {
    return score_of(following(gap, leader_speed, speed, ConstantAcceleration{}), 0.0, 0);
  };
  CHECK(score_of(following(10.0, 5.0, 20.0, ConstantAcceleration{})) == 0.0);  // hits the leader
  CHECK(score_of(calm) == 1.0);
  CHECK(score_of(calm, 50.0) == doctest::Approx(1.0));
  CHECK(score_of(calm, 100.0) == doctest::Approx((16.0 - 2.5) / 16.0));
  CHECK(score_of(calm, 249.0) == doctest::Approx((11.0 + 5.0 * 50.0 / 249.0) / 16.0));
  CHECK(score_of(calm, 251.0) == 0.0);  // less than a fifth of the way
  CHECK(closing(9.6, 20.0, 10.0) == 1.0);
  CHECK(closing(9.4, 20.0, 10.0) == doctest::Approx(11.0 / 16.0));    // a time to collision below 0.95 s
  CHECK(closing(0.012, 0.006, 0.0) == 1.0);                           // 2 s
  CHECK(closing(0.012, 0.015, 0.0) == doctest::Approx(11.0 / 16.0));  // 0.8 s
  CHECK(closing(0.009, 0.006, 0.0) == doctest::Approx(11.0 / 16.0));  // touches, to 1 cm
  CHECK(closing(0.009, 0.004, 0.0) == 1.0);                           // it stands

  Sim off(support::straight_road(1, 300));
  off.add({.position = {100, -3.2}, .speed = 5.0, .behavior = ConstantAcceleration{}, .id = AgentId{2}});
  CHECK(score_of(off, 0.0, 1) == 0.0);

  auto const limited = support::own_map("lane_drop.xodr");
  for (double const excess : {0.0, 1.115, 2.23, 3.0}) {
    CAPTURE(excess);
    Sim fast(limited);
    double const limit = limited->lane(limited->nearest_lane({50, -1.75, 0})->lane).speed_limit_at(50);
    fast.add({.position = {50, -1.75}, .speed = limit + excess, .behavior = ConstantAcceleration{}, .id = AgentId{2}});
    CHECK(score_of(fast, 0.0, 10) == doctest::Approx((12.0 + 4.0 * std::max(0.0, 1.0 - excess / 2.23)) / 16.0));
  }
}

TEST_CASE("the closed-loop score calls comfortable what is within each of nuPlan's bounds") {
  struct Case {
    std::string bound;
    double speed;
    std::vector<double> accelerations, yaw_rates;
    bool is_comfortable;
  };
  std::vector<double> const none{0, 0, 0};
  for (auto const& [bound, speed, accelerations, yaw_rates, is_comfortable] :
       {Case{"acceleration", 10, {2.39, 2.39, 2.39}, none, true},
        Case{"acceleration", 10, {2.41, 2.41, 2.41}, none, false},
        Case{"braking", 10, {-4.04, -4.04, -4.04}, none, true}, Case{"braking", 10, {-4.06, -4.06, -4.06}, none, false},
        Case{"jerk", 10, {0, 0.412, 0}, none, true}, Case{"jerk", 10, {0, 0.414, 0.414}, none, false},
        Case{"jerk", 10, {0, -0.414, -0.414}, none, false}, Case{"lateral", 10, none, {0.488, 0.488, 0.488}, true},
        Case{"lateral", 10, none, {0.49, 0.49, 0.49}, false}, Case{"lateral", 10, none, {-0.49, -0.49, -0.49}, false},
        Case{"jerk of the size", 10, none, {0, 0.083, 0.083}, true},
        Case{"jerk of the size", 10, none, {0, 0.085, 0.085}, false},
        Case{"jerk of the size", 10, none, {0, -0.085, -0.085}, false},
        Case{"yaw rate", 2, none, {0.949, 0.949, 0.949}, true},
        Case{"yaw rate", 2, none, {-0.951, -0.951, -0.951}, false},
        Case{"yaw acceleration", 2, none, {0, 0.192, 0}, true},
        Case{"yaw acceleration", 2, none, {0, 0.194, 0.194}, false},
        Case{"yaw acceleration", 2, none, {0, -0.194, -0.194}, false}}) {
    CAPTURE(bound);
    CAPTURE(is_comfortable);
    CHECK(score_of(driven(speed, accelerations, yaw_rates), 0.0, 3) ==
          doctest::Approx(is_comfortable ? 1.0 : 14.0 / 16.0));
  }
}

TEST_CASE(
    "the closed-loop score sees crossing traffic where it counts for nuPlan, and no fault where another is to blame") {
  auto const map = support::own_map("intersection_4way.xodr");
  // Both are 25 m before the middle of the junction at 10 m/s, one going east, one north, `late` seconds behind.
  auto const crossing = [&](double late, double seconds) {
    Sim world(map);
    double const back = 25.0 + 10.0 * late;
    for (auto const& [x, y, heading, id] : {std::tuple{-25.0, -1.75, 0.0, 2u}, {1.75, -back, geometry::pi / 2, 1u}}) {
      State state{0.0, x, y, heading, 10.0}, end = state;
      end.time = 5.0;
      end.x += 50.0 * std::cos(heading);
      end.y += 50.0 * std::sin(heading);
      world.add({.position = {x, y},
                 .heading = heading,
                 .speed = 10.0,
                 .behavior = StaticTrajectory({state, end}),
                 .id = AgentId{id}});
    }
    return observed(world, AgentId{2}, ClosedLoopScore{}, static_cast<int>(10.0 * seconds)).parts();
  };
  // The ego's front is at the other's way after (25 + 1.75 - 0.9 - 3.6) m: the bodies touch from 2.2 s on.
  CHECK(crossing(0.0, 1.0).keeps_distance == 1.0);  // 1.2 s before, and not yet in the junction
  CHECK(crossing(0.0, 2.0).keeps_distance == 0.0);  // a moment before the crash
  CHECK(crossing(0.0, 2.0).no_fault == 1.0);
  CHECK(crossing(0.0, 2.6).no_fault == 0.0);
  CHECK(crossing(3.0, 4.0).keeps_distance == 1.0);  // the other one passes behind

  // Whom it drives through between two frames it has hit.
  for (double const step : {0.2, 1.0}) {
    Sim through(support::straight_road(1, 500));
    through.add({.position = {100, -1.75}, .speed = 60, .behavior = ConstantAcceleration{}, .id = AgentId{2}});
    through.add({.position = {130, -1.75}, .behavior = ConstantAcceleration{}, .id = AgentId{1}});
    CHECK(observed(through, AgentId{2}, ClosedLoopScore{}, 1, 0.2).parts().no_fault == 1.0);
    CHECK(observed(through, AgentId{2}, ClosedLoopScore{}, static_cast<int>(1.0 / step), step).parts().no_fault == 0.0);
  }

  // One that comes over from beside counts for an ego that is not within its lane.
  for (bool const straddles : {false, true}) {
    Sim world(support::straight_road(3, 500));
    world.add({.position = {100, straddles ? -4.25 : -5.25},
               .speed = 10,
               .behavior = ConstantAcceleration{},
               .id = AgentId{2}});
    world.add({.position = {101.5, -1.75},
               .heading = -0.2,
               .speed = 10.2,
               .behavior = ConstantAcceleration{},
               .id = AgentId{1}});
    CHECK(TimeToCollision{}(world, world.slot_of(AgentId{2})) < 0.95);
    CHECK(observed(world, AgentId{2}, ClosedLoopScore{}, 0).parts().keeps_distance == (straddles ? 0.0 : 1.0));
  }

  // A neighbour drifts into the ego's side, in its lane or over its border.
  for (bool const straddles : {false, true}) {
    Sim world(support::straight_road(3, 500));
    double const y = straddles ? -4.2 : -5.25;
    world.add({.position = {100, y}, .speed = 10, .behavior = ConstantAcceleration{}, .id = AgentId{2}});
    std::vector<State> drifts;
    for (int i = 0; i <= 40; ++i) drifts.push_back({0.1 * i, 98.0 + i, std::max(y + 1.5, -1.75 - 0.1 * i), 0.0, 10});
    world.add({.position = {98, -1.75}, .speed = 10, .behavior = StaticTrajectory(drifts), .id = AgentId{1}});
    auto const parts = observed(world, AgentId{2}, ClosedLoopScore{}, 35).parts();
    CHECK(parts.no_fault == (straddles ? 0.0 : 1.0));
  }
}

TEST_CASE("the closed-loop score counts the way against the direction within any second: up to 2 m, up to 6 m, more") {
  struct Case {
    double speed;
    int steps;  // of an eighth of a second, in the oncoming lane
    double expected;
  };
  for (auto const& [speed, steps, expected] :
       {Case{10, 0, 1.0}, Case{7.9, 2, 1.0}, Case{8.1, 2, 0.5}, Case{5.9, 12, 0.5}, Case{1.9, 12, 1.0},
        Case{2.1, 12, 0.5}, Case{6.1, 12, 0.0}}) {
    CAPTURE(speed);
    CAPTURE(steps);
    std::vector<State> states;
    for (int i = 0; i <= 20; ++i)
      states.push_back({0.125 * i, 100.0 + 0.125 * i * speed, i > 4 && i <= 4 + steps ? 1.75 : -1.75, 0.0, speed});
    Sim world(support::two_way_road(300));
    world.add({.position = {100, -1.75},
               .heading = 0.0,
               .speed = speed,
               .behavior = StaticTrajectory(states),
               .id = AgentId{2}});
    CHECK(score_of(world, 0.0, 20, 0.125) == doctest::Approx(expected));
  }
  for (double const speed : {1.9, 2.1}) {  // a second has 5 steps of 0.2 s, however their times are rounded
    std::vector<State> states;
    for (int i = 0; i <= 101; ++i)
      states.push_back({0.2 * i, 100.0 + 0.2 * i * speed, i > 0 ? 1.75 : -1.75, 0.0, speed});
    Sim world(support::two_way_road(300));
    world.add({.position = {100, -1.75},
               .heading = 0.0,
               .speed = speed,
               .behavior = StaticTrajectory(states),
               .id = AgentId{2}});
    CHECK(observed(world, AgentId{2}, ClosedLoopScore{}, 100, 0.2).parts().direction == (speed < 2.0 ? 1.0 : 0.5));
  }
}
