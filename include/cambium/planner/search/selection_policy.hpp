#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "cambium/core/distributions.hpp"
#include "cambium/core/random.hpp"

namespace cambium {

/// What a search knows of one action of one agent at one node. `Statistics`: what a selection policy keeps beside it.
template <class Action, class Statistics>
struct Arm {
  Action action{};
  std::uint32_t visits = 0;
  double total_return = 0.0;  ///< of the courses that began with it
  double total_cost = 0.0;
  [[no_unique_address]] Statistics statistics{};

  [[nodiscard]] double mean_return() const { return visits > 0 ? total_return / visits : 0.0; }
  [[nodiscard]] double mean_cost() const { return visits > 0 ? total_cost / visits : 0.0; }
};

/// Maps an agent's returns and costs to scores in [0, 1]: the return by the least and greatest that the search has seen
/// so far, less `multiplier` times the cost.
struct ReturnScale {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  double multiplier = 0.0;  ///< Lagrange multiplier of the cost, see `CostConstraint`

  void include(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }

  /// Whether the sum of 2^32 such returns, and their differences, are finite.
  [[nodiscard]] bool can_be_summed() const { return low >= -1e290 && high <= 1e290; }

  /// 0.5 as long as all returns are equal.
  [[nodiscard]] double score(double value, double cost) const {
    double const share = high > low ? (value - low) / (high - low) : 0.5;
    return multiplier > 0.0 ? (share + multiplier * (1.0 - cost)) / (1.0 + multiplier) : share;
  }

  template <class Arm>
  [[nodiscard]] double score(Arm const& arm) const {
    return score(arm.mean_return(), arm.mean_cost());
  }
};

/// How an agent chooses at a node: a bandit. A copyable struct of parameters with
///   `Statistics`, default constructible: what it keeps for each arm;
///   `select(arms, visits, scale, random)`: the arm to try; `visits`: the sum over the arms, of which there is one at
///     least;
///   `update(arms, chosen, score, scale)`: learns the score of the arm that it selected, before that arm's own visits
///     and totals count it.
/// O(arms) each; no allocation, no exception.
template <class P>
concept SelectionPolicy = std::copyable<P> && std::default_initializable<typename P::Statistics> &&
    requires(P const policy, std::span<Arm<int, typename P::Statistics>> arms,
             std::span<Arm<int, typename P::Statistics> const> seen, ReturnScale const scale, RandomStream random) {
  { policy.select(seen, std::uint32_t{}, scale, random) } -> std::same_as<std::size_t>;
  policy.update(arms, std::size_t{}, 0.0, scale);
};

namespace detail {

/// One of the arms that nobody has tried yet, each as likely; their number where there is none.
template <class Arms, class Random>
[[nodiscard]] std::size_t untried_arm(Arms const& arms, Random& random) {
  auto const is_untried = [](auto const& arm) { return arm.visits == 0; };
  auto const count = static_cast<std::uint32_t>(std::count_if(arms.begin(), arms.end(), is_untried));
  if (count == 0) return arms.size();
  auto skip = count > 1 ? uniform_index(random, count) : 0;
  std::size_t i = 0;
  while (!is_untried(arms[i]) || skip-- > 0) ++i;
  return i;
}

/// The arm of which `score(arm)` is greatest, the first of equals.
template <class Arms, class Score>
[[nodiscard]] std::size_t best_arm(Arms const& arms, Score&& score) {
  std::size_t best = 0;
  double best_score = score(arms[0]);
  for (std::size_t i = 1; i < arms.size(); ++i) {
    if (double const s = score(arms[i]); s > best_score) {
      best = i;
      best_score = s;
    }
  }
  return best;
}

}  // namespace detail

}  // namespace cambium
