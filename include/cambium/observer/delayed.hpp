#pragma once

#include <algorithm>
#include <cstddef>

#include "cambium/core/parameters.hpp"
#include "cambium/observer/observer_model.hpp"

namespace cambium::inline v0_1 {

/// Perceives states and accelerations with a delay of some steps, at most `LongestDelay`. Each record grows by 48 bytes
/// per step of `LongestDelay`. An agent that entered within the delay is seen in the state in which it entered. The
/// delay does not apply to which agents are present and in which order they follow each other.
template <std::size_t LongestDelay>
struct DelayedObserver {
  static_assert(
      LongestDelay > 0,
      "cambium::DelayedObserver<LongestDelay>: give a delay of at least one step, or use cambium::PerfectObserver");

  int others = static_cast<int>(LongestDelay);
  int own = 0;

  static constexpr bool perfect = false;
  static constexpr std::size_t past_steps = LongestDelay;
  static constexpr char const* name = "delayed";
  static constexpr char const* summary = "sees the states with a delay of some steps";
  static constexpr char const* source = "own";
  static constexpr auto parameters() {
    constexpr Range steps{0, static_cast<double>(LongestDelay)};
    return parameter_list(
        parameter("others", &DelayedObserver::others, "-", steps, "delay of the others' states, in steps"),
        parameter("own", &DelayedObserver::own, "-", steps, "delay of its own state, in steps"));
  }

  [[nodiscard]] std::size_t steps_back(bool is_own) const {
    return static_cast<std::size_t>(std::max(0, is_own ? own : others));
  }

  template <MotionState S>
  [[nodiscard]] S const& observe(S const& state, bool, RandomStream const&) const {
    return state;
  }
};
static_assert(ObserverModel<DelayedObserver<1>>);

}  // namespace cambium::inline v0_1
