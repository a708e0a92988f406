#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/planner/planner_model.hpp"
#include "cambium/planner/predicted.hpp"
#include "cambium/planner/mcts/traffic_domain.hpp"
#include "cambium/planner/search/parallel_tree_search.hpp"
#include "cambium/planner/search/tree_search.hpp"

namespace cambium {

/// How a search of traffic goes about it. Under a `TimeBudget` what comes out depends on the machine and its load.
template <SelectionPolicy SelectionType = Ucb1, class RolloutType = RandomRollout,
          SearchBudget BudgetType = IterationBudget>
struct MctsOptions {
  using Selection = SelectionType;
  using Rollout = RolloutType;
  using Budget = BudgetType;

  TreeSearchParameters search{.horizon = 30, .discount = 0.95};
  Budget budget{};
  Selection selection{};
  Rollout rollout{};
  double step = 0.2;
  int threads = 1;

  static constexpr char const* name = "mcts_options";
  static constexpr char const* summary = "how a search of traffic goes about it";
  static constexpr auto parameters() {
    using P = MctsOptions;
    return parameter_list(parameter("search", &P::search, "-", {}, "the tree"),
                          parameter("budget", &P::budget, "-", {}, "how long it grows"),
                          parameter("selection", &P::selection, "-", {}, "how agents choose at its nodes"),
                          parameter("rollout", &P::rollout, "-", {}, "how courses go on from its leaves"),
                          parameter("step", &P::step, "s", Range{0.01, 10}, "between decisions"),
                          parameter("threads", &P::threads, "-", Range{1, 64},
                                    "trees that share the budget, each grown by a thread of its own, and are merged"));
  }
};

/// What a search of traffic reports: its candidates are ego's actions at the root.
template <class Domain, class Memory>
struct MctsReport : PlannerReport<typename Domain::World, Memory> {
  SearchResult<typename Domain::Action> result;
  std::vector<AgentId> choosing;  ///< the agents of the result, ego first
};

/// A search of traffic and its memory: what a planner works with.
template <class DomainType, class Options>
class MctsWorkspace {
  static_assert(
      requires { MctsOptions<typename Options::Selection, typename Options::Rollout, typename Options::Budget>{}; },
      "cambium::MctsWorkspace<Domain, Options>: Options must be cambium::MctsOptions<Selection, Rollout, "
      "Budget>, as the last argument of the planner");

  static_assert(
      detail::HasPriors<DomainType> ||
          !requires(typename Options::Selection::Statistics statistics) { statistics.prior; },
      "cambium::MctsWorkspace: a search by priors (cambium::Puct) needs a reward with `double prior(World const&, "
      "Slot slot, cambium::MacroAction const&) const` (see RewardModel)");

 public:
  using Domain = DomainType;
  using World = typename Domain::World;
  using Action = typename Domain::Action;
  using Search = TreeSearch<Domain, typename Options::Selection, typename Options::Rollout, typename Options::Budget>;
  using Result = SearchResult<Action>;

  /// Searches from the domain's world. Throws `ParameterError` where an option is out of its range.
  Result const& run(Domain domain, Options const& options, std::uint64_t seed) {
    if (std::exchange(keeps_, false) && !domain.is_same_game(this->domain())) trees_.forget();
    auto const root = domain.root();
    trees_.set(std::move(domain), options.search, options.selection, options.rollout, options.budget,
               static_cast<std::size_t>(options.threads));
    return trees_.run(root, seed);
  }

  /// Keeps, for the next `think`, what is known of where the best actions lead; returns whether there is anything. To
  /// be asked when the world is about to go on for one step of the search (`MctsOptions::step`). The next `think`, of a
  /// planner with the last report's `memory`, builds on it where the world came out as predicted, at the time that was
  /// predicted (`TrafficDomain::same_state`), and nothing else has changed, in the world, the reward or the actions
  /// (`TrafficDomain::is_same_game`); `result.kept_nodes` says whether it did. Who fills a new world for each think has
  /// to set its time (`WorldOptions::time`). Not where hypotheses are drawn for each iteration: there nodes have no
  /// states.
  bool keep() {
    auto const& result = trees_.result();
    keeps_ = !result.variation.empty() && trees_.keep({result.variation.data(), result.agents});
    return keeps_;
  }

