#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/planner/detail/predicted.hpp"
#include "cambium/planner/traffic_domain.hpp"
#include "cambium/planner/tree_search.hpp"

namespace cambium {

/// How a search of traffic goes about it.
template <class Selection = Ucb1, class Rollout = RandomRollout>
struct MctsOptions {
  TreeSearchParameters search{.horizon = 30, .discount = 0.95};
  IterationBudget budget{};
  Selection selection{};
  Rollout rollout{};
  double step = 0.2;

  static constexpr char const* name = "mcts";
  static constexpr char const* summary = "how a search of traffic goes about it";
  static constexpr auto parameters() {
    using P = MctsOptions;
    return std::make_tuple(parameter("search", &P::search, "-", {}, "the tree"),
                           parameter("budget", &P::budget, "-", {}, "how long it grows"),
                           parameter("selection", &P::selection, "-", {}, "how agents choose at its nodes"),
                           parameter("rollout", &P::rollout, "-", {}, "how courses go on from its leaves"),
                           parameter("step", &P::step, "s", Range{0.01, 10}, "between decisions"));
  }
};

/// What a search of traffic thought.
template <class World, class Choice>
struct MctsReport {
  SearchResult<Choice> result;
  std::vector<AgentId> choosing;                  ///< the agents of the result, ego first
  std::vector<std::string> actions;               ///< ego's actions at the root, in words
  std::vector<typename World::FrameType> course;  ///< the principal variation: all agents, now and step by step
  std::vector<AgentId> agents;                    ///< of the frames' records
};

/// A search of traffic and its memory: what a planner works with.
template <class DomainType, class Selection, class Rollout>
class MctsWorkspace {
 public:
  using Domain = DomainType;
  using World = typename Domain::World;
  using Action = typename Domain::Action;
  using Search = TreeSearch<Domain, Selection, Rollout>;
  using Result = SearchResult<Action>;

  /// Searches from the domain's world. Throws `ParameterError` where an option is out of its range.
  Result const& run(Domain domain, MctsOptions<Selection, Rollout> const& options, std::uint64_t seed) {
    auto root = domain.root();
    if (search_) {
      search_->domain() = std::move(domain);
      search_->set(options.search, options.selection, options.rollout, options.budget);
    } else {
      search_.emplace(std::move(domain), options.search, options.selection, options.rollout, options.budget);
    }
    return search_->run(root, seed);
  }

  /// The search after a run.
  [[nodiscard]] Search& search() { return *search_; }

  /// Plays the principal variation until `end` [s], and beyond its end what agents do without any manoeuvre; calls
  /// `f(frame)` after each step of the search, and at `end`.
  template <class F>
  void play(double end, F&& f) {
    auto& domain = search_->domain();
    auto const& result = search_->result();
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

  /// What the last run thought.
  [[nodiscard]] MctsReport<World, Action> report() {
    auto& domain = search_->domain();
    auto const& world = domain.world();
    MctsReport<World, Action> report;
    report.result = search_->result();
    for (auto const slot : domain.slots()) report.choosing.push_back(world.roster().agents[slot].id);
    for (auto const& agent : world.roster().agents) report.agents.push_back(agent.id);
    if (report.result.problem != SearchProblem::none) return report;
    using Set = detail::ActionSet<std::remove_cvref_t<decltype(domain.action_set())>>;
    for (auto const& arm : report.result.of(0)) report.actions.push_back(Set::text(domain.action_set(), arm.action));
    report.course.push_back(world.frame());
    double const steps = static_cast<double>(report.result.variation.size() / domain.agents());
    play(world.time() + steps * domain.dt(), [&](auto const& frame) { report.course.push_back(frame); });
    return report;
  }

 private:
  std::optional<Search> search_;
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
                                              std::vector<std::uint32_t>& slots) {
  using Behavior = typename ActionSet<Actions>::Behavior;
  std::optional<std::uint32_t> ego;
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
  auto const slot = workspace.search().domain().slots()[0];
  workspace.play(view.time() + dt, [&](auto const& frame) {
    auto const& ego = frame.agents[slot];
    if (plan.trajectory.empty()) plan.action = ego.action;
    plan.trajectory.push_back(ego.state);
    if (auto const* at_end = std::get_if<Workspace::Domain::behavior_index>(&ego.memory)) memory = *at_end;
  });
}

/// Throws `SearchError`, in words of traffic, where `ego` cannot be planned for.
inline void throw_if(SearchProblem problem, AgentId ego) {
  auto const where = "agent " + to_string(ego);
  if (problem == SearchProblem::no_agents) cambium::throw_if(SearchProblem::not_in_world);
  if (problem == SearchProblem::no_actions)
    throw SearchError(where, "none of its actions is available in a state that the search came to",
                      "give it one that always is, such as keep_gap or stay");
  if (problem == SearchProblem::terminal_root)
    throw SearchError(where, "its course is over: it touches something, is off the road, or is at its goal",
                      "ask the evaluators before you plan");
  cambium::throw_if(problem);
}

/// The plan that `search(workspace)`, which says what was found, leads to for the next `dt` [s]. Where ego's course is
/// over already, at its goal as after a collision, it drives on without any manoeuvre.
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
