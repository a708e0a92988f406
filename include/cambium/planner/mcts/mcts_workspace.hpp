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
#include "cambium/core/constants.hpp"
#include "cambium/planner/planner_model.hpp"
#include "cambium/planner/predicted.hpp"
#include "cambium/planner/mcts/traffic_domain.hpp"
#include "cambium/planner/search/parallel_tree_search.hpp"
#include "cambium/planner/search/puct.hpp"
#include "cambium/planner/search/tree_search.hpp"

namespace cambium::inline v0_1 {

/// Settings of a tree search in traffic. Under a `TimeBudget` the result depends on the machine and its load.
template <SelectionPolicy SelectionType = Puct, class RolloutType = PolicyRollout,
          SearchBudget BudgetType = IterationBudget>
struct MctsOptions {
  using Selection = SelectionType;
  using Rollout = RolloutType;
  using Budget = BudgetType;

  TreeSearchParameters search{.horizon = 8, .discount = 0.9, .constraint = {.discount = 0.9}};
  Budget budget{};
  Selection selection{};
  Rollout rollout{};
  double step = 0.2;
  int hold = 5;
  int threads = 1;

  static constexpr char const* name = "mcts_options";
  static constexpr char const* summary = "settings of a tree search in traffic";
  static constexpr auto parameters() {
    using P = MctsOptions;
    return parameter_list(parameter("search", &P::search, "the tree"),
                          parameter("budget", &P::budget, "how long the tree grows"),
                          parameter("selection", &P::selection, "how agents choose at the nodes"),
                          parameter("rollout", &P::rollout, "how courses continue from the leaves"),
                          parameter("step", &P::step, "s", Range{0.01, 10}, "time step of the predictions"),
                          parameter("hold", &P::hold, "-", Range{1, 1000},
                                    "steps for which an action is kept: between two decisions of the tree"),
                          parameter("threads", &P::threads, "-", Range{1, 64},
                                    "number of trees that share the budget, one per thread, merged at the end"));
  }
};

/// What a tree search in traffic reports. Its candidates are ego's actions at the root.
template <class Domain, class Memory>
struct MctsReport : PlannerReport<typename Domain::World, Memory> {
  SearchResult<typename Domain::Action> result;
  std::vector<AgentId> choosing;  ///< the agents that choose, as in `result`; ego first
};

/// The trees of an `Mcts` and the memory that it reuses.
template <class DomainType, class Options>
class MctsWorkspace {
  static_assert(
      requires { MctsOptions<typename Options::Selection, typename Options::Rollout, typename Options::Budget>{}; },
      "cambium::MctsWorkspace<Domain, Options>: Options must be cambium::MctsOptions<Selection, Rollout, "
      "Budget>, as the last argument of the planner");

 public:
  using Domain = DomainType;
  using World = typename Domain::World;
  using Action = typename Domain::Action;
  using Search = TreeSearch<Domain, typename Options::Selection, typename Options::Rollout, typename Options::Budget>;
  using Result = SearchResult<Action>;

  static constexpr char const* name = "workspace";

  /// Searches from the domain's world. The budget of `options` must have been started. Throws `ParameterError` if an
  /// option is out of range.
  Result const& run(Domain domain, Options const& options, std::uint64_t seed) {
    if (!std::exchange(keeps_, false) || !domain.is_same_game(this->domain())) trees_.forget();
    auto const root = domain.root();
    trees_.set(domain, options.search, options.selection, options.rollout, options.budget,
               static_cast<std::size_t>(options.threads));
    return trees_.run(root, seed);
  }

