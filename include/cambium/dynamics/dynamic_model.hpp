#pragma once

#include <concepts>

#include "cambium/core/constants.hpp"
#include "cambium/core/described.hpp"
#include "cambium/core/plan.hpp"
#include "cambium/core/state.hpp"

namespace cambium::inline v0_1 {

/// A vehicle model: how inputs change a state. A model has
///   - `State`, with the fields of `BasicState` and maybe more, all of them described; or with an `add_scaled(state,
///     derivative, h)` of its own;
///   - `derivative`, pure: no allocation, no hidden state;
///   - `limited`, which restricts an input to what the vehicle can do in its state;
///   - `input`, which translates a driver's action (acceleration, steering angle) to an input within the same limits;
///     with it, behaviours and controllers can drive any model;
///   - optionally `wheel_base` [m], see `wheel_base_of`, and, for `drive`, the fields `double highest_speed` [m/s] and
///     `double response_time` [s], above 0, or a function `driven(state, action, dt)`.
template <class M>
concept DynamicModel = std::copyable<M> && MotionState<typename M::State> && std::copyable<typename M::Input> &&
    requires(M const model, typename M::State const x, typename M::Input const u, Action const action, double h) {
  { model.derivative(x, u) } -> std::same_as<typename M::State>;  // [unit/s], field by field; time: 1
  { model.limited(u, x) } -> std::same_as<typename M::Input>;
  { model.input(action, x) } -> std::same_as<typename M::Input>;
  { add_scaled(x, x, h) } -> std::same_as<typename M::State>;
};

/// `state + h * derivative`, for each field that the state describes; `h` in [s].
template <MotionState S>
requires Described<S>
[[nodiscard]] S add_scaled(S const& state, S const& derivative, double h) {
  auto const s = decltype(S::time)(h);
  S sum;
  for_each_parameter<S>([&](auto const& of) { sum.*of.field = state.*of.field + s * derivative.*of.field; });
  return sum;
}

/// Distance from the reference point forward to the steered axle [m]: the model's `wheel_base`, a field or a function;
/// if it has none, that of a car.
template <class M>
[[nodiscard]] double wheel_base_of(M const& model) {
  if constexpr (requires { model.wheel_base(); })
    return model.wheel_base();
  else if constexpr (requires { double{model.wheel_base}; })
    return model.wheel_base;
  else
    return car_wheel_base;
}

/// The action that a driver carried out after `asked` was translated to `input`: the input itself if it consists of an
/// acceleration and a steering angle, else `asked`.
template <class Input>
[[nodiscard]] Action action_of(Input const& input, Action const& asked) {
  if constexpr (requires { Action{input.acceleration, input.steering}; })
    return {input.acceleration, input.steering};
  else
    return asked;
}

}  // namespace cambium::inline v0_1
