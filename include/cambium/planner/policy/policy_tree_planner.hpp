#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include <boost/container/static_vector.hpp>

#include "cambium/core/portable_math.hpp"
#include "cambium/evaluation/driving.hpp"
#include "cambium/planner/candidate_planner.hpp"
#include "cambium/planner/mcts/action_set.hpp"
#include "cambium/planner/policy/policy_tree.hpp"
#include "cambium/planner/search/search_budget.hpp"

namespace cambium::inline v0_1 {

/// A sequence of ego's actions and its cost. In a plan, unlike a report, one that cannot win is broken off: then its
/// cost is a bound, above that of the best, and the other figures are incomplete.
struct PolicyBranch {
  PolicySequence sequence{};
  std::size_t scenarios{};  ///< number of simulations, one for each intention of the others that matters
  PolicyCost mean{};        ///< over the scenarios, weighted by their probabilities
  double expected{};        ///< total of `mean`
  double worst{};           ///< total of the worst scenario that is not too unlikely; at least `expected`
  double cost{};            ///< the mix of both by which the planner chooses
};

/// What a `PolicyTreePlanner` reports. Its candidates are the branches; a score is a negative cost. The course is that
/// of the best branch if all others keep their lanes.
template <class World, class Memory>
struct PolicyTreeReport : CandidateReport<World, Memory, PolicyBranch> {
  std::vector<IntentionBranch> intentions;  ///< of the others, as simulated
};

/// EUDM (Ding, Zhang, Chen, Shen 2020, "Efficient uncertainty-aware decision-making for automated driving using guided
/// branching"): plans by a tree of sequences of semantic actions with at most one change. It simulates each sequence
/// closed loop in several scenarios: all others keep their lanes, or one of them deviates in a way that matters to the
/// sequence. Scenarios count by their probabilities. `Actions` are `MacroActions`, or `DriverActions`, which must be in
/// the behaviour set of `PredictionWorld`. With `DriverActions<Intersection>`, the usual ones where the set has them,
/// ego may drive by the rules at junctions, and others do unless they deviate.
///
///     layer       1          2          3            scenarios, each where it matters
///     ongoing    keep ----- keep ----- keep           all others keep their lanes
///     later      keep ----- keep ----- left           agent 4, on the left, does not yield
///     soon       keep ----- left ----- left           agent 7, on the right, changes left
///     now        left ----- left ----- left
template <class PredictionWorld, class Actions = detail::UsualActions<PredictionWorld>, SearchBudget Budget = NoBudget,
          class Own = Terms<>>
struct PolicyTreePlanner {
  static_assert(detail::check_planner<PredictionWorld>() && detail::check_terms<Own>());
  static_assert(PredictionWorld::Behaviors::template contains<Actions>,
                "cambium::PolicyTreePlanner<PredictionWorld>: the behaviour set of PredictionWorld must contain its "
                "Actions, such as cambium::MacroActions, which carry out ego's actions and the others' intentions");

  using World = PredictionWorld;
  using Semantic = SemanticActions<Actions>;
  using Memory = typename Actions::Memory;  ///< the ongoing action and its lane change
  using Report = PolicyTreeReport<World, Memory>;

  struct Workspace : CandidateWorkspace<World, PolicyBranch> {
    bool has_goal = false;
    double clearance{};  ///< a smaller distance to others counts as a collision [m]
    std::vector<IntentionBranch> intentions;
  };

  Actions actions = Semantic::usual();
  typename Semantic::Others others{};
  IntentionPrior intentions{};
  PolicyWeights weights{};
  int layers = 5;
  double layer_duration = 1.0;
  double step = 0.2;
  int most_agents = 4;
  double range = 60.0;
  Budget budget{};
  Own terms{};
  bool others_insist = true;