  /// Keeps the subtree below the best actions for the next `think`; returns whether there is one. Call it before the
  /// world advances by one step of the search, with `MctsOptions::hold` 1: the memory in a report is that after one
  /// step, and with longer decisions there is no tree to keep. The next `think`, with the `memory` of
  /// the last report, continues the subtree if the world turns out as predicted, at the predicted time
  /// (`TrafficDomain::same_state`), and nothing else has changed in the world, the reward or the actions
  /// (`TrafficDomain::is_same_game`). What is expected of the others must not change either: without
  /// `Mcts::others_keep_speed`. `result.kept_nodes` tells whether it continued. If you fill a new world for each
  /// `think`, set its time (`WorldOptions::time`). Impossible with hypotheses about the others, because then nodes have
  /// no states.
  bool keep() {
    if (keeps_) return true;  // as it has before, or one that was restored
    auto const& result = trees_.result();
    keeps_ = !result.variation.empty() && domain().hold() == 1 && trees_.keep({result.variation.data(), result.agents});
    return keeps_;
  }

  /// The trees of which `keep` has kept something; null if there are none.
  [[nodiscard]] ParallelTreeSearch<Search> const* kept() const { return keeps_ ? &trees_ : nullptr; }
  /// Lets the next `think` continue trees that another workspace has kept.
  void restore_kept(ParallelTreeSearch<Search> trees) {
    trees_ = std::move(trees);
    keeps_ = true;
  }

  /// The search after a run; the first one if there are several threads. Throws `SearchError` before the first run.
  [[nodiscard]] Search& search() {
    require_run();
    return trees_.searches()[0];
  }
  [[nodiscard]] Domain& domain() { return search().domain(); }

  /// The world to whose agents the frames of `play` belong. Throws `SearchError` before the first run.
  [[nodiscard]] World const& predicted() const {
    require_run();
    return trees_.searches()[0].domain().world();
  }

  /// How many decisions of ego it has compared.
  [[nodiscard]] std::size_t compared() const { return trees_.result().of(0).size(); }

  /// The state from which the agents go on with what they have decided.
  [[nodiscard]] typename Domain::State decided() {
    auto state = domain().root();
    auto const& result = trees_.result();
    if (result.variation.size() >= result.agents) domain().choose(state, {result.variation.data(), result.agents});
    return state;
  }

  /// Plays the principal variation until the time `end` [s]; if it is shorter, all agents then drive on without a
  /// manoeuvre. Calls `f(frame)` after each step of the search, and at `end`. With a `first` decision of ego, the
  /// number of an action at the root, all drive on without a manoeuvre after that, unless it is the best.
  template <class F>
  void play(double end, F&& f, std::optional<std::size_t> first = {}) {
    auto& domain = this->domain();
    auto const& result = trees_.result();
    auto const agents = domain.agents();
    state_ = domain.root();
    joint_.resize(agents);
    RandomStream none(0, 0, 0);
    for (std::size_t step = 0; state_.frame.time < end - same_time; ++step) {
      if (auto const hold = static_cast<std::size_t>(domain.hold()); step % hold == 0) {
        auto const decision = step / hold;
        bool const goes_on = !first || *first == result.best[0] || decision == 0;
        bool const is_known = goes_on && (decision + 1) * agents <= result.variation.size();
        for (std::size_t k = 0; k < agents; ++k)
          joint_[k] = is_known ? result.variation[decision * agents + k] : domain.policy_action(state_, k, none);
        if (decision == 0 && first) joint_[0] = result.of(0)[*first].action;
        domain.choose(state_, joint_);
      }
      // `end` may lie between two steps. The course may bend there: take a shorter step instead of interpolating.
      double const left = end - state_.frame.time;
      domain.advance(state_, left < domain.dt() - same_time ? left : domain.dt());
      f(std::as_const(state_.frame));
    }
  }

  /// The plan for the next `dt` [s]: what ego does by the principal variation, and in `memory` its memory then. If its
  /// course is over already, at its goal or after a collision, it drives on without a manoeuvre.
  template <class View, class Memory>
  [[nodiscard]] Plan<View> drive(View const& view, double dt, Memory& memory) {
    Plan<View> plan;
    auto const slot = domain().slots()[0];
    play(view.time() + dt, [&](auto const& frame) {
      auto const& ego = frame.agents[slot];
      if (plan.trajectory.empty()) plan.action = ego.action;
      if (plan.trajectory.empty() || ego.state.time > plan.trajectory.back().time) plan.trajectory.push_back(ego.state);
      if (auto const* at_end = std::get_if<Domain::behavior_index>(&ego.memory)) memory = *at_end;
    });
    go_straight_on(view, view.time() + dt, plan);
    return plan;
  }

