#pragma once

#include <algorithm>
#include <type_traits>

#include "cambium/core/ids.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/evaluation/evaluator.hpp"
#include "cambium/world/frame.hpp"

namespace cambium::inline v0_1 {

/// What a step is worth to an agent, and whether its course ends there.
struct Judgement {
  double reward = 0.0;  ///< to be maximised
  double cost = 0.0;    ///< probability of the event that a limit on risk bounds, such as a collision; 0 to 1
  bool ends = false;

  friend Judgement operator+(Judgement const& a, Judgement const& b) {
    return {a.reward + b.reward, std::max(a.cost, b.cost), a.ends || b.ends};
  }
};

/// A term by which a planner judges: an evaluator's value after a step, times a weight.
template <class E>
struct Weighted {
  static_assert(
      Described<E>,
      "cambium::Terms<Evaluators...>: describe each evaluator's parameters, as cambium::Collision does; where "
      "it has none: `static constexpr auto parameters() { return cambium::parameter_list(); }`");
  static_assert(
      !requires { E::needs_history; },
      "cambium::Terms<Evaluators...>: this evaluator needs a history, and predictions keep none: it would "
      "always be 0; judge by cambium::Acceleration or the state instead");
  E evaluator{};
  double weight = 0.0;
  double cost = 0.0;
  bool per_second = false;
  bool ends = false;

  static constexpr char const* name = "weighted";
  static constexpr char const* summary = "an evaluator's value after a step, times a weight";
  static constexpr auto parameters() {
    using P = Weighted;
    return parameter_list(
        parameter("evaluator", &P::evaluator, "returns a bool or a number"),
        parameter("weight", &P::weight, "-", any_finite, "factor on its value"),
        parameter("cost", &P::cost, "-", Range{0, 1},
                  "of a value other than 0: the probability of the event that a limit on risk bounds; for Mcts only"),
        parameter("per_second", &P::per_second, "whether the term is multiplied by the duration of the step"),
        parameter("ends", &P::ends, "whether a value other than 0 ends the course"));
  }

  template <class World>
  [[nodiscard]] Judgement judge(World& world, Slot slot, double dt) const {
    static_assert(EvaluatorFor<E, World>,
                  "cambium::Terms<Evaluators...>: each must have `template <class World> auto operator()(World&, Slot) "
                  "const` that returns a bool or a number (see EvaluatorFor)");
    if (weight == 0.0 && cost == 0.0 && !ends) return {};
    auto const value = static_cast<double>(evaluator(world, slot));
    bool const is_event = value != 0.0;
    return {weight * value * (per_second ? dt : 1.0), is_event ? cost : 0.0, ends && is_event};
  }
};

/// One weighted term for each evaluator, by which every planner can judge: `terms.term<Gap>() = {.weight = 0.1,
/// .per_second = true}`.
template <class... Evaluators>
struct Terms;

namespace detail {
template <class T>
inline constexpr bool is_terms = false;
template <class... Evaluators>
inline constexpr bool is_terms<Terms<Evaluators...>> = true;
}  // namespace detail

template <>
struct Terms<> {
  static constexpr char const* name = "terms";
  static constexpr char const* summary = "a sum of weighted evaluators";
  static constexpr auto parameters() { return parameter_list(); }

  template <class E>
  [[nodiscard]] Weighted<E>& term() {
    static_assert(std::is_void_v<E>, "cambium::Terms<Evaluators...>::term<E>: E is not one of Evaluators");
  }
  [[nodiscard]] constexpr bool has_cost() const { return false; }

  template <class World>
  [[nodiscard]] Judgement judge(World&, Slot, double) const {
    return {};
  }
  template <class World>
  [[nodiscard]] double value(World&, Slot, double) const {
    return 0.0;
  }
};

template <class First, class... Rest>
struct Terms<First, Rest...> {
  static_assert(!(std::is_same_v<First, Rest> || ...),
                "cambium::Terms<Evaluators...>: an evaluator is there twice; each has one term");
  Weighted<First> first{};
  Terms<Rest...> rest{};

  static constexpr char const* name = "terms";
  static constexpr char const* summary = "a sum of weighted evaluators";
  static constexpr auto parameters() {
    return parameter_list(parameter("first", &Terms::first, "the first term"),
                          parameter("rest", &Terms::rest, "the other terms"));
  }

  /// The term of evaluator `E`.
  template <class E>
  [[nodiscard]] Weighted<E>& term() {
    if constexpr (std::is_same_v<E, First>)
      return first;
    else
      return rest.template term<E>();
  }

  /// Whether one of them has a `cost`.
  [[nodiscard]] constexpr bool has_cost() const { return first.cost != 0.0 || rest.has_cost(); }

  /// The sum of the terms for the agent at `slot` after a step of `dt` [s]; nothing for an agent that is not driving.
  template <class World>
  [[nodiscard]] Judgement judge(World& world, Slot slot, double dt) const {
    if (world.frame().agents[slot].status != AgentStatus::driving) return {};
    return first.judge(world, slot, dt) + rest.judge(world, slot, dt);
  }
  /// The terms per second as if nothing changed for `duration` [s].
  template <class World>
  [[nodiscard]] double value(World& world, Slot slot, double duration) const {
    return (first.per_second ? first.judge(world, slot, duration).reward : 0.0) + rest.value(world, slot, duration);
  }
};

}  // namespace cambium::inline v0_1
