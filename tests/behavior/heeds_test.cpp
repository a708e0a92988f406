#include "cambium/behavior/drivers.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "cambium/map/opendrive.hpp"

#include "gipps.hpp"
#include "lane_traffic_fixtures.hpp"

using namespace lane_traffic;

namespace {

/// `Behavior` that heeds `Heed`, too, unless it does already.
template <class Behavior, class Heed>
struct Adding;
template <class Law, class Lateral, class... Heeds, class Heed>
struct Adding<cb::Driver<Law, Lateral, Heeds...>, Heed> {
  using Behavior = std::conditional_t<cb::Heeding<Heeds...>::template contains<Heed>,
                                      cb::Driver<Law, Lateral, Heeds...>, cb::Driver<Law, Lateral, Heeds..., Heed>>;
};
template <class Law, class... Heeds, class Heed>
struct Adding<cb::BasicMacroActions<Law, Heeds...>, Heed> {
  using Behavior = std::conditional_t<cb::Heeding<Heeds...>::template contains<Heed>,
                                      cb::BasicMacroActions<Law, Heeds...>, cb::BasicMacroActions<Law, Heeds..., Heed>>;
};
template <class Law, class... Heeds, class Heed>
struct Adding<cb::BasicProposal<Law, Heeds...>, Heed> {
  using Behavior = std::conditional_t<cb::Heeding<Heeds...>::template contains<Heed>, cb::BasicProposal<Law, Heeds...>,
                                      cb::BasicProposal<Law, Heeds..., Heed>>;
};
template <class Driver, class Heed>
struct Adding<cb::HeadwayHypotheses<Driver>, Heed> {
  using Behavior = cb::HeadwayHypotheses<typename Adding<Driver, Heed>::Behavior>;
};
template <class Driver, class Heed>
struct Adding<cb::RssConformant<Driver>, Heed> {
  using Behavior = cb::RssConformant<typename Adding<Driver, Heed>::Behavior>;
};
template <class Driver, class Heed>
struct Adding<cb::HumanDriver<Driver>, Heed> {
  using Behavior = cb::HumanDriver<typename Adding<Driver, Heed>::Behavior>;
};
template <class Distribution, class Driver, class Heed>
struct Adding<cb::BasicIdmStochastic<Distribution, Driver>, Heed> {
  using Behavior = cb::BasicIdmStochastic<Distribution, typename Adding<Driver, Heed>::Behavior>;
};
template <class Behavior, class Heed>
using Heeds = typename Adding<Behavior, Heed>::Behavior;

#define DRIVERS                                                                                                        \
  cb::IdmClassic, cb::AdaptiveCruiseControl, cb::IdmLaneTracking, cb::IdmStochastic, cb::Mobil, cb::Intersection,      \
      cb::LaneChangeRuleBased, cb::ZipMerge, cb::MacroActions, cb::HeadwayHypotheses<cb::IdmClassic>, cb::IdmProposal, \
      cb::RssConformant<cb::IdmClassic>, cb::HumanDriver<cb::IdmClassic>, cb::Driver<Gipps, cb::KeepLane>

using Driven = Traffic<DRIVERS>;

template <class Behavior>
auto& heeds_of(Behavior& behavior) {
  if constexpr (requires { behavior.nominal; })
    return heeds_of(behavior.nominal);
  else if constexpr (requires { behavior.driver; })
    return heeds_of(behavior.driver);
  else
    return behavior.heeds;
}

template <class Behavior>
cb::KeepLane& lane_keeping_of(Behavior& behavior) {
  if constexpr (requires { behavior.driver; })
    return behavior.driver.lateral;
  else if constexpr (requires { behavior.lateral.keep; })
    return behavior.lateral.keep;
  else
    return behavior.lateral;
}

/// Passes `drive` the behaviour with and, unless it has it already, without a heed.
template <class Behavior, class Heed, class Drive>
void with_and_without(Drive const& drive) {
  drive(Heeds<Behavior, Heed>{}, true);
  if constexpr (!std::is_same_v<Behavior, Heeds<Behavior, Heed>>) drive(Behavior{}, false);
}

}  // namespace

