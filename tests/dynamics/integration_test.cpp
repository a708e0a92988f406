#include "cambium/dynamics/integration.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "cambium/dynamics/single_track.hpp"

namespace cb = cambium;

TEST_CASE("a vehicle that is held on its brakes stops where the closed form says, whatever the step") {
  cb::SingleTrack const model;
  for (double const dt : {0.03, 0.2, 1.0, 5.0}) {
    cb::State x{.time = 7.0, .speed = 6.0};
    int steps = 0;
    for (; steps * dt < 4.0; ++steps) x = cb::drive(model, x, {-4.0, 0.0}, dt);
    CHECK(x.x == doctest::Approx(4.5));
    CHECK(x.speed == 0.0);
    CHECK(x.time == doctest::Approx(7.0 + steps * dt));
  }
}

namespace {

/// A user's model, which knows no limits but for its highest speed.
struct Plain {
  using State = cb::State;
  using Input = cb::Action;
  double highest_speed = 3.0;
  State derivative(State const& x, Input const& u) const { return {1.0, x.speed, 0.0, 0.0, u.acceleration}; }
  Input limited(Input const& u, State const&) const { return u; }
  Input input(cb::Action const& action, State const&) const { return action; }
};

}  // namespace

TEST_CASE("a vehicle that has come to its model's highest speed goes no faster") {
  Plain const model;
  for (double const dt : {0.05, 0.2, 1.0}) {
    cb::State x{.speed = 2.0};
    for (int i = 1; i <= 20; ++i) {
      x = cb::drive(model, x, {2.0, 0.0}, dt);
      double const t = i * dt;
      CHECK(x.speed == doctest::Approx(std::min(3.0, 2.0 + 2.0 * t)));
      CHECK(x.x == doctest::Approx(t <= 0.5 ? 2.0 * t + t * t : 1.25 + 3.0 * (t - 0.5)));
    }
    CHECK(cb::drive(model, x, {-1.0, 0.0}, dt).speed == doctest::Approx(3.0 - dt));
    x.speed = 5.0;  // as it came from elsewhere
    CHECK(cb::drive(model, x, {2.0, 0.0}, dt).speed == doctest::Approx(5.0));
  }
}

TEST_CASE("a step by Euler's scheme differs from one by Runge-Kutta's on a curve") {
  cb::SingleTrack const model;
  cb::State const x{.speed = 8.0};
  CHECK(cb::drive<true>(model, x, {0.0, 0.2}, 0.2).y == 0.0);
  CHECK(cb::drive(model, x, {0.0, 0.2}, 0.2).y > 0.05);
}
