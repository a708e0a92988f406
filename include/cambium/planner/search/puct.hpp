#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "cambium/core/parameters.hpp"
#include "cambium/planner/search/selection_policy.hpp"

namespace cambium {

/// PUCT (Rosin 2011, as in Silver 2017): selects the arm with the highest score plus exploration P sqrt(N) / (1 + n). P
/// is its prior probability: `SearchDomain::priors`, normalised over the node's actions, or uniform without them. An
/// untried arm has the mean score of its node.
struct Puct {
  struct Statistics {
    double prior = 1.0;  ///< set by the search; the sum over a node need not be 1
  };

  double exploration = 1.25;

  static constexpr char const* name = "puct";
  static constexpr char const* summary = "score plus exploration prior sqrt(N) / (1 + n)";
  static constexpr char const* source = "Rosin 2011; Silver 2017";
  static constexpr auto parameters() {
    return parameter_list(
        parameter("exploration", &Puct::exploration, "-", Range{0, 100}, "weight of the prior against the score"));
  }

  template <class Arms, class Random>
  [[nodiscard]] std::size_t select(Arms const& arms, std::uint32_t visits, ReturnScale const& scale, Random&) const {
    double priors = 0.0, returns = 0.0, costs = 0.0;
    for (auto const& arm : arms) {
      priors += arm.statistics.prior;
      returns += arm.total_return;
      costs += arm.total_cost;
    }
    double const known = visits > 0 ? scale.score(returns / visits, costs / visits) : 0.5;
    // Before the first visit the prior alone decides.
    double const weight = exploration / priors * std::sqrt(visits > 0 ? static_cast<double>(visits) : 1.0);
    return detail::best_arm(arms, [&](auto const& arm) {
      return (arm.visits > 0 ? scale.score(arm) : known) + weight * arm.statistics.prior / (1.0 + arm.visits);
    });
  }

  template <class Arms>
  void update(Arms const&, std::size_t, double, ReturnScale const&) const {}
};
static_assert(SelectionPolicy<Puct>);

}  // namespace cambium