TEST_CASE_TEMPLATE("every driver stops before its lane's end if the rules say so", Behavior, DRIVERS) {
  using Ending = Heeds<Behavior, cb::LaneEnd>;
  auto const drive = [](cb::LaneEnd::Of ends) {
    Ending driver{};
    heeds_of(driver).template get<cb::LaneEnd>().of = ends;
    Traffic<Ending> world(straight_road(1, 300));
    auto const id = world.add({.position = {100, -1.75}, .speed = 14, .behavior = driver});
    for (int i = 0; i < 300; ++i) REQUIRE(world.step(0.2));
    return world.record(id);
  };
  auto const record = drive(cb::LaneEnd::Of::corridor);
  CHECK(record.status == cb::AgentStatus::driving);
  CHECK(record.state.speed < 0.05);
  double const front = record.state.x + 3.6;
  CHECK(front < 285.0);
  CHECK(front > 280.0);
  // It drives on if the end is its destination, except under BARK's option.
  CHECK(drive(cb::LaneEnd::Of::route).status != cb::AgentStatus::driving);
}

TEST_CASE_TEMPLATE(
    "a driver that enters over the border of its lane finds back to the middle, one within it keeps its place",
    Behavior, cb::IdmClassic, cb::AdaptiveCruiseControl, cb::Intersection) {
  auto const offset_after = [](double offset) {
    Driven world(straight_road(2, 400));
    auto const id = world.add({.position = {50, -5.25 + offset}, .speed = 10, .behavior = Behavior{}});
    for (int i = 0; i < 60; ++i) REQUIRE(world.step(0.2));
    CHECK(std::abs(world.record(id).lane.heading_error) < 1e-3);
    return world.record(id).lane.lateral;
  };
  for (double const offset : {1.6, -1.6}) CHECK(std::abs(offset_after(offset)) < 0.02);
  for (double const offset : {0.5, -0.5}) CHECK(offset_after(offset) == doctest::Approx(offset));
}

TEST_CASE("of a leader and the lane's end, the one that requires more braking counts") {
  Driven world(straight_road(1, 300));
  auto const ahead = add(world, 1, 290.0, 0.0, cb::IdmClassic{}), id = add(world, 1, 250.0, 10.0, cb::IdmClassic{});
  auto const strictest = [&](auto const& view) {
    cb::Idm const law;
    cb::Limits limits(law, 10.0, law.desired_speed);
    cb::KeepLane{}.heed_next(view, limits);
    cb::LaneEnd{.of = cb::LaneEnd::Of::corridor}.heed(view, limits, 0.2);
    return limits.constraint();
  };
  auto const view = world.observe(id);
  auto const leader = strictest(view);
  REQUIRE(view.ahead().has_value());
  CHECK(view.ahead()->agent == ahead);
  CHECK(leader.gap < view.ahead()->gap);
  CHECK(leader.gap == doctest::Approx(300 - 250 - 3.6 - 15));
  world.set_state(ahead, {.x = 265, .y = -1.75});
  auto const near = world.observe(id);
  CHECK(strictest(near).gap == near.ahead()->gap);
}

TEST_CASE("a driver keeps its leader's gap although a vehicle that merges is nearer, and faster") {
  MergingRoad const merge;
  Driven world(merge.site.map);
  auto const place = [&](MergingRoad::Entrance const& from, double before, double speed, double desired) {
    return merge.add(world, from, before,
                     {.speed = speed, .behavior = cb::IdmClassic{.law = {.desired_speed = desired}}});
  };
  auto const id = place(merge.through, 80.0, 12.0, 15.0), leader = place(merge.through, 58.0, 9.9, 9.9);
  auto alone = world;
  auto const merging = place(merge.ramp, 58.0, 15.0, 15.0);
  auto view = world.observe(id);
  REQUIRE(view.ahead());
  REQUIRE(view.ahead()->agent == merging);
  REQUIRE(view.ahead({.merging = cb::Merging::ignored})->agent == leader);
  step_all(1, 0.2, alone, world);
  CHECK(alone.record(id).action.acceleration < -0.5);
  CHECK(world.record(id).action.acceleration <= alone.record(id).action.acceleration);
}

