#pragma once

#include <concepts>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/goal/goal_situation.hpp"
#include "cambium/map/fwd.hpp"

namespace cambium::inline v0_1 {

namespace detail {
template <class G>
concept HasAtGoal = requires(G const goal, GoalSituation const& at) {
  { goal.at_goal(at) } -> std::same_as<bool>;
};
}  // namespace detail

/// A goal: a copyable struct of parameters with one pure function, `bool at_goal(GoalSituation const&) const`.
/// Optional members:
/// - `parameters()`: checked when an agent enters, and used for comparison (otherwise ==);
/// - `std::vector<LaneId> lanes(Map const&) const`: lanes in which a route to the goal may end, best first. An agent
///   without a route gets one to the first lane that it can reach, or straight on if the list is empty;
/// - `void check(std::string const& where) const`: throws an `Error` if the goal can never be reached.
template <class G>
concept GoalModel = detail::HasAtGoal<G> && std::copyable<G>;

/// Holds a goal of a user-defined type as an alternative of `Goal`. Copies share the immutable struct.
class OwnGoal {
 public:
  template <class G>
  requires(!std::is_same_v<G, OwnGoal> && GoalModel<G>) OwnGoal(G goal)
      : goal_(std::make_shared<G const>(std::move(goal))), operations_(&operations_of<G>) {
    static_assert(
        !requires { requires std::is_member_function_pointer_v<decltype(&G::lanes)>; } ||
            requires(G const own, Map const& map) {
              { own.lanes(map) } -> std::same_as<std::vector<LaneId>>;
            },
        "cambium::Goal: your goal's `lanes` would be ignored; write `std::vector<cambium::LaneId> lanes(cambium::Map "
        "const&) const`");
    static_assert(
        !requires { requires std::is_member_function_pointer_v<decltype(&G::check)>; } ||
            requires(G const own, std::string const& where) { own.check(where); },
        "cambium::Goal: your goal's `check` would be ignored; write `void check(std::string const& where) "
        "const`");
  }

  // No moves, which would leave a goal without its struct.
  OwnGoal(OwnGoal const&) = default;
  OwnGoal& operator=(OwnGoal const&) = default;
  ~OwnGoal() = default;

  [[nodiscard]] bool at_goal(GoalSituation const& at) const { return operations_->at_goal(goal_.get(), at); }

  /// Lanes in which a route to it may end; empty if it names none.
  [[nodiscard]] std::vector<LaneId> lanes(Map const& map) const { return operations_->lanes(goal_.get(), map); }

  /// Throws an `Error` if a parameter is out of range or the goal can never be reached.
  void check(std::string const& where) const { operations_->check(goal_.get(), where); }

  /// The struct, if it is a `G`, else null.
  template <GoalModel G>
  [[nodiscard]] G const* get() const {
    return operations_ == &operations_of<G> ? static_cast<G const*>(goal_.get()) : nullptr;
  }

  friend bool operator==(OwnGoal const& a, OwnGoal const& b) {
    return a.operations_ == b.operations_ &&
           (a.goal_ == b.goal_ || a.operations_->are_equal(a.goal_.get(), b.goal_.get()));
  }

 private:
  struct Operations {
    bool (*at_goal)(void const* goal, GoalSituation const& at);
    std::vector<LaneId> (*lanes)(void const* goal, Map const& map);
    void (*check)(void const* goal, std::string const& where);
    bool (*are_equal)(void const* a, void const* b);
  };

  template <class G>
  [[nodiscard]] static std::vector<LaneId> lanes_of(void const* goal, Map const& map) {
    if constexpr (requires { static_cast<G const*>(goal)->lanes(map); })
      return static_cast<G const*>(goal)->lanes(map);
    else
      return {};
  }

  template <class G>
  static void check_one(void const* goal, std::string const& where) {
    auto const& own = *static_cast<G const*>(goal);
    if constexpr (Described<G>)  // calls its own check, too
      check_parameters(own, where);
    else if constexpr (requires { own.check(where); })
      own.check(where);
  }

  template <class G>
  [[nodiscard]] static bool are_equal(void const* a, void const* b) {
    auto const &one = *static_cast<G const*>(a), &other = *static_cast<G const*>(b);
    if constexpr (Described<G>)
      return equal_parameters(one, other);
    else if constexpr (std::equality_comparable<G>)
      return one == other;
    else
      return std::is_empty_v<G>;
  }

  template <class G>
  static constexpr Operations operations_of{
      [](void const* goal, GoalSituation const& at) { return static_cast<G const*>(goal)->at_goal(at); }, &lanes_of<G>,
      &check_one<G>, &are_equal<G>};

  std::shared_ptr<void const> goal_;
  Operations const* operations_;
};

}  // namespace cambium::inline v0_1
