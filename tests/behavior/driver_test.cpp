// Drivers composed of a law, a lateral part and heeds.
#include "cambium/behavior/drivers.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <string>
#include <vector>

#include "cambium/behavior.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/world/world.hpp"

#include "../support/maps.hpp"
#include "gipps.hpp"

using namespace cambium;

namespace {

/// A queue in each lane that leads to the map; `behavior` makes one for each vehicle.
template <class World, class Make>
void fill_in_queues(World& world, Make const& behavior) {
  for (auto const& lane : world.map().lanes())
    for (double s = 10.0; lane.drivable() && lane.predecessors.empty() && s < lane.length() - 30.0; s += 25.0) {
      auto const pose = lane.path.pose(s);
      world.add({.position = pose.position(), .heading = pose.heading, .speed = 6.0, .behavior = behavior()});
    }
}

}  // namespace

TEST_CASE("drivers have the names of the files, or those of their parts") {
  CHECK(std::string(IdmClassic::name) == "idm_classic");
  CHECK(std::string(UrbanDriver::name) == "urban_driver");
  CHECK(std::string(Driver<Gipps, KeepLane, Signals>::name) == "gipps_keep_lane_signals");
  CHECK(std::string(Mobil::Also<Signals, SpeedLimit>::name) ==
        "idm_change_lanes_bends_pedestrians_signals_speed_limit");
}

TEST_CASE("a heed is found by its type or a base of it, read, and replaced in a copy") {
  auto const driver = Mobil{}.with(Bends{.lateral_acceleration = 2.0});
  CHECK(driver.heed<Bends>().lateral_acceleration == 2.0);
  CHECK(Mobil{}.heed<Bends>().lateral_acceleration == 3.0);
  CHECK(IdmLaneTracking{}.heed<Bends>().lateral_acceleration == 3.4);
  static_assert(!Heeding<Bends>::contains<Signals>);
  static_assert(sizeof(Driver<Idm, KeepLane>) == sizeof(Idm) + sizeof(KeepLane) + sizeof(double));
  static_assert(sizeof(IdmClassic::Memory) == sizeof(KeepLane::Memory));
}

TEST_CASE("the strictest constraint is found whenever the law's response is asked for") {
  Idm const law;
  auto const response = law.at(10.0, law.desired_speed);
  Limits limits(law, 10.0, law.desired_speed);
  CHECK_FALSE(limits.is_constrained());
  CHECK(limits.acceleration() == response.free());
  limits.heed({20.0, 0.0});
  CHECK(limits.acceleration() == response(20.0, 0.0));
  limits.heed({100.0, 9.0});
  CHECK(limits.constraint().gap == 20.0);
  CHECK(limits.acceleration() == response(20.0, 0.0));
  limits.heed({15.0, 0.0});
  CHECK(limits.constraint().gap == 15.0);
  CHECK(limits.acceleration() == response(15.0, 0.0));
}

TEST_CASE_TEMPLATE("drivers for town change lanes and give way, whatever their law", Law, Idm, Gipps) {
  using Urban = BasicUrbanDriver<Law>;
  using Sim = World<BehaviorSet<Urban>, InterpolateExecution, SingleTrack>;
  bool any_changes = false;
  for (auto const* const name : {"intersection_4way.xodr", "roundabout.xodr", "highway_exit.xodr"}) {
    CAPTURE(name);
    Sim world(support::own_map(name), {.seed = 7});
    RandomStream random(11, 0, 0);
    fill_in_queues(world, [&] { return Urban{.law = {.desired_speed = uniform01(random) < 0.3 ? 5.0 : 14.0}}; });
    bool changes = false;
    std::size_t left = 0;
    auto const agents = world.frame().agents.size();
    for (int step = 0; step < 600; ++step) {
      REQUIRE(world.step(0.2));
      left = 0;
      for (std::uint32_t i = 0; i < agents; ++i) {
        auto const& agent = world.frame().agents[Slot{i}];
        changes = changes || std::get<0>(agent.memory).lateral.change.active();
        left += agent.status == AgentStatus::driving ? 0 : 1;
        CHECK_FALSE((agent.status == AgentStatus::driving && Collision{}(world, Slot{i})));
      }
    }
    CAPTURE(agents);
    CHECK(left > agents / 2);  // have left the map
    any_changes = any_changes || changes;
  }
  CHECK(any_changes);
}

namespace {
struct Anywhere {
  std::uint16_t corridor = 0;
  static constexpr char const* name = "anywhere";
  static constexpr auto parameters() {
    return parameter_list(parameter("corridor", &Anywhere::corridor, "-", Range{0, 1000}, "its target"));
  }
  template <class Choice>
  CorridorId operator()(Choice const&) const {
    return CorridorId{corridor};
  }
};
}  // namespace

