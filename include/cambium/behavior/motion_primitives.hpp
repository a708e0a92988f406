#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <tuple>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/external_input.hpp"
#include "cambium/core/error.hpp"

namespace cambium {

/// An input that a search may choose.
struct MotionPrimitive {
  double acceleration = 0.0;  ///< [m/s^2]
  double steering = 0.0;      ///< steering angle, left positive [rad]

  friend bool operator==(MotionPrimitive const&, MotionPrimitive const&) = default;
};

/// Drives by one of a few inputs, held over each step and carried out by the vehicle model. A search or a learner sets
/// which in the agent's memory (`World::memory`). Heeds neither lanes nor others. Never reverses.
struct MotionPrimitives {
  static constexpr std::size_t capacity = 16;

  struct Memory {
    std::uint8_t chosen = 0;  ///< place in the list; beyond its end: nothing, coasting straight on

    friend bool operator==(Memory, Memory) = default;
  };

  std::array<MotionPrimitive, capacity> primitives{{{0, 0}, {2, 0}, {-3, 0}, {0, 0.1}, {0, -0.1}}};
  int count = 5;
  InputScheme scheme = InputScheme::rk4;
  double longest_substep = 0.1;

  static constexpr char const* name = "motion_primitives";
  static constexpr char const* summary =
      "carries out one of a few inputs (acceleration, steering) through the vehicle model, as a search chooses";
  static constexpr char const* source = "after BARK";
  static constexpr auto parameters() {
    using P = MotionPrimitives;
    return std::make_tuple(
        parameter("count", &P::count, "-", Range{1, capacity}, "how many of the primitives there are"),
        parameter("scheme", &P::scheme, "-", Range{0, 1}, "integration of the vehicle model: 0 RK4, 1 Euler"),
        parameter("longest_substep", &P::longest_substep, "s", Range{1e-4, 10},
                  "a step is integrated in equal parts no longer than this"));
  }

  /// Throws `ParameterError` where a primitive is no finite number.
  void check(std::string const& where) const {
    for (auto const& p : primitives)
      if (!(std::abs(p.acceleration) <= 50.0 && std::abs(p.steering) <= 1.5))
        throw ParameterError(where, "has a primitive beyond 50 m/s^2 or 1.5 rad", "give what a vehicle can do");
  }

  /// With these primitives. Throws `ParameterError` for none, or more than `capacity`.
  [[nodiscard]] static MotionPrimitives of(std::initializer_list<MotionPrimitive> list) {
    if (list.size() == 0 || list.size() > capacity)
      throw ParameterError(name, "has " + std::to_string(list.size()) + " primitives", "give 1 to 16");
    MotionPrimitives result;
    std::copy(list.begin(), list.end(), result.primitives.begin());
    result.count = static_cast<int>(list.size());
    return result;
  }

  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(count); }

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory const& memory, double dt) const {
    auto const chosen = memory.chosen < size() ? primitives[memory.chosen] : MotionPrimitive{};
    return plan_with_input(view, {chosen.acceleration, chosen.steering}, dt, scheme, longest_substep);
  }
};
static_assert(BehaviorModel<MotionPrimitives>);

}  // namespace cambium
