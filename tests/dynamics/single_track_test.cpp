#include "cambium/dynamics/single_track.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "cambium/core/distributions.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/random.hpp"
#include "cambium/dynamics/integration.hpp"
#include "cambium/geometry/angle.hpp"

#include "../support/dual.hpp"

namespace cb = cambium;

namespace {

/// State after `t` [s] of a vehicle that starts at the origin along +x and holds its steering and its acceleration: it
/// drives along a circle.
cb::State on_circle(cb::SingleTrack const& model, cb::SingleTrack::Input const& u, double speed, double t) {
  double const radius = model.wheel_base / std::tan(u.steering);
  double const driven = speed * t + u.acceleration * t * t / 2, angle = driven / radius;
  return {t, radius * std::sin(angle), radius * (1 - std::cos(angle)), angle, speed + u.acceleration * t};
}

enum class Scheme { euler, rk4 };

/// Distance [m] between the closed form and `steps` steps over 4 s.
double error(Scheme scheme, int steps) {
  cb::SingleTrack const model;
  cb::SingleTrack::Input const u{1.5, 0.2};
  double const duration = 4.0, dt = duration / steps;
  cb::State x{.speed = 6.0};
  for (int i = 0; i < steps; ++i)
    x = scheme == Scheme::euler ? cb::euler_step(model, x, u, dt) : cb::rk4_step(model, x, u, dt);
  auto const exact = on_circle(model, u, 6.0, duration);
  return std::hypot(x.x - exact.x, x.y - exact.y);
}

/// The order at which the error falls when the steps are halved.
double measured_order(Scheme scheme, int steps) { return std::log2(error(scheme, steps) / error(scheme, 2 * steps)); }

}  // namespace

TEST_CASE("held steering drives a circle of wheel base over tangent") {
  cb::SingleTrack const model{.wheel_base = 3.1};
  for (double const steering : {-0.5, -0.05, 0.05, 0.5}) {
    cb::State x{.speed = 10.0};
    for (int i = 0; i < 400; ++i) x = cb::rk4_step(model, x, {0.0, steering}, 0.01);
    auto const exact = on_circle(model, {0.0, steering}, 10.0, 4.0);
    CHECK(x.x == doctest::Approx(exact.x).epsilon(1e-8));
    CHECK(x.y == doctest::Approx(exact.y).epsilon(1e-8));
    CHECK(x.heading == doctest::Approx(exact.heading).epsilon(1e-12));
    CHECK(x.speed == 10.0);
    CHECK(x.time == doctest::Approx(4.0));
  }
}

TEST_CASE("steering left turns counter-clockwise, and without steering the way is straight along the heading") {
  cb::SingleTrack const model;
  CHECK(cb::rk4_step(model, {.speed = 5.0}, {0.0, 0.1}, 1.0).heading > 0.0);
  auto const straight = cb::rk4_step(model, {.x = 1, .y = 2, .heading = 2.0, .speed = 5.0}, {-1.0, 0.0}, 2.0);
  CHECK(straight.x == doctest::Approx(1 + 8 * std::cos(2.0)));
  CHECK(straight.y == doctest::Approx(2 + 8 * std::sin(2.0)));
  CHECK(straight.heading == 2.0);
  CHECK(straight.speed == doctest::Approx(3.0));
}

TEST_CASE("Euler's scheme is of order 1, Runge-Kutta's of order 4") {
  for (int const steps : {40, 80, 160}) {
    CHECK(measured_order(Scheme::euler, steps) == doctest::Approx(1.0).epsilon(0.05));
    CHECK(measured_order(Scheme::rk4, steps) == doctest::Approx(4.0).epsilon(0.05));
  }
  MESSAGE("after 4 s in steps of 0.1 s: Euler is " << error(Scheme::euler, 40) << " m off, Runge-Kutta "
                                                   << error(Scheme::rk4, 40) << " m");
  CHECK(error(Scheme::rk4, 40) < 1e-3);
}

TEST_CASE("inputs are brought within what the vehicle can do") {
  cb::SingleTrack const model{.steering_limit = 0.4, .lowest_acceleration = -6.0, .highest_acceleration = 2.0};
  double const infinite = std::numeric_limits<double>::infinity();
  auto const within = model.limited({-1.0, 0.3}, {});
  CHECK(within.acceleration == -1.0);
  CHECK(within.steering == 0.3);
  for (double const much : {10.0, infinite}) {
    auto const most = model.limited({much, much}, {}), least = model.limited({-much, -much}, {});
    CHECK(most.acceleration == 2.0);
    CHECK(most.steering == 0.4);
    CHECK(least.acceleration == -6.0);
    CHECK(least.steering == -0.4);
  }
}

