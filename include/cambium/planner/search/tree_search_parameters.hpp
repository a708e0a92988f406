#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "cambium/core/distributions.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/portable_math.hpp"

namespace cambium::inline v0_1 {

/// Progressive widening (Coulom 2007; of actions and of outcomes: Couetoux et al. 2011): after N visits, a node may
/// have coefficient N^exponent children, at least one.
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

/// A widening as a table: how many visits a node needs for each further child.
struct WideningSchedule {
  static constexpr std::size_t longest = 4096;  ///< no node has more children

  std::vector<double> from;  ///< visits needed for the second child, the third, ...

  void set(Widening const& widening, std::size_t most_visits) {
    from.clear();
    while (from.size() + 1 < longest) {
      double const share = static_cast<double>(from.size() + 2) / widening.coefficient;
      double const visits = share <= 1.0 ? 0.0 : portable::pow(share, 1.0 / widening.exponent);
      if (!(visits <= static_cast<double>(most_visits))) break;
      from.push_back(visits);
    }
  }

  /// Whether a node with `children` children may get another one.
  [[nodiscard]] bool allow(std::size_t children, std::uint32_t visits) const {
    return children == 0 || (children <= from.size() && static_cast<double>(visits) >= from[children - 1]);
  }
};

}  // namespace detail

/// How costs weigh against returns. Returns alone are scaled to [0, 1], so a forbidden event neither stretches that
/// scale nor gets lost in it. With a limit, the search starts from the weight and learns the Lagrange multiplier that
/// keeps the expected cost of the chosen course within the limit (Lee et al. 2018, CC-POMCP). If a forbidden event
/// costs 1, this is a chance constraint: costs count in full, however late they come. Without a limit, a late event may
/// count less than an early one. The worst course without such an event beats the best one with it at the horizon if
/// the weight exceeds 1 / discount^(horizon - 1).
struct CostConstraint {
  double weight = 2.5;
  double discount = 1.0;
  double limit = 1.0;
  double step = 1.0;

  /// The discount that counts.
  [[nodiscard]] double effective_discount() const { return limit < 1.0 ? 1.0 : discount; }

  static constexpr char const* name = "cost_constraint";
  static constexpr char const* summary =
      "weighs costs beside returns, or keeps the expected cost of the chosen course below a limit, by a Lagrange "
      "multiplier";
  static constexpr auto parameters() {
    return parameter_list(
        parameter("weight", &CostConstraint::weight, "-", Range{0, 1e3},
                  "of a cost of 1, in units of the range of all returns"),
        parameter("discount", &CostConstraint::discount, "-", Range{0, 1},
                  "worth of a cost one step later; with a limit: 1"),
        parameter("limit", &CostConstraint::limit, "-", Range{0, 1}, "greatest expected cost; 1: none"),
        parameter("step", &CostConstraint::step, "-", Range{0, 1e3},
                  "step size of the multiplier, divided by the square root of the iterations"));
  }
};

/// How an agent's best action at the root is determined.
enum class FinalMove : std::uint8_t {
  most_visits,
  best_return,
  lower_bound,  ///< highest score minus sqrt(ln N / n)
};

/// Parameters of every tree search.
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
  static constexpr char const* summary = "parameters of every tree search";
  static constexpr auto parameters() {
    using P = TreeSearchParameters;
    return parameter_list(
        parameter("horizon", &P::horizon, "-", Range{1, 10'000}, "steps of a course, in the tree and beyond it"),
        parameter("discount", &P::discount, "-", Range{0, 1}, "worth of a reward one step later"),
        parameter("lowest_return", &P::lowest_return, "-", Range{-1e290, 1e290},
                  "counts as a return seen before the search: returns are scaled by the bounds seen"),
        parameter("highest_return", &P::highest_return, "-", Range{-1e290, 1e290},
                  "likewise; if equal to the lowest, only returns seen count"),
        parameter("memory", &P::memory, "B", Range{4096, 1e12},
                  "limit of the tree; a full tree gets no new nodes, but the search continues; under a time budget its "
                  "arrays briefly take more while they grow"),
        choice("final_move", &P::final_move, "most_visits|best_return|lower_bound",
               "how the move is chosen at the end"),
        parameter("action_widening", &P::action_widening, "number of actions tried from a continuum"),
        parameter("outcome_widening", &P::outcome_widening,
                  "number of outcomes of the same actions that become nodes, if steps are random"),
        parameter("constraint", &P::constraint, "what costs count for beside returns, and a limit on them"));
  }

  /// Throws `ParameterError` if the bounds of the returns are in the wrong order.
  void check(std::string const& where) const {
    if (!(lowest_return <= highest_return))
      throw ParameterError(where, "has its highest return below the lowest", "swap the two");
  }
};

}  // namespace cambium::inline v0_1
