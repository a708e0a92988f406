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

TEST_CASE("a force in the plane moves it as Newton says, while it is within the limits") {
  cb::KinematicPoint const model{.yaw_rate_limit = 50, .highest_speed = 50};
  double const ax = 0.4, ay = -0.9;
  cb::State x{.heading = 0.4, .speed = 2.0};
  double const vx = 2.0 * std::cos(0.4), vy = 2.0 * std::sin(0.4), t = 2.0;
  int const steps = 20000;
  for (int i = 0; i < steps; ++i) x = cb::rk4_step(model, x, model.toward(ax, ay, x), t / steps);
  CHECK(x.x == doctest::Approx(vx * t + ax * t * t / 2).epsilon(1e-3));
  CHECK(x.y == doctest::Approx(vy * t + ay * t * t / 2).epsilon(1e-3));
  CHECK(x.speed * std::cos(x.heading) == doctest::Approx(vx + ax * t).epsilon(1e-3));
  CHECK(x.speed * std::sin(x.heading) == doctest::Approx(vy + ay * t).epsilon(1e-3));
}

TEST_CASE("whatever the force, one that stands turns towards it, and it stays within its limits") {
  cb::KinematicPoint const model;
  cb::RandomStream random(5, 0, 0);
  for (int i = 0; i < 200; ++i) {
    double const angle = 6.28 * cb::uniform01(random);
    cb::State x{.heading = 6.28 * cb::uniform01(random)};
    for (int k = 0; k < 60; ++k) {
      auto const u = model.toward(2 * std::cos(angle), 2 * std::sin(angle), x);
      CHECK(std::abs(u.yaw_rate) <= model.yaw_rate_limit);
      CHECK(std::abs(u.yaw_rate * x.speed) <= model.lateral_acceleration_limit + 1e-9);
      x = cb::rk4_step(model, x, u, 0.05);
      x.speed = std::max(0.0, x.speed);
      CHECK(x.speed <= model.highest_speed + 0.05 * model.highest_acceleration);
      CHECK(cb::is_finite(x));
    }
    CHECK(std::cos(x.heading - angle) > 0.99);
    CHECK(x.speed > 1.5);
  }
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