TEST_CASE("a lane rule that names a corridor which is not beside changes no lane") {
  using Changer = Driver<Idm, ChangeLanes<Anywhere>>;
  for (auto const corridor : {std::uint16_t{3}, std::uint16_t{77}}) {
    World<BehaviorSet<Changer>, InterpolateExecution, SingleTrack> world(support::own_map("highway.xodr"));
    Changer driver;
    driver.lateral.rule.corridor = corridor;
    auto const id = world.add({.position = {20.0, -8.75}, .speed = 12.0, .behavior = driver});
    auto const lane = world.record(id).lane;
    for (int step = 0; step < 50; ++step) REQUIRE(world.step(0.2));
    CHECK(world.record(id).lane.corridor == lane.corridor);
    CHECK(std::abs(world.record(id).lane.lateral) < 0.01);
  }
}

namespace {
/// A law whose acceleration behind a leader is NaN, and a heed that desires what it is told.
struct Undecided : Gipps {
  static constexpr char const* name = "undecided";
  [[nodiscard]] double acceleration(double v, double desired, Constraint const& leader) const {
    return leader.gap > 100.0 ? Gipps::acceleration(v, desired, leader) : std::nan("");
  }
};
struct Wish {
  double speed = 5.0;
  static constexpr char const *name = "wish", *summary = "desires no more than this";
  static constexpr auto parameters() { return parameter_list(); }
  template <class Law, class View>
  double desired_speed(Law const&, View const&, double) const {
    return speed;
  }
};

using Doubtful = Driver<Undecided, KeepLane, Pedestrians>;
using Doubters = World<BehaviorSet<Doubtful, IdmClassic>, InterpolateExecution, SingleTrack>;
}  // namespace

TEST_CASE("what every law has is checked, though a law describes less") {
  Doubters world(support::straight_road());
  auto const nan = std::nan("");
  for (auto const& [law, expected] :
       {std::pair{Undecided{{.comfortable_deceleration = -1.0}},
                  "law.comfortable_deceleration: is -1 m/s^2; give a value in (0, inf) m/s^2"},
        std::pair{Undecided{{.maximum_acceleration = nan}}, "law.maximum_acceleration: is nan"},
        std::pair{Undecided{{.lowest_acceleration = 0.0}},
                  "law.lowest_acceleration: is 0 m/s^2; give a value in (-inf, -0.01] m/s^2"}})
    CHECK_THROWS_WITH_AS(world.add({.position = {20.0, -1.75}, .behavior = Doubtful{.law = law}}),
                         doctest::Contains(expected), ParameterError);
  CHECK(world.size() == 0);
}

TEST_CASE("the acceleration changes no faster than the jerk permits, but faster the harder a driver has to brake") {
  constexpr double dt = 0.1, speed = 10.0;
  Idm const law{.comfortable_deceleration = 2.0};
  Limits<Idm> limits(law, speed, 15.0);
  limits.jerk_bound = {.jerk = 2.0, .acceleration = 0.5};
  auto const acceleration = [&](double wanted) {
    double const end = speed + wanted * dt;
    return (limits.within({0.5 * (speed + end) * dt, end}, dt).speed - speed) / dt;
  };
  CHECK(acceleration(0.6) == doctest::Approx(0.6));
  CHECK(acceleration(1.5) == doctest::Approx(0.7));
  CHECK(acceleration(-1.5) == doctest::Approx(0.3));
  CHECK(acceleration(-3.5) == doctest::Approx(-0.075));  // 1.5 m/s^2 beyond comfort: 3.75 m/s^3 more
  CHECK(acceleration(-4.8) == doctest::Approx(-4.8));    // an emergency
  Limits<Idm> stops(law, 0.05, 15.0);
  stops.jerk_bound = {.jerk = 2.0, .acceleration = -1.0};
  auto const last = stops.within({0.0, 0.0}, dt);
  CHECK(last.speed == 0.0);
  CHECK(last.distance >= 0.0);
  CHECK(last.distance < 0.05 * dt);
  // Smoothly it would still drive at 9.9 m/s: 16.3 m to stop at 3 m/s^2, after 1 m.
  for (auto const& [distance, expected] : {std::pair{17.6, 0.3 - 1.3}, {17.2, -1.5}}) {
    limits.jerk_bound = {.jerk = 2.0, .acceleration = -0.8};
    limits.place_to_wait = {distance, 3.0};
    CHECK(acceleration(-1.5) == doctest::Approx(expected));
    limits.jerk_bound = {.jerk = 2.0, .acceleration = 0.5};
    CHECK(acceleration(1.5) == doctest::Approx(0.7));
  }
}

