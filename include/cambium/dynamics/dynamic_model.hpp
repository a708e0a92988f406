#pragma once

#include <concepts>

#include "cambium/core/state.hpp"

namespace cambium {

/// A vehicle model: how inputs move a state. `derivative` is pure: no allocation, no hidden state. `State` has the
/// fields of `BasicState` and may add more; `add_scaled(state, derivative, h)` must exist for it. `limited` brings an
/// input within what the vehicle can do in that state.
template <class M>
concept DynamicModel = std::copyable<M> && MotionState<typename M::State> && std::copyable<typename M::Input> &&
    requires(M const model, typename M::State const x, typename M::Input const u, double h) {
  { model.derivative(x, u) } -> std::same_as<typename M::State>;  // [unit/s], field by field; time: 1
  { model.limited(u, x) } -> std::same_as<typename M::Input>;
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

}  // namespace cambium
