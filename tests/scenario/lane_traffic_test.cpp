#include "cambium/scenario/lane_traffic.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

namespace cb = cambium;
using cb::LaneTraffic;
using cb::LaneVehicle;

namespace {

std::vector<LaneVehicle> sample(LaneTraffic const& traffic, std::uint32_t number) {
  cb::RandomStream random(9, number, 0);
  return traffic.sample(random);
}

/// Distance between two vehicles, bumper to bumper [m].
double gap(LaneVehicle const& follower, LaneVehicle const& leader) {
  return leader.s - leader.shape.rear - follower.s - follower.shape.front;
}

}  // namespace

TEST_CASE("vehicles stand on the stretch from its front to its rear, and what is drawn is within its bounds") {
  LaneTraffic const traffic{.begin = 30.0, .end = 400.0};
  double slowest = 1e9, fastest = 0.0;
  for (std::uint32_t number = 0; number < 200; ++number) {
    auto const vehicles = sample(traffic, number);
    REQUIRE(vehicles.size() > 5);
    CHECK(vehicles.front().s + vehicles.front().shape.front == doctest::Approx(400.0));
    CHECK(vehicles.back().s - vehicles.back().shape.rear >= 30.0);
    for (auto const& v : vehicles) {
      CHECK(v.speed <= std::min(traffic.speed.highest(), v.driver.law.desired_speed));
      CHECK(v.speed >= traffic.speed.lowest());
      CHECK(v.driver.law.desired_speed <= traffic.desired_speed.highest());
      CHECK(v.driver.law.desired_speed >= 0.85 * traffic.desired_speed.lowest());
      CHECK_NOTHROW(cb::check_parameters(v.driver));
      slowest = std::min(slowest, v.speed);
      fastest = std::max(fastest, v.speed);
    }
  }
  CHECK(slowest < 8.1);
  CHECK(fastest > 13.9);
}

TEST_CASE("every gap lets the follower keep its headway and brake comfortably to its leader's speed") {
  LaneTraffic const traffic{
      .begin = 0.0, .end = 500.0, .speed = cb::Uniform{2.0, 25.0}, .desired_speed = cb::Uniform{20.0, 30.0}};
  for (std::uint32_t number = 0; number < 200; ++number) {
    auto const vehicles = sample(traffic, number);
    for (std::size_t i = 1; i < vehicles.size(); ++i) {
      auto const &follower = vehicles[i], &leader = vehicles[i - 1];
      double const closing = std::max(0.0, follower.speed - leader.speed);
      double const braking_way = closing * closing / (2 * follower.driver.law.comfortable_deceleration);
      double const headway = (gap(follower, leader) - follower.driver.law.minimum_gap - braking_way) / follower.speed;
      CHECK(headway >= traffic.headway.lowest() - 1e-9);
      CHECK(headway <= traffic.headway.highest() + 1e-9);
    }
  }
}

TEST_CASE("the safe gap is the minimum gap at rest, and grows with headway, speed and closing speed") {
  cb::IdmClassic const driver{.law = {.minimum_gap = 2.0, .comfortable_deceleration = 2.0}};
  CHECK(LaneTraffic::safe_gap(driver, 0.0, 0.0, 1.0) == 2.0);
  CHECK(LaneTraffic::safe_gap(driver, 10.0, 10.0, 1.5) == doctest::Approx(17.0));
  CHECK(LaneTraffic::safe_gap(driver, 10.0, 20.0, 1.5) == doctest::Approx(17.0));
  CHECK(LaneTraffic::safe_gap(driver, 10.0, 0.0, 1.5) == doctest::Approx(17.0 + 25.0));
}

TEST_CASE("the share of trucks is that asked for") {
  for (double const share : {0.0, 0.3, 1.0}) {
    int trucks = 0, all = 0;
    for (std::uint32_t number = 0; number < 400; ++number)
      for (auto const& v : sample({.end = 2000.0, .mix = {.truck_share = share}}, number)) {
        trucks += v.shape == cb::geometry::truck();
        ++all;
      }
    CHECK(static_cast<double>(trucks) / all == doctest::Approx(share).epsilon(0.05));
  }
}

TEST_CASE("a stretch too short for a vehicle stays empty") {
  CHECK(sample({.begin = 0.0, .end = 4.0}, 1).empty());
  CHECK(sample({.begin = 10.0, .end = 0.0}, 1).empty());
}

TEST_CASE("bounds that contradict each other, and values out of range, are refused by name") {
  cb::RandomStream random(1, 0, 0);
  CHECK_THROWS_WITH_AS((void)(LaneTraffic{.speed = cb::Uniform{9, 8}}.sample(random)),
                       doctest::Contains("lane_traffic"), cb::ParameterError);
  CHECK_THROWS_WITH_AS((void)(LaneTraffic{.mix = {.truck_share = 1.5}}.sample(random)),
                       doctest::Contains("truck_share"), cb::ParameterError);
  CHECK_THROWS_WITH_AS((void)(LaneTraffic{.speed = cb::Uniform{-1, 8}}.sample(random)),
                       doctest::Contains("lane_traffic.speed: draws down to -1 m/s"), cb::ParameterError);
}
