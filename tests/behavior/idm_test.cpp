#include "cambium/behavior/law/idm.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "cambium/cambium.hpp"

namespace cb = cambium;

TEST_CASE("a follower at the equilibrium gap keeps its speed") {
  cb::Idm const p;
  for (double v : {0.0, 1.0, 5.0, 10.0, 14.0}) {
    double const gap = cb::idm_equilibrium_gap(p, v);
    CHECK(cb::idm_acceleration(p, v, gap, v) == doctest::Approx(0.0).epsilon(1e-12));
    CHECK(gap == doctest::Approx((2.0 + 1.5 * v) / std::sqrt(1 - std::pow(v / 15.0, 4))));
  }
  CHECK(std::isinf(cb::idm_equilibrium_gap(p, 15.0)));
  CHECK(cb::idm_equilibrium_speed(p, cb::idm_equilibrium_gap(p, 10.0)) == doctest::Approx(10.0));
  CHECK(cb::idm_equilibrium_speed(p, 1.9) == doctest::Approx(0.0));
}

TEST_CASE("a closed gap causes the hardest braking") {
  cb::Idm const p;
  for (double gap : {0.0, -1.0, -1e9}) CHECK(cb::idm_acceleration(p, 10.0, gap, 10.0) == p.lowest_acceleration);
}

TEST_CASE("a faster leader is not mistaken for a close one") {
  cb::Idm const p;
  // Without the bound at the minimum gap the desired gap would be -26 m here, and its square would brake.
  CHECK(cb::idm_desired_gap(p, 10.0, 25.0) == p.minimum_gap);
  CHECK(cb::idm_acceleration(p, 10.0, 10.0, 25.0) > 0.0);
}

TEST_CASE("acceleration falls with speed, with a slower leader and with a smaller gap") {
  cb::Idm const p;
  cb::RandomStream random(3, 0, 0);
  for (int i = 0; i < 10000; ++i) {
    double const v = 30 * cb::uniform01(random), gap = 0.1 + 100 * cb::uniform01(random),
                 leader = 30 * cb::uniform01(random);
    double const a = cb::idm_acceleration(p, v, gap, leader);
    CHECK(a >= cb::idm_acceleration(p, v + 0.5, gap, leader));
    CHECK(a >= cb::idm_acceleration(p, v, gap * 0.9, leader));
    CHECK(a >= cb::idm_acceleration(p, v, gap, leader * 0.9));
  }
}

namespace {

/// A twin of `idm_motion` by 20000 explicit midpoint steps.
cb::LongitudinalMotion<double> fine_motion(cb::Idm const& p, double v, double gap, double leader, double dt) {
  constexpr int n = 20000;
  double const h = dt / n;
  double x = 0, speed = v;
  for (int i = 0; i < n; ++i) {
    double const a1 = cb::idm_acceleration(p, speed, gap + leader * (h * i) - x, leader);
    double const middle = std::max(0.0, speed + a1 * h / 2);
    double const a2 = cb::idm_acceleration(p, middle, gap + leader * (h * (i + 0.5)) - (x + speed * h / 2), leader);
    x += middle * h;
    speed = std::max(0.0, speed + a2 * h);
  }
  return {x, speed};
}

/// A value of the range, usually log-uniform, sometimes one of its ends.
double any_in(cb::Range range, cb::RandomStream& random) {
  double const u = cb::uniform01(random);
  if (u < 0.08) return range.low;
  if (u < 0.16) return range.high;
  double const v = cb::uniform01(random);
  if (range.low > 0) return range.low * std::pow(range.high / range.low, v);
  return range.low + (range.high - range.low) * (u < 0.5 ? v : range.low < 0 ? 1 - v * v * v : v * v * v);
}

}  // namespace

