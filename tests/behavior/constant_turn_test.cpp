#include "cambium/behavior/open_loop/constant_turn.hpp"

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "../support/maps.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/world/world.hpp"

namespace cb = cambium;

namespace {

using World = cb::World<cb::BehaviorSet<cb::ConstantTurn>, cb::InterpolateExecution, cb::SingleTrack>;

/// Where one is after 3 s in steps of `dt` [s].
cb::State after_three_seconds(cb::ConstantTurn const& model, double speed, double acceleration, double curvature,
                              double dt) {
  World world(support::straight_road());
  auto const id =
      world.add({.position = {10.0, -1.75}, .speed = speed, .acceleration = acceleration, .behavior = model});
  world.memory<cb::ConstantTurn>(id).curvature = curvature;
  for (int i = 0; i < std::lround(3.0 / dt); ++i) CHECK(world.step(dt));
  return world.state(id);
}

}  // namespace

TEST_CASE("a turn that does not fade is a circle") {
  cb::ConstantTurn const lasting{.turn_fade = 1e6};
  for (double const curvature : {0.05, -0.02, 0.0})
    for (double const dt : {0.05, 0.3}) {
      CAPTURE(curvature);
      CAPTURE(dt);
      auto const state = after_three_seconds(lasting, 10.0, 0.0, curvature, dt);
      double const turn = 30.0 * curvature;
      CHECK(state.heading == doctest::Approx(turn).epsilon(1e-4));
      if (curvature == 0.0) continue;
      CHECK(state.x - 10.0 == doctest::Approx(std::sin(turn) / curvature).epsilon(1e-4));
      CHECK(state.y + 1.75 == doctest::Approx((1.0 - std::cos(turn)) / curvature).epsilon(1e-4));
    }
}

TEST_CASE("an acceleration fades: speed and distance are those of the differential equation, in steps of any length") {
  for (double const acceleration : {2.0, -1.5})
    for (double const dt : {0.05, 0.3, 1.0}) {
      auto const state = after_three_seconds({.acceleration_fade = 2.0}, 10.0, acceleration, 0.0, dt);
      double const gain = acceleration * 2.0 * (1.0 - std::exp(-1.5));
      CHECK(state.speed == doctest::Approx(10.0 + gain).epsilon(1e-9));
      CHECK(state.x - 10.0 == doctest::Approx(30.0 + 2.0 * (3.0 * acceleration - gain)).epsilon(1e-9));
    }
}

TEST_CASE("it stops rather than reverses, turns no more then, and exceeds no limit") {
  auto const stopped = after_three_seconds({.acceleration_fade = 1e6}, 4.0, -4.0, 0.1, 0.2);
  CHECK(stopped.speed == 0.0);
  CHECK(stopped.heading == doctest::Approx(0.2).epsilon(0.05));
  CHECK(after_three_seconds({.acceleration_fade = 1e6, .highest_speed = 12.0}, 10.0, 4.0, 0.0, 0.2).speed == 12.0);
}
