#pragma once

#include <algorithm>
#include <cmath>

#include "cambium/dynamics/dynamic_model.hpp"

namespace cambium::inline v0_1 {

/// One explicit Euler step over `dt` [s] with a constant input; order 1. State and input may have any scalar type that
/// the model takes.
template <class Model, class State = typename Model::State, class Input = typename Model::Input>
[[nodiscard]] State euler_step(Model const& model, State const& x, Input const& u, double dt) {
  return add_scaled(x, model.derivative(x, u), dt);
}

/// One classical Runge-Kutta step over `dt` [s] with a constant input; order 4.
template <class Model, class State = typename Model::State, class Input = typename Model::Input>
[[nodiscard]] State rk4_step(Model const& model, State const& x, Input const& u, double dt) {
  auto const k1 = model.derivative(x, u);
  auto const k2 = model.derivative(add_scaled(x, k1, dt / 2), u);
  auto const k3 = model.derivative(add_scaled(x, k2, dt / 2), u);
  auto const k4 = model.derivative(add_scaled(x, k3, dt), u);
  return add_scaled(add_scaled(add_scaled(add_scaled(x, k1, dt / 6), k2, dt / 3), k3, dt / 3), k4, dt / 6);
}

namespace detail {

/// One step of `drive`. It is cut in two where the speed would exceed the model's `highest_speed` or fall below 0.
template <bool euler, class Model>
[[nodiscard]] typename Model::State drive_step(Model const& model, typename Model::State x, Action const& action,
                                               double dt) {
  if constexpr (requires { model.driven(x, action, dt); }) return model.driven(x, action, dt);
  auto const go = [&](auto const& u, double duration) {
    if (!(duration > 0.0)) return;
    if constexpr (euler)
      x = euler_step(model, x, u, duration);
    else
      x = rk4_step(model, x, u, duration);
  };
  auto u = model.input(action, x);
  double const end = x.time + dt;
  double change = model.derivative(x, u).speed;
  if constexpr (requires { double{model.highest_speed}; }) {
    double const room = std::max(0.0, model.highest_speed - x.speed);
    if (change * dt > room) {
      double const rising = room / change, top = std::max(x.speed, double{model.highest_speed});
      go(u, rising);
      x.speed = top;
      u = model.input({std::min(0.0, action.acceleration), action.steering}, x);
      change = model.derivative(x, u).speed;
      dt -= rising;
    }
  }
  double const moving = x.speed + change * dt < 0.0 ? x.speed / -change : dt;
  go(u, moving);
  if (moving < dt) x.speed = 0.0;
  x.speed = std::max(0.0, x.speed);
  x.time = end;
  return x;
}

}  // namespace detail

/// State of a vehicle after its driver has held `action` for `dt` [s], within the model's limits. Takes one Runge-Kutta
/// (or Euler) step; for a model with a `response_time`, several equal steps no longer than that. A model with a
/// function `driven(state, action, dt)` uses that instead. The vehicle never reverses: after braking to a standstill it
/// stays there, and after reaching the model's `highest_speed` it accelerates no further.
template <bool euler = false, DynamicModel Model>
[[nodiscard]] typename Model::State drive(Model const& model, typename Model::State x, Action const& action,
                                          double dt) {
  x.speed = std::max(0.0, x.speed);
  if constexpr (requires { double{model.response_time}; }) {
    int const steps = std::max(1, static_cast<int>(std::ceil(dt / model.response_time - 1e-9)));
    for (int i = 0; i < steps; ++i) x = detail::drive_step<euler>(model, x, action, dt / steps);
    return x;
  } else {
    return detail::drive_step<euler>(model, x, action, dt);
  }
}

}  // namespace cambium::inline v0_1