  /// The search after a run; with threads the first one.
  [[nodiscard]] Search& search() {
    if (trees_.searches().empty())
      throw SearchError("workspace", "nothing has been searched yet", "call `think` first");
    return trees_.searches()[0];
  }
  [[nodiscard]] Domain& domain() { return search().domain(); }

  /// Plays the principal variation until `end` [s], and beyond its end what agents do without any manoeuvre; calls
  /// `f(frame)` after each step of the search, and at `end`.
  template <class F>
  void play(double end, F&& f) {
    auto& domain = this->domain();
    auto const& result = trees_.result();
    auto const agents = domain.agents();
    state_ = domain.root();
    joint_.resize(agents);
    RandomStream none(0, 0, 0);
    for (std::size_t step = 0; state_.frame.time < end - 1e-9; ++step) {
      for (std::size_t k = 0; k < agents; ++k)
        joint_[k] = (step + 1) * agents <= result.variation.size() ? result.variation[step * agents + k]
                                                                   : domain.policy_action(state_, k, none);
      // A plan ends where it is asked for: between two steps of the search the course need not be straight.
      double const left = end - state_.frame.time;
      domain.advance(state_, joint_, left < domain.dt() - 1e-9 ? left : domain.dt());
      f(std::as_const(state_.frame));
    }
  }

  /// What the last run, which must have had no problem, found; all but ego's memory.
  template <class Memory>
  [[nodiscard]] MctsReport<Domain, Memory> report() {
    auto& domain = this->domain();
    auto const& world = domain.world();
    MctsReport<Domain, Memory> report;
    report.result = trees_.result();
    for (auto const slot : domain.slots()) report.choosing.push_back(world.roster().agents[slot].id);
    for (auto const& agent : world.roster().agents) report.agents.push_back(agent.id);
    using Set = ActionSet<std::remove_cvref_t<decltype(domain.action_set())>>;
    double second = 0.0;  // share of the visits
    for (auto const& arm : report.result.of(0)) {
      if (report.candidates.size() != report.result.best[0]) second = std::max(second, arm.share);
      report.candidates.push_back(
          {Set::text(domain.action_set(), arm.action), arm.mean_return, arm.visits > 0 ? "" : "not tried"});
    }
    report.chosen = report.result.best[0];
    report.decidedness = std::max(0.0, report.result.choice(0).share - second);
    report.course.push_back(world.frame());
    play(world.time() + search().parameters().horizon * domain.dt(),
         [&](auto const& frame) { report.course.push_back(frame); });
    return report;
  }

