#pragma once

#include <cstddef>
#include <limits>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/one_of.hpp"

namespace cambium::inline v0_1 {

namespace detail {
/// Plans in a function of its own, with the workspace if there is one. A step that inlined every behaviour of a large
/// set would take more than twice as long to compile and run no faster; a flattened one must not inline a whole search.
template <class B, class View, class Memory, class... Workspace>
CAMBIUM_NOINLINE [[nodiscard]] Plan<View> plan_apart(B const& behavior, View const& view, Memory& memory, double dt,
                                                     Workspace&... workspace) {
  return behavior.plan(view, memory, dt, workspace...);
}
/// Plans in a flattened function of its own.
template <class B, class View, class Memory>
CAMBIUM_NOINLINE CAMBIUM_FLATTEN [[nodiscard]] Plan<View> plan_flattened(B const& behavior, View const& view,
                                                                         Memory& memory, double dt) {
  return behavior.plan(view, memory, dt);
}
/// A step inlines the plans of at most this many behaviours (those with a workspace do not count).
inline constexpr std::size_t most_plans_in_step = 4;
}  // namespace detail

/// The closed set of behaviours that the agents of a world may have. Each agent has one of them, with its own
/// parameters.
template <class... Behaviors>
struct BehaviorSet {
  static_assert(sizeof...(Behaviors) > 0,
                "cambium::BehaviorSet<...>: name at least one behaviour, as in BehaviorSet<cambium::IdmClassic>");
  static_assert((detail::check_behavior<Behaviors>() && ...));
  static_assert(
      detail::all_different<Behaviors...>,
      "cambium::BehaviorSet<...>: name each behaviour once; agents of one model have parameters of their own");

  using Any = OneOf<Behaviors...>;
  using Memory = std::variant<MemoryOf<Behaviors>...>;

  /// Scratch memory for planning, one for each behaviour.
  using Workspaces = std::tuple<WorkspaceOf<Behaviors>...>;

  /// Whether `B` is in the set.
  template <class B>
  static constexpr bool contains = Any::template contains<B>;

  /// Whether any behaviour asks for neighbours in the lanes beside; worlds then prefetch them.
  static constexpr bool looks_beside = (detail::looks_beside<Behaviors>() || ...);

  /// Whether any behaviour asks for neighbours in the plane; worlds then keep an index of it.
  static constexpr bool looks_around = (detail::looks_around<Behaviors>() || ...);

  /// Whether any behaviour heeds conflicts: it searches in many lanes.
  static constexpr bool heeds_conflicts = (detail::heeds_conflicts<Behaviors>() || ...);

  /// Index of `B` in the set.
  template <class B>
  static constexpr std::size_t index = Any::template place<B>;

  /// The memory with which an agent starts.
  [[nodiscard]] static Memory initial_memory(Any const& behavior) {
    return behavior.visit([](auto const&, auto place) { return Memory(std::in_place_index<place>); });
  }

  /// Tells a memory that `World::set_state` has moved the vehicle, see `BehaviorModel`.
  static void was_set(Memory& memory) {
    std::visit([](auto& own) { cambium::was_set(own); }, memory);
  }

  /// When the agent enters traffic [s]; -infinity if the behaviour does not say.
  [[nodiscard]] static double start_time(Any const& behavior) {
    return behavior.visit([](auto const& model) {
      if constexpr (requires { model.start_time(); })
        return static_cast<double>(model.start_time());
      else
        return -std::numeric_limits<double>::infinity();
    });
  }

  /// Plans by the agent's behaviour with its memory. One well-predicted branch per alternative, no virtual call.
  /// `flattens`: whether each behaviour that plans in a function of its own is flattened there.
  template <bool flattens = true, class View>
  [[nodiscard]] static Plan<View> plan(Any const& behavior, View const& view, Memory& memory, double dt,
                                       Workspaces& workspaces) {
    constexpr bool plans_apart =
        (std::size_t{std::is_same_v<WorkspaceOf<Behaviors>, NoWorkspace>} + ...) > detail::most_plans_in_step;
    return behavior.visit([&](auto const& model, auto place) -> Plan<View> {
      using Workspace = std::tuple_element_t<place, Workspaces>;
      auto& own = *std::get_if<place>(&memory);
      if constexpr (!std::is_same_v<Workspace, NoWorkspace>)
        return detail::plan_apart(model, view, own, dt, std::get<place>(workspaces));
      else if constexpr (!plans_apart)
        return model.plan(view, own, dt);
      else if constexpr (flattens)
        return detail::plan_flattened(model, view, own, dt);
      else
        return detail::plan_apart(model, view, own, dt);
    });
  }
};

/// Whether `T` is a `BehaviorSet`.
template <class T>
inline constexpr bool is_behavior_set = false;
template <class... Behaviors>
inline constexpr bool is_behavior_set<BehaviorSet<Behaviors...>> = true;

}  // namespace cambium::inline v0_1
