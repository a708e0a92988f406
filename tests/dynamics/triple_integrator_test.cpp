#include "cambium/dynamics/triple_integrator.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "cambium/dynamics/integration.hpp"

#include "../support/dual.hpp"

namespace cb = cambium;

namespace {

/// Position and velocity under a constant jerk: three integrals each.
struct Exact {
  double x, y, vx, vy;
};
Exact exact(cb::TripleIntegrator::State const& s, cb::JerkInput<double> const& u, double t) {
  double const c = std::cos(s.heading), n = std::sin(s.heading);
  double const ax = s.acceleration * c - s.lateral_acceleration * n,
               ay = s.acceleration * n + s.lateral_acceleration * c;
  auto const position = [t](double v, double a, double j) { return v * t + a * t * t / 2 + j * t * t * t / 6; };
  auto const velocity = [t](double v, double a, double j) { return v + a * t + j * t * t / 2; };
  return {position(s.speed * c, ax, u.x), position(s.speed * n, ay, u.y), velocity(s.speed * c, ax, u.x),
          velocity(s.speed * n, ay, u.y)};
}

cb::TripleIntegrator::State const start{
    .heading = 0.4, .speed = 9.0, .acceleration = 0.7, .lateral_acceleration = -1.2};

double error(int steps) {
  cb::TripleIntegrator const model;
  cb::JerkInput<double> const u{0.8, -0.5};
  auto x = start;
  for (int i = 0; i < steps; ++i) x = cb::rk4_step(model, x, u, 3.0 / steps);
  auto const twin = exact(start, u, 3.0);
  return std::hypot(x.x - twin.x, x.y - twin.y);
}

}  // namespace

TEST_CASE("a constant jerk integrates to a cubic, and the path's coordinates are that motion's") {
  cb::TripleIntegrator const model;
  cb::JerkInput<double> const u{0.8, -0.5};
  auto x = start;
  for (int i = 0; i < 300; ++i) x = cb::rk4_step(model, x, u, 0.01);
  auto const twin = exact(start, u, 3.0);
  CHECK(x.x == doctest::Approx(twin.x).epsilon(1e-9));
  CHECK(x.y == doctest::Approx(twin.y).epsilon(1e-9));
  CHECK(x.speed == doctest::Approx(std::hypot(twin.vx, twin.vy)).epsilon(1e-9));
  CHECK(x.heading == doctest::Approx(std::atan2(twin.vy, twin.vx)).epsilon(1e-9));
  for (int const steps : {8, 16, 32})
    CHECK(std::log2(error(steps) / error(2 * steps)) == doctest::Approx(4.0).epsilon(0.1));
}

TEST_CASE("the jerk is kept within its length, and a driver's action is reached") {
  cb::TripleIntegrator const model{.jerk_limit = 5.0};
  auto const u = model.limited({30.0, 40.0}, {});
  CHECK(std::hypot(u.x, u.y) == doctest::Approx(5.0));
  CHECK(u.y / u.x == doctest::Approx(4.0 / 3.0));
  cb::TripleIntegrator::State x{.speed = 10.0};
  for (int i = 0; i < 200; ++i) x = cb::drive(model, x, {0.0, 0.05}, 0.02);
  double const curvature = std::tan(0.05) / 2.7;
  CHECK(x.lateral_acceleration == doctest::Approx(100.0 * curvature).epsilon(0.01));
  CHECK(x.speed == doctest::Approx(10.0).epsilon(0.01));
  for (int i = 0; i < 200; ++i) x = cb::drive(model, x, {-6.0, 0.0}, 0.02);
  CHECK(x.speed == 0.0);
  CHECK(x.acceleration <= 0.0);
  for (int i = 0; i < 100; ++i) x = cb::drive(model, x, {2.0, 0.0}, 0.02);
  CHECK(x.speed > 2.0);
}

TEST_CASE("a driver's turn stays within its limit, and depends little on the step, in braking too") {
  cb::TripleIntegrator const model;
  for (double const speed : {2.0, 5.0, 10.0})
    for (double const steering : {0.05, 0.2, 0.5})
      for (double const braking : {-1.0, -8.0}) {
        CAPTURE(speed);
        CAPTURE(steering);
        CAPTURE(braking);
        double lowest = 100.0, highest = -100.0;
        for (double const dt : {0.01, 0.05, 0.2}) {
          cb::TripleIntegrator::State x{.speed = speed};
          while (x.time < 12.0) {
            x = cb::drive(model, x, {x.time < 2.0 - 1e-9 ? 1.0 : braking, steering}, dt);
            double const tightest = x.speed * x.speed * std::tan(1.5) / model.wheel_base;
            CHECK(std::abs(x.lateral_acceleration) <= std::min(model.lateral_acceleration_limit, tightest) + 1e-9);
          }
          lowest = std::min(lowest, x.heading);
          highest = std::max(highest, x.heading);
        }
        CHECK(highest - lowest < 0.1);
      }
}

TEST_CASE("a driver's motion is the cubic of its jerk, as long as that suffices") {
  cb::TripleIntegrator const model;
  cb::TripleIntegrator::State x{.heading = 0.4, .speed = 9.0, .acceleration = 0.1, .lateral_acceleration = 1.2};
  auto twin = x;
  for (int i = 0; i < 300; ++i) {
    cb::Action const action{0.2, 0.04};
    twin = cb::rk4_step(model, twin, model.input(action, twin), 0.01);
    x = cb::drive(model, x, action, 0.01);
  }
  CHECK(std::hypot(x.x - twin.x, x.y - twin.y) < 1e-3);
  CHECK(x.heading == doctest::Approx(twin.heading).epsilon(1e-4));
  CHECK(x.speed == doctest::Approx(twin.speed).epsilon(1e-5));
}

TEST_CASE("with dual numbers the triple integrator tells how it depends on its jerk") {
  using support::Dual;
  cb::TripleIntegrator const model;
  cb::BasicAcceleratedState<Dual> const x{0.0, 0.0, 0.0, 0.4, 9.0, 0.7, -1.2};
  auto const dual = cb::rk4_step(model, x, cb::JerkInput<Dual>{0.8, Dual(-0.5, 1.0)}, 0.5);
  auto const after = [&](double j) { return cb::rk4_step(model, start, {0.8, j}, 0.5); };
  CHECK(dual.y.v == doctest::Approx(after(-0.5).y).epsilon(1e-13));
  CHECK(dual.y.d == doctest::Approx((after(-0.5 + 1e-4).y - after(-0.5 - 1e-4).y) / 2e-4).epsilon(1e-6));
  cb::BasicAcceleratedState<float> const small{0.0f, 0.0f, 0.0f, 0.4f, 9.0f, 0.7f, -1.2f};
  CHECK(std::abs(cb::rk4_step(model, small, cb::JerkInput<float>{0.8f, -0.5f}, 0.5).x - after(-0.5).x) < 1e-5);
}
