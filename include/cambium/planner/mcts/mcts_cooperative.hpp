#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/following/idm_classic.hpp"
#include "cambium/planner/detail/predicted.hpp"
#include "cambium/planner/mcts/mcts_workspace.hpp"

namespace cambium {

/// Plans by tree search in which ego and those near it choose at once, each for itself and, by `cooperation`, for the
/// others: reward = own + cooperation x the others' (Lenz, Kessler, Knoll 2016). Who is farther away follows `Others`.
/// The others' goals are not known: let the reward say what everybody wants, as speed and no collision.
template <class PredictionWorld, class Actions = MacroActions, class Reward = TrafficReward, class Others = IdmClassic,
          class Options = MctsOptions<>>
struct MctsCooperative {
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
  double cooperation = 0.5;
  int most_agents = 4;
  double range = 50.0;

  static constexpr char const* name = "mcts_cooperative";
  static constexpr char const* summary =
      "tree search (decoupled UCT) in which ego and those near it choose at once, for themselves and for each other";
  static constexpr char const* source = "Lenz, Kessler, Knoll 2016; Tak, Lanctot, Winands 2014";
  static constexpr auto parameters() {
    using P = MctsCooperative;
    return parameter_list(
        parameter("actions", &P::actions, "-", {}, "what those who choose may do"),
        parameter("others", &P::others, "-", {}, "how the rest is expected to behave"),
        parameter("reward", &P::reward, "-", {}, "what each wants"),
        parameter("options", &P::options, "-", {}, "how it is searched"),
        parameter("cooperation", &P::cooperation, "-", Range{0, 1}, "weight of the others' rewards in one's own"),
        parameter("most_agents", &P::most_agents, "-", Range{1, 32}, "who choose, ego among them"),
        parameter("range", &P::range, "m", non_negative, "who is farther away does not choose"));
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
    if (!slots.empty())
      for (auto const slot :
           detail::nearest_agents(world, slots[0], static_cast<std::size_t>(most_agents - 1), range)) {
        if (reward.judge(world, slot, options.step).ends) continue;  // its course is over
        world.set_behavior(world.roster().agents[slot].id, detail::ActionSet<Actions>::behavior(actions));
        slots.push_back(slot);
      }
    return workspace.run(Domain(std::move(world), slots, actions, reward, options.step, cooperation), options,
                         view.random(detail::search_purpose)());
  }
};

}  // namespace cambium
