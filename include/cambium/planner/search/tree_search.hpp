#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "cambium/core/parameters.hpp"
#include "cambium/core/random.hpp"
#include "cambium/planner/search/detail/search_tree.hpp"
#include "cambium/planner/search/rollout.hpp"
#include "cambium/planner/search/search_budget.hpp"
#include "cambium/planner/search/search_domain.hpp"
#include "cambium/planner/search/search_result.hpp"
#include "cambium/planner/search/tree_search_parameters.hpp"
#include "cambium/planner/search/ucb1.hpp"

namespace cambium::inline v0_1 {

/// Monte Carlo tree search in which all agents choose at the same time, each by its own bandit at every node (decoupled
/// UCT with `Ucb1`: Tak, Lanctot, Winands 2014). With one agent it is UCT (Kocsis, Szepesvari 2006).
///
/// An iteration has four phases:
///
///     select      walk down from the root; at each node every agent chooses an arm by `Selection`     choose, descend
///     expand      step the domain by the first joint action that has no node yet, and add its node    descend
///     roll out    play on to the horizon by `Rollout`                                                 roll_out
///     back up     add the discounted return to the chosen arms, from the last step to the root        back_up
///
/// Selection policies see returns scaled to [0, 1] by the bounds seen so far. A node stores its state, so walking down
/// costs no steps; only a domain that draws its root anew (`sample_root`) steps from the root in every iteration.
///
/// Under an `IterationBudget` the result is a pure function of state, parameters and seed. Once warm, a search
/// allocates nothing. O(horizon) steps per iteration.
template <class Domain, SelectionPolicy Selection = Ucb1, class Rollout = RandomRollout,
          SearchBudget Budget = IterationBudget>
class TreeSearch {
  static_assert(
      SearchDomain<Domain>,
      "cambium::TreeSearch<Domain>: Domain must be a game: State, Action, agents(), is_terminal(state), actions "
      "or sample_action, and `bool step(State&, std::span<Action const>, cambium::RandomStream&, "
      "std::span<cambium::AgentOutcome>)` (see SearchDomain)");
  static_assert(!SearchDomain<Domain> || RolloutPolicy<Rollout, Domain>,
                "cambium::TreeSearch<Domain, Selection, Rollout>: Rollout must be a roll-out policy such as "
                "cambium::RandomRollout (see RolloutPolicy)");
  static_assert(TreeSearchBudget<Budget>,
                "cambium::TreeSearch: a tree search does not end by itself; use cambium::IterationBudget or "
                "cambium::TimeBudget");
  static_assert(!SearchDomain<Domain> || detail::fewer_actions_than<Domain, 65536>,
                "cambium::TreeSearch<Domain>: Domain::max_actions must be 1 to 65535");

 public:
  using State = typename Domain::State;
  using Action = typename Domain::Action;
  using ArmType = Arm<Action, typename Selection::Statistics>;
  using Tree = detail::SearchTree<State, ArmType>;
  using Result = SearchResult<Action>;

  /// Throws `ParameterError` if a parameter is out of range.
  explicit TreeSearch(Domain domain, TreeSearchParameters const& parameters = {}, Selection const& selection = {},
                      Rollout const& rollout = {}, Budget const& budget = {})
      : domain_(std::move(domain)), parameters_(parameters), selection_(selection), rollout_(rollout), budget_(budget) {
    check(parameters, selection, rollout, budget);
  }

  /// Replaces the parameters. Keeps the memory, and a kept tree if `parameters` are equal. If it throws (as the
  /// constructor), nothing has changed.
  void set(TreeSearchParameters const& parameters, Selection const& selection, Rollout const& rollout,
           Budget const& budget) {
    check(parameters, selection, rollout, budget);
    if (!equal_parameters(parameters, parameters_)) forget();
    parameters_ = parameters;
    selection_ = selection;
    rollout_ = rollout;
    budget_ = budget;
  }

  /// Searches from `root`. If the domain or the state is faulty, the result is empty except for its `problem`. `tree`
  /// distinguishes searches with the same seed that will be merged. The result is valid until the next run.
  Result const& run(State const& root, std::uint64_t seed, std::uint32_t tree = 0) {
    auto clock = budget_;
    clock.start();
    start(root, seed);
    while (result_.problem == SearchProblem::none && clock.goes_on(result_.iterations)) {
      RandomStream random(seed, tree, static_cast<std::uint32_t>(result_.iterations), iteration_purpose);
      iterate(random);
      if (result_.problem == SearchProblem::none) ++result_.iterations;
    }
    if (result_.problem == SearchProblem::none) detail::fill_result(tree_, scales(), parameters_, chosen_, result_);
    return result_;
  }

