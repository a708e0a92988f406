#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>

#include "cambium/core/described.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/core/random.hpp"

namespace cambium::inline v0_1 {

/// What a search knows about one action of one agent at one node. `Statistics`: additional data of the selection
/// policy.
template <class Action, class Statistics>
struct Arm {
  Action action{};
  std::uint32_t visits = 0;
  double total_return = 0.0;  ///< over all courses that took it here
  double total_cost = 0.0;
  [[no_unique_address]] Statistics statistics{};

  static constexpr char const* name = "arm";
  static constexpr auto parameters() {
    constexpr auto totals = parameter_list(
        parameter("action", &Arm::action, "-", any_finite, "what it stands for"),
        parameter("visits", &Arm::visits, "-", Range{0, 4294967295.0}, "how often it was chosen"),
        parameter("total_return", &Arm::total_return, "-", any_finite, "over all courses that took it here"),
        parameter("total_cost", &Arm::total_cost, "-", any_finite, "likewise"));
    if constexpr (std::is_empty_v<Statistics>)
      return totals;
    else
      return join_parameters(totals,
                             parameter_list(parameter("statistics", &Arm::statistics, "of the selection policy")));
  }

  [[nodiscard]] double mean_return() const { return visits > 0 ? total_return / visits : 0.0; }
  [[nodiscard]] double mean_cost() const { return visits > 0 ? total_cost / visits : 0.0; }
};

/// Maps an agent's returns and costs to scores in [0, 1]. It scales the return by the lowest and the highest seen so
/// far, then subtracts `multiplier` times the cost and scales the result to [0, 1] again by the highest cost seen.
struct ReturnScale {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  double highest_cost = 0.0;
  double multiplier = 0.0;  ///< of the cost, see `CostConstraint`

  static constexpr char const* name = "return_scale";
  static constexpr auto parameters() {
    using P = ReturnScale;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    return parameter_list(parameter("low", &P::low, "-", Range{-infinity, infinity}, "lowest return seen"),
                          parameter("high", &P::high, "-", Range{-infinity, infinity}, "highest return seen"),
                          parameter("highest_cost", &P::highest_cost, "-", Range{0, 1}, "highest cost seen"),
                          parameter("multiplier", &P::multiplier, "-", Range{0, 1e3}, "of the cost"));
  }

  void include(double value, double cost = 0.0) {
    low = std::min(low, value);
    high = std::max(high, value);
    highest_cost = std::max(highest_cost, cost);
  }
  void include(ReturnScale const& other) {
    include(other.low);
    include(other.high, other.highest_cost);
  }
  /// Whether sums of 2^32 such returns, and differences of them, are finite.
  [[nodiscard]] bool can_be_summed() const { return low >= -1e290 && high <= 1e290; }

  /// The score; without costs it is 0.5 as long as all returns are equal.
  [[nodiscard]] double score(double value, double cost) const {
    double const share = high > low ? (value - low) / (high - low) : 0.5;
    return (share + multiplier * (highest_cost - cost)) / (1.0 + multiplier * highest_cost);
  }

  template <class Arm>
  [[nodiscard]] double score(Arm const& arm) const {
    return score(arm.mean_return(), arm.mean_cost());
  }
};

/// How an agent chooses at a node: a multi-armed bandit. A copyable struct of parameters with
///
/// - `Statistics`, default constructible: what it keeps for each arm; described, if a snapshot is to hold a kept tree;
/// - `select(arms, visits, scale, random)`: returns the number of the arm to try. `visits` is the sum over all arms;
///   there is at least one arm.
/// - `update(arms, chosen, score, scale)`: learns the score of the arm that it selected. It is called before that arm's
///   visits and totals include the score.
///
/// Each is O(arms), does not allocate and does not throw.
template <class P>
concept SelectionPolicy = std::copyable<P> && std::default_initializable<typename P::Statistics> &&
    requires(P const policy, std::span<Arm<int, typename P::Statistics>> arms,
             std::span<Arm<int, typename P::Statistics> const> seen, ReturnScale const scale, RandomStream random) {
  { policy.select(seen, std::uint32_t{}, scale, random) } -> std::same_as<std::size_t>;
  policy.update(arms, std::size_t{}, 0.0, scale);
};

namespace detail {

/// The visits of all arms of an agent at a node.
template <class Arms>
[[nodiscard]] std::uint32_t total_visits(Arms const& arms) {
  std::uint32_t sum = 0;
  for (auto const& arm : arms) sum += arm.visits;
  return sum;
}

/// A random arm among those not tried yet, or `arms.size()` if all have been tried.
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

/// A number below `count`, drawn by `probability(i)`.
template <class Random, class Probability>
[[nodiscard]] std::size_t drawn(std::size_t count, Random& random, Probability const& probability) {
  double left = uniform01(random);
  for (std::size_t i = 0; i + 1 < count; ++i) {
    left -= probability(i);
    if (left < 0.0) return i;
  }
  return count - 1;
}

/// The arm with the highest `score(arm)`; the first one if several are equal.
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

}  // namespace cambium::inline v0_1