  static constexpr char const* name = "policy_tree_planner";
  static constexpr char const* summary =
      "simulates sequences of semantic actions with at most one change, under those intentions of the others that "
      "matter to each, and drives the one with the best mix of mean and worst case";
  static constexpr char const* source = "Ding, Zhang, Chen, Shen 2020 (EUDM)";
  static constexpr auto parameters() {
    using P = PolicyTreePlanner;
    return parameter_list(
        parameter("actions", &P::actions, "what ego may do"),
        parameter("others", &P::others, "how the others keep gaps, or drive"),
        parameter("intentions", &P::intentions, "what the others may be about to do"),
        parameter("weights", &P::weights, "what makes a sequence good"),
        parameter("layers", &P::layers, "-", Range{1, 32}, "decisions in a sequence"),
        parameter("layer_duration", &P::layer_duration, "s", Range{0.1, 20}, "time between decisions"),
        parameter("step", &P::step, "s", Range{0.01, 1}, "time step of the simulations"),
        parameter("most_agents", &P::most_agents, "-", Range{0, 32},
                  "number of nearest others whose intentions are simulated"),
        parameter("range", &P::range, "m", non_negative, "agents farther away keep their lanes"),
        parameter("budget", &P::budget, "how many sequences are simulated, the ongoing action first"),
        parameter("terms", &P::terms, "evaluators whose sum over a sequence is deducted from its cost"),
        parameter(
            "others_insist", &P::others_insist,
            "those who go first and do not brake yet are expected to go on, and to open no gap where lanes merge"));
  }

  void check(std::string const& where) const { detail::refuse_costs(terms, where); }

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory& memory, double dt, Workspace& workspace) const {
    return plan_by_candidates(*this, view, memory, dt, workspace);
  }

  /// See `PlannerModel`.
  template <class View>
  [[nodiscard]] Report think(View const& view, Memory const& memory, Workspace& workspace) const {
    auto report = think_by_candidates(*this, view, memory, workspace);
    report.intentions = workspace.intentions;
    return report;
  }

  /// See `CandidatePlanner`, also for `drive`, `foresee` and `entry`.
  template <class View>
  [[nodiscard]] SearchProblem compare(View const& view, Memory const& memory, Workspace& workspace,
                                      Budget& clock) const {
    auto const intended = Semantic::intended(others);
    if (!workspace.predict(view, actions, intended)) return SearchProblem::not_in_world;
    if constexpr (Semantic::drives) {
      detail::expect(*workspace.world, workspace.ego, intended, {.insists = others_insist});
      workspace.start = workspace.world->frame();
    }
    workspace.has_goal = view.has_goal();
    bool const is_close = Collision{weights.clearance}(*workspace.world, workspace.ego);
    workspace.clearance = is_close ? 0.0 : weights.clearance;
    set_intentions(workspace);
    auto& branches = workspace.candidates;
    auto const now = ongoing(memory);
    auto const all = choices();
    for (auto const& sequence : policy_sequences({all.data(), all.size()}, now, static_cast<std::size_t>(layers))) {
      if (!is_available(view, sequence.first, memory)) continue;
      if (!workspace.goes_on(clock, branches.size())) break;
      bool const compares_all = workspace.shows_all || !std::is_same_v<Own, Terms<>> || !workspace.chosen;
      double const limit = compares_all ? infinite : branches[*workspace.chosen].cost;
      auto& branch = branches.emplace_back();
      branch.sequence = sequence;
      double const extra = sequence.first != now ? weights.change : 0.0;
      weigh(workspace, memory, branch, limit - extra);
      branch.cost += extra;
      if (!std::isfinite(branch.cost)) return SearchProblem::not_finite;
      if (!workspace.chosen || branch.cost < branches[*workspace.chosen].cost) workspace.chosen = branches.size() - 1;
    }
    return workspace.chosen ? SearchProblem::none : SearchProblem::no_actions;
  }

  template <class View>
  [[nodiscard]] Plan<View> drive(View const& view, Memory& memory, double dt, Workspace& workspace) const {
    begin(workspace, memory, workspace.candidates[*workspace.chosen].sequence.first, nullptr);
    return workspace.template drive<Actions>(view, dt, step, memory);
  }

  template <class View>
  [[nodiscard]] auto foresee(View const& view, Memory const& memory, Workspace& workspace,
                             std::optional<std::size_t> candidate) const {
    workspace.check_foreseen(view, candidate);
    std::vector course{workspace.start};
    auto const& branch = workspace.candidates[candidate.value_or(*workspace.chosen)];
    (void)simulate(workspace, memory, branch.sequence, nullptr, &course, never);
    return course;
  }

