#include "cambium/dynamics/single_track_steering.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <type_traits>

#include "cambium/dynamics/integration.hpp"

#include "../support/dual.hpp"

namespace cb = cambium;

namespace {

/// State after `t` [s] of a vehicle at a constant speed whose wheels turn from straight at `rate`: by Simpson's rule
/// over its heading, which is known in closed form: the integral of v tan(rate t) / L is -v / (L rate) ln cos(rate t).
cb::SingleTrackSteering::State on_spiral(cb::SingleTrackSteering const& model, double speed, double rate, double t) {
  auto const heading = [&](double u) { return -speed / (model.wheel_base * rate) * std::log(std::cos(rate * u)); };
  int const parts = 2000;
  double x = 0.0, y = 0.0, h = t / parts;
  for (int i = 0; i <= parts; ++i) {
    double const weight = i == 0 || i == parts ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
    x += weight * h / 3 * speed * std::cos(heading(i * h));
    y += weight * h / 3 * speed * std::sin(heading(i * h));
  }
  return {t, x, y, heading(t), speed, rate * t};
}

double error(int steps) {
  cb::SingleTrackSteering const model;
  cb::SingleTrackSteering::State x{.speed = 12.0};
  for (int i = 0; i < steps; ++i) x = cb::rk4_step(model, x, {0.0, 0.1}, 3.0 / steps);
  auto const exact = on_spiral(model, 12.0, 0.1, 3.0);
  return std::hypot(x.x - exact.x, x.y - exact.y);
}

}  // namespace

TEST_CASE("the derivative of a state is what each quantity gains in a second") {
  cb::SingleTrackSteering const model;
  auto const rate = model.derivative(cb::SingleTrackSteering::State{.heading = 0.5, .speed = 10.0, .steering = 0.1},
                                     {.acceleration = 2.0, .steering_rate = 0.3});
  CHECK(rate.time == 1.0);
  CHECK(rate.x == doctest::Approx(10.0 * std::cos(0.5)));
  CHECK(rate.y == doctest::Approx(10.0 * std::sin(0.5)));
  CHECK(rate.heading == doctest::Approx(10.0 * std::tan(0.1) / model.wheel_base));
  CHECK(rate.speed == 2.0);
  CHECK(rate.steering == 0.3);
}

TEST_CASE("wheels that turn steadily drive a clothoid") {
  cb::SingleTrackSteering const model;
  cb::SingleTrackSteering::State x{.speed = 12.0};
  for (int i = 0; i < 300; ++i) x = cb::rk4_step(model, x, {0.0, 0.1}, 0.01);
  auto const exact = on_spiral(model, 12.0, 0.1, 3.0);
  CHECK(x.x == doctest::Approx(exact.x).epsilon(1e-9));
  CHECK(x.y == doctest::Approx(exact.y).epsilon(1e-9));
  CHECK(x.heading == doctest::Approx(exact.heading).epsilon(1e-10));
  CHECK(x.steering == doctest::Approx(0.3).epsilon(1e-12));
  // For small angles that is the clothoid's own law: the heading grows with the square of the way.
  double const way = 12.0 * 0.5, per_metre = 0.1 / (12.0 * model.wheel_base);
  CHECK(on_spiral(model, 12.0, 0.1, 0.5).heading == doctest::Approx(way * way * per_metre / 2).epsilon(1e-3));
}

TEST_CASE("Runge-Kutta's order is 4 on a clothoid too") {
  for (int const steps : {20, 40, 80})
    CHECK(std::log2(error(steps) / error(2 * steps)) == doctest::Approx(4.0).epsilon(0.05));
}

TEST_CASE("a driver's steering angle is reached at the rate's limit and kept") {
  cb::SingleTrackSteering const model{.steering_limit = 0.5, .steering_rate_limit = 0.4};
  cb::SingleTrackSteering::State x{.speed = 3.0};
  double previous = 0.0;
  for (int i = 0; i < 200; ++i) {
    x = cb::drive(model, x, {0.0, 0.3}, 0.02);
    CHECK(x.steering - previous <= 0.4 * 0.02 + 1e-12);
    CHECK(x.steering <= 0.3 + 1e-12);
    previous = x.steering;
    if (i == 24) CHECK(x.steering == doctest::Approx(0.2));  // 0.5 s at the limit
  }
  CHECK(x.steering == doctest::Approx(0.3));
  for (int i = 0; i < 400; ++i) x = cb::drive(model, x, {0.0, 2.0}, 0.02);
  CHECK(x.steering == doctest::Approx(0.5));
  CHECK(model.limited({0.0, 1.0}, {.steering = 0.5}).steering_rate == 0.0);
  CHECK(model.limited({0.0, -1.0}, {.steering = 0.5}).steering_rate == -0.4);
}

TEST_CASE("the model that steers at a rate takes floats and dual numbers") {
  cb::SingleTrackSteering const model;
  cb::BasicSteeringState<float> const small{0.0f, 0.0f, 0.0f, 0.3f, 9.0f, 0.1f};
  auto const rounded = cb::rk4_step(model, small, cb::SteeringRateInput<float>{1.0f, 0.2f}, 0.2);
  auto const after = [&](double rate) {
    return cb::rk4_step(model, {.heading = 0.3, .speed = 9.0, .steering = 0.1}, {1.0, rate}, 0.2);
  };
  static_assert(std::is_same_v<decltype(rounded.x), float>);
  CHECK(std::abs(rounded.x - after(0.2).x) < 1e-5);
  CHECK(std::abs(rounded.heading - after(0.2).heading) < 1e-6);
  using support::Dual;
  cb::BasicSteeringState<Dual> const start{0.0, 0.0, 0.0, 0.3, 9.0, 0.1};
  auto const dual = cb::rk4_step(model, start, cb::SteeringRateInput<Dual>{1.0, Dual(0.2, 1.0)}, 0.2);
  CHECK(dual.y.v == doctest::Approx(after(0.2).y).epsilon(1e-13));
  CHECK(dual.y.d == doctest::Approx((after(0.2 + 1e-5).y - after(0.2 - 1e-5).y) / 2e-5).epsilon(1e-6));
  CHECK(dual.heading.d ==
        doctest::Approx((after(0.2 + 1e-5).heading - after(0.2 - 1e-5).heading) / 2e-5).epsilon(1e-6));
}
