#pragma once

#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cambium/core/described.hpp"
#include "cambium/core/random.hpp"

namespace cambium::inline v0_1 {

/// Why a search has no result. `throw_if` puts it in words, in this order.
enum class SearchProblem : std::uint8_t {
  none,
  no_agents,
  no_actions,
  no_budget,
  terminal_root,
  not_finite,
  cost_out_of_range,
  bad_priors,
  not_in_world,
};

/// What a joint step yields for one agent. `reward`: any finite number, to be maximised. `cost`, from 0 to 1: a second
/// channel, for example the probability of a collision, or 1 for a collision. The search sums the costs along a course
/// with a discount of their own (`CostConstraint`) and caps the sum at 1.
struct AgentOutcome {
  double reward = 0.0;
  double cost = 0.0;

  static constexpr char const* name = "agent_outcome";
  static constexpr auto parameters() {
    return parameter_list(parameter("reward", &AgentOutcome::reward, "-", any_finite, "to be maximised"),
                          parameter("cost", &AgentOutcome::cost, "-", Range{0, 1}, "to be avoided"));
  }

  friend bool operator==(AgentOutcome const&, AgentOutcome const&) = default;
};

namespace detail {

[[nodiscard]] inline SearchProblem problem_of(std::span<AgentOutcome const> outcomes) {
  for (auto const& outcome : outcomes) {
    if (!std::isfinite(outcome.reward) || !std::isfinite(outcome.cost)) return SearchProblem::not_finite;
    if (!(outcome.cost >= 0.0 && outcome.cost <= 1.0)) return SearchProblem::cost_out_of_range;
  }
  return SearchProblem::none;
}

template <class D>
concept ListsActions = requires(D domain, typename D::State const state, std::span<typename D::Action> out) {
  { D::max_actions } -> std::convertible_to<std::size_t>;
  { domain.actions(state, std::size_t{}, out) } -> std::convertible_to<std::size_t>;
};

template <class D>
concept SamplesActions = requires(D domain, typename D::State const state, RandomStream random) {
  { domain.sample_action(state, std::size_t{}, random) } -> std::same_as<typename D::Action>;
};

template <class D>
concept SamplesRoot = requires(D domain, typename D::State state, RandomStream random) {
  domain.sample_root(state, random);
};

template <class D>
concept HasPriors = requires(D domain, typename D::State const state, std::span<typename D::Action const> actions,
                             std::span<double> priors) {
  domain.priors(state, std::size_t{}, actions, priors);
};

template <class D>
concept HasValue = requires(D domain, typename D::State const state) {
  { domain.value(state, std::size_t{}) } -> std::convertible_to<double>;
};

template <class D>
concept HasPolicy = requires(D domain, typename D::State const state, RandomStream random) {
  { domain.policy_action(state, std::size_t{}, random) } -> std::same_as<typename D::Action>;
};

template <class D, std::size_t limit>
inline constexpr bool fewer_actions_than = [] {
  if constexpr (ListsActions<D>)
    return D::max_actions > 0 && static_cast<std::size_t>(D::max_actions) < limit;
  else
    return true;
}();

/// Whether the domain promises that the same actions in the same state always lead to the same state.
template <class D>
inline constexpr bool is_deterministic = [] {
  if constexpr (requires { D::is_deterministic; })
    return static_cast<bool>(D::is_deterministic);
  else
    return false;
}();

/// Whether a kept tree still holds: by the domain's `same_state`, else by ==.
template <class D>
[[nodiscard]] bool is_same_state(D& domain, typename D::State const& predicted, typename D::State const& seen) {
  if constexpr (requires { domain.same_state(predicted, seen); })
    return domain.same_state(predicted, seen);
  else if constexpr (std::equality_comparable<typename D::State>)
    return predicted == seen;
  else
    return false;
}

/// The memory of a state beyond its size [B].
template <class D>
[[nodiscard]] std::size_t heap_bytes(D& domain, typename D::State const& state) {
  if constexpr (requires { domain.heap_bytes(state); })
    return domain.heap_bytes(state);
  else
    return 0;
}

}  // namespace detail

/// A game that can be searched: a state, agents that choose at the same time, and a joint step.
///
/// - `State`, copyable: what a node stores. `Action`, copyable, with ==.
/// - `agents()`: the number of agents that choose, at least one, constant throughout the game.
/// - `is_terminal(state)`: whether the game is over. The search calls it for the root only.
/// - `step(state, actions, random, outcomes)`: every agent takes one action, all at once. Changes the state, adds to
///   the outcomes (one per agent, initially zero) and returns whether the game is over. All randomness comes from
///   `random`.
///
/// The actions are either a list or a continuum:
///
/// - List: `max_actions`, and `actions(state, agent, out)`, which writes the agent's actions to `out` and returns their
///   number. In a turn-based game, a player who is not to move has one action that does nothing.
/// - Continuum: `sample_action(state, agent, random)`. The search adds samples gradually, see
///   `TreeSearchParameters::action_widening`.
///
/// Optional members:
///
/// - `static constexpr bool is_deterministic = true`: `step` does not use `random`. Otherwise the same actions may lead
///   to several states, each with a node of its own, see `outcome_widening`.
/// - `sample_root(state, random)`: draws what is unknown about the root, such as the others' intentions, anew for each
///   iteration (root sampling). Nodes then stand for sequences of actions, and every iteration steps from the root. The
///   available actions must not depend on what is drawn, because a node keeps those of the first draw.
/// - `priors(state, agent, actions, out)`: weights of the actions, for `Puct`.
/// - `value(state, agent)`: the expected return from here, for `TruncatedRollout` and `NoRollout`.
/// - `policy_action(state, agent, random)`: for `PolicyRollout`.
/// - `same_state(predicted, observed)`: whether a kept tree still holds; == by default.
/// - `heap_bytes(state)`: memory of a state beyond its size.
///
/// A search owns its domain by value. A domain may keep working memory, but no result may depend on it.
template <class D>
concept SearchDomain = std::copy_constructible<D> && std::copyable<typename D::State> &&
    std::default_initializable<typename D::State> && std::copyable<typename D::Action> &&
    std::default_initializable<typename D::Action> &&
    requires(D domain, typename D::State state, typename D::State const seen,
             std::span<typename D::Action const> actions, RandomStream random, std::span<AgentOutcome> outcomes) {
  { domain.agents() } -> std::convertible_to<std::size_t>;
  { domain.is_terminal(seen) } -> std::same_as<bool>;
  { domain.step(state, actions, random, outcomes) } -> std::same_as<bool>;
  requires detail::ListsActions<D> || detail::SamplesActions<D>;
};

}  // namespace cambium::inline v0_1