  /// Keeps the subtree below `joint`, one action per agent, for the next run; returns whether there is one. The next
  /// run continues it if its root has a state that the domain considers the same (`same_state`). Impossible if the
  /// domain draws its root anew for each iteration, because then nodes have no states.
  bool keep(std::span<Action const> joint) {
    forget();
    if (result_.problem != SearchProblem::none) return false;
    if (detail::SamplesRoot<Domain> || tree_.size() == 0 || joint.size() != tree_.agents()) return false;
    for (std::size_t k = 0; k < joint.size(); ++k) {
      auto const arms = tree_.arms(0, k);
      auto const at = std::ranges::find(arms, joint[k], &ArmType::action);
      if (at == arms.end()) return false;
      chosen_[k] = static_cast<std::uint16_t>(at - arms.begin());
    }
    kept_ = tree_.find(0, {chosen_.data(), joint.size()});
    return kept_ != detail::no_node;
  }

  /// The node that `keep` has kept, in `tree`; `detail::no_node` if there is none.
  [[nodiscard]] std::uint32_t kept() const { return kept_; }
  /// Lets the next run continue `tree`, which another search has kept: its root is what that search had predicted.
  /// `scales`: those of that search.
  void restore_kept(Tree tree, std::vector<ReturnScale> scales) {
    tree_ = std::move(tree);
    scales_ = std::move(scales);
    kept_ = 0;
  }

  /// Lets the next run start with an empty tree.
  void forget() { kept_ = detail::no_node; }

  [[nodiscard]] Result const& result() const { return result_; }
  /// The tree that the last run left.
  [[nodiscard]] Tree const& tree() const { return tree_; }
  [[nodiscard]] Domain& domain() { return domain_; }
  [[nodiscard]] Domain const& domain() const { return domain_; }
  [[nodiscard]] TreeSearchParameters const& parameters() const { return parameters_; }
  [[nodiscard]] Selection const& selection() const { return selection_; }
  [[nodiscard]] Rollout const& rollout() const { return rollout_; }
  [[nodiscard]] Budget& budget() { return budget_; }
  [[nodiscard]] Budget const& budget() const { return budget_; }
  /// The bounds of the returns and the multipliers of the costs at the end of the last run, for each agent.
  [[nodiscard]] std::span<ReturnScale const> scales() const { return scales_; }

 private:
  static constexpr bool resimulates = detail::SamplesRoot<Domain>;
  static constexpr bool lists = detail::ListsActions<Domain>;
  static constexpr std::uint32_t iteration_purpose = 0x75c7;
  static constexpr std::uint32_t root_purpose = 0x75c8;

  template <class... Parameters>
  static void check(Parameters const&... parameters) {
    auto const check_one = [](auto const& one) {
      if constexpr (Described<std::remove_cvref_t<decltype(one)>>) check_parameters(one);
    };
    (check_one(parameters), ...);
  }

