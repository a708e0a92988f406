#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>

#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/drivers.hpp"
#include "cambium/behavior/actions/driver_actions.hpp"
#include "cambium/behavior/actions/macro_actions.hpp"
#include "cambium/behavior/open_loop/external_input.hpp"
#include "cambium/behavior/open_loop/motion_primitives.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/planner/predicted.hpp"

namespace cambium::inline v0_1 {

/// Accelerations and steering angles from a continuum, for a search with progressive widening. `ExternalInput`, which
/// must be in the behaviour set of the prediction world, carries them out.
struct SampledInputs {
  double lowest_acceleration = -5.0;
  double highest_acceleration = 3.0;
  double largest_steering = 0.05;
  ExternalInput model{};

  static constexpr char const* name = "sampled_inputs";
  static constexpr char const* summary = "acceleration and steering, each drawn uniformly from its range";
  static constexpr char const* source = "-";
  static constexpr auto parameters() {
    using P = SampledInputs;
    return parameter_list(
        parameter("lowest_acceleration", &P::lowest_acceleration, "m/s^2", Range{-50, 0}, "hardest braking"),
        parameter("highest_acceleration", &P::highest_acceleration, "m/s^2", Range{0, 50}, "strongest acceleration"),
        parameter("largest_steering", &P::largest_steering, "rad", Range{0, 1.5}, "largest angle to either side"),
        parameter("model", &P::model, "carries out the inputs"));
  }
};

/// How a search uses `Actions`, a struct that describes what an agent may do. Specialise it for your own actions:
///
/// - `Behavior`: the model that carries out the actions; it must be in the behaviour set of the prediction world.
///   `static Behavior const& behavior(Actions const&)` returns it.
/// - `Choice`: represents an action in the tree; comparable by ==. `static void set(Behavior::Memory&, Choice)` makes
///   the behaviour carry it out from now on.
/// - `static std::size_t list(Actions const&, View const&, Behavior::Memory const&, std::span<Choice> out)` writes the
///   available choices to `out` and returns their number, at most `static constexpr std::size_t capacity`. For a
///   continuum instead: `static Choice sample(Actions const&, RandomStream&)`.
/// - `static Choice usual(Actions const&)`: the choice of a driver without any manoeuvre in mind. If such a driver is
///   careful, `static constexpr bool usual_drives = true`: roll-outs then follow it.
/// - `static auto action(Actions const&, Choice)`: the action behind a choice, as passed to `RewardModel::prior`.
///   `static std::string text(Actions const&, Choice)`: the same in words.
/// - `static bool goes_on_alike(Behavior::Memory const&, Behavior::Memory const&)`: whether both are in the middle of
///   the same manoeuvre. A kept tree is continued only then.
///
/// `Actions` itself must be described.
template <class Actions>
struct ActionSet;

/// Whether there is an `ActionSet<Actions>`.
template <class Actions>
concept SearchActions = Described<Actions> &&
    requires(Actions const& actions, typename ActionSet<Actions>::Choice choice,
             typename ActionSet<Actions>::Behavior::Memory& memory) {
  ActionSet<Actions>::behavior(actions);
  ActionSet<Actions>::set(memory, choice);
  { ActionSet<Actions>::usual(actions) } -> std::same_as<typename ActionSet<Actions>::Choice>;
  ActionSet<Actions>::action(actions, choice);
  { ActionSet<Actions>::text(actions, choice) } -> std::same_as<std::string>;
  { ActionSet<Actions>::goes_on_alike(memory, memory) } -> std::same_as<bool>;
};

template <class Law, class... Heeds>
struct ActionSet<BasicMacroActions<Law, Heeds...>> {
  using Behavior = BasicMacroActions<Law, Heeds...>;
  using Memory = typename Behavior::Memory;
  using Choice = std::uint8_t;
  static constexpr std::size_t capacity = Behavior::capacity;
  static constexpr bool usual_drives = true;