TEST_CASE("the single track's own Runge-Kutta step is the general one") {
  cb::SingleTrack const model;
  cb::RandomStream random(6, 0, 0);
  for (int i = 0; i < 5000; ++i) {
    auto const between = [&](double low, double high) { return low + (high - low) * cb::uniform01(random); };
    cb::State const x{between(0, 100), between(-100, 100), between(-100, 100),
                      i % 10 == 0 ? between(-3e5, 3e5) : between(-10, 10), between(-5, 50)};
    cb::SingleTrackInput<double> const u{between(-8, 4), between(-0.6, 0.6)};
    auto const own = cb::rk4_step(model, x, u, 0.3);
    auto const general = cb::rk4_step<cb::SingleTrack>(model, x, u, 0.3);
    CHECK(std::hypot(own.x - general.x, own.y - general.y) < 1e-9);
    CHECK(std::abs(own.heading - general.heading) < 1e-9);
    CHECK(std::abs(own.speed - general.speed) + std::abs(own.time - general.time) < 1e-12);
  }
}

TEST_CASE("steering stays within the lateral acceleration that the tyres give") {
  cb::SingleTrack const model{.lateral_acceleration_limit = 5.0};
  for (double speed = 0.0; speed < 60.0; speed += 0.37)
    for (double const asked : {-1.0, -0.2, -0.01, 0.01, 0.05, 0.2, 0.6}) {
      double const steering = model.limited({0.0, asked}, {.speed = speed}).steering;
      double const lateral = speed * speed * std::tan(steering) / model.wheel_base;
      CHECK(std::abs(lateral) <= 5.0 * (1 + 1e-12));
      CHECK(steering * asked >= 0.0);
      CHECK(std::abs(steering) <= 0.6);
      // Not less than needed: either all that was asked for, or a limit.
      bool const full = steering == asked || std::abs(steering) == 0.6 || std::abs(lateral) > 5.0 * (1 - 1e-12);
      CHECK(full);
    }
}

TEST_CASE("a vehicle without wheel base is refused by name") {
  CHECK_THROWS_WITH_AS(cb::check_parameters(cb::SingleTrack{.wheel_base = 0.0}), doctest::Contains("wheel_base"),
                       cb::ParameterError);
}

TEST_CASE("a step with floats or dual numbers equals that with doubles, and dual numbers give its derivatives") {
  cb::SingleTrack const model;
  for (double const steering : {-0.4, -0.01, 0.0, 0.2, 0.5})
    for (double const acceleration : {-3.0, 0.0, 2.0}) {
      cb::State const x{.x = 3, .y = -2, .heading = 0.7, .speed = 8};
      auto const after = [&](double turn) { return cb::rk4_step(model, x, {acceleration, turn}, 0.2); };
      auto const exact = after(steering);

      cb::BasicState<float> const small{0.0f, 3.0f, -2.0f, 0.7f, 8.0f};
      cb::SingleTrackInput<float> const input{static_cast<float>(acceleration), static_cast<float>(steering)};
      auto const rounded = cb::rk4_step(model, small, input, 0.2);
      static_assert(std::is_same_v<decltype(rounded.x), float>);
      CHECK(std::abs(rounded.x - exact.x) < 1e-5);
      CHECK(std::abs(rounded.y - exact.y) < 1e-5);
      CHECK(std::abs(rounded.heading - exact.heading) < 1e-6);
      CHECK(std::abs(cb::euler_step(model, small, input, 0.2).speed - exact.speed) < 1e-5);

      using support::Dual;
      cb::BasicState<Dual> const start{Dual(0.0), Dual(3.0), Dual(-2.0), Dual(0.7), Dual(8.0)};
      auto const dual =
          cb::rk4_step(model, start, cb::SingleTrackInput<Dual>{Dual(acceleration), Dual(steering, 1.0)}, 0.2);
      auto const high = after(steering + 1e-5), low = after(steering - 1e-5);
      CHECK(dual.x.v == doctest::Approx(exact.x).epsilon(1e-14));
      CHECK(dual.x.d == doctest::Approx((high.x - low.x) / 2e-5).epsilon(1e-6));
      CHECK(dual.y.d == doctest::Approx((high.y - low.y) / 2e-5).epsilon(1e-6));
      CHECK(dual.heading.d == doctest::Approx((high.heading - low.heading) / 2e-5).epsilon(1e-6));
    }
}

TEST_CASE("the steering within grip is the arc tangent's, at any speed") {
  for (double const speed : {1e-3, 0.5, 3.0, 10.0, 30.0})
    for (double const limit : {0.01, 0.3, 0.7, 1.2, 2.0}) {
      double const grip = std::atan(4.0 * 2.7 / (speed * speed));
      CHECK(cambium::steering_within_grip(limit, 4.0, 2.7, speed) == doctest::Approx(std::min(limit, grip)));
    }
  CHECK(cambium::steering_within_grip(2.0, 4.0, 2.7, 0.0) == doctest::Approx(cambium::geometry::pi / 2));
}
