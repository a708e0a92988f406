#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "cambium/core/distributions.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/parameters.hpp"

namespace cambium {

/// How many children a node may have after N visits: coefficient N^exponent, one at least (progressive widening: Coulom
/// 2007; of actions and of outcomes: Couetoux et al. 2011).
struct Widening {
  double coefficient = 1.0;
  double exponent = 0.5;

  static constexpr char const* name = "widening";
  static constexpr char const* summary = "a node visited N times may have coefficient N^exponent children";
  static constexpr auto parameters() {
    return parameter_list(
        parameter("coefficient", &Widening::coefficient, "-", Range{0, 1e4}, "children after the first visit"),
        parameter("exponent", &Widening::exponent, "-", Range{0, 1}, "0: no growth; 1: one more with every visit"));
  }
};

namespace detail {

/// From how many visits on a node may have how many children: a widening, worked out beforehand.
struct WideningSchedule {
  static constexpr std::size_t longest = 4096;  ///< no node has more children

  std::vector<double> from;  ///< visits that the second child needs, the third, ...

  void set(Widening const& widening, std::size_t most_visits) {
    from.clear();
    while (from.size() + 1 < longest) {
      double const share = static_cast<double>(from.size() + 2) / widening.coefficient;
      double const visits = share <= 1.0 ? 0.0 : portable_power(share, 1.0 / widening.exponent);
      if (!(visits <= static_cast<double>(most_visits))) break;
      from.push_back(visits);
    }
  }

  /// Whether a node of `children` may have another one.
  [[nodiscard]] bool allow(std::size_t children, std::uint32_t visits) const {
    return children == 0 || (children <= from.size() && static_cast<double>(visits) >= from[children - 1]);
  }
};

}  // namespace detail

/// That the expected cost of the chosen course stays below a limit: a chance constraint, where costs are 1 for what
/// must not happen. The search weighs costs by a Lagrange multiplier, which it learns (Lee et al. 2018, CC-POMCP).
struct CostConstraint {
  double limit = 1.0;
  double step = 1.0;

  static constexpr char const* name = "cost_constraint";
  static constexpr char const* summary =
      "the expected cost of the chosen course stays below a limit, by a Lagrange multiplier";
  static constexpr auto parameters() {
    return parameter_list(
        parameter("limit", &CostConstraint::limit, "-", Range{0, 1}, "greatest expected cost; 1: costs do not count"),
        parameter("step", &CostConstraint::step, "-", Range{0, 1e3},
                  "how fast the multiplier is learnt, divided by the root of the iterations"));
  }
};

/// Which of an agent's actions at the root is the best.
enum class FinalMove : std::uint8_t {
  most_visits,
  best_return,
  lower_bound,  ///< the greatest score less sqrt(ln N / n)
};

/// What every tree search goes by.
struct TreeSearchParameters {
  int horizon = 20;
  double discount = 0.95;
  double lowest_return = 0.0;
  double highest_return = 0.0;
  std::size_t memory = 256u << 20;
  FinalMove final_move = FinalMove::most_visits;
  Widening action_widening{2.0, 0.4};
  Widening outcome_widening{2.0, 0.25};
  CostConstraint constraint{};

  static constexpr char const* name = "tree_search";
  static constexpr char const* summary = "what every tree search goes by";
  static constexpr auto parameters() {
    using P = TreeSearchParameters;
    return parameter_list(
        parameter("horizon", &P::horizon, "-", Range{1, 10'000}, "steps that a course has, in the tree and after it"),
        parameter("discount", &P::discount, "-", Range{0, 1}, "what a reward one step later is worth"),
        parameter("lowest_return", &P::lowest_return, "-", Range{-1e290, 1e290},
                  "counts as seen from the beginning, where returns are scaled by the bounds seen"),
        parameter("highest_return", &P::highest_return, "-", Range{-1e290, 1e290},
                  "likewise; equal to the lowest: only what is seen counts"),
        parameter("memory", &P::memory, "B", Range{4096, 1e12},
                  "the tree grows no larger, but for the moment in which its arrays move, where time is its budget; "
                  "then the search goes on without new nodes"),
        choice("final_move", &P::final_move, "most_visits|best_return|lower_bound",
               "what the move that is made has most of"),
        parameter("action_widening", &P::action_widening, "-", {}, "how many of a continuum of actions are tried"),
        parameter("outcome_widening", &P::outcome_widening, "-", {},
                  "how many outcomes of the same actions become nodes, where steps are random"),
        parameter("constraint", &P::constraint, "-", {}, "what the chosen course may cost"));
  }

  /// Throws `ParameterError` where the bounds of the returns are in the wrong order.
  void check(std::string const& where) const {
    if (!(lowest_return <= highest_return))
      throw ParameterError(where, "has its highest return below the lowest", "swap the two");
  }
};

}  // namespace cambium
