#pragma once

#include <concepts>
#include <tuple>

#include "cambium/core/random.hpp"
#include "cambium/core/state.hpp"

namespace cambium {

/// How an agent perceives: `observe` gives the state that it believes an agent (itself included) to have. Pure: what is
/// random is drawn from `random`, a stream keyed by (seed, observer, step) with the observed agent as its purpose.
/// `perfect` says that nothing is changed, so that what is seen can be a view of the truth.
template <class O>
concept ObserverModel = std::copyable<O> &&
    requires(O const observer, State const truth, RandomStream const random, bool own) {
  { O::perfect } -> std::convertible_to<bool>;
  { observer.observe(truth, own, random) } -> std::convertible_to<State>;
};

/// Sees the truth.
struct PerfectObserver {
  static constexpr bool perfect = true;
  static constexpr char const* name = "perfect";
  static constexpr auto parameters() { return std::make_tuple(); }

  template <MotionState S>
  [[nodiscard]] S const& observe(S const& truth, bool /*own*/, RandomStream const&) const {
    return truth;
  }
};
static_assert(ObserverModel<PerfectObserver>);

}  // namespace cambium
