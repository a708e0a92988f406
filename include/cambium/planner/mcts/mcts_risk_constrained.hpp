#pragma once

#include "cambium/planner/mcts/mcts_single_agent.hpp"

namespace cambium {

/// As `MctsSingleAgent`, with a chance constraint: among courses whose probability of a collision, as far as the search
/// can tell, is at most `risk`, the one of the best reward; where there is none, the one of the least risk. The search
/// learns what a collision weighs (Lagrange multiplier), so the reward need not.
template <class PredictionWorld, class Actions = MacroActions, class Reward = TrafficReward, class Others = IdmClassic,
          class Options = MctsOptions<>>
struct MctsRiskConstrained {
  using SingleAgent = MctsSingleAgent<PredictionWorld, Actions, Reward, Others, Options>;
  using Workspace = typename SingleAgent::Workspace;
  using Memory = typename SingleAgent::Memory;

  SingleAgent planner{};
  double risk = 0.05;

  static constexpr char const* name = "mcts_risk_constrained";
  static constexpr char const* summary =
      "tree search (UCT) for the best reward among courses whose probability of a collision is below a limit";
  static constexpr char const* source = "Lee et al. 2018 (CC-POMCP)";
  static constexpr auto parameters() {
    using P = MctsRiskConstrained;
    return parameter_list(parameter("planner", &P::planner, "-", {}, "the search"),
                          parameter("risk", &P::risk, "-", Range{0, 1},
                                    "greatest expected cost, the share of simulated courses that collide"));
  }

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory& memory, double dt, Workspace& workspace) const {
    return constrained().plan(view, memory, dt, workspace);
  }

  /// What it thinks of what `view` shows. Throws `SearchError` where there is nothing to search.
  template <class View>
  [[nodiscard]] auto think(View const& view, Memory const& memory, Workspace& workspace) const {
    check_parameters(*this);
    return constrained().think(view, memory, workspace);
  }

 private:
  [[nodiscard]] SingleAgent constrained() const {
    auto result = planner;
    result.options.search.constraint.limit = risk;
    return result;
  }
};

}  // namespace cambium
