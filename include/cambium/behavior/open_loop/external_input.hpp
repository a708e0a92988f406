#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/core/described.hpp"
#include "cambium/dynamics/integration.hpp"

namespace cambium::inline v0_1 {

/// Integration scheme of an input.
enum class InputScheme : std::uint8_t { rk4, euler };

namespace detail {

/// The plan of a vehicle that applies the input `asked` for `dt` [s], within the limits of its own model, in equal
/// parts of at most `longest_substep` [s]. Never reverses: a braking vehicle stays where it stops.
template <class View>
[[nodiscard]] Plan<View> plan_with_input(View const& view, Action const& asked, double dt, InputScheme scheme,
                                         double longest_substep) {
  auto const& model = view.dynamics();
  auto x = view.state();
  x.speed = std::max(0.0, x.speed);
  Plan<View> plan;
  plan.action = action_of(model.input(asked, x), asked);
  auto const steps = static_cast<int>(std::ceil(dt / longest_substep));
  for (int i = 0; i < steps; ++i)
    x = scheme == InputScheme::rk4 ? drive(model, x, asked, dt / steps) : drive<true>(model, x, asked, dt / steps);
  x.time = view.time() + dt;
  plan.trajectory.push_back(x);
  return plan;
}

}  // namespace detail

/// Applies an input (acceleration, steering) from outside: a planner, a search or a learner sets it in the agent's
/// memory by `World::memory`, and the vehicle model carries it out over the step. Ignores lanes and other road users.
/// Never reverses.
struct ExternalInput {
  /// The input until the next one is set.
  struct Memory {
    double acceleration = 0.0;  ///< [m/s^2]
    double steering = 0.0;      ///< steering angle, left positive [rad]

    static constexpr char const* name = "external_input_memory";
    static constexpr auto parameters() {
      using P = Memory;
      return parameter_list(parameter("acceleration", &P::acceleration, "m/s^2", any_finite, "along the heading"),
                            parameter("steering", &P::steering, "rad", any_finite, "steering angle, left positive"));
    }

    friend bool operator==(Memory const&, Memory const&) = default;
  };

  InputScheme scheme = InputScheme::rk4;
  double longest_substep = 0.1;

  static constexpr char const* name = "external_input";
  static constexpr char const* summary =
      "carries out acceleration and steering set from outside, through the vehicle model";
  static constexpr char const* source = "kinematics";
  static constexpr auto parameters() {
    return parameter_list(choice("scheme", &ExternalInput::scheme, "rk4|euler", "integration of the vehicle model"),
                          parameter("longest_substep", &ExternalInput::longest_substep, "s", Range{1e-4, 10},
                                    "a step is integrated in equal parts, each at most this long"));
  }

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory const& memory, double dt) const {
    return detail::plan_with_input(view, {memory.acceleration, memory.steering}, dt, scheme, longest_substep);
  }
};
static_assert(BehaviorModel<ExternalInput>);

}  // namespace cambium::inline v0_1
