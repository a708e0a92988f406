#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "cambium/core/distributions.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/planner/search/detail/search_tree.hpp"
#include "cambium/planner/search/search_domain.hpp"
#include "cambium/planner/search/selection_policy.hpp"
#include "cambium/planner/search/tree_search_parameters.hpp"

namespace cambium::inline v0_1 {

/// Thrown if a search is impossible or its game is faulty.
struct SearchError : Error {
  using Error::Error;
};

/// Throws `SearchError`, unless `problem` is `none`. `steps`: from the root to where it arose.
inline void throw_if(SearchProblem problem, int steps = 0) {
  struct Words {
    char const *what, *remedy;
  };
  static constexpr Words words[] = {
      {"", ""},
      {"no agent chooses", "let SearchDomain::agents be at least 1"},
      {"an agent has no action, or more than max_actions, in a state where the game is not over",
       "list at least one, such as doing nothing, or let step say that the game is over"},
      {"its budget is 0 iterations", "give it at least 1"},
      {"the game is over at the root", "call is_terminal before the search"},
      {"a reward, a cost or a value is not finite, or a return exceeds 1e290",
       "check what step, value and the evaluators return"},
      {"a cost is not between 0 and 1",
       "return the probability of the event that must not happen, or 1 once it happened"},
      {"the priors of a node are negative, not finite or all zero",
       "return weights of at least 0, at least one of them positive"},
      {"the agent to plan for is not in the predicted world, or not in traffic", "plan for an agent that drives"}};
  if (problem == SearchProblem::none) return;
  auto const& [what, remedy] = words[static_cast<std::size_t>(problem)];
  throw SearchError("search" + (steps > 0 ? ", at step " + std::to_string(steps) : std::string()), what, remedy);
}

/// The result for one action of one agent at the root.
template <class Action>
struct RootArm {
  Action action{};
  std::uint32_t visits = 0;
  double mean_return = 0.0;
  double mean_cost = 0.0;
  double share = 0.0;  ///< of the visits: the agent's mixed strategy
};

/// The result of a search.
template <class Action>
struct SearchResult {
  SearchProblem problem = SearchProblem::none;
  int problem_steps = 0;  ///< from the root to where it arose
  std::uint64_t seed = 0;
  std::size_t iterations = 0;
  std::size_t nodes = 0;       ///< in the tree, including kept ones
  std::size_t kept_nodes = 0;  ///< taken over from the previous search
  bool is_full = false;        ///< memory ran out; the search continued without new nodes

  std::size_t agents = 0;
  std::vector<RootArm<Action>> arms;   ///< of the first agent, then the second, ...
  std::vector<std::size_t> first_arm;  ///< start in `arms` for each agent, then the end of `arms`
  std::vector<std::size_t> best;       ///< for each agent, the number of its best arm
  std::vector<Action> variation;       ///< principal variation: all agents' actions, step by step
  std::vector<std::uint32_t> depths;   ///< number of iterations that left the tree, by depth

  /// The agent's actions at the root. Throws `SearchError` if the search had a problem or the agent does not exist.
  [[nodiscard]] std::span<RootArm<Action> const> of(std::size_t agent) const {
    throw_if(problem, problem_steps);
    if (agent >= agents)
      throw SearchError("search result", "has no agent " + std::to_string(agent),
                        agents == 0 ? "run the search first" : "it has " + std::to_string(agents));
    return {arms.data() + first_arm[agent], first_arm[agent + 1] - first_arm[agent]};
  }
  /// The agent's best action. Throws as `of`.
  [[nodiscard]] RootArm<Action> const& choice(std::size_t agent) const { return of(agent)[best[agent]]; }