TEST_CASE("the motion of a step solves the model's differential equation for any step length") {
  cb::RandomStream random(11, 0, 0);
  double worst_speed = 0, worst_distance = 0;
  for (int i = 0; i < 300; ++i) {
    cb::Idm p;
    p.desired_speed = 5 + 30 * cb::uniform01(random);
    double const v = 25 * cb::uniform01(random), leader = 25 * cb::uniform01(random);
    double const gap = i % 5 == 0 ? std::numeric_limits<double>::infinity() : 1 + 80 * cb::uniform01(random);
    for (double dt : {0.05, 0.2, 1.0, 3.0}) {
      auto const motion = cb::idm_motion(p, v, gap, leader, dt, 1e-4);
      auto const twin = fine_motion(p, v, gap, leader, dt);
      worst_speed = std::max(worst_speed, std::abs(motion.speed - twin.speed));
      worst_distance = std::max(worst_distance, std::abs(motion.distance - twin.distance));
      CHECK(motion.speed >= 0.0);
      CHECK(motion.distance >= 0.0);
    }
  }
  MESSAGE("largest error at the default tolerance: " << worst_speed << " m/s, " << worst_distance << " m");
  CHECK(worst_speed < 3e-3);
  CHECK(worst_distance < 5e-3);
}

TEST_CASE("a smaller tolerance makes the motion more accurate") {
  cb::Idm const p;
  auto const twin = fine_motion(p, 14.0, 12.0, 6.0, 2.0);
  double previous = 1.0;
  for (double tolerance : {1e-2, 1e-4, 1e-6}) {
    double const error = std::abs(cb::idm_motion(p, 14.0, 12.0, 6.0, 2.0, tolerance).distance - twin.distance);
    CHECK(error <= previous);
    previous = error + 1e-7;
  }
  CHECK(previous < 1e-5);
}

TEST_CASE("a follower stops behind a standing leader, stands, and starts when the leader leaves") {
  cb::Idm const p;
  double gap = 30, v = 10;
  for (int i = 0; i < 400; ++i) {
    auto const m = cb::idm_motion(p, v, gap, 0.0, 0.2, 1e-4);
    gap -= m.distance;
    v = m.speed;
    CHECK(gap > 0.0);
  }
  CHECK(v < 0.02);
  CHECK(gap == doctest::Approx(p.minimum_gap).epsilon(0.05));
  for (int i = 0; i < 10; ++i) v = cb::idm_motion(p, v, gap += 5.0, 5.0, 0.2, 1e-4).speed;
  CHECK(v > 1.0);
}

TEST_CASE("for any parameters, speeds and gap the motion is finite, forward and within its bounds") {
  cb::RandomStream random(31, 0, 0);
  double const infinite = std::numeric_limits<double>::infinity();
  int bounded = 0;
  for (int i = 0; i < 20000; ++i) {
    cb::Idm p;
    cb::idm_parameters<cb::Idm>()([&](auto const& entry) { p.*entry.field = any_in(entry.range, random); });
    p.tolerance = any_in({1e-8, 1}, random);
    REQUIRE_NOTHROW(cb::check_parameters(p));
    double const speed = any_in({0, 60}, random), leader = any_in({0, 60}, random);
    double const gap = i % 6 == 0 ? infinite : any_in({-10, 500}, random), dt = any_in({1e-3, 10}, random);
    INFO(cb::to_string(p), ", speed ", speed, ", gap ", gap, ", leader ", leader, ", dt ", dt);
    auto const motion = cb::idm_motion(p, speed, gap, leader, dt, p.tolerance);
    REQUIRE(std::isfinite(motion.distance));
    REQUIRE(std::isfinite(motion.speed));
    CHECK(motion.speed >= 0.0);
    CHECK(motion.distance >= 0.0);
    double const a = cb::idm_acceleration(p, speed, gap, leader);
    CHECK(a >= p.lowest_acceleration);
    CHECK(a <= p.highest_acceleration);
    double const strongest = std::min(p.maximum_acceleration, p.highest_acceleration);
    double const highest_speed = speed + strongest * dt;
    CHECK(motion.speed <= highest_speed * (1 + 1e-12));
    CHECK(motion.distance <= dt * highest_speed * (1 + 1e-12));
    if (p.exponent <= 20 && p.lowest_acceleration <= -0.1 && p.tolerance <= 0.01) {
      // Nobody accelerates beyond the desired speed, except for the error of the tolerance and the shortest step.
      double const fastest = std::max(speed, p.desired_speed) + p.tolerance * dt + 1e-3 * strongest;
      CHECK(motion.speed <= fastest);
      CHECK(motion.distance <= dt * fastest);
      ++bounded;
    }
  }
  CHECK(bounded > 2000);
}
