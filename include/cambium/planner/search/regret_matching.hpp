#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "cambium/core/distributions.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/planner/search/selection_policy.hpp"

namespace cambium::inline v0_1 {

/// Regret matching for simultaneous moves (Hart, Mas-Colell 2000; in trees: Lanctot, Lisy, Winands 2014): plays an arm
/// in proportion to the regret of not having played it. In zero-sum games the visits converge to a mixed equilibrium,
/// where `Ucb1` may cycle. It sees only the score of the arm that it played; it estimates those of the others with
/// their means as control variates (Schmid et al. 2019).
struct RegretMatching {
  struct Statistics {
    double regret = 0.0;

    static constexpr char const* name = "regret_matching_statistics";
    static constexpr auto parameters() {
      return parameter_list(parameter("regret", &Statistics::regret, "-", any_finite, "of not having played it"));
    }
  };

  double exploration = 0.1;

  static constexpr char const* name = "regret_matching";
  static constexpr char const* summary = "plays in proportion to positive regret, sometimes at random";
  static constexpr char const* source = "Hart 2000; Lanctot 2014";
  static constexpr auto parameters() {
    return parameter_list(
        parameter("exploration", &RegretMatching::exploration, "-", Range{1e-6, 1}, "share of random choices"));
  }

  template <class Arms, class Random>
  [[nodiscard]] std::size_t select(Arms const& arms, std::uint32_t, ReturnScale const&, Random& random) const {
    double const regrets = positive_regrets(arms);
    return detail::drawn(arms.size(), random, [&](std::size_t i) { return mixed(arms, i, regrets); });
  }

  template <class Arms>
  void update(Arms const& arms, std::size_t chosen, double score, ReturnScale const& scale) const {
    double const regrets = positive_regrets(arms);
    auto const known = [&](std::size_t i) { return arms[i].visits > 0 ? scale.score(arms[i]) : 0.5; };
    double const surprise = (score - known(chosen)) / mixed(arms, chosen, regrets);
    double expected = probability(arms, chosen, regrets) * surprise;
    for (std::size_t i = 0; i < arms.size(); ++i) expected += probability(arms, i, regrets) * known(i);
    for (std::size_t i = 0; i < arms.size(); ++i)
      arms[i].statistics.regret += known(i) + (i == chosen ? surprise : 0.0) - expected;
  }

 private:
  template <class Arms>
  [[nodiscard]] static double positive_regrets(Arms const& arms) {
    double sum = 0.0;
    for (auto const& arm : arms) sum += std::max(0.0, arm.statistics.regret);
    return sum;
  }

  /// Probability of arm `i` by regret alone.
  template <class Arms>
  [[nodiscard]] static double probability(Arms const& arms, std::size_t i, double regrets) {
    return regrets > 0.0 ? std::max(0.0, arms[i].statistics.regret) / regrets : 1.0 / static_cast<double>(arms.size());
  }

  /// Probability with which arm `i` is played: by regret, mixed with uniform exploration.
  template <class Arms>
  [[nodiscard]] double mixed(Arms const& arms, std::size_t i, double regrets) const {
    return exploration / static_cast<double>(arms.size()) + (1.0 - exploration) * probability(arms, i, regrets);
  }
};
static_assert(SelectionPolicy<RegretMatching>);

}  // namespace cambium::inline v0_1
