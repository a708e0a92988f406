#include "cambium/core/state.hpp"
#include "cambium/core/state_vector.hpp"

#include <limits>

#include <doctest/doctest.h>

using namespace cambium;

namespace {

struct WithSteering : State {
  double steering{};
};
static_assert(MotionState<WithSteering> && MotionState<BasicState<float>> && !MotionState<int>);
static_assert(sizeof(State) == 5 * sizeof(double));

}  // namespace

TEST_CASE("a state survives the way into a vector and back") {
  State const state{.time = 1.0, .x = 2.0, .y = 3.0, .heading = 4.0, .speed = 5.0};
  auto const vector = to_vector(state);
  for (int i = 0; i < 5; ++i) CHECK(vector[i] == i + 1.0);
  CHECK(from_vector(vector) == state);
}

TEST_CASE("a state is finite only when each of its fields is") {
  CHECK(is_finite(State{1.0, 2.0, 3.0, 4.0, 5.0}));
  for (double const bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                           -std::numeric_limits<double>::infinity()}) {
    for (double State::*field : {&State::time, &State::x, &State::y, &State::heading, &State::speed}) {
      State state{};
      state.*field = bad;
      CHECK(!is_finite(state));
    }
  }
  State both{};
  both.x = std::numeric_limits<double>::infinity();
  both.y = -both.x;
  CHECK(!is_finite(both));
}
