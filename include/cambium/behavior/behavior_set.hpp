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

namespace cambium {

namespace detail {
/// Plans by a behaviour that has a workspace: not part of a flattened step, which would take in a whole search.
template <class B, class View, class Memory, class Workspace>
CAMBIUM_NOINLINE [[nodiscard]] Plan<View> plan_apart(B const& behavior, View const& view, Memory& memory, double dt,
                                                     Workspace& workspace) {
  return behavior.plan(view, memory, dt, workspace);
}
/// Plans by one of many behaviours, in a flattened function of its own: a step that took in all of them would compile
/// more than twice as long, and run no faster.
template <class B, class View, class Memory>
CAMBIUM_NOINLINE CAMBIUM_FLATTEN [[nodiscard]] Plan<View> plan_apart(B const& behavior, View const& view,
                                                                     Memory& memory, double dt) {
  return behavior.plan(view, memory, dt);
}
/// A step inlines the plans of at most so many behaviours (those with a workspace do not count); of more, each plan is
/// a function of its own.
inline constexpr std::size_t most_plans_in_step = 4;
}  // namespace detail

/// The closed set of behaviours that the agents of a world may have. An agent has one of them with parameters of its
/// own.
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

  /// What planning works with, one for each behaviour.
  using Workspaces = std::tuple<WorkspaceOf<Behaviors>...>;

  /// Whether `B` is one of the set.
  template <class B>
  static constexpr bool contains = Any::template contains<B>;

  /// Whether some of them ask for neighbours in the lanes beside: then those are worth being loaded ahead.
  static constexpr bool looks_beside = (detail::looks_beside<Behaviors>() || ...);

  /// Whether some of them ask for who is around, on whatever lane: then worlds keep an index of the plane.
  static constexpr bool looks_around = (detail::looks_around<Behaviors>() || ...);

  /// Place of `B` in the set.
  template <class B>
  static constexpr std::size_t index = Any::template place<B>;

  /// The memory an agent starts with.
  [[nodiscard]] static Memory initial_memory(Any const& behavior) {
    return behavior.visit([](auto const&, auto place) { return Memory(std::in_place_index<place>); });
  }

  /// When the behaviour begins [s]; until then the agent is not in traffic. -infinity where it does not say so.
  [[nodiscard]] static double start_time(Any const& behavior) {
    return behavior.visit([](auto const& model) {
      if constexpr (requires { model.start_time(); })
        return static_cast<double>(model.start_time());
      else
        return -std::numeric_limits<double>::infinity();
    });
  }

  /// Calls the agent's own behaviour with its own memory. One well-predicted branch per alternative, no virtual call.
  template <class View>
  [[nodiscard]] static Plan<View> plan(Any const& behavior, View const& view, Memory& memory, double dt,
                                       Workspaces& workspaces) {
    return behavior.visit([&](auto const& model, auto place) -> Plan<View> {
      using Workspace = std::tuple_element_t<place, Workspaces>;
      auto& own = *std::get_if<place>(&memory);
      if constexpr (!std::is_same_v<Workspace, NoWorkspace>)
        return detail::plan_apart(model, view, own, dt, std::get<place>(workspaces));
      else if constexpr ((std::size_t{std::is_same_v<WorkspaceOf<Behaviors>, NoWorkspace>} + ...) >
                         detail::most_plans_in_step)
        return detail::plan_apart(model, view, own, dt);
      else
        return model.plan(view, own, dt);
    });
  }
};

template <class T>
inline constexpr bool is_behavior_set = false;
template <class... Behaviors>
inline constexpr bool is_behavior_set<BehaviorSet<Behaviors...>> = true;

}  // namespace cambium
