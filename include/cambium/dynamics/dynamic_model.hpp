#pragma once

#include <concepts>

#include "cambium/core/plan.hpp"
#include "cambium/core/state.hpp"

namespace cambium {

/// A vehicle model: how inputs move a state. `derivative` is pure: no allocation, no hidden state. `State` has the
/// fields of `BasicState` and may add more; `add_scaled(state, derivative, h)` must exist for it. `limited` brings an
/// input within what the vehicle can do in that state. `input` is what a driver's action (acceleration, steering angle)
/// means for this vehicle, within the same limits: with it behaviours and controllers drive any model. It may have
/// `wheel_base` [m], see `wheel_base_of`; and, see `drive`, the fields `double highest_speed` [m/s] and `double
/// response_time` [s], above 0, or a function `driven(state, action, dt)`.
template <class M>
concept DynamicModel = std::copyable<M> && MotionState<typename M::State> && std::copyable<typename M::Input> &&
    requires(M const model, typename M::State const x, typename M::Input const u, Action const action, double h) {
  { model.derivative(x, u) } -> std::same_as<typename M::State>;  // [unit/s], field by field; time: 1
  { model.limited(u, x) } -> std::same_as<typename M::Input>;
  { model.input(action, x) } -> std::same_as<typename M::Input>;
  { add_scaled(x, x, h) } -> std::same_as<typename M::State>;
};

/// `state + h * derivative`, field by field; `h` in [s].
template <class Scalar>
[[nodiscard]] BasicState<Scalar> add_scaled(BasicState<Scalar> const& state, BasicState<Scalar> const& derivative,
                                            double h) {
  auto const s = Scalar(h);
  return {state.time + s * derivative.time, state.x + s * derivative.x, state.y + s * derivative.y,
          state.heading + s * derivative.heading, state.speed + s * derivative.speed};
}

/// How far ahead of the reference point a vehicle is steered [m]: the model's `wheel_base`, a field or a function; that
/// of a car where it has none.
template <class M>
[[nodiscard]] double wheel_base_of(M const& model) {
  if constexpr (requires { model.wheel_base(); })
    return model.wheel_base();
  else if constexpr (requires { double{model.wheel_base}; })
    return model.wheel_base;
  else
    return 2.7;
}

/// What a driver did whose `asked` action became `input`: the input itself where that is an acceleration and a steering
/// angle, else what was asked.
template <class Input>
[[nodiscard]] Action action_of(Input const& input, Action const& asked) {
  if constexpr (requires { Action{input.acceleration, input.steering}; })
    return {input.acceleration, input.steering};
  else
    return asked;
}

}  // namespace cambium
