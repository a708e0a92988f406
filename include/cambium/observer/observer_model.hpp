#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>

#include "cambium/core/described.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/random.hpp"
#include "cambium/core/state.hpp"

namespace cambium::inline v0_1 {

/// A model of an agent's perception: `observe` returns the state that the agent believes another agent, or itself, to
/// be in. Pure: random numbers come from `random`, a stream keyed by (seed, observer, step) with the observed agent as
/// its purpose. `perfect` says that the observer changes nothing, so that views can return references to the true
/// states.
///
/// Optional members:
/// - `template <class Scene> bool sees(Scene const& scene, Slot own, Slot other) const`: whether the
///   agent in slot `own` perceives the agent in slot `other` (see `ObserverScene`);
/// - `template <class Scene> bool sees_object(Scene const& scene, Slot own, Slot object) const`:
///   whether it perceives the static object with index `object`;
/// - `static constexpr std::size_t past_steps` and `std::size_t steps_back(bool own) const`: it perceives states up
///   to `past_steps` steps old, which the world then keeps in its records.
template <class O>
concept ObserverModel = std::copyable<O> &&
    requires(O const observer, State const truth, RandomStream const random, bool own) {
  { O::perfect } -> std::convertible_to<bool>;
  { observer.observe(truth, own, random) } -> std::convertible_to<State>;
};

/// An observer that may hide agents.
template <class O, class Scene>
concept LimitedSight = requires(O const observer, Scene const scene, Slot slot) {
  { observer.sees(scene, slot, slot) } -> std::convertible_to<bool>;
};

/// An observer that may hide static objects.
template <class O, class Scene>
concept LimitedSightOfObjects = requires(O const observer, Scene const scene, Slot slot) {
  { observer.sees_object(scene, slot, slot) } -> std::convertible_to<bool>;
};

/// Whether an observer perceives the agent in slot `other`; true of one that hides none.
template <class O, class Scene>
[[nodiscard]] bool sees_agent(O const& observer, Scene const& scene, Slot own, Slot other) {
  if constexpr (LimitedSight<O, Scene>)
    return observer.sees(scene, own, other);
  else
    return true;
}
/// Whether an observer perceives the static object with index `object`; true of one that hides none.
template <class O, class Scene>
[[nodiscard]] bool sees_object(O const& observer, Scene const& scene, Slot own, Slot object) {
  if constexpr (LimitedSightOfObjects<O, Scene>)
    return observer.sees_object(scene, own, object);
  else
    return true;
}

/// Largest delay of observer type `O` [steps].
template <class O>
inline constexpr std::size_t past_steps_of = 0;
template <class O>
requires requires { O::past_steps; }
inline constexpr std::size_t past_steps_of<O> = O::past_steps;

/// This observer's delay [steps], for itself or for others.
template <class O>
[[nodiscard]] std::size_t steps_back(O const& observer, bool own) {
  if constexpr (past_steps_of < O >> 0)
    return std::min(observer.steps_back(own), O::past_steps);
  else
    return 0;
}

/// Replaces `PastStates` in worlds whose observers have no delay.
struct NoPast {
  static constexpr char const* name = "no_past";
  static constexpr auto parameters() { return parameter_list(); }

  friend bool operator==(NoPast, NoPast) = default;
};

/// An agent's last states and accelerations, latest first, for delayed observers.
template <MotionState S, std::size_t Steps>
struct PastStates {
  std::array<S, Steps> states{};
  std::array<double, Steps> accelerations{};  ///< [m/s^2]

  /// Adds the state of one more step; drops the oldest.
  void push(S const& state, double acceleration) {
    std::copy_backward(states.begin(), states.end() - 1, states.end());
    std::copy_backward(accelerations.begin(), accelerations.end() - 1, accelerations.end());
    states.front() = state;
    accelerations.front() = acceleration;
  }

  /// Fills the past with one state, as if the agent had always been there.
  void fill(S const& state) {
    states.fill(state);
    accelerations.fill(0.0);
  }

  static constexpr char const* name = "past_states";
  static constexpr auto parameters() {
    using P = PastStates;
    return parameter_list(parameter("states", &P::states, "latest first"),
                          parameter("accelerations", &P::accelerations, "m/s^2", any_finite, "likewise"));
  }

  friend bool operator==(PastStates const&, PastStates const&) = default;
};

}  // namespace cambium::inline v0_1
