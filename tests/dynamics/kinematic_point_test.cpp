#include "cambium/dynamics/kinematic_point.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "cambium/core/distributions.hpp"
#include "cambium/core/random.hpp"
#include "cambium/dynamics/integration.hpp"

#include "../support/dual.hpp"

namespace cb = cambium;

TEST_CASE("a constant yaw rate drives a circle of speed over yaw rate") {
  cb::KinematicPoint const model;
  cb::State x{.speed = 1.4};
  for (int i = 0; i < 100; ++i) x = cb::rk4_step(model, x, {0.0, 0.7}, 0.02);
  CHECK(x.x == doctest::Approx(2.0 * std::sin(1.4)).epsilon(1e-8));
  CHECK(x.y == doctest::Approx(2.0 * (1 - std::cos(1.4))).epsilon(1e-8));
  CHECK(x.heading == doctest::Approx(1.4));
}

TEST_CASE("whatever is asked of it, it stays within its limits, and turns on the spot") {
  cb::KinematicPoint const model;
  cb::RandomStream random(5, 0, 0);
  cb::Uniform const acceleration{-20.0, 20.0}, rate{-20.0, 20.0};
  for (int i = 0; i < 200; ++i) {
    cb::State x{.heading = 6.28 * cb::uniform01(random)};
    for (int k = 0; k < 60; ++k) {
      auto const u = model.limited({acceleration(random), rate(random)}, x);
      CHECK(std::abs(u.yaw_rate) <= model.yaw_rate_limit);
      CHECK(std::abs(u.yaw_rate * x.speed) <= model.lateral_acceleration_limit + 1e-9);
      CHECK(u.acceleration >= model.lowest_acceleration);
      x = cb::rk4_step(model, x, u, 0.05);
      x.speed = std::max(0.0, x.speed);
      CHECK(x.speed <= model.highest_speed + 0.05 * model.highest_acceleration);
      CHECK(cb::is_finite(x));
    }
  }
  CHECK(model.limited({0.0, 2.0}, {}).yaw_rate == 2.0);
}

TEST_CASE("with dual numbers the point tells how it depends on its yaw rate") {
  using support::Dual;
  cb::KinematicPoint const model;
  cb::BasicState<Dual> const start{0.0, 0.0, 0.0, 0.3, 2.0};
  auto const dual = cb::rk4_step(model, start, cb::KinematicPointInput<Dual>{0.5, Dual(0.4, 1.0)}, 0.3);
  auto const after = [&](double rate) { return cb::rk4_step(model, {.heading = 0.3, .speed = 2.0}, {0.5, rate}, 0.3); };
  CHECK(dual.y.d == doctest::Approx((after(0.4 + 1e-5).y - after(0.4 - 1e-5).y) / 2e-5).epsilon(1e-6));
  cb::BasicState<float> const small{0.0f, 0.0f, 0.0f, 0.3f, 2.0f};
  CHECK(std::abs(cb::rk4_step(model, small, cb::KinematicPointInput<float>{0.5f, 0.4f}, 0.3).y - after(0.4).y) < 1e-6);
}

TEST_CASE("a driver reaches the highest speed and keeps it, whatever the step") {
  cb::KinematicPoint const model;
  for (double const dt : {0.05, 0.2, 1.0, 3.0}) {
    CAPTURE(dt);
    cb::State x{.speed = 2.99};
    x = cb::drive(model, x, {3.0, 0.0}, dt);
    CHECK(x.speed == 3.0);
    CHECK(x.time == dt);
    double const rising = 0.01 / 3.0;
    CHECK(x.x == doctest::Approx(2.995 * rising + 3.0 * (dt - rising)));
    CHECK(cb::drive(model, x, {3.0, 0.3}, dt).speed == 3.0);
    CHECK(cb::drive<true>(model, {.speed = 2.99}, {3.0, 0.0}, dt).speed == 3.0);
    cb::State from_rest{};
    while (from_rest.time < 4.0) {
      from_rest = cb::drive(model, from_rest, {2.0, 0.1}, dt);
      CHECK(from_rest.speed <= 3.0);
    }
    CHECK(from_rest.speed == 3.0);
  }
  CHECK(cb::drive(model, {.speed = 5.0}, {3.0, 0.0}, 1.0).speed == 5.0);  // entered faster
}
