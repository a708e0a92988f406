#pragma once

#include <concepts>
#include <type_traits>

#include "cambium/behavior/view.hpp"

namespace cambium::inline v0_1 {

/// The workspace of a behaviour that needs none.
struct NoWorkspace {};

namespace detail {
template <class B>
[[nodiscard]] constexpr auto memory_of() {
  if constexpr (requires { typename B::Memory; })
    return std::type_identity<typename B::Memory>{};
  else
    return std::type_identity<NoMemory>{};
}
template <class B>
[[nodiscard]] constexpr auto workspace_of() {
  if constexpr (requires { typename B::Workspace; })
    return std::type_identity<typename B::Workspace>{};
  else
    return std::type_identity<NoWorkspace>{};
}
}  // namespace detail

/// What behaviour `B` remembers between steps: its `Memory`, or `NoMemory`.
template <class B>
using MemoryOf = typename decltype(detail::memory_of<B>())::type;

/// The scratch memory of behaviour `B`: its `Workspace`, or `NoWorkspace`.
template <class B>
using WorkspaceOf = typename decltype(detail::workspace_of<B>())::type;

/// A behaviour: a copyable struct of parameters with one function template
///   `template <class View> Plan<View> plan(View const& view, Memory& memory, double dt) const`
/// that plans the agent's motion over the next `dt` [s]. It changes nothing but `memory`, allocates nothing and throws
/// nothing. A world calls it once a step, on a view of frame k; `memory` belongs to the agent, lives in the frame and
/// is copied with it. A behaviour may further have
/// - `memory.fell_short(way, left_course)`, if its memory holds how far the vehicle is along a course: see
///   `fell_short`.
/// - `memory.was_set()`, if it infers a manoeuvre from the motion with which the vehicle enters: `World::set_state` has
///   moved the vehicle, and the memory stays.
/// - `double start_time() const` [s]: an agent that is added earlier enters traffic only then.
/// - a default constructible `Workspace`, if planning needs much scratch memory, as a search does; `plan` then takes a
///   reference to one after `dt`. It belongs to the world, serves one agent after the other and is not copied, so its
///   content must not influence the plan.
///
/// Three constants, false by default, tell the world what to prepare:
/// - `static constexpr bool looks_beside`: the behaviour asks for places in the lanes beside; large worlds then
///   prefetch them. No result depends on it.
/// - `static constexpr bool looks_around`: the behaviour calls `view.around(distance, f)` in each step; worlds then
///   keep an index of the plane, and the call takes no longer in a large world.
/// - `static constexpr bool heeds_conflicts`: the behaviour relies on `LaneCorridor::conflicts`; worlds then refuse
///   agents larger than the shapes for which the map computed its conflicts.
template <class B>
concept BehaviorModel = std::copyable<B> && std::copyable<MemoryOf<B>> && std::default_initializable<MemoryOf<B>> &&(
    requires(B const behavior, ViewArchetype const view, MemoryOf<B> memory, double dt) {
      { behavior.plan(view, memory, dt) } -> std::same_as<Plan<ViewArchetype>>;
    } ||
    requires(B const behavior, ViewArchetype const view, MemoryOf<B> memory, double dt, WorkspaceOf<B>& workspace) {
      { behavior.plan(view, memory, dt, workspace) } -> std::same_as<Plan<ViewArchetype>>;
    });

namespace detail {

/// The constants of a behaviour, see `BehaviorModel`; false where it has none.
template <class B>
[[nodiscard]] constexpr bool looks_beside() {
  if constexpr (requires { B::looks_beside; }) return B::looks_beside;
  return false;
}
template <class B>
[[nodiscard]] constexpr bool looks_around() {
  if constexpr (requires { B::looks_around; }) return B::looks_around;
  return false;
}
template <class B>
[[nodiscard]] constexpr bool heeds_conflicts() {
  if constexpr (requires { B::heeds_conflicts; }) return B::heeds_conflicts;
  return false;
}

/// Detects misspelt constants, which would silently have no effect.
template <class B>
concept MisspellsConstants = requires {
  B::look_beside;
}
|| requires { B::looks_besides; }
|| requires { B::looks_aside; }
|| requires { B::look_around; }
|| requires { B::looks_arround; }
|| requires { B::heed_conflicts; }
|| requires { B::heed_conflict; }
|| requires { B::heeds_conflict; };

/// Whether `B` has a `start_time` that worlds would ignore.
template <class B>
concept HidesStartTime = requires {
  &B::start_time;
}
&&!requires(B const behavior) {
  { behavior.start_time() } -> std::convertible_to<double>;
};

/// Whether `B` has `parameters` that nobody could ask without an object: they would not be checked.
template <class B>
concept HidesParameters = requires {
  &B::parameters;
}
&&!requires { B::parameters(); };

/// Whether the constants that `B` has are `static constexpr bool` and spelled correctly.
template <class B>
[[nodiscard]] constexpr bool has_good_constants() {
  bool good = !MisspellsConstants<B>;
  if constexpr (requires { &B::looks_beside; }) good = good && std::is_same_v<decltype(&B::looks_beside), bool const*>;
  if constexpr (requires { &B::looks_around; }) good = good && std::is_same_v<decltype(&B::looks_around), bool const*>;
  if constexpr (requires { &B::heeds_conflicts; })
    good = good && std::is_same_v<decltype(&B::heeds_conflicts), bool const*>;
  return good;
}

struct HasPlan {
  int plan;
};
template <class B>
struct WithAnotherPlan : B, HasPlan {};
/// Whether class `B` has a member named `plan`, even a template: a second member of that name makes the name ambiguous.
/// A final class cannot be tested and counts as having one.
template <class B>
[[nodiscard]] constexpr bool names_plan() {
  if constexpr (std::is_class_v<B> && !std::is_final_v<B>) return !requires {
      &WithAnotherPlan<B>::plan;
    };
  else
    return std::is_final_v<B>;
}
/// Whether `plan` can be called on a `B` (or `B const`), whatever it returns.
template <class B>
concept Plans = requires(B behavior, ViewArchetype const view, MemoryOf<B> memory, double dt) {
  behavior.plan(view, memory, dt);
}
|| requires(B behavior, ViewArchetype const view, MemoryOf<B> memory, double dt, WorkspaceOf<B>& workspace) {
  behavior.plan(view, memory, dt, workspace);
};

/// Returns true; fails to compile with a sentence that says what `B` lacks to be a behaviour.
template <class B>
[[nodiscard]] constexpr bool check_behavior() {
  using Memory = MemoryOf<B>;
  using Workspace = WorkspaceOf<B>;
  constexpr bool is_copyable = std::is_class_v<B> && std::copyable<B>;
  constexpr bool remembers = std::copyable<Memory> && std::default_initializable<Memory>;
  static_assert(is_copyable, "cambium::BehaviorSet<...>: a behaviour must be a copyable struct, named without const");
  static_assert(!is_copyable || remembers,
                "cambium::BehaviorSet<...>: a behaviour's Memory must be copyable and default constructible, because "
                "it is copied with the frame");
  static_assert(
      std::default_initializable<Workspace>,
      "cambium::BehaviorSet<...>: a behaviour's Workspace must be default constructible, because worlds create it");
  if constexpr (is_copyable)
    static_assert(has_good_constants<B>(),
                  "cambium::BehaviorSet<...>: what a behaviour says to worlds is `static constexpr bool looks_beside`, "
                  "looks_around or heeds_conflicts: spell it so, and as such a constant");
  if constexpr (is_copyable) {
    static_assert(!HidesStartTime<B>,
                  "cambium::BehaviorSet<...>: a behaviour's start_time would be ignored; write "
                  "`double start_time() const`");
    static_assert(!HidesParameters<B>,
                  "cambium::BehaviorSet<...>: a behaviour's parameters would not be checked; write "
                  "`static constexpr auto parameters()`");
  }
  if constexpr (!BehaviorModel<B> && is_copyable && remembers) {
    constexpr bool has_plan = names_plan<B>(), plans = Plans<B>, plans_const = Plans<B const>;
    static_assert(has_plan,
                  "cambium::BehaviorSet<...>: each alternative must be a behaviour, and this one has no function plan: "
                  "`template <class View> Plan<View> plan(View const&, Memory&, double dt) const` (see BehaviorModel)");
    static_assert(!has_plan || !plans || plans_const,
                  "cambium::BehaviorSet<...>: a behaviour's plan must be const: what it remembers is its Memory");
    static_assert(
        !has_plan || plans,
        "cambium::BehaviorSet<...>: a behaviour's plan must take (View const& view, Memory& memory, double dt) and be "
        "public: View is a template parameter, Memory the struct of that name in the behaviour, or else "
        "cambium::NoMemory");
    static_assert(!plans_const,
                  "cambium::BehaviorSet<...>: a behaviour's plan must return cambium::Plan<View>, the type View being "
                  "that of what it is called with");
  }
  return true;
}
}  // namespace detail

/// Tells a behaviour's memory that the vehicle drives `way` [m] less along its last plan than planned, and whether it
/// leaves the plan's course. A behaviour that overrides the plan of another one calls this, see `RssConformant`.
template <class Memory>
void fell_short(Memory& memory, double way, bool left_course) {
  if constexpr (requires { memory.fell_short(way, left_course); }) memory.fell_short(way, left_course);
}

/// Tells a behaviour's memory that `World::set_state` has moved the vehicle, see `BehaviorModel`. A memory that
/// contains another behaviour's passes it on.
template <class Memory>
void was_set(Memory& memory) {
  if constexpr (requires { memory.was_set(); }) memory.was_set();
}

}  // namespace cambium::inline v0_1