TEST_CASE_TEMPLATE("no desired speed is below 0.1 m/s; NaN is reported", Law, Idm, ImprovedIdm, Acc, Gipps) {
  using Wishful = Driver<Law, KeepLane, Wish, SpeedLimit>;
  auto const drive = [](double desired, double& speed) {
    World<BehaviorSet<Wishful>, InterpolateExecution, SingleTrack> world(support::straight_road());
    auto const id = world.add({.position = {20.0, -1.75}, .speed = 2.0, .behavior = Wishful{}.with(Wish{desired})});
    StepResult result;
    for (int step = 0; step < 100 && result; ++step) result = world.step(0.2);
    speed = world.state(id).speed;
    return result.problem;
  };
  double speed = 0.0;
  CHECK(drive(1.0, speed) == StepProblem::none);
  CHECK(speed == doctest::Approx(1.0).epsilon(0.01));
  for (double const desired : {-3.0, -1e300}) {
    CHECK(drive(desired, speed) == StepProblem::none);
    CHECK(speed <= 0.3);  // a law's scheme may overshoot such a speed
  }
  CHECK(drive(std::nan(""), speed) == StepProblem::not_finite);
}

TEST_CASE_TEMPLATE("a law whose acceleration is NaN is reported by the step, whatever wraps the driver", Driver,
                   Doubtful, HumanDriver<Doubtful>, RssConformant<Doubtful>, RssConformant<HumanDriver<Doubtful>>) {
  World<BehaviorSet<Driver, IdmClassic>, InterpolateExecution, SingleTrack> world(support::straight_road());
  auto const id = world.add({.position = {20.0, -1.75}, .speed = 2.0, .behavior = Driver{}});
  REQUIRE(world.step(0.2));
  world.add({.position = {100.0, -1.75}, .speed = 2.0, .behavior = IdmClassic{}});
  auto const result = world.step(0.2);
  CHECK(result.problem == StepProblem::not_finite);
  CHECK(result.agent == id);
}

namespace {
/// Bounds the motion by what it is told.
struct Bounded final {
  LongitudinalMotion<double> motion{};
  static constexpr char const *name = "bounded", *summary = "bounds the motion";
  static constexpr auto parameters() { return parameter_list(); }
  template <class View, class Limits>
  void heed(View const&, Limits& limits, double) const {
    limits.bound(motion);
  }
};
}  // namespace

TEST_CASE("a bound that leads backwards stops the vehicle") {
  using Stopped = Driver<Idm, KeepLane, Bounded>;
  for (auto const& motion : {LongitudinalMotion<double>{-5.0, 5.0}, {0.0, 5.0}, {-1e300, 0.0}}) {
    World<BehaviorSet<Stopped>, InterpolateExecution, SingleTrack> world(support::straight_road());
    auto const id = world.add({.position = {20.0, -1.75}, .behavior = Stopped{}.with(Bounded{motion})});
    for (int step = 0; step < 5; ++step) REQUIRE(world.step(0.2));
    CHECK(world.state(id).x == doctest::Approx(20.0).epsilon(1e-9));
    CHECK(world.state(id).speed == 0.0);
  }
}

TEST_CASE("limits lose no NaN, in any order; a gap or a speed that is NaN stops the driver") {
  auto const nan = std::nan("");
  for (bool const first : {true, false}) {
    Undecided const law;  // NaN behind whatever is nearer than 100 m
    Limits<Undecided> limits(law, 10.0, 15.0);
    for (double const gap : {first ? 20.0 : 200.0, first ? 200.0 : 20.0}) limits.heed({gap, 10.0});
    CHECK(std::isnan(limits.acceleration()));
    limits.bound(first ? LongitudinalMotion<double>{nan, nan} : LongitudinalMotion<double>{1.0, 2.0});
    limits.bound(first ? LongitudinalMotion<double>{1.0, 2.0} : LongitudinalMotion<double>{nan, nan});
    CHECK(std::isnan(limits.within({1.5, 2.0}, 0.1).distance));

    Idm const idm;
    Limits<Idm> blind(idm, 10.0, 15.0);
    for (double const gap : {first ? nan : 20.0, first ? 20.0 : nan}) blind.heed({gap, 10.0});
    CHECK(blind.acceleration() == idm.lowest_acceleration);
    Limits<Idm> unsure(idm, 10.0, 15.0);
    for (double const speed : {first ? nan : 10.0, first ? 10.0 : nan}) unsure.heed({50.0, speed});
    CHECK(unsure.acceleration() == idm.lowest_acceleration);
  }
}
