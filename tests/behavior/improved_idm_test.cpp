// The Improved Intelligent Driver Model.
#include "cambium/behavior/law/improved_idm.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "cambium/behavior/drivers.hpp"

#include "lane_traffic_fixtures.hpp"

using namespace lane_traffic;

TEST_CASE("the improved IDM is its equations") {
  // Computed from the equations with 30 digits, for the defaults.
  struct {
    double speed, gap, leader_speed, acceleration;
  } const rows[] = {{0, 10, 0, 1.632},
                    {5, 20, 5, 1.3071703399487},
                    {5, 9, 4, -0.83200324219843},
                    {10, 40, 12, 1.3087472767653},
                    {10, 16, 9, -0.94761800530211},
                    {14, 30, 14, 0.3647124174872},
                    {15, 30, 15, 0},
                    {15, 20, 14, -1.8622346005445},
                    {18, 60, 15, -0.87511954836401},
                    {18, 30, 18, -0.87511954836401},
                    {20, 200, 20, -1.1524123670079}};
  cb::ImprovedIdm const law;
  for (auto const& row : rows) {
    CAPTURE(row.speed);
    CAPTURE(row.gap);
    CHECK(law.acceleration(row.speed, law.desired_speed, {row.gap, row.leader_speed}) ==
          doctest::Approx(row.acceleration).epsilon(1e-12));
  }
  CHECK(law.acceleration(10.0, 15.0, {0.0, 10.0}) == law.lowest_acceleration);
  CHECK(law.acceleration(15.0, 15.0, {0.5, 0.0}) == law.lowest_acceleration);
}

TEST_CASE("the improved IDM never accelerates more than on a free road, nor jumps where its equations meet") {
  cb::RandomStream random(3, 0, 0);
  for (int i = 0; i < 20'000; ++i) {
    cb::ImprovedIdm const law{.desired_speed = between(5, 40, random),
                              .time_headway = between(0.5, 3, random),
                              .maximum_acceleration = between(0.3, 3, random),
                              .comfortable_deceleration = between(0.5, 4, random)};
    double const v = between(0, 1.5, random) * law.desired_speed, leader_speed = between(0, 45, random);
    auto const at = [&](double speed, double gap) {
      return law.acceleration(speed, law.desired_speed, {gap, leader_speed});
    };
    double const gap = between(0.1, 200, random), free = at(v, std::numeric_limits<double>::infinity());
    double const here = at(v, gap);
    CHECK(here <= free);
    CHECK(here >= law.lowest_acceleration);
    CHECK(std::abs(at(v, gap + 1e-7) - here) < 1e-3);
    CHECK(std::abs(at(law.desired_speed + 1e-9, gap) - at(law.desired_speed - 1e-9, gap)) < 1e-3);
  }
}

TEST_CASE("a platoon of the improved IDM keeps its time headway up to the desired speed; IDM's gaps widen") {
  auto const gap_behind = [](auto const& driver, double speed) {
    using Driver = std::decay_t<decltype(driver)>;
    cb::World<cb::BehaviorSet<Driver, cb::ConstantAcceleration>, cb::InterpolateExecution, cb::SingleTrack> world(
        support::straight_road(1, 8000.0));
    std::vector<cb::AgentId> ids;
    ids.push_back(world.add({.position = {300.0, -1.75}, .speed = speed, .behavior = cb::ConstantAcceleration{}}));
    for (double x : {240.0, 180.0, 120.0})
      ids.push_back(world.add({.position = {x, -1.75}, .speed = speed, .behavior = driver}));
    for (int step = 0; step < 1000; ++step) REQUIRE(world.step(0.2));
    auto const car = cb::geometry::car();
    return world.state(ids[2]).x - world.state(ids[3]).x - car.front - car.rear;
  };
  using Improved = cb::Driver<cb::ImprovedIdm, cb::KeepLane>;
  for (double const speed : {10.0, 27.0, 29.4}) {
    CAPTURE(speed);
    double const headway = 2.0 + 1.5 * speed;  // minimum gap, time headway
    CHECK(gap_behind(Improved{.law = {.desired_speed = 30.0}}, speed) == doctest::Approx(headway).epsilon(0.01));
  }
  CHECK(gap_behind(cb::IdmClassic{.law = {.desired_speed = 30.0}}, 27.0) > 1.5 * (2.0 + 1.5 * 27.0));
}