  static Behavior const& behavior(Behavior const& actions) { return actions; }
  template <class View>
  static std::size_t list(Behavior const& actions, View const& view, Memory const& memory, std::span<Choice> out) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < actions.size(); ++i)
      if (actions.available(view, i, memory.change)) out[count++] = static_cast<Choice>(i);
    return count;
  }
  static void set(Memory& memory, Choice choice) { memory.choose(choice); }
  static MacroAction const& action(Behavior const& actions, Choice choice) { return actions.actions[choice]; }
  static bool goes_on_alike(Memory const& a, Memory const& b) { return a.change.target == b.change.target; }
  static Choice usual(Behavior const& actions) { return actions.keeping_gap(); }
  static std::string text(Behavior const& actions, Choice choice) {
    auto const& action = actions.actions[choice];
    std::string result = to_string(action.kind);
    if (action.kind != MacroAction::Kind::keep_gap) result += " " + detail::rounded_text(action.acceleration);
    return result;
  }
};

template <class Driver>
struct ActionSet<DriverActions<Driver>> {
  using Behavior = DriverActions<Driver>;
  using Memory = typename Behavior::Memory;
  using Macro = ActionSet<typename Behavior::Macro>;
  using Choice = typename Macro::Choice;
  static constexpr std::size_t capacity = Macro::capacity + 1;
  static constexpr bool usual_drives = true;

  static Behavior const& behavior(Behavior const& actions) { return actions; }
  template <class View>
  static std::size_t list(Behavior const& actions, View const& view, Memory const& memory, std::span<Choice> out) {
    out[0] = Behavior::drive;
    return 1 + Macro::list(actions.macro, view, memory.macro, out.subspan(1));
  }
  static void set(Memory& memory, Choice choice) { memory.choose(choice); }
  /// To drive counts as `keep_gap`.
  static MacroAction action(Behavior const& actions, Choice choice) {
    if (choice == Behavior::drive) return {MacroAction::Kind::keep_gap};
    return Macro::action(actions.macro, choice);
  }
  static bool goes_on_alike(Memory const& a, Memory const& b) { return Macro::goes_on_alike(a.macro, b.macro); }
  static Choice usual(Behavior const&) { return Behavior::drive; }
  static std::string text(Behavior const& actions, Choice choice) {
    return choice == Behavior::drive ? "drive" : Macro::text(actions.macro, choice);
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

static_assert(SearchActions<MacroActions> && SearchActions<MotionPrimitives> && SearchActions<SampledInputs>);

namespace detail {
/// Whether the actions are a list rather than a continuum.
template <class Actions>
concept ListsChoices = requires {
  ActionSet<Actions>::capacity;
};

/// The first behaviour of the set that obeys the rules at junctions; without one, `IdmClassic`.
template <class First, class... Rest>
[[nodiscard]] constexpr auto usual_driver(std::type_identity<BehaviorSet<First, Rest...>>) {
  if constexpr (heeds_conflicts<First>())
    return std::type_identity<First>{};
  else if constexpr (sizeof...(Rest) > 0)
    return usual_driver(std::type_identity<BehaviorSet<Rest...>>{});
  else
    return std::type_identity<IdmClassic>{};
}

/// What a planner that predicts in `PredictionWorld` expects of the others unless told otherwise.
template <class PredictionWorld>
[[nodiscard]] constexpr auto usual_others() {
  if constexpr (is_world<PredictionWorld>)
    return usual_driver(std::type_identity<typename PredictionWorld::Behaviors>{});
  else
    return std::type_identity<IdmClassic>{};  // `check_planner` reports it
}
template <class PredictionWorld>
using UsualDriver = typename decltype(usual_others<PredictionWorld>())::type;

/// What it chooses from unless told otherwise: macro actions, or to drive like the usual driver if the set permits.
template <class PredictionWorld, class Driving = DriverActions<UsualDriver<PredictionWorld>>>
using UsualActions = std::conditional_t<HasBehavior<PredictionWorld, Driving>, Driving, MacroActions>;

}  // namespace detail

}  // namespace cambium::inline v0_1