  /// The intentions of those that may deviate, see `PlannerModel`.
  template <class View>
  [[nodiscard]] std::vector<Alternative> alternatives(View const&, Memory const& memory, Workspace& workspace,
                                                      double duration) const {
    std::vector<Alternative> all;
    auto const& agents = workspace.world->roster().agents;
    auto const add = [&](Slot slot, IntentionBranch const* deviation, double probability) {
      std::vector course{workspace.start};
      (void)simulate(workspace, memory, workspace.candidates[*workspace.chosen].sequence, deviation, &course, never);
      auto const k = static_cast<std::size_t>(std::lround(duration / step));
      auto const& then = course[std::min(k, course.size() - 1)].agents[slot].state;
      all.push_back({agents[slot].id, probability, plain_state(then)});
    };
    for (auto at = workspace.intentions.begin(); at != workspace.intentions.end();) {
      auto const end = std::find_if(at, workspace.intentions.end(), [&](auto const& i) { return i.slot != at->slot; });
      double sum = 0.0;
      for (auto i = at; i != end; ++i) sum += i->probability;
      double const scale = std::max(1.0, sum);
      add(at->slot, nullptr, 1.0 - sum / scale);
      for (; at != end; ++at) add(at->slot, &*at, at->probability / scale);
    }
    return all;
  }

  /// See `CandidatePlanner`.
  [[nodiscard]] static bool begin_alike(PolicyBranch const& a, PolicyBranch const& b) {
    return a.sequence.first == b.sequence.first;
  }

  /// "keep_gap for 2 s, then change_left 0".
  template <class View>
  [[nodiscard]] PlannerCandidate entry(View const&, Workspace const&, PolicyBranch const& branch) const {
    auto const& sequence = branch.sequence;
    auto const words = [&](std::uint8_t action) { return ActionSet<Actions>::text(actions, action); };
    auto text = words(sequence.first);
    if (sequence.first != sequence.then)
      text += " for " + detail::rounded_text(sequence.layers_of_first * layer_duration) + " s, then " +
              words(sequence.then);
    return {std::move(text), -branch.cost};
  }

 private:
  static constexpr double infinite = std::numeric_limits<double>::infinity(), rounding = 1e-9;
  static constexpr auto never = [](PolicyCost const&) { return false; };

  [[nodiscard]] bool is_change(std::uint8_t choice, int side) const {
    return ActionSet<Actions>::action(actions, choice).kind ==
           (side > 0 ? MacroAction::Kind::change_left : MacroAction::Kind::change_right);
  }

  /// The ongoing action. After a completed lane change, that is to keep the lane at the same acceleration.
  [[nodiscard]] std::uint8_t ongoing(Memory const& memory) const {
    if constexpr (Semantic::drives)
      if (memory.drives) return Actions::drive;
    auto const& macro = Semantic::macro(actions);
    auto const& own = Semantic::macro(memory);
    std::uint8_t const chosen = own.chosen < macro.size() ? own.chosen : 0;
    bool const changes = is_change(chosen, 1) || is_change(chosen, -1);
    if (!changes || own.change.active() || own.is_new) return chosen;
    for (std::uint8_t i = 0; i < macro.size(); ++i)
      if (macro.actions[i].kind == MacroAction::Kind::stay &&
          macro.actions[i].acceleration == macro.actions[chosen].acceleration)
        return i;
    return chosen;
  }

  [[nodiscard]] auto choices() const {
    boost::container::static_vector<std::uint8_t, MacroActions::capacity + 1> all;
    for (std::uint8_t i = 0; i < Semantic::macro(actions).size(); ++i) all.push_back(i);
    if constexpr (Semantic::drives) all.push_back(Actions::drive);
    return all;
  }

  /// Whether `choice` could begin now, or is under way.
  template <class View>
  [[nodiscard]] bool is_available(View const& view, std::uint8_t choice, Memory const& memory) const {
    auto const& own = Semantic::macro(memory);
    if (Semantic::drives && choice == MacroActions::nothing) return true;
    return (choice == ongoing(memory) && !own.is_new) || Semantic::macro(actions).available(view, choice, own.change);
  }