TEST_CASE_TEMPLATE("vehicles that merge count, or are ignored, as the rules say", Behavior, cb::IdmClassic,
                   cb::AdaptiveCruiseControl, cb::IdmLaneTracking, cb::IdmStochastic, cb::Mobil, cb::UrbanDriver) {
  MergingRoad const merge;
  auto const acceleration = [&](bool has_ramp, cb::Merging merging) {
    Behavior behavior;
    lane_keeping_of(behavior).merging = merging;
    Traffic<Behavior, cb::ConstantAcceleration> world(merge.site.map);
    auto const id = merge.add(world, merge.through, 60.0, {.speed = 12.0, .behavior = behavior});
    if (has_ramp) merge.add(world, merge.ramp, 36.0, {.speed = 12.0, .behavior = cb::ConstantAcceleration{}});
    REQUIRE(world.step(0.2));
    return world.record(id).action.acceleration;
  };
  double const alone = acceleration(false, cb::Merging::counts);
  CHECK(acceleration(true, cb::Merging::ignored) == alone);
  CHECK(acceleration(true, cb::Merging::counts) < alone - 0.3);
}

TEST_CASE("the permitted speed is the limit, or a speed that still meets lower limits ahead") {
  cb::map::LaneCorridor corridor;
  corridor.speed_limits = {{0.0, 30.0}, {200.0, 10.0}, {400.0, 20.0}};
  CHECK(cb::detail::permitted_speed(corridor, 10.0, 20.0, 2.0) == 30.0);
  CHECK(cb::detail::permitted_speed(corridor, 150.0, 30.0, 2.0) == doctest::Approx(10.0));
  CHECK(cb::detail::permitted_speed(corridor, 60.0, 30.0, 2.0) == doctest::Approx(std::sqrt(100.0 + 4.0 * 50.0)));
  CHECK(cb::detail::permitted_speed(corridor, 250.0, 10.0, 2.0) == 10.0);
  CHECK(cb::detail::permitted_speed(corridor, 401.0, 10.0, 2.0) == 20.0);
  CHECK(std::isinf(cb::detail::permitted_speed(cb::map::LaneCorridor{}, 10.0, 20.0, 2.0)));
}

TEST_CASE_TEMPLATE("it has slowed down where a lower speed limit begins", Driver, cb::IdmClassic::Also<cb::SpeedLimit>,
                   cb::UrbanDriver, cb::Intersection) {
  auto const map = support::own_map("highway_exit.xodr");
  auto const ramp = map->find_lane("2", 20.0, -1);
  for (double const factor : {1.0, 1.1}) {
    Driver driver{.law = {.desired_speed = 33.0}};
    driver.template heed<cb::SpeedLimit>().factor = factor;
    Traffic<Driver> world(map);
    auto const id = enter(world, map->lane(map->find_lane("1", 450.0, -4)), 50.0,
                          {.speed = 20.0, .behavior = driver, .goal = cb::ReachLane{.lane = ramp, .from = 100.0}});
    double slowest = 1e9;
    while (world.time() < 60.0 && world.status(id) == cb::AgentStatus::driving) {
      auto const& record = world.record(id);
      double const limit = world.roster().agents[0].road->corridors[record.lane.corridor].speed_limit_at(record.lane.s);
      slowest = std::min(slowest, limit);
      CHECK(record.state.speed <= factor * limit + 0.05);
      REQUIRE(world.step(0.1));
    }
    CHECK(slowest < 20.0);
  }
}

TEST_CASE("a driver that obeys speed limits keeps them on a town's roads") {
  auto const map = corpus_map("Town04.xodr");
  if (!map) return;
  int limited = 0;
  for (std::size_t i = 0; i < map->lanes().size() && limited < 12; ++i) {
    auto const& lane = map->lanes()[i];
    if (!lane.drivable() || lane.length() < 60 || lane.speed_limits.empty()) continue;
    double const limit = cb::map::speed_limit_at(lane.speed_limits, 5.0);
    if (!std::isfinite(limit)) continue;
    using Obeying = cb::IdmClassic::Also<cb::SpeedLimit>;
    Traffic<Obeying> world(map);
    auto const id =
        enter(world, lane, 5.0, {.speed = 0.9 * limit, .behavior = Obeying{.law = {.desired_speed = 50.0}}});
    for (int k = 0; k < 100 && world.status(id) == cb::AgentStatus::driving; ++k) {
      auto const& record = world.record(id);
      auto const& corridor = world.roster().agents[0].road->corridors[record.lane.corridor];
      CHECK(record.state.speed <= corridor.speed_limit_at(record.lane.s) + 0.05);
      REQUIRE(world.step(0.2));
    }
    ++limited;
  }
  MESSAGE(limited << " lanes");
  CHECK(limited > 0);
}

