#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <string>

#include <boost/container/static_vector.hpp>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/open_loop/external_input.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/parameters.hpp"

namespace cambium::inline v0_1 {

/// An input of `MotionPrimitives`.
struct MotionPrimitive {
  double acceleration = 0.0;  ///< [m/s^2]
  double steering = 0.0;      ///< steering angle, left positive [rad]

  static constexpr char const* name = "motion_primitive";
  static constexpr char const* summary = "one input of `MotionPrimitives`";
  static constexpr auto parameters() {
    using P = MotionPrimitive;
    return parameter_list(
        parameter("acceleration", &P::acceleration, "m/s^2", Range{-50, 50}, "along the heading"),
        parameter("steering", &P::steering, "rad", Range{-1.5, 1.5}, "steering angle, left positive"));
  }

  friend bool operator==(MotionPrimitive const&, MotionPrimitive const&) = default;
};

/// Applies one of a few inputs over each step through the vehicle model. A search or a learner chooses it in the
/// agent's memory (`World::memory`). Ignores lanes and other road users. Never reverses.
struct MotionPrimitives {
  static constexpr std::size_t capacity = 16;
  static constexpr std::uint8_t nothing = 255;  ///< chosen instead of a primitive: coast straight on

  struct Memory {
    std::uint8_t chosen = 0;  ///< index in the list, or `nothing`; any other makes the plan fail

    static constexpr char const* name = "motion_primitives_memory";
    static constexpr auto parameters() {
      using P = Memory;
      return parameter_list(parameter("chosen", &P::chosen, "-", Range{0, 255}, "index in the list"));
    }

    friend bool operator==(Memory, Memory) = default;
  };

  /// The default primitives. (Not a braced list: g++ 12 reports that as uninitialised at -O2.)
  static constexpr MotionPrimitive usual[] = {{0, 0}, {2, 0}, {-3, 0}, {0, 0.1}, {0, -0.1}};

  /// 1 to `capacity` of them.
  boost::container::static_vector<MotionPrimitive, capacity> primitives{std::begin(usual), std::end(usual)};
  InputScheme scheme = InputScheme::rk4;
  double longest_substep = 0.1;

  static constexpr char const* name = "motion_primitives";
  static constexpr char const* summary =
      "carries out one of a few inputs (acceleration, steering) through the vehicle model, as a search chooses";
  static constexpr char const* source = "after BARK";
  static constexpr auto parameters() {
    using P = MotionPrimitives;
    return parameter_list(parameter("primitives", &P::primitives, "the inputs to choose from, 1 to 16"),
                          choice("scheme", &P::scheme, "rk4|euler", "integration of the vehicle model"),
                          parameter("longest_substep", &P::longest_substep, "s", Range{1e-4, 10},
                                    "a step is integrated in equal parts, each at most this long"));
  }

  void check(std::string const& where) const {
    if (primitives.empty()) throw ParameterError(where + ".primitives", "has none", "give 1 to 16");
  }

  /// Creates the behaviour from a list of primitives. Throws `ParameterError` for none, or more than `capacity`.
  [[nodiscard]] static MotionPrimitives of(std::initializer_list<MotionPrimitive> list) {
    if (list.size() == 0 || list.size() > capacity)
      throw ParameterError(name, "has " + std::to_string(list.size()) + " primitives", "give 1 to 16");
    return {.primitives = list};
  }

  [[nodiscard]] std::size_t size() const { return primitives.size(); }

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory const& memory, double dt) const {
    if (memory.chosen >= size() && memory.chosen != nothing) {
      Plan<View> failed;
      failed.status = PlanStatus::failed;
      return failed;
    }
    auto const chosen = memory.chosen != nothing ? primitives[memory.chosen] : MotionPrimitive{};
    return detail::plan_with_input(view, {chosen.acceleration, chosen.steering}, dt, scheme, longest_substep);
  }
};
static_assert(BehaviorModel<MotionPrimitives>);

}  // namespace cambium::inline v0_1
