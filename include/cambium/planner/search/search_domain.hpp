#pragma once

#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cambium/core/random.hpp"

namespace cambium {

/// What is wrong with a search.
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

/// What a joint step brought one agent. `reward`: any finite number, to be maximised. `cost`, 0 to 1: of the second
/// channel, as the probability, or the fact, of a collision; the costs along one course are summed without discount, up
/// to 1.
struct AgentOutcome {
  double reward = 0.0;
  double cost = 0.0;

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

/// Whether the same actions in the same state always lead to the same state, as far as the domain says so.
template <class D>
inline constexpr bool is_deterministic = [] {
  if constexpr (requires { D::is_deterministic; })
    return static_cast<bool>(D::is_deterministic);
  else
    return false;
}();

}  // namespace detail

/// A game that can be searched: agents that choose at once, a state, and a joint step.
///   `State`, copyable: what a node stores. `Action`, copyable, with ==.
///   `agents()`: how many agents choose, at least one, the same in all states.
///   `is_terminal(state)`: whether the game is over; asked of the root only.
///   `step(state, actions, random, outcomes)`: all agents act at once, one action each; changes the state, adds to the
///     outcomes (one per agent, zero at first), and says whether the game is over. All that is random in it comes from
///     `random`.
/// Either a list of actions: `max_actions`, and `actions(state, agent, out)`, which fills in those that the agent has
/// and says how many (a player who is not to move has one that does nothing). Or actions from a continuum:
/// `sample_action(state, agent, random)`; they are tried out bit by bit, see `TreeSearchParameters::action_widening`.
/// A domain may say more:
///   `static constexpr bool is_deterministic = true`: `step` does not use `random`; else the states that the same
///     actions lead to become several nodes, see `outcome_widening`.
///   `sample_root(state, random)`: draws what is not known of the root (the others' intentions) anew for each
///     iteration; then nodes stand for sequences of actions, and every iteration steps from the root. What actions
///     there are may depend only on what is known, for a node has those of the first draw.
///   `priors(state, agent, actions, out)`: weights for `Puct`; `value(state, agent)`: the expected return from here,
///   for
///     `TruncatedRollout` and `NoRollout`; `policy_action(state, agent, random)`: for `PolicyRollout`;
///     `same_state(predicted, observed)`: whether a kept tree still holds, by default ==; `heap_bytes(state)`: what a
///     state holds beyond its own size.
/// A search has a domain of its own, by value: it may keep working memory, but no answer may depend on that.
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

}  // namespace cambium