TEST_CASE_TEMPLATE("every driver stops at a red light until it is green if the rules say so, and passes it otherwise",
                   Behavior, DRIVERS) {
  auto const map = support::road_with_signal("1000001");
  REQUIRE(map->lights().size() == 1);
  with_and_without<Behavior, cb::Signals>([&](auto const& driver, bool obeys) {
    Traffic<std::remove_cvref_t<decltype(driver)>> world(map);
    world.set_light(map->lights()[0].id, {.cycle = 100.0, .green_begin = 60.0, .green_end = 90.0});
    auto const id = world.add({.position = {50, -1.75}, .speed = 13, .behavior = driver});
    for (int k = 0; k < 290; ++k) REQUIRE(world.step(0.2));
    CAPTURE(world.state(id).x);
    if (!obeys) {
      CHECK(world.state(id).x > 210.0);
      return;
    }
    double const front = world.state(id).x + world.roster().agents[0].shape.front;
    CHECK(world.state(id).speed < 0.1);
    CHECK(front < 200.0);
    CHECK(front > 197.5);
    for (int k = 0; k < 50; ++k) REQUIRE(world.step(0.2));
    CHECK(world.state(id).x > 210.0);
  });
}

TEST_CASE_TEMPLATE("every driver stops once at a stop sign and goes on", Behavior, DRIVERS) {
  using Obeying = Heeds<Behavior, cb::Signals>;
  Obeying const driver{};
  Traffic<Obeying> world(support::road_with_signal("206"));
  auto const id = world.add({.position = {100, -1.75}, .speed = 13, .behavior = driver});
  int stops = 0;
  for (int k = 0; k < 200 && world.state(id).x < 300.0; ++k) {
    bool const stood = world.state(id).speed < cb::standing_speed;
    REQUIRE(world.step(0.2));
    stops += !stood && world.state(id).speed < cb::standing_speed;
  }
  CHECK(stops == 1);
  CHECK(world.state(id).x >= 300.0);
}

TEST_CASE("a driver who rolls through stop signs slows down to its speed there, and does not stand") {
  for (double const rolling : {0.0, 2.0}) {
    cb::IdmClassic::Also<cb::Signals> driver{};
    driver.heed<cb::Signals>().rolling_speed = rolling;
    Traffic<cb::IdmClassic::Also<cb::Signals>> world(support::road_with_signal("206"));
    auto const id = world.add({.position = {100, -1.75}, .speed = 13, .behavior = driver});
    double slowest = 13.0;
    for (int k = 0; k < 300 && world.state(id).x < 300.0; ++k) {
      REQUIRE(world.step(0.1));
      slowest = std::min(slowest, world.state(id).speed);
    }
    CHECK(world.state(id).x >= 300.0);
    CHECK(slowest < rolling + 0.1);
    CHECK(slowest > 0.5 * rolling - 0.01);
  }
}

TEST_CASE("a driver responds to a light that turns yellow, and to green where it stands, after its reaction time") {
  using Obeying = cb::IdmClassic::Also<cb::Signals>;
  auto const map = support::road_with_signal("1000001");
  cb::map::LightPlan const plan{
      .cycle = 60.0, .green_begin = 30.0, .green_end = 62.0};  // yellow from 2 s, red from 5 s
  CHECK(plan.shown_for(3.5) == doctest::Approx(1.5));
  CHECK(plan.shown_for(6.0) == doctest::Approx(1.0));
  CHECK(plan.shown_for(31.0) == doctest::Approx(1.0));
  CHECK(plan.shown_for(61.0) == doctest::Approx(31.0));
  CHECK(std::isinf(cb::map::LightPlan{.cycle = 60.0, .green_end = 60.0}.shown_for(7.0)));
  CHECK(cb::map::LightPlan{}.shown_for(7.0) == 0.0);
  double braked[2]{}, started[2]{};
  for (int i = 0; i < 2; ++i) {
    Obeying driver{.jerk = 1e6};
    driver.heed<cb::Signals>().reaction = i;
    Traffic<Obeying> world(map);
    world.set_light(map->lights().front().id, plan);
    auto const id = world.add({.position = {110, -1.75}, .speed = 15, .behavior = driver});  // 4 s from the line
    while (world.time() < 45.0 && started[i] == 0.0) {
      double const before = world.state(id).speed;
      REQUIRE(world.step(0.05));
      double const now = world.state(id).speed;
      if (braked[i] == 0.0 && now < before - 0.02) braked[i] = world.time();
      if (world.time() > 20.0 && now > cb::standing_speed) started[i] = world.time();
    }
  }
  CHECK(braked[0] >= 2.0);
  CHECK(braked[1] >= 3.0);
  CHECK(started[0] < 30.3);
  CHECK(started[1] - started[0] == doctest::Approx(1.0).epsilon(0.06));
}