  /// Empties the result, keeps its memory, and reserves room for the longest variation.
  void clear(std::uint64_t new_seed, std::size_t horizon, std::size_t choosing) {
    problem = SearchProblem::none;
    problem_steps = 0;
    seed = new_seed;
    iterations = nodes = kept_nodes = agents = 0;
    is_full = false;
    arms.clear();
    first_arm.clear();
    best.clear();
    variation.clear();
    variation.reserve(horizon * choosing);
    depths.assign(horizon + 1, 0);
  }
};

namespace detail {

/// The cost of an arm by Laplace's rule of succession: an arm with few visits does not count as safe.
template <class Action>
[[nodiscard]] double estimated_cost(RootArm<Action> const& arm) {
  return (arm.mean_cost * arm.visits + 1.0) / (arm.visits + 2.0);
}

/// The arm to take: the best by `final_move` among those whose `estimated_cost` is within the limit, or the cheapest if
/// none is.
template <class Action>
[[nodiscard]] std::size_t final_choice(std::span<RootArm<Action> const> arms, ReturnScale scale, FinalMove final_move,
                                       double cost_limit) {
  double cheapest = 1.0;
  for (auto const& arm : arms)
    if (arm.visits > 0) cheapest = std::min(cheapest, estimated_cost(arm));
  double const log_visits = portable::log(std::max(1.0, static_cast<double>(total_visits(arms))));
  double const limit = std::max(cheapest, cost_limit);
  if (cost_limit < 1.0) scale.multiplier = 0.0;  // within the limit, costs do not count
  auto const merit = [&](RootArm<Action> const& arm) {
    double const score = scale.score(arm.mean_return, arm.mean_cost);
    if (final_move == FinalMove::most_visits) return arm.visits + 0.5 * score;  // the score breaks ties
    return final_move == FinalMove::best_return ? score : score - std::sqrt(log_visits / arm.visits);
  };
  return best_arm(arms, [&](RootArm<Action> const& arm) {
    return arm.visits > 0 && estimated_cost(arm) <= limit ? merit(arm) : -std::numeric_limits<double>::infinity();
  });
}

/// Fills in the principal variation: the agents' best actions at the root, then the most visited ones.
template <class Tree, class Action>
void fill_variation(Tree const& tree, std::span<std::uint16_t> joint, SearchResult<Action>& result) {
  for (std::uint32_t node = 0; node != no_node && tree.has_arms(node);) {
    for (std::size_t k = 0; k < tree.agents(); ++k) {
      auto const arms = tree.arms(node, k);
      joint[k] = static_cast<std::uint16_t>(
          node == 0 ? result.best[k] : best_arm(arms, [](auto const& arm) { return double(arm.visits); }));
    }
    auto const child = tree.find(node, joint);
    if (child == no_node && node != 0) break;  // at the root, the best actions may never have been tried together
    for (std::size_t k = 0; k < tree.agents(); ++k) result.variation.push_back(tree.arms(node, k)[joint[k]].action);
    node = child;
  }
}

/// Fills in the result of a tree: arms, best arms, principal variation.
template <class Tree, class Action>
void fill_result(Tree const& tree, std::span<ReturnScale const> scales, TreeSearchParameters const& parameters,
                 std::span<std::uint16_t> joint, SearchResult<Action>& result) {
  result.agents = tree.agents();
  result.nodes = tree.size();
  for (std::size_t k = 0; k < tree.agents(); ++k) {
    result.first_arm.push_back(result.arms.size());
    double const visits = total_visits(tree.arms(0, k));
    for (auto const& arm : tree.arms(0, k))
      result.arms.push_back(
          {arm.action, arm.visits, arm.mean_return(), arm.mean_cost(), visits > 0.0 ? arm.visits / visits : 0.0});
  }
  result.first_arm.push_back(result.arms.size());
  for (std::size_t k = 0; k < tree.agents(); ++k)
    result.best.push_back(final_choice(result.of(k), scales[k], parameters.final_move, parameters.constraint.limit));
  fill_variation(tree, joint, result);
}

}  // namespace detail

}  // namespace cambium::inline v0_1