  void start(State const& root, std::uint64_t seed) {
    auto const agents = static_cast<std::size_t>(domain_.agents());
    result_.clear(seed, static_cast<std::size_t>(parameters_.horizon), agents);
    depth_ = 0;
    if (agents == 0)
      stop(SearchProblem::no_agents);
    else if (budget_.most() == 0)
      stop(SearchProblem::no_budget);
    else if (domain_.is_terminal(root))
      stop(SearchProblem::terminal_root);
    auto const from = result_.problem == SearchProblem::none ? kept_outcome(root) : detail::no_node;
    bool const builds_on = from != detail::no_node;
    forget();
    if (builds_on)
      tree_.keep_below(from);
    else
      tree_.clear();
    if (result_.problem != SearchProblem::none) return;
    seed_ = seed;
    root_ = root;
    make_room(agents);
    if constexpr (!lists) more_actions_.set(parameters_.action_widening, budget_.most());
    if constexpr (!resimulates && !detail::is_deterministic<Domain>)
      more_outcomes_.set(parameters_.outcome_widening, budget_.most());
    auto const kept = tree_.size();
    auto const most = std::min<std::size_t>(budget_.most(), detail::no_node);
    typename Tree::Limits limits{.agents = agents,
                                 .nodes = most + 1 + kept,
                                 .bytes = parameters_.memory,
                                 .arms_per_node = arms_per_node(agents),
                                 .state_bytes = resimulates ? 0 : sizeof(State) + detail::heap_bytes(domain_, root)};
    if constexpr (requires { budget_.expected(); }) limits.first_nodes = budget_.expected() + 1 + kept;
    if (builds_on) {
      tree_.reserve(limits);
      tree_.state(0) = root;
      result_.kept_nodes = kept;
      return;
    }
    tree_.reset(limits);
    ReturnScale scale{.multiplier = parameters_.constraint.weight};
    if (parameters_.lowest_return < parameters_.highest_return) {
      scale.include(parameters_.lowest_return);
      scale.include(parameters_.highest_return);
    }
    std::fill(scales_.begin(), scales_.end(), scale);
    tree_.add(detail::no_node, chosen_, outcomes_, false, root);
  }

  void stop(SearchProblem problem) {
    result_.problem = problem;
    result_.problem_steps = depth_;
  }

  void make_room(std::size_t agents) {
    auto const depth = static_cast<std::size_t>(parameters_.horizon);
    chosen_.assign(agents, 0);
    joint_.assign(agents, Action{});
    returns_.assign(agents, 0.0);
    costs_.assign(agents, 0.0);
    outcomes_.assign(agents, AgentOutcome{});
    scales_.resize(agents);
    path_.resize(depth + 1);
    path_arms_.resize(depth * agents);
    path_outcomes_.resize(depth * agents);
    if constexpr (lists) {
      options_.resize(Domain::max_actions);
      priors_.resize(Domain::max_actions);
    }
  }

  /// The kept node with the same state as `root`, or none.
  [[nodiscard]] std::uint32_t kept_outcome(State const& root) {
    if (tree_.agents() != static_cast<std::size_t>(domain_.agents())) return detail::no_node;
    return tree_.find_outcome(kept_, [&](std::uint32_t node) {
      return !tree_.node(node).terminal && detail::is_same_state(domain_, tree_.state(node), root);
    });
  }

  [[nodiscard]] std::size_t arms_per_node(std::size_t agents) const {
    if constexpr (lists)
      return agents * Domain::max_actions;
    else
      return agents * 2 * (more_actions_.from.size() + 1);
  }

  void iterate(RandomStream& random) {
    std::uint32_t node = 0;
    int depth = 0;
    bool over = false, is_new = false;
    if constexpr (resimulates) {
      work_ = root_;
      domain_.sample_root(work_, random);
    }
    path_[0] = 0;
    while (depth < parameters_.horizon && !is_new && !over && node != detail::no_node) {
      depth_ = depth;
      if (!choose(node, resimulates ? work_ : tree_.state(node), random)) break;
      node = descend(node, depth, over, is_new, random);
      if (result_.problem != SearchProblem::none) return;
      ++depth;
      path_[static_cast<std::size_t>(depth)] = node;
    }
    if (result_.problem != SearchProblem::none) return;
    std::fill(returns_.begin(), returns_.end(), 0.0);
    std::fill(costs_.begin(), costs_.end(), 0.0);
    if (!over) {
      if (!resimulates && !is_new && node != detail::no_node) work_ = tree_.state(node);
      roll_out(depth, random);
    }
    back_up(depth);
  }

  /// Lets every agent choose an arm at the node; false if its arms do not fit into memory.
  bool choose(std::uint32_t node, State const& state, RandomStream& random) {
    auto const chosen_before = detail::total_visits(tree_.arms(node, 0));  // how often they have chosen here
    for (std::size_t k = 0; k < tree_.agents(); ++k) {
      if constexpr (lists) {
        if (tree_.arms(node, k).empty() && !list_arms(node, k, state)) return false;
      } else {
        if (!widen(node, k, state, chosen_before)) return false;
      }
      if (result_.problem != SearchProblem::none) return false;
      auto const arms = std::as_const(tree_).arms(node, k);
      chosen_[k] = static_cast<std::uint16_t>(selection_.select(arms, chosen_before, scales_[k], random));
      joint_[k] = arms[chosen_[k]].action;
    }
    return true;
  }