  /// The intentions that matter. Agents in the lanes beside ego may change into its lane if they are not behind, and
  /// may refuse to let it into theirs if they are not ahead.
  void set_intentions(Workspace& workspace) const {
    auto const& world = *workspace.world;
    auto const& own = world.roster().agents[workspace.ego];
    auto const& at = world.frame().agents[workspace.ego].lane;
    auto const& corridor = own.road->corridors[at.corridor];
    auto const sides = corridor.widths_at(at.s, at.segment);
    double const width = sides.left + sides.right;
    workspace.intentions.clear();
    for (auto const slot : nearest_agents(world, workspace.ego, static_cast<std::size_t>(most_agents), range)) {
      auto const& other = world.frame().agents[slot];
      auto const foot = corridor.center.project({other.state.x, other.state.y}, at.segment);
      double const aside = std::abs(foot.lateral);
      if (aside < 0.5 * width || aside > 1.5 * width || std::abs(other.lane.heading_error) > 1.0) continue;
      int const side = foot.lateral > 0.0 ? 1 : -1;
      auto const changes =
          change_probabilities(intentions, other.state.speed * portable::sin(other.lane.heading_error));
      double const front = foot.s + world.roster().agents[slot].shape.front;
      if (front > at.s - own.shape.rear)
        workspace.intentions.push_back({slot, side > 0 ? Intention::change_right : Intention::change_left,
                                        side > 0 ? changes.right : changes.left, 0});
      if (front < at.s + own.shape.front)
        workspace.intentions.push_back({slot, Intention::not_yield, intentions.not_yield, side});
    }
  }

  /// Simulates a branch with all others in their lanes, and then with each deviation of one of them; weighs the costs
  /// by the odds of each scenario. It breaks off once the cost must be above `limit`; then the cost that it sets is,
  /// too.
  void weigh(Workspace& workspace, Memory const& memory, PolicyBranch& branch, double limit) const {
    auto const& sequence = branch.sequence;
    auto const odds_of = [&](IntentionBranch const& other) {
      constexpr double most = 0.99;  // keeps the odds finite
      bool const matters =
          other.side == 0 || is_change(sequence.first, other.side) || is_change(sequence.then, other.side);
      double const p = matters ? std::min(other.probability, most) : 0.0;
      return p / (1.0 - p);
    };
    double all_odds = 1.0;
    for (auto const& other : workspace.intentions) all_odds += odds_of(other);
    double sum = 0.0;  // of costs times odds
    auto const add = [&](IntentionBranch const* deviation, double odds) {
      bool const is_likely = deviation == nullptr || odds >= weights.least_odds;
      auto const exceeds = [&](PolicyCost const& so_far) {
        double const total = weights.total(so_far), expected = (sum + odds * total) / all_odds;
        double const worst = std::max({branch.worst, expected, is_likely ? total : 0.0});
        branch.cost = mix(expected, worst);
        return branch.cost > limit * (1.0 + rounding);
      };
      auto const cost = simulate(workspace, memory, sequence, deviation, nullptr, exceeds);
      if (exceeds(cost)) return false;
      double const total = weights.total(cost);
      ++branch.scenarios;
      if (is_likely) branch.worst = std::max(branch.worst, total);
      branch.mean.efficiency += odds * cost.efficiency;
      branch.mean.safety += odds * cost.safety;
      branch.mean.navigation += odds * cost.navigation;
      branch.mean.terms += odds * cost.terms;
      branch.mean.courtesy += odds * cost.courtesy;
      sum += odds * total;
      return true;
    };
    branch.worst = -infinite;
    bool goes_on = add(nullptr, 1.0);
    for (auto const& other : workspace.intentions)
      if (double const odds = odds_of(other); goes_on && odds > 0.0) goes_on = add(&other, odds);
    if (!goes_on) return;
    for (auto* part : {&branch.mean.efficiency, &branch.mean.safety, &branch.mean.navigation, &branch.mean.terms,
                       &branch.mean.courtesy})
      *part /= all_odds;
    branch.expected = weights.total(branch.mean);
    branch.worst = std::max(branch.worst, branch.expected);
    branch.cost = mix(branch.expected, branch.worst);
  }

  [[nodiscard]] double mix(double expected, double worst) const {
    return (1.0 - weights.worst_case) * expected + weights.worst_case * worst;
  }

