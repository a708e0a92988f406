// IDM's mathematics with float and with dual numbers, which carry a derivative.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "../support/dual.hpp"
#include "lane_traffic_fixtures.hpp"

using namespace lane_traffic;
using support::Dual;

namespace {

/// A random follower with moderate numbers.
struct Case {
  cb::Idm p;
  double speed, gap, leader_speed;

  explicit Case(cb::RandomStream& random)
      : speed(between(0.5, 30, random)), gap(between(2, 150, random)), leader_speed(between(0, 30, random)) {
    p.desired_speed = between(5, 40, random);
    p.time_headway = between(0.5, 2.5, random);
    p.maximum_acceleration = between(0.5, 3, random);
    p.exponent = cb::uniform01(random) < 0.5 ? 4.0 : between(1, 8, random);
  }
};

}  // namespace

TEST_CASE("IDM with float agrees with double to float's accuracy") {
  cb::RandomStream random(21, 0, 0);
  double worst_acceleration = 0, worst_speed = 0, worst_distance = 0;
  for (int i = 0; i < 20000; ++i) {
    Case const c(random);
    auto const speed = static_cast<float>(c.speed), gap = static_cast<float>(c.gap),
               leader = static_cast<float>(c.leader_speed);
    auto const a = cb::idm_acceleration(c.p, speed, gap, leader);
    static_assert(std::is_same_v<decltype(a), float const>);
    double const exact = cb::idm_acceleration(c.p, double{speed}, double{gap}, double{leader});
    // The terms of the difference may be far larger than the result.
    double const scale = 1.0 + std::pow(speed / c.p.desired_speed, c.p.exponent) +
                         std::pow(cb::idm_desired_gap(c.p, c.speed, c.leader_speed) / c.gap, 2);
    worst_acceleration = std::max(worst_acceleration, std::abs(a - exact) / scale);
    auto const motion = cb::idm_motion(c.p, speed, gap, leader, 0.2, 1e-4);
    auto const twin = cb::idm_motion(c.p, double{speed}, double{gap}, double{leader}, 0.2, 1e-4);
    worst_speed = std::max(worst_speed, std::abs(motion.speed - twin.speed));
    worst_distance = std::max(worst_distance, std::abs(motion.distance - twin.distance));
  }
  MESSAGE("largest differences: " << worst_acceleration << " of the largest term, " << worst_speed << " m/s, "
                                  << worst_distance << " m");
  CHECK(worst_acceleration < 5e-6);
  CHECK(worst_speed < 1e-3);  // the step length may differ: the tolerance is 1e-4 m/s per s
  CHECK(worst_distance < 2e-4);
}

TEST_CASE("with dual numbers IDM yields the derivatives of the acceleration") {
  cb::RandomStream random(22, 0, 0);
  int compared = 0;
  for (int i = 0; i < 20000; ++i) {
    Case const c(random);
    auto const acceleration = [&](double speed, double gap, double leader) {
      return cb::idm_acceleration(c.p, speed, gap, leader);
    };
    double const h = 1e-5, a = acceleration(c.speed, c.gap, c.leader_speed);
    double const dynamic = cb::idm_desired_gap(c.p, c.speed, c.leader_speed) - c.p.minimum_gap;
    if (a < c.p.lowest_acceleration + 0.01 || a > c.p.highest_acceleration - 0.01 || dynamic < 0.01) continue;  // kinks
    for (int const by : {0, 1, 2}) {
      auto const at = [&](double d) {
        return acceleration(c.speed + (by == 0) * d, c.gap + (by == 1) * d, c.leader_speed + (by == 2) * d);
      };
      auto const dual =
          cb::idm_acceleration(c.p, Dual(c.speed, by == 0), Dual(c.gap, by == 1), Dual(c.leader_speed, by == 2));
      CHECK(dual.v == doctest::Approx(a).epsilon(1e-12));
      CHECK(std::abs(dual.d - (at(h) - at(-h)) / (2 * h)) < 1e-5);
    }
    ++compared;
  }
  CHECK(compared > 5000);
  auto const free =
      cb::idm_acceleration(cb::Idm{}, Dual(10.0, 1.0), Dual(std::numeric_limits<double>::infinity()), Dual(0.0));
  CHECK(free.d == doctest::Approx(-1.7 * 4 * std::pow(10.0 / 15, 3) / 15));
}

TEST_CASE("with dual numbers IDM's motion has the same value and yields its derivative by the initial gap") {
  cb::RandomStream random(23, 0, 0);
  int compared = 0;
  for (int i = 0; i < 3000; ++i) {
    Case const c(random);
    auto const motion = [&](double gap) { return cb::idm_motion(c.p, c.speed, gap, c.leader_speed, 0.2, 1e-6); };
    auto const dual = cb::idm_motion(c.p, Dual(c.speed), Dual(c.gap, 1.0), Dual(c.leader_speed), 0.2, 1e-6);
    auto const twin = motion(c.gap);
    CHECK(dual.distance.v == doctest::Approx(twin.distance).epsilon(1e-12));
    CHECK(dual.speed.v == doctest::Approx(twin.speed).epsilon(1e-12));
    double const a = cb::idm_acceleration(c.p, c.speed, c.gap, c.leader_speed), h = 1e-3;
    if (a < -4 || c.speed < 2) continue;  // it may stop or reach a bound
    CHECK(dual.speed.d == doctest::Approx((motion(c.gap + h).speed - motion(c.gap - h).speed) / (2 * h)).epsilon(0.02));
    ++compared;
  }
  CHECK(compared > 1000);
}