  /// Gives the agent its listed actions as arms at the node; false if they are faulty or do not fit into memory.
  bool list_arms(std::uint32_t node, std::size_t agent, State const& state) {
    auto const count = static_cast<std::size_t>(domain_.actions(state, agent, options_));
    if (count == 0 || count > options_.size()) {
      stop(SearchProblem::no_actions);
      return false;
    }
    if (!tree_.has_room_for_arms(count)) {
      result_.is_full = true;
      return false;
    }
    for (std::size_t i = 0; i < count; ++i) tree_.add_arm(node, agent, count).action = options_[i];
    set_priors(node, agent, state);
    return true;
  }

  /// Samples another action for the agent if the widening permits; false if it then has no arm at all.
  bool widen(std::uint32_t node, std::size_t agent, State const& state, std::uint32_t chosen_before) {
    auto const count = tree_.arms(node, agent).size();
    if (!more_actions_.allow(count, chosen_before + 1)) return true;
    if (!tree_.has_room_for_arms(std::max<std::size_t>(4, 2 * count))) {
      result_.is_full = true;
      return count > 0;
    }
    // Independent of the tree's number: trees to be merged try the same actions at the root.
    RandomStream random(seed_, static_cast<std::uint32_t>(agent), static_cast<std::uint32_t>(count),
                        root_purpose + node * 2);
    tree_.add_arm(node, agent, 4).action = domain_.sample_action(state, agent, random);
    set_priors(node, agent, state);
    return true;
  }

  void set_priors([[maybe_unused]] std::uint32_t node, [[maybe_unused]] std::size_t agent,
                  [[maybe_unused]] State const& state) {
    if constexpr (detail::HasPriors<Domain> && requires(ArmType arm) { arm.statistics.prior; }) {
      auto const arms = tree_.arms(node, agent);
      options_.resize(std::max(options_.size(), arms.size()));
      priors_.resize(options_.size());
      for (std::size_t i = 0; i < arms.size(); ++i) options_[i] = arms[i].action;
      std::span<double> const priors(priors_.data(), arms.size());
      std::fill(priors.begin(), priors.end(), 1.0);
      domain_.priors(state, agent, std::span<Action const>(options_.data(), arms.size()), priors);
      double sum = 0.0;
      for (auto const prior : priors) sum += prior >= 0.0 ? prior : std::numeric_limits<double>::quiet_NaN();
      if (!(sum > 0.0 && sum <= std::numeric_limits<double>::max())) return stop(SearchProblem::bad_priors);
      for (std::size_t i = 0; i < arms.size(); ++i) arms[i].statistics.prior = priors[i];
    }
  }

  /// The node to which the chosen actions lead from `node`; adds it if necessary, or returns none if there is no room.
  /// If it stepped the domain, `work_` is the state reached.
  std::uint32_t descend(std::uint32_t node, int depth, bool& over, bool& is_new, RandomStream& random) {
    auto const agents = tree_.agents();
    std::copy(chosen_.begin(), chosen_.end(), path_arms_.begin() + depth * static_cast<std::ptrdiff_t>(agents));
    auto child = tree_.find(node, chosen_);
    std::span<AgentOutcome> const outcomes(path_outcomes_.data() + static_cast<std::size_t>(depth) * agents, agents);
    auto const wants_outcome = [&] {
      auto const [count, visits] = tree_.outcomes_of_actions(child);
      return more_outcomes_.allow(count, visits + 1);
    };
    if (!resimulates && child != detail::no_node && (detail::is_deterministic<Domain> || !wants_outcome())) {
      if constexpr (!detail::is_deterministic<Domain>) child = tree_.drawn_outcome(child, random);
      std::ranges::copy(tree_.outcomes(child), outcomes.begin());
      over = tree_.node(child).terminal;
      return child;
    }
    if (!resimulates) work_ = tree_.state(node);
    std::fill(outcomes.begin(), outcomes.end(), AgentOutcome{});
    over = domain_.step(work_, joint_, random, outcomes);
    depth_ = depth + 1;
    if (auto const problem = detail::problem_of(outcomes); problem != SearchProblem::none) stop(problem);
    if (resimulates && child != detail::no_node) return child;
    if constexpr (!resimulates && !detail::is_deterministic<Domain> && std::equality_comparable<State>)
      if (auto const known = tree_.find_outcome(child, [&](auto other) { return tree_.state(other) == work_; });
          known != detail::no_node) {
        ++tree_.node(known).draws;
        return known;
      }
    is_new = true;
    if (!tree_.has_room()) {
      result_.is_full = true;
      return detail::no_node;
    }
    return tree_.add(node, chosen_, outcomes, over, work_);
  }