  /// Resets the prediction world to its start, with ego about to do `action`, and one agent about to deviate if given.
  void begin(Workspace& workspace, Memory const& memory, std::uint8_t action, IntentionBranch const* deviation) const {
    auto& world = *workspace.world;
    world.restore(workspace.start);
    auto const& agents = world.roster().agents;
    auto& own = world.template memory<Actions>(agents[workspace.ego].id);
    own = memory;
    if (action != ongoing(memory))
      own.choose(action);
    else if (!Semantic::drives || action != MacroActions::nothing)
      Semantic::macro(own).chosen = action;
    if (deviation != nullptr)
      world.template memory<Actions>(agents[deviation->slot].id).choose(static_cast<std::size_t>(deviation->intention));
  }

  /// The cost of a simulation to the end of ego's course, or until that `exceeds` a limit; with a `course`, see
  /// `simulate` of its workspace.
  template <class Exceeds>
  [[nodiscard]] PolicyCost simulate(Workspace& workspace, Memory const& memory, PolicySequence const& sequence,
                                    IntentionBranch const* deviation, std::vector<typename World::FrameType>* course,
                                    Exceeds const& exceeds) const {
    auto& world = *workspace.world;
    auto const id = world.roster().agents[workspace.ego].id;
    int const steps = std::max(1, static_cast<int>(std::lround(layers * layer_duration / step)));
    int const change = static_cast<int>(std::lround(sequence.layers_of_first * layer_duration / step));
    auto const choose_before = [&](int k) {
      if (k == change) world.template memory<Actions>(id).choose(sequence.then);
    };
    PolicyCost cost;
    begin(workspace, memory, sequence.first, deviation);
    choose_before(0);
    workspace.simulate(steps, step, course, [&](int k) {
      auto const end = course_end(world, workspace.ego, [&](World const& judged, Slot own_slot) {
        return Collision{workspace.clearance}.in_last_step(judged, own_slot);
      });
      auto const own = terms.judge(world, workspace.ego, step);
      cost.terms -= own.reward;
      if (end == CourseEnd::collision || end == CourseEnd::off_road) {  // the earlier, the worse
        double const left = static_cast<double>(steps - k) / steps;
        cost.safety += weights.collision * (1.0 + left);
        cost.efficiency += left;
      }
      if (end != CourseEnd::none || own.ends || (workspace.has_goal && world.reached_goal(workspace.ego))) return false;
      add_step(workspace, id, 1.0 / steps, cost);
      if (exceeds(cost)) return false;
      choose_before(k + 1);
      return true;
    });
    return cost;
  }

  /// Whether a lane change under way leads around `front`, one that stands.
  template <class View>
  [[nodiscard]] static bool goes_around(View const& view, RoadUser const& front, Memory const& memory) {
    if (front.speed >= detail::at_rest_below) return false;
    auto const leads = [&](LaneChange const& change) {
      return change.active() && LaneChangeCourse{}.leads_around(view, change, front);
    };
    if constexpr (requires { memory.driver.lateral.change; })
      if (leads(memory.driver.lateral.change)) return true;
    return leads(Semantic::macro(memory).change);
  }

  /// Adds the cost of the present state, which stands for `share` of the horizon.
  void add_step(Workspace& workspace, AgentId id, double share, PolicyCost& cost) const {
    auto& world = *workspace.world;
    auto const view = world.observe(id);
    double const speed = view.state().speed, desired = Semantic::macro(actions).law.desired_speed;
    cost.efficiency += share * SpeedDeviation{desired}(world, workspace.ego) / desired;
    auto const front = view.ahead(), rear = view.behind();
    bool const unsafe = (front && front->gap < weights.safe_gap(speed, front->speed) &&
                         !goes_around(view, *front, world.template memory<Actions>(id))) ||
                        (rear && rear->gap < weights.safe_gap(rear->speed, speed));
    cost.safety += unsafe ? share : 0.0;
    cost.navigation += share * LaneChangeUrgency{}(world, workspace.ego);
    if (weights.courtesy > 0.0) cost.courtesy += share * OthersBraking{}(world, workspace.ego);
  }
};

}  // namespace cambium::inline v0_1