TEST_CASE_TEMPLATE("every driver brakes comfortably and in time for a bend if the rules say so", Behavior, DRIVERS) {
  double const radius = 20.0;
  auto const map = road_with_bend(radius);
  using Slowing = Heeds<Behavior, cb::Bends>;
  for (bool const slows : {true, false}) {
    Slowing driver{};
    heeds_of(driver).template get<cb::Bends>().lateral_acceleration = slows ? 2.5 : 50.0;
    Traffic<Slowing> world(map);
    auto const id = world.add({.position = {10, -1.75}, .speed = 14.0, .behavior = driver});
    double fastest = 0.0, hardest = 0.0;
    while (world.status(id) == cb::AgentStatus::driving && world.record(id).lane.s < 240.0) {
      REQUIRE(world.step(0.2));
      hardest = std::min(hardest, world.record(id).action.acceleration);
      if (world.record(id).lane.s > 201.0) fastest = std::max(fastest, world.state(id).speed);
    }
    double const allowed = std::sqrt(2.5 * (radius + 1.75));
    INFO("fastest ", fastest, ", hardest ", hardest);
    CHECK((fastest < 1.03 * allowed) == slows);
    if (slows) CHECK(fastest > 0.9 * allowed);
    CHECK(hardest > -2.5);
  }
}

TEST_CASE_TEMPLATE("every driver meets a lower speed limit in time if the rules say so", Behavior, DRIVERS) {
  auto const map = cb::parse_opendrive(
                       "<OpenDRIVE><road id='0' length='600' junction='-1'><type s='0' type='town'><speed max='10' "
                       "unit='m/s'/></type><type s='300' type='town'><speed max='6' unit='m/s'/></type>"
                       "<planView><geometry s='0' x='0' y='0' hdg='0' length='600'><line/></geometry></planView>"
                       "<lanes><laneSection s='0'><center><lane id='0'/></center><right><lane id='-1' type='driving'>"
                       "<width sOffset='0' a='3.5' b='0' c='0' d='0'/></lane></right></laneSection></lanes></road>"
                       "</OpenDRIVE>")
                       .map;
  with_and_without<Behavior, cb::SpeedLimit>([&](auto const& driver, bool obeys) {
    Traffic<std::remove_cvref_t<decltype(driver)>> world(map);
    auto const id = world.add({.position = {20, -1.75}, .speed = 15.0, .behavior = driver});
    double before = 0.0, behind = 0.0, hardest = 0.0;
    for (int k = 0; k < 300 && world.status(id) == cb::AgentStatus::driving && world.state(id).x < 580.0; ++k) {
      REQUIRE(world.step(0.2));
      auto const& state = world.state(id);
      if (state.x > 100.0 && state.x < 290.0) before = std::max(before, state.speed);
      if (state.x > 302.0) behind = std::max(behind, state.speed);
      if (state.x > 100.0) hardest = std::min(hardest, world.record(id).action.acceleration);
    }
    INFO("before ", before, ", behind ", behind, ", hardest ", hardest);
    CHECK((before < 10.3) == obeys);
    CHECK((behind > 0.0 && behind < 6.5) == obeys);
    if (obeys) CHECK(before > 9.0);
    CHECK(hardest > -2.5);
  });
}

TEST_CASE("macro actions that obey limits keep their speed on a road without a limit") {
  using Actions = cb::BasicMacroActions<cb::Idm, cb::SpeedLimit>;
  Traffic<Actions> world(support::straight_road());
  auto const id = world.add({.position = {20, -1.75}, .speed = 30.0, .behavior = Actions{}});
  world.memory<Actions>(id).choose(cb::MacroActions::nothing);
  for (int k = 0; k < 20; ++k) REQUIRE(world.step(0.2));
  CHECK(world.state(id).speed == doctest::Approx(30.0));
}
