#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "cambium/core/distributions.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/planner/search/search_domain.hpp"

namespace cambium::inline v0_1 {

/// The input, output and working memory of one roll-out. The search owns it all.
template <SearchDomain Domain>
struct RolloutRun {
  Domain& domain;
  typename Domain::State& state;  ///< start of the roll-out, which advances it
  RandomStream& random;
  int steps;                                    ///< greatest number, up to the search's horizon
  double discount;                              ///< of returns, per step
  double cost_discount;                         ///< of costs
  std::span<double> returns;                    ///< out: per agent, from `state` on
  std::span<double> costs;                      ///< out
  std::span<typename Domain::Action> joint;     ///< working memory, one per agent
  std::span<AgentOutcome> outcomes;             ///< likewise
  std::span<typename Domain::Action> options;   ///< likewise, `max_actions`
  int played = 0;                               ///< out: number of steps
  SearchProblem problem = SearchProblem::none;  ///< out: of the last step
};

/// How a course is valued beyond the tree: a copyable struct of parameters with `roll_out(run)`, which adds to
/// `run.returns` and `run.costs` (initially zero) and returns whether the game ended. No allocation.
template <class R, class Domain>
concept RolloutPolicy = std::copyable<R> && requires(R const rollout, RolloutRun<Domain>& run) {
  { rollout.roll_out(run) } -> std::same_as<bool>;
};

/// Plays up to `steps` steps; in each, agent k takes the action `choose(k, step)`. Returns the discount factor after
/// the last one, or 0 if the game is over.
template <class Run, class Choose>
[[nodiscard]] double play(Run& run, int steps, Choose&& choose) {
  double weight = 1.0, cost_weight = 1.0;
  for (int step = 0; step < steps; ++step) {
    for (std::size_t k = 0; k < run.joint.size(); ++k) run.joint[k] = choose(k, step);
    if (run.problem != SearchProblem::none) return 0.0;
    std::fill(run.outcomes.begin(), run.outcomes.end(), AgentOutcome{});
    bool const over = run.domain.step(run.state, run.joint, run.random, run.outcomes);
    ++run.played;
    run.problem = detail::problem_of(run.outcomes);
    if (run.problem != SearchProblem::none) return 0.0;
    for (std::size_t k = 0; k < run.joint.size(); ++k) {
      run.returns[k] += weight * run.outcomes[k].reward;
      run.costs[k] += cost_weight * run.outcomes[k].cost;
    }
    if (over) return 0.0;
    weight *= run.discount;
    cost_weight *= run.cost_discount;
  }
  return weight;
}

/// A random action of the agent, uniformly distributed.
template <class Run>
[[nodiscard]] auto random_action(Run& run, std::size_t agent) {
  if constexpr (detail::ListsActions<std::remove_reference_t<decltype(run.domain)>>) {
    auto const count = static_cast<std::size_t>(run.domain.actions(run.state, agent, run.options));
    bool const is_wrong = count == 0 || count > run.options.size();
    if (is_wrong) run.problem = SearchProblem::no_actions;
    return run.options[is_wrong ? 0 : uniform_index(run.random, static_cast<std::uint32_t>(count))];
  } else {
    return run.domain.sample_action(run.state, agent, run.random);
  }
}

/// Takes random actions to the horizon and holds each for `hold` steps. More than one step suits games in which an
/// available action remains available.
struct RandomRollout {
  int hold = 1;
  int steps = 1'000'000;

  static constexpr char const* name = "random_rollout";
  static constexpr char const* summary = "random actions to the horizon";
  static constexpr char const* source = "-";
  static constexpr auto parameters() {
    return parameter_list(
        parameter("hold", &RandomRollout::hold, "-", Range{1, 1'000'000}, "steps for which an action is held"),
        parameter("steps", &RandomRollout::steps, "-", Range{1, 1'000'000}, "greatest number of steps"));
  }

  template <class Run>
  bool roll_out(Run& run) const {
    return play(run, std::min(run.steps, steps), [&](std::size_t agent, int step) {
             return step % hold == 0 ? random_action(run, agent) : run.joint[agent];
           }) == 0.0;
  }
};

/// Follows the domain's `policy_action` to the horizon; in traffic, that is a behaviour model. In some steps it takes
/// a random action instead.
struct PolicyRollout {
  double random = 0.1;
  int steps = 1'000'000;

  static constexpr char const* name = "policy_rollout";
  static constexpr char const* summary = "the domain's own policy to the horizon, sometimes a random action";
  static constexpr char const* source = "-";
  static constexpr auto parameters() {
    using P = PolicyRollout;
    return parameter_list(parameter("random", &P::random, "-", Range{0, 1}, "probability of a random action"),
                          parameter("steps", &P::steps, "-", Range{1, 1'000'000}, "greatest number of steps"));
  }

  template <class Run>
  bool roll_out(Run& run) const {
    static_assert(detail::HasPolicy<std::remove_reference_t<decltype(run.domain)>>,
                  "cambium::PolicyRollout: the domain must have a policy: "
                  "`Action policy_action(State const&, std::size_t agent, RandomStream&)`");
    return play(run, std::min(run.steps, steps), [&](std::size_t agent, int) {
             bool const wanders = random > 0.0 && uniform01(run.random) < random;
             return wanders ? random_action(run, agent) : run.domain.policy_action(run.state, agent, run.random);
           }) == 0.0;
  }
};

/// Rolls out `Base` for its number of steps, then adds the domain's `value` of the state that it reached.
template <class Base>
struct TruncatedRollout {
  Base base{};

  static constexpr char const* name = "truncated_rollout";
  static constexpr char const* summary = "the first steps of another roll-out, then the domain's value";
  static constexpr auto parameters() {
    return parameter_list(parameter("base", &TruncatedRollout::base, "the roll-out, and its number of steps"));
  }

  template <class Run>
  bool roll_out(Run& run) const {
    static_assert(detail::HasValue<std::remove_reference_t<decltype(run.domain)>>,
                  "cambium::TruncatedRollout: the domain must value a state: "
                  "`double value(State const&, std::size_t agent)`");
    int const steps = std::min(run.steps, base.steps);
    if (base.roll_out(run)) return true;
    double const weight = portable::integer_power(run.discount, static_cast<unsigned>(steps));
    for (std::size_t k = 0; k < run.joint.size(); ++k) run.returns[k] += weight * run.domain.value(run.state, k);
    return false;
  }
};

/// Takes no steps. The return is the domain's `value` of the leaf, or 0 for a domain without one.
struct NoRollout {
  static constexpr char const* name = "no_rollout";
  static constexpr char const* summary = "the domain's value of the leaf, or 0 without one";
  static constexpr char const* source = "-";
  static constexpr auto parameters() { return parameter_list(); }

  template <class Run>
  bool roll_out(Run& run) const {
    if constexpr (detail::HasValue<std::remove_reference_t<decltype(run.domain)>>)
      for (std::size_t k = 0; k < run.joint.size(); ++k) run.returns[k] = run.domain.value(run.state, k);
    return false;
  }
};

}  // namespace cambium::inline v0_1
