#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "cambium/behavior/lane_change/macro_actions.hpp"
#include "cambium/behavior/open_loop/external_input.hpp"
#include "cambium/behavior/open_loop/motion_primitives.hpp"
#include "cambium/core/distributions.hpp"

namespace cambium {

/// Accelerations and steering angles from a continuum, for a search with progressive widening; carried out by
/// `ExternalInput`, which must be in the prediction's behaviour set.
struct SampledInputs {
  double lowest_acceleration = -5.0;
  double highest_acceleration = 3.0;
  double largest_steering = 0.05;
  ExternalInput model{};

  static constexpr char const* name = "sampled_inputs";
  static constexpr char const* summary = "acceleration and steering, each uniform in its range";
  static constexpr char const* source = "-";
  static constexpr auto parameters() {
    using P = SampledInputs;
    return parameter_list(
        parameter("lowest_acceleration", &P::lowest_acceleration, "m/s^2", Range{-50, 0}, "hardest braking"),
        parameter("highest_acceleration", &P::highest_acceleration, "m/s^2", Range{0, 50}, "strongest acceleration"),
        parameter("largest_steering", &P::largest_steering, "rad", Range{0, 1.5}, "to either side"),
        parameter("model", &P::model, "-", {}, "how they are carried out"));
  }
};

namespace detail {

/// How a search gives an agent its actions: `Behavior`, what carries them out; `Choice`, what an action is; `list`, or
/// `sample`; `set`, which writes one into the behaviour's memory; `action`, what a choice stands for; `goes_on_alike`,
/// whether the same manoeuvre is under way in two memories.
template <class Actions>
struct ActionSet;

template <>
struct ActionSet<MacroActions> {
  using Behavior = MacroActions;
  using Choice = std::uint8_t;
  static constexpr std::size_t capacity = MacroActions::capacity;

  static MacroActions const& behavior(MacroActions const& actions) { return actions; }
  template <class View>
  static std::size_t list(MacroActions const& actions, View const& view, MacroActions::Memory const& memory,
                          std::span<Choice> out) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < actions.size(); ++i)
      if (actions.available(view, i, memory.change)) out[count++] = static_cast<Choice>(i);
    return count;
  }
  static void set(MacroActions::Memory& memory, Choice choice) { memory.choose(choice); }
  static MacroAction const& action(MacroActions const& actions, Choice choice) { return actions.actions[choice]; }
  static bool goes_on_alike(MacroActions::Memory const& a, MacroActions::Memory const& b) {
    return a.change.target == b.change.target;
  }
  /// What a driver does who does nothing in particular.
  static Choice usual(MacroActions const& actions) {
    for (std::size_t i = 0; i < actions.size(); ++i)
      if (actions.actions[i].kind == MacroAction::Kind::keep_gap) return static_cast<Choice>(i);
    return MacroActions::nothing;
  }
  static std::string text(MacroActions const& actions, Choice choice) {
    auto const& action = actions.actions[choice];
    std::string result = to_string(action.kind);
    if (action.kind != MacroAction::Kind::keep_gap) result += " " + detail::rounded_text(action.acceleration);
    return result;
  }
};

template <>
struct ActionSet<MotionPrimitives> {
  using Behavior = MotionPrimitives;
  using Choice = std::uint8_t;
  static constexpr std::size_t capacity = MotionPrimitives::capacity;

  static MotionPrimitives const& behavior(MotionPrimitives const& actions) { return actions; }
  template <class View>
  static std::size_t list(MotionPrimitives const& actions, View const&, MotionPrimitives::Memory,
                          std::span<Choice> out) {
    for (std::size_t i = 0; i < actions.size(); ++i) out[i] = static_cast<Choice>(i);
    return actions.size();
  }
  static void set(MotionPrimitives::Memory& memory, Choice choice) { memory.chosen = choice; }
  static MotionPrimitive const& action(MotionPrimitives const& actions, Choice choice) {
    return actions.primitives[choice];
  }
  static bool goes_on_alike(MotionPrimitives::Memory, MotionPrimitives::Memory) { return true; }
  static Choice usual(MotionPrimitives const&) { return MotionPrimitives::nothing; }
  static std::string text(MotionPrimitives const& actions, Choice choice) {
    auto const& p = actions.primitives[choice];
    return detail::rounded_text(p.acceleration) + " m/s^2 " + detail::rounded_text(p.steering) + " rad";
  }
};

template <>
struct ActionSet<SampledInputs> {
  using Behavior = ExternalInput;
  using Choice = ExternalInput::Memory;

  static ExternalInput const& behavior(SampledInputs const& actions) { return actions.model; }
  static Choice sample(SampledInputs const& actions, RandomStream& random) {
    Choice choice;
    choice.acceleration = Uniform{actions.lowest_acceleration, actions.highest_acceleration}(random);
    choice.steering = Uniform{-actions.largest_steering, actions.largest_steering}(random);
    return choice;
  }
  static void set(ExternalInput::Memory& memory, Choice const& choice) { memory = choice; }
  static Choice const& action(SampledInputs const&, Choice const& choice) { return choice; }
  static bool goes_on_alike(ExternalInput::Memory const&, ExternalInput::Memory const&) { return true; }
  static Choice usual(SampledInputs const&) { return {}; }
  static std::string text(SampledInputs const&, Choice const& choice) {
    return detail::rounded_text(choice.acceleration) + " m/s^2 " + detail::rounded_text(choice.steering) + " rad";
  }
};

template <class Actions>
concept ListsChoices = requires {
  ActionSet<Actions>::capacity;
};

}  // namespace detail

}  // namespace cambium
