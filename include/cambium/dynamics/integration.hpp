#pragma once

#include "cambium/dynamics/dynamic_model.hpp"

namespace cambium {

/// One explicit Euler step over `dt` [s] under a constant input: order 1. State and input may be of any scalar that the
/// model takes.
template <class Model, class State = typename Model::State, class Input = typename Model::Input>
[[nodiscard]] State euler_step(Model const& model, State const& x, Input const& u, double dt) {
  return add_scaled(x, model.derivative(x, u), dt);
}

/// One classical Runge-Kutta step over `dt` [s] under a constant input: order 4.
template <class Model, class State = typename Model::State, class Input = typename Model::Input>
[[nodiscard]] State rk4_step(Model const& model, State const& x, Input const& u, double dt) {
  auto const k1 = model.derivative(x, u);
  auto const k2 = model.derivative(add_scaled(x, k1, dt / 2), u);
  auto const k3 = model.derivative(add_scaled(x, k2, dt / 2), u);
  auto const k4 = model.derivative(add_scaled(x, k3, dt), u);
  return add_scaled(add_scaled(add_scaled(add_scaled(x, k1, dt / 6), k2, dt / 3), k3, dt / 3), k4, dt / 6);
}

}  // namespace cambium
