#include "cambium/dynamics/integration.hpp"

#include <doctest/doctest.h>

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

TEST_CASE("a step by Euler's scheme differs from one by Runge-Kutta's on a curve") {
  cb::SingleTrack const model;
  cb::State const x{.speed = 8.0};
  CHECK(cb::drive<true>(model, x, {0.0, 0.2}, 0.2).y == 0.0);
  CHECK(cb::drive(model, x, {0.0, 0.2}, 0.2).y > 0.05);
}
