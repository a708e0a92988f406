#pragma once

#include <algorithm>
#include <cstddef>

#include "cambium/core/parameters.hpp"
#include "cambium/observer/observer_model.hpp"

namespace cambium {

/// Perceives states and accelerations of some steps ago, at most `LongestDelay`, which costs 48 bytes of each record
/// and step. An agent that has entered since is seen as it entered. Who is there at all, and who is next to whom, is
/// seen at once.
template <std::size_t LongestDelay>
struct DelayedObserver {
  static_assert(LongestDelay > 0, "cambium::DelayedObserver<LongestDelay>: see at least one step late, or perfectly");

  int others = static_cast<int>(LongestDelay);
  int own = 0;

  static constexpr bool perfect = false;
  static constexpr std::size_t past_steps = LongestDelay;
  static constexpr char const* name = "delayed";
  static constexpr char const* summary = "sees the states of some steps ago";
  static constexpr char const* source = "own";
  static constexpr auto parameters() {
    constexpr Range steps{0, static_cast<double>(LongestDelay)};
    return parameter_list(
        parameter("others", &DelayedObserver::others, "-", steps, "steps after which others are seen"),
        parameter("own", &DelayedObserver::own, "-", steps, "steps after which the agent knows where itself is"));
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

}  // namespace cambium
