#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>

#include "cambium/core/ids.hpp"
#include "cambium/core/random.hpp"
#include "cambium/core/state.hpp"

namespace cambium {

/// How an agent perceives: `observe` gives the state that it believes an agent (itself included) to have. Pure: what is
/// random is drawn from `random`, a stream keyed by (seed, observer, step) with the observed agent as its purpose.
/// `perfect` says that nothing is changed, so that what is seen can be a view of the truth.
///
/// An observer may have more:
/// - `template <class Scene> bool sees(Scene const& scene, Slot own, Slot other) const`: whether the
///   agent in slot `own` perceives that in slot `other` at all (see `ObserverScene`);
/// - `template <class Scene> bool sees_object(Scene const& scene, Slot own, Slot object) const`:
///   likewise static objects, by their place among them;
/// - `static constexpr std::size_t past_steps` and `std::size_t steps_back(bool own) const`: it perceives states of up
///   to `past_steps` steps ago, which the world then keeps in its records.
template <class O>
concept ObserverModel = std::copyable<O> &&
    requires(O const observer, State const truth, RandomStream const random, bool own) {
  { O::perfect } -> std::convertible_to<bool>;
  { observer.observe(truth, own, random) } -> std::convertible_to<State>;
};

/// Whether observer `O` does not see everybody.
template <class O, class Scene>
concept LimitedSight = requires(O const observer, Scene const scene, Slot slot) {
  { observer.sees(scene, slot, slot) } -> std::convertible_to<bool>;
};

/// Whether observer `O` does not see all static objects.
template <class O, class Scene>
concept LimitedSightOfObjects = requires(O const observer, Scene const scene, Slot slot) {
  { observer.sees_object(scene, slot, slot) } -> std::convertible_to<bool>;
};

/// How many steps back observer `O` may look.
template <class O>
inline constexpr std::size_t past_steps_of = 0;
template <class O>
requires requires { O::past_steps; }
inline constexpr std::size_t past_steps_of<O> = O::past_steps;

/// How many steps back this one looks, at itself or at others.
template <class O>
[[nodiscard]] std::size_t steps_back(O const& observer, bool own) {
  if constexpr (past_steps_of < O >> 0)
    return std::min(observer.steps_back(own), O::past_steps);
  else
    return 0;
}

/// The record's part of worlds whose observers see the present.
struct NoPast {
  friend bool operator==(NoPast, NoPast) = default;
};

/// What others see late of an agent: its last states and accelerations, the latest first.
template <MotionState S, std::size_t Steps>
struct PastStates {
  std::array<S, Steps> states{};
  std::array<double, Steps> accelerations{};  ///< [m/s^2]

  /// One step on.
  void push(S const& state, double acceleration) {
    std::copy_backward(states.begin(), states.end() - 1, states.end());
    std::copy_backward(accelerations.begin(), accelerations.end() - 1, accelerations.end());
    states.front() = state;
    accelerations.front() = acceleration;
  }

  /// As if the agent had always been there.
  void fill(S const& state) {
    states.fill(state);
    accelerations.fill(0.0);
  }

  friend bool operator==(PastStates const&, PastStates const&) = default;
};

}  // namespace cambium