  void roll_out(int depth, RandomStream& random) {
    RolloutRun<Domain> run{domain_,
                           work_,
                           random,
                           parameters_.horizon - depth,
                           parameters_.discount,
                           parameters_.constraint.effective_discount(),
                           returns_,
                           costs_,
                           joint_,
                           outcomes_,
                           options_};
    rollout_.roll_out(run);
    depth_ = depth + run.played;
    if (run.problem != SearchProblem::none) return stop(run.problem);
    for (std::size_t k = 0; k < returns_.size(); ++k)
      if (!std::isfinite(returns_[k]) || !std::isfinite(costs_[k])) stop(SearchProblem::not_finite);
  }

  void back_up(int depth) {
    if (result_.problem != SearchProblem::none) return;
    auto const agents = tree_.agents();
    ++result_.depths[static_cast<std::size_t>(depth)];
    for (auto d = static_cast<std::size_t>(depth); d-- > 0;) {
      if (path_[d + 1] != detail::no_node) ++tree_.node(path_[d + 1]).visits;
      for (std::size_t k = 0; k < agents; ++k) {
        auto const& outcome = path_outcomes_[d * agents + k];
        returns_[k] = outcome.reward + parameters_.discount * returns_[k];
        costs_[k] = std::min(1.0, outcome.cost + parameters_.constraint.effective_discount() * costs_[k]);
        scales_[k].include(returns_[k], costs_[k]);
        auto const arms = tree_.arms(path_[d], k);
        auto& arm = arms[path_arms_[d * agents + k]];
        selection_.update(arms, path_arms_[d * agents + k], scales_[k].score(returns_[k], costs_[k]), scales_[k]);
        ++arm.visits;
        arm.total_return += returns_[k];
        arm.total_cost += costs_[k];
      }
    }
    for (auto const& scale : scales_)  // the scale has seen all returns
      if (!scale.can_be_summed()) return stop(SearchProblem::not_finite);
    ++tree_.node(0).visits;
    if (parameters_.constraint.limit < 1.0) update_multipliers();
  }

  /// A step of gradient ascent on the Lagrangian (Lee et al. 2018, CC-POMCP): raises the multiplier while the best arm
  /// exceeds the cost limit, else lowers it.
  void update_multipliers() {
    double const step = parameters_.constraint.step / std::sqrt(static_cast<double>(tree_.node(0).visits));
    for (std::size_t k = 0; k < tree_.agents(); ++k) {
      auto const arms = std::as_const(tree_).arms(0, k);
      auto const best =
          detail::best_arm(arms, [&](auto const& arm) { return arm.visits > 0 ? scales_[k].score(arm) : -1.0; });
      auto& multiplier = scales_[k].multiplier;
      multiplier = std::clamp(multiplier + step * (arms[best].mean_cost() - parameters_.constraint.limit), 0.0, 1e3);
    }
  }

  Domain domain_;
  TreeSearchParameters parameters_;
  Selection selection_;
  Rollout rollout_;
  Budget budget_;
  Tree tree_;
  Result result_;
  std::uint32_t kept_ = detail::no_node;  ///< first outcome of the kept subtree
  int depth_ = 0;                         ///< steps from the root, for messages
  std::uint64_t seed_ = 0;
  State root_{}, work_{};
  detail::WideningSchedule more_actions_, more_outcomes_;
  std::vector<ReturnScale> scales_;  ///< by agent, like the next ones
  std::vector<std::uint16_t> chosen_;
  std::vector<Action> joint_, options_;
  std::vector<double> returns_, costs_, priors_;
  std::vector<AgentOutcome> outcomes_;
  std::vector<std::uint32_t> path_;       ///< nodes of this iteration, by depth
  std::vector<std::uint16_t> path_arms_;  ///< by depth and agent
  std::vector<AgentOutcome> path_outcomes_;
};

}  // namespace cambium::inline v0_1