  /// The report on the last run, except ego's memory. Precondition: the run had no problem.
  template <class Memory>
  [[nodiscard]] MctsReport<Domain, Memory> report() {
    auto& domain = this->domain();
    auto const& world = domain.world();
    MctsReport<Domain, Memory> report;
    report.result = trees_.result();
    for (auto const slot : domain.slots()) report.choosing.push_back(world.roster().agents[slot].id);
    report.agents = detail::ids_of(world);
    using Set = ActionSet<std::remove_cvref_t<decltype(domain.action_set())>>;
    double const limit = search().parameters().constraint.limit;
    double second = 0.0;  // share of the visits
    for (auto const& arm : report.result.of(0)) {
      bool const is_chosen = report.candidates.size() == report.result.best[0];
      if (!is_chosen) second = std::max(second, arm.share);
      std::string refused;
      if (arm.visits == 0)
        refused = "not tried";
      else if (!is_chosen && detail::estimated_cost(arm) > limit)
        refused = "risk " + detail::rounded_text(detail::estimated_cost(arm)) + " above " + detail::rounded_text(limit);
      double const score = arm.visits == 0 ? 0.0 : search().scales()[0].score(arm.mean_return, arm.mean_cost);
      report.candidates.push_back({Set::text(domain.action_set(), arm.action), score, std::move(refused)});
      report.is_cut_short = report.is_cut_short || arm.visits == 0;
    }
    report.chosen = report.result.best[0];
    report.decidedness = std::max(0.0, report.result.choice(0).share - second);
    report.course = course({});
    return report;
  }

  /// The frames of all agents, now and after each step to the horizon; `first`: see `play`.
  [[nodiscard]] std::vector<typename World::FrameType> course(std::optional<std::size_t> first) {
    auto const& domain = this->domain();
    std::vector frames{domain.world().frame()};
    play(
        domain.world().time() + search().parameters().horizon * domain.hold() * domain.dt(),
        [&](auto const& frame) { frames.push_back(frame); }, first);
    return frames;
  }

 private:
  void require_run() const {
    if (trees_.searches().empty())
      throw SearchError("workspace", "nothing has been searched yet", "call `think` first");
  }

  ParallelTreeSearch<Search> trees_;
  bool keeps_ = false;  ///< the next run may continue the tree
  typename Domain::State state_;
  std::vector<Action> joint_;
};

namespace detail {

/// Why the course of an agent in `slots` is over, in words, for the first agent to which that applies.
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
  return "the reward (`judge`) ends it";
}

/// Throws `SearchError` in terms of traffic, unless the search had no problem.
template <class Action, class Workspace>
void throw_if(SearchResult<Action> const& result, Workspace& workspace, AgentId ego) {
  auto const problem = result.problem;
  auto const where = "agent " + to_string(ego) +
                     (result.problem_steps > 0 ? ", at step " + std::to_string(result.problem_steps) : std::string());
  if (problem == SearchProblem::no_agents || problem == SearchProblem::not_in_world)
    throw SearchError(where, "it is not in the predicted world, or not in traffic", "plan for agents that drive");
  if (problem == SearchProblem::not_finite)
    throw SearchError(where, "its reward (`judge`), its cost or the value of a course is not finite, or exceeds 1e290",
                      "check what the reward returns in such states");
  if (problem == SearchProblem::no_actions)
    throw SearchError(where, "none of its actions is available in a state that the search reached",
                      "add one that always is, such as keep_gap or stay");
  if (problem == SearchProblem::terminal_root)
    throw SearchError(
        where,
        "the course is over already (" + what_is_over(workspace.domain().world(), workspace.domain().slots()) + ")",
        "ask the evaluators before you plan");
  cambium::throw_if(problem, result.problem_steps);
}

}  // namespace detail

}  // namespace cambium::inline v0_1
