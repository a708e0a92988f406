#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/following/idm_classic.hpp"
#include "cambium/planner/detail/predicted.hpp"
#include "cambium/planner/mcts/mcts_workspace.hpp"

namespace cambium {

/// Plans by Monte Carlo tree search over predicted worlds: ego chooses among `Actions`, the others follow `Others`.
/// `PredictionWorld`: the world's own type with a behaviour set that holds both. A behaviour like any other, in
/// simulation and, with a small budget, in predictions; or call `think` to be told what it thought. As a behaviour it
/// searches anew at each step: a copied world has no tree.
template <class PredictionWorld, class Actions = MacroActions, class Reward = TrafficReward, class Others = IdmClassic,
          class Options = MctsOptions<>>
struct MctsSingleAgent {
  static_assert(detail::check_planner<PredictionWorld, Others>());
  static_assert(Described<Others>,
                "cambium: a planner's Others must be a behaviour with described parameters, as cambium::IdmClassic; "
                "where it has none: `static constexpr auto parameters() { return cambium::parameter_list(); }`");

  using Domain = TrafficDomain<PredictionWorld, Actions, Reward>;
  using Workspace = MctsWorkspace<Domain, Options>;
  using Memory = detail::ActionMemory<Actions>;

  Actions actions{};
  Others others{};
  Reward reward{};
  Options options{};

  static constexpr char const* name = "mcts_single_agent";
  static constexpr char const* summary =
      "tree search (UCT) over its own actions in predicted worlds; the others follow a behaviour model";
  static constexpr char const* source = "Kocsis, Szepesvari 2006; Bernhard 2020";
  static constexpr auto parameters() {
    using P = MctsSingleAgent;
    return parameter_list(parameter("actions", &P::actions, "-", {}, "what ego may do"),
                          parameter("others", &P::others, "-", {}, "how the others are expected to behave"),
                          parameter("reward", &P::reward, "-", {}, "what ego wants"),
                          parameter("options", &P::options, "-", {}, "how it is searched"));
  }

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory& memory, double dt, Workspace& workspace) const {
    return detail::plan_by_search<PredictionWorld>(
        view, memory, workspace, dt, [&](auto& w) -> auto const& { return search(view, memory, w); });
  }

  /// What it thinks of what `view` shows. `memory`: the manoeuvre under way, as the last report's `memory`, or ego's
  /// record in a frame of its `course`, has it; {} for none. `workspace.keep()` before it: see there. Throws
  /// `SearchError` where there is nothing to search, `ParameterError` where a parameter is out of its range.
  template <class View>
  [[nodiscard]] MctsReport<Domain> think(View const& view, Memory const& memory, Workspace& workspace) const {
    check_parameters(*this);
    detail::throw_if(search(view, memory, workspace), workspace, view.id());
    return workspace.report();
  }

 private:
  template <class View>
  [[nodiscard]] SearchResult<typename Domain::Action> const& search(View const& view, Memory const& memory,
                                                                    Workspace& workspace) const {
    std::vector<Slot> slots;
    auto world = detail::world_to_search<PredictionWorld>(view, actions, memory, others, slots);
    return workspace.run(Domain(std::move(world), slots, actions, reward, options.step), options,
                         view.random(detail::search_purpose)());
  }
};

}  // namespace cambium
