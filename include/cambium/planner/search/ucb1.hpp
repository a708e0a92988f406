#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cambium/core/distributions.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/planner/search/selection_policy.hpp"

namespace cambium::inline v0_1 {

/// UCB1 (Auer, Cesa-Bianchi, Fischer 2002; in trees: Kocsis, Szepesvari 2006): selects the arm with the highest score
/// plus exploration sqrt(ln N / n), for n visits of the arm and N of all. Untried arms come first, in random order.
struct Ucb1 {
  struct Statistics {};

  double exploration = 0.7;

  static constexpr char const* name = "ucb1";
  static constexpr char const* summary = "score in [0, 1] plus exploration sqrt(ln N / n)";
  static constexpr char const* source = "Auer 2002; Kocsis 2006";
  static constexpr auto parameters() {
    return parameter_list(parameter("exploration", &Ucb1::exploration, "-", Range{0, 100},
                                    "weight of the uncertainty; sqrt(2) in the paper, for scores in [0, 1]"));
  }

  template <class Arms, class Random>
  [[nodiscard]] std::size_t select(Arms const& arms, std::uint32_t visits, ReturnScale const& scale,
                                   Random& random) const {
    if (auto const untried = detail::untried_arm(arms, random); untried < arms.size()) return untried;
    double const log_visits = portable::log(static_cast<double>(visits));
    return detail::best_arm(
        arms, [&](auto const& arm) { return scale.score(arm) + exploration * std::sqrt(log_visits / arm.visits); });
  }

  template <class Arms>
  void update(Arms const&, std::size_t, double, ReturnScale const&) const {}
};
static_assert(SelectionPolicy<Ucb1>);

/// UCB1-tuned (Auer, Cesa-Bianchi, Fischer 2002, section 4): explores arms with little variance less.
struct Ucb1Tuned {
  struct Statistics {
    double squares = 0.0;  ///< sum of the squared scores
    double scores = 0.0;   ///< sum of the scores: the scale moves, so mean returns would not match `squares`

    static constexpr char const* name = "ucb1_tuned_statistics";
    static constexpr auto parameters() {
      using P = Statistics;
      return parameter_list(parameter("squares", &P::squares, "-", non_negative, "sum of the squared scores"),
                            parameter("scores", &P::scores, "-", any_finite, "sum of the scores"));
    }
  };

  double exploration = 1.0;

  static constexpr char const* name = "ucb1_tuned";
  static constexpr char const* summary = "score plus exploration sqrt(ln N / n min(1/4, variance + sqrt(2 ln N / n)))";
  static constexpr char const* source = "Auer 2002";
  static constexpr auto parameters() {
    return parameter_list(parameter("exploration", &Ucb1Tuned::exploration, "-", Range{0, 100},
                                    "weight of the uncertainty; 1 in the paper"));
  }

  template <class Arms, class Random>
  [[nodiscard]] std::size_t select(Arms const& arms, std::uint32_t visits, ReturnScale const& scale,
                                   Random& random) const {
    if (auto const untried = detail::untried_arm(arms, random); untried < arms.size()) return untried;
    double const log_visits = portable::log(static_cast<double>(visits));
    return detail::best_arm(arms, [&](auto const& arm) {
      double const mean = arm.statistics.scores / arm.visits;
      double const variance = std::max(0.0, arm.statistics.squares / arm.visits - mean * mean);
      double const bound = std::min(0.25, variance + std::sqrt(2.0 * log_visits / arm.visits));
      return scale.score(arm) + exploration * std::sqrt(log_visits / arm.visits * bound);
    });
  }

  template <class Arms>
  void update(Arms const& arms, std::size_t chosen, double score, ReturnScale const&) const {
    arms[chosen].statistics.scores += score;
    arms[chosen].statistics.squares += score * score;
  }
};
static_assert(SelectionPolicy<Ucb1Tuned>);

}  // namespace cambium::inline v0_1
