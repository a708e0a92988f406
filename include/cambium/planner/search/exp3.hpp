#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "cambium/core/distributions.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/planner/search/selection_policy.hpp"

namespace cambium::inline v0_1 {

/// Exp3 (Auer, Cesa-Bianchi, Freund, Schapire 2002): plays one of K arms in proportion to exp(gamma G / K). G sums the
/// arm's scores, each divided by the probability with which it was played; gamma is the share of random choices. Makes
/// no assumption about how the others play.
struct Exp3 {
  struct Statistics {
    double gain = 0.0;  ///< G

    static constexpr char const* name = "exp3_statistics";
    static constexpr auto parameters() {
      return parameter_list(parameter("gain", &Statistics::gain, "-", any_finite, "G in the paper"));
    }
  };

  double exploration = 0.1;

  static constexpr char const* name = "exp3";
  static constexpr char const* summary = "plays in proportion to exp(exploration gain / arms), sometimes at random";
  static constexpr char const* source = "Auer 2002 (nonstochastic)";
  static constexpr auto parameters() {
    return parameter_list(parameter("exploration", &Exp3::exploration, "-", Range{1e-6, 1},
                                    "share of random choices, gamma in the paper"));
  }

  template <class Arms, class Random>
  [[nodiscard]] std::size_t select(Arms const& arms, std::uint32_t, ReturnScale const&, Random& random) const {
    auto const norm = normaliser(arms);
    return detail::drawn(arms.size(), random, [&](std::size_t i) { return mixed(arms, i, norm); });
  }

  template <class Arms>
  void update(Arms const& arms, std::size_t chosen, double score, ReturnScale const&) const {
    arms[chosen].statistics.gain += score / mixed(arms, chosen, normaliser(arms));
  }

 private:
  struct Normaliser {
    double best, sum;
  };

  template <class Arms>
  [[nodiscard]] Normaliser normaliser(Arms const& arms) const {
    double best = arms[0].statistics.gain, sum = 0.0;
    for (auto const& arm : arms) best = std::max(best, arm.statistics.gain);
    for (auto const& arm : arms) sum += weight(arm, best, arms.size());
    return {best, sum};
  }

  /// Weight of the arm, relative to that of the best one so that it does not overflow.
  template <class Arm>
  [[nodiscard]] double weight(Arm const& arm, double best, std::size_t arms) const {
    return portable::exp(exploration * (arm.statistics.gain - best) / static_cast<double>(arms));
  }

  template <class Arms>
  [[nodiscard]] double mixed(Arms const& arms, std::size_t i, Normaliser const& norm) const {
    return exploration / static_cast<double>(arms.size()) +
           (1.0 - exploration) * weight(arms[i], norm.best, arms.size()) / norm.sum;
  }
};
static_assert(SelectionPolicy<Exp3>);

}  // namespace cambium::inline v0_1
