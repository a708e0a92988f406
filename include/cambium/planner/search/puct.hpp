#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "cambium/core/parameters.hpp"
#include "cambium/planner/search/selection_policy.hpp"

namespace cambium::inline v0_1 {

/// PUCT (Rosin 2011, as in Silver 2017): selects the arm with the highest score plus exploration D P sqrt(N) / (1 + n).
/// P is its prior probability: `SearchDomain::priors`, normalised over the node's actions, or uniform without them. D,
/// which the paper lacks, is the standard deviation of all scores at the node: the search explores alike whatever the
/// range of returns elsewhere in the tree. An untried arm has the mean score of its node.
struct Puct {
  struct Statistics {
    double prior = 1.0;                  ///< set by the search; the sum over a node need not be 1
    double scores = 0.0, squares = 0.0;  ///< sums: the scale moves, so the mean return would not match the squares

    static constexpr char const* name = "puct_statistics";
    static constexpr auto parameters() {
      using P = Statistics;
      return parameter_list(parameter("prior", &P::prior, "-", non_negative, "relative to the others of its node"),
                            parameter("scores", &P::scores, "-", any_finite, "sum of the scores"),
                            parameter("squares", &P::squares, "-", non_negative, "sum of their squares"));
    }
  };

  double exploration = 2.0;
  double least_deviation = 0.01;

  static constexpr char const* name = "puct";
  static constexpr char const* summary =
      "score plus exploration prior sqrt(N) / (1 + n), in standard deviations of the node's scores";
  static constexpr char const* source = "after Rosin 2011; Silver 2017";
  static constexpr auto parameters() {
    using P = Puct;
    return parameter_list(
        parameter("exploration", &P::exploration, "-", Range{0, 100}, "weight of the prior against the score"),
        parameter("least_deviation", &P::least_deviation, "-", Range{0, 1}, "where all scores are alike"));
  }

  template <class Arms, class Random>
  [[nodiscard]] std::size_t select(Arms const& arms, std::uint32_t visits, ReturnScale const& scale, Random&) const {
    double priors = 0.0, returns = 0.0, costs = 0.0, scores = 0.0, squares = 0.0;
    for (auto const& arm : arms) {
      priors += arm.statistics.prior;
      scores += arm.statistics.scores;
      squares += arm.statistics.squares;
      returns += arm.total_return;
      costs += arm.total_cost;
    }
    double known = 0.5, deviation = 1.0, root = 1.0;  // before the first visit the prior alone decides
    if (visits > 0) {
      double const mean = scores / visits;
      known = scale.score(returns / visits, costs / visits);
      deviation = std::max(least_deviation, std::sqrt(std::max(0.0, squares / visits - mean * mean)));
      root = std::sqrt(static_cast<double>(visits));
    }
    double const weight = exploration * deviation * root / priors;
    return detail::best_arm(arms, [&](auto const& arm) {
      return (arm.visits > 0 ? scale.score(arm) : known) + weight * arm.statistics.prior / (1.0 + arm.visits);
    });
  }

  template <class Arms>
  void update(Arms const& arms, std::size_t chosen, double score, ReturnScale const&) const {
    arms[chosen].statistics.scores += score;
    arms[chosen].statistics.squares += score * score;
  }
};
static_assert(SelectionPolicy<Puct>);

}  // namespace cambium::inline v0_1