 private:
  ParallelTreeSearch<Search> trees_;
  bool keeps_ = false;  ///< the next run may build on what was found
  typename Domain::State state_;
  std::vector<Action> joint_;
};

namespace detail {

/// The purpose of the random numbers of a search in traffic.
inline constexpr std::uint32_t search_purpose = 0x3c75;

/// What carries out the actions: its memory, as of a lane change under way, lasts from one search to the next.
template <class Actions>
using ActionMemory = typename ActionSet<Actions>::Behavior::Memory;

/// The world that is predicted where ego may choose, in the middle of what `memory` says; slot of ego there first in
/// `slots`, or empty.
template <class PredictionWorld, class Actions, class Others, class View>
[[nodiscard]] PredictionWorld world_to_search(View const& view, Actions const& actions,
                                              ActionMemory<Actions> const& memory, Others const& others,
                                              std::vector<Slot>& slots) {
  using Behavior = typename ActionSet<Actions>::Behavior;
  std::optional<Slot> ego;
  auto world = predicted_for<PredictionWorld>(view, ActionSet<Actions>::behavior(actions), others, ego);
  slots.clear();
  if (!ego) return world;
  slots.push_back(*ego);
  world.template memory<Behavior>(view.id()) = memory;
  return world;
}

/// What ego does over the next `dt` [s] by the principal variation, and what it remembers then.
template <class View, class Workspace, class Memory>
void take_course(View const& view, Workspace& workspace, double dt, Plan<View>& plan, Memory& memory) {
  auto const slot = workspace.domain().slots()[0];
  workspace.play(view.time() + dt, [&](auto const& frame) {
    auto const& ego = frame.agents[slot];
    if (plan.trajectory.empty()) plan.action = ego.action;
    if (plan.trajectory.empty() || ego.state.time > plan.trajectory.back().time) plan.trajectory.push_back(ego.state);
    if (auto const* at_end = std::get_if<Workspace::Domain::behavior_index>(&ego.memory)) memory = *at_end;
  });
  go_straight_on(view, view.time() + dt, plan);
}

/// Why a course is over, of the first of `slots` whose is; else that the reward says so.
template <class World>
[[nodiscard]] std::string what_is_over(World const& world, std::span<Slot const> slots) {
  for (auto const slot : slots) {
    auto const who = "agent " + to_string(world.roster().agents[slot].id) + " ";
    auto const status = world.frame().agents[slot].status;
    if (status != AgentStatus::driving) return who + "does not drive: its status is " + to_string(status);
    if (auto const contact = Collision{}.contact(world, slot))
      return who + "touches " + (is_valid(contact->agent) ? "agent " + to_string(contact->agent) : "an object");
    if (OffRoad{}(world, slot)) return who + "is off the road";
    if (OncomingLane{}(world, slot)) return who + "is in a lane of oncoming traffic";
    if (world.reached_goal(slot)) return who + "is at its goal";
  }
  return "the reward (`judge`) says so";
}

/// Throws `SearchError`, in words of traffic, where `ego` could not be planned for.
template <class Action, class Workspace>
void throw_if(SearchResult<Action> const& result, Workspace& workspace, AgentId ego) {
  auto const problem = result.problem;
  auto const where = "agent " + to_string(ego) +
                     (result.problem_steps > 0 ? ", at step " + std::to_string(result.problem_steps) : std::string());
  if (problem == SearchProblem::no_agents || problem == SearchProblem::not_in_world)
    throw SearchError(where, "it is not in the predicted world, or not in traffic", "plan for agents that drive");
  if (problem == SearchProblem::not_finite)
    throw SearchError(where,
                      "its reward (`judge`), its cost or the value of a course is not a finite number, or beyond 1e290",
                      "check what the reward gives in such states");
  if (problem == SearchProblem::no_actions)
    throw SearchError(where, "none of its actions is available in a state that the search came to",
                      "give it one that always is, such as keep_gap or stay");
  if (problem == SearchProblem::terminal_root)
    throw SearchError(
        where,
        "the course is over already (" + what_is_over(workspace.domain().world(), workspace.domain().slots()) + ")",
        "ask the evaluators before you plan");
  cambium::throw_if(problem, result.problem_steps);
}

/// The plan that `search(workspace)`, which says what was found, leads to for the next `dt` [s]. Where ego's course is
/// over already, at its goal as after a collision, it drives on without any manoeuvre. Nothing is kept for the next
/// one: a copy of the world would not have it.
template <class PredictionWorld, class View, class Memory, class Workspace, class Search>
[[nodiscard]] Plan<View> plan_by_search(View const& view, Memory& memory, Workspace& workspace, double dt,
                                        Search&& search) {
  Plan<View> plan;
  plan.status = PlanStatus::failed;
  if constexpr (Predicts<View, typename PredictionWorld::Behaviors, PredictionWorld>) {
    auto const problem = search(workspace).problem;
    if (problem != SearchProblem::none && problem != SearchProblem::terminal_root) return plan;
    plan.status = PlanStatus::valid;
    take_course(view, workspace, dt, plan, memory);
  }
  return plan;
}

}  // namespace detail

}  // namespace cambium
