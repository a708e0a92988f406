#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/behavior_set.hpp"
#include "cambium/behavior/wrap/headway_hypotheses.hpp"
#include "cambium/behavior/drivers.hpp"
#include "cambium/core/described.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/planner/mcts/belief.hpp"
#include "cambium/planner/mcts/mcts_workspace.hpp"
#include "cambium/planner/planner_model.hpp"
#include "cambium/planner/predicted.hpp"

namespace cambium::inline v0_1 {

namespace detail {

/// What an `Mcts` believes about one other agent.
struct TrackedAgent {
  AgentId id = none<AgentId>;
  Belief belief{};
  float speed = 0.0f;                              ///< as last observed [m/s]
  std::array<float, Belief::capacity> expected{};  ///< next observed speed, by hypothesis [m/s]

  static constexpr char const* name = "tracked_agent";
  static constexpr auto parameters() {
    using P = TrackedAgent;
    return parameter_list(parameter("id", &P::id, "whom it is about"),
                          parameter("belief", &P::belief, "probabilities of the hypotheses"),
                          parameter("speed", &P::speed, "m/s", any_finite, "as last observed"),
                          parameter("expected", &P::expected, "m/s", any_finite, "next observed speed, by hypothesis"));
  }

  friend bool operator==(TrackedAgent const&, TrackedAgent const&) = default;
};

/// Whether roll-outs follow a driver without any manoeuvre in mind.
template <class Actions>
concept UsuallyDrives = requires {
  requires ActionSet<Actions>::usual_drives;
};

}  // namespace detail

/// Memory of an `Mcts` that learns about others.
template <class CourseMemory>
struct BeliefMemory {
  /// Greatest number of agents about whom it learns.
  static constexpr std::size_t capacity = 6;

  std::array<detail::TrackedAgent, capacity> tracked{};
  double observed_at = -1.0, expected_at = -1.0;  ///< times of `TrackedAgent::speed` and `expected` [s]
  CourseMemory course{};                          ///< the manoeuvre under way

  /// The belief about an agent; null if there is none.
  [[nodiscard]] Belief const* belief(AgentId id) const {
    auto const at = std::ranges::find(tracked, id, &detail::TrackedAgent::id);
    return is_valid(id) && at != tracked.end() ? &at->belief : nullptr;
  }
  static constexpr char const* name = "belief_memory";
  static constexpr auto parameters() {
    using P = BeliefMemory;
    return parameter_list(parameter("tracked", &P::tracked, "the agents about whom it learns"),
                          parameter("observed_at", &P::observed_at, "s", any_finite, "time of the observed speeds"),
                          parameter("expected_at", &P::expected_at, "s", any_finite, "time of the expected ones"),
                          parameter("course", &P::course, "the manoeuvre under way"));
  }

  friend bool operator==(BeliefMemory const&, BeliefMemory const&) = default;
};

/// Plans by Monte Carlo tree search over `Actions` in predicted worlds and maximises `Reward`; the other agents behave
/// as `Others` (see `others_keep_speed`). `PredictionWorld` is the type of the world in which it plans, with a
/// behaviour set that contains `Others` and the model that carries out the actions. If that set contains
/// `Intersection`, the others are expected to drive by it, and with `DriverActions<Intersection>` ego may, too. As a
/// behaviour it searches anew in each step, because a copied world has no tree.
///
/// Its fields and template arguments select the variant; all of them combine:
///
/// - Single-agent search (UCT: Kocsis, Szepesvari 2006): the defaults.
/// - Cooperative search (decoupled UCT: Tak, Lanctot, Winands 2014; Lenz, Kessler, Knoll 2016): `most_agents` above 1.
///   The agents nearest to ego choose at the same time, each for its own reward plus `cooperation` times the rewards of
///   the others; costs likewise, of which the greatest counts (also for a limit on them). Their goals are unknown, so
///   the reward should hold what everybody wants, such as speed and no collision. Agents whose intention is obvious do
///   not choose: slow drivers on a free road, such as cyclists, agents that move across their lane, and pedestrians.
/// - Search under a chance constraint (CC-POMCP: Lee et al. 2018): `options.search.constraint.limit` below 1. It
///   maximises the reward among courses whose estimated probability of a collision is within the limit; if there is
///   none, it minimises that probability. It learns the weight of a collision (a Lagrange multiplier), so the reward
///   needs none.
/// - Search with hypotheses about the others (RSBG: Bernhard, Knoll 2020): `Others` is a `HypothesisModel`, such as
///   `HeadwayHypotheses<IdmClassic>` or `<Intersection>`, drivers whose time headway is unknown but lies in one of a
///   few regions. The probabilities of the hypotheses follow from what the agent does (Bayes). Each iteration draws one
///   for each agent anew (root sampling: Silver, Veness 2010), so nodes stand for ego's actions only.
template <class PredictionWorld, class Actions = detail::UsualActions<PredictionWorld>, class Reward = TrafficReward,
          class Others = detail::UsualDriver<PredictionWorld>,
          class Options =
              std::conditional_t<detail::UsuallyDrives<Actions>, MctsOptions<>, MctsOptions<Puct, RandomRollout>>>
struct Mcts {
  static_assert(detail::check_planner<PredictionWorld, Others>());
  static_assert(
      Described<Others>,
      "cambium: a planner's Others must be a behaviour with described parameters, such as cambium::IdmClassic; "
      "if it has none: `static constexpr auto parameters() { return cambium::parameter_list(); }`");

  /// Whether it learns about the others.
  static constexpr bool learns = HypothesisModel<Others>;

  using CourseMemory = typename ActionSet<Actions>::Behavior::Memory;  ///< such as a lane change under way
  using Memory = std::conditional_t<learns, BeliefMemory<CourseMemory>, CourseMemory>;
  using Domain = std::conditional_t<learns, HypothesisDomain<PredictionWorld, Actions, Reward, Others>,
                                    TrafficDomain<PredictionWorld, Actions, Reward>>;
  using Workspace = MctsWorkspace<Domain, Options>;
  using Report = MctsReport<Domain, Memory>;

  Actions actions{};
  Others others{};
  bool others_keep_speed = true;
  Reward reward{};
  Options options{};
  int most_agents = 1;
  double range = 50.0;
  double cooperation = 0.5;
  BeliefParameters belief{};
  bool others_insist = true;

  static constexpr char const* name = "mcts";
  static constexpr char const* summary =
      "tree search over ego's actions in predicted worlds; optionally with other agents that choose at "
      "the same time, a limit on risk, and beliefs about the others";
  static constexpr char const* source =
      "Kocsis, Szepesvari 2006; Lenz, Kessler, Knoll 2016; Lee et al. 2018; Bernhard, Knoll 2020";
  static constexpr auto parameters() {
    using P = Mcts;
    return parameter_list(
        parameter("actions", &P::actions, "what ego and the agents that choose with it may do"),
        parameter("others", &P::others, "how the others are expected to behave"),
        parameter(
            "others_keep_speed", &P::others_keep_speed,
            "those who drive faster than the others like, or steadily (if it learns about them: with nobody close "
            "ahead), or are on foot, are expected to like the speed they have"),
        parameter("reward", &P::reward, "what ego and each agent that chooses with it wants"),
        parameter("options", &P::options, "settings of the search"),
        parameter("most_agents", &P::most_agents, "-", Range{1, 32}, "number of agents that choose, including ego"),
        parameter("range", &P::range, "m", non_negative, "agents farther away do not choose"),
        parameter("cooperation", &P::cooperation, "-", Range{0, 1},
                  "weight of the others' rewards and costs in an agent's own"),
        parameter("belief", &P::belief, "how it learns about the others if there are hypotheses about them"),
        parameter(
            "others_insist", &P::others_insist,
            "those who go first and do not brake yet are expected to go on, and to open no gap where lanes merge"));
  }

  void check(std::string const& where) const {
    if constexpr (learns)
      if (std::size_t const n = others.hypotheses(); n < 1 || n > Belief::capacity)
        throw ParameterError(where, "has " + std::to_string(n) + " hypotheses about the others", "give 1 to 8");
  }

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory& memory, double dt, Workspace& workspace) const {
    if constexpr (detail::Predicts<View, PredictionWorld>) {
      auto const problem = search(view, memory, dt, workspace).problem;
      if (problem == SearchProblem::none || problem == SearchProblem::terminal_root)
        return workspace.drive(view, dt, course_of(memory));
    }
    Plan<View> failed;
    failed.status = PlanStatus::failed;
    return failed;
  }

  /// See `PlannerModel`. The report's course is the principal variation; after its end, all agents drive on without a
  /// manoeuvre. A candidate's score is its mean return less what its costs count (see `CostConstraint`), both in shares
  /// of their ranges in the (first) tree: about from 0 to 1; 0 for one that was not tried. `decidedness` is the share
  /// of visits of the chosen action minus that of the next best. After `workspace.keep()` the search continues the last
  /// tree, see there.
  template <class View>
  [[nodiscard]] Report think(View const& view, Memory const& memory, Workspace& workspace) const {
    check_parameters(*this);
    Memory next = memory;
    detail::throw_if(search(view, next, belief.interval, workspace), workspace, view.id());
    auto report = workspace.template report<Memory>();
    auto const& after = report.course[1].agents[workspace.domain().slots()[0]];
    course_of(next) = *std::get_if<Domain::behavior_index>(&after.memory);
    report.memory = next;
    return report;
  }

  /// See `PlannerModel`. After a candidate that is not the best, all drive on without a manoeuvre.
  template <class View>
  [[nodiscard]] auto foresee(View const& view, Memory const&, Workspace& workspace,
                             std::optional<std::size_t> candidate) const {
    auto const& domain = workspace.domain();
    detail::check_foreseen(domain.world().roster().agents[domain.slots()[0]].id, view.id(), candidate,
                           workspace.compared());
    return workspace.course(candidate);
  }

  /// The hypotheses about those of whom it learns, each as if it held for all, see `PlannerModel`.
  template <class View>
  [[nodiscard]] std::vector<Alternative> alternatives(View const&, Memory const&, Workspace& workspace,
                                                      double duration) const requires learns {
    std::vector<Alternative> all;
    auto& domain = workspace.domain();
    auto const& world = domain.world();
    auto const near = learnt_about(world, domain.slots()[0]);
    for (std::size_t number = 0; number < others.hypotheses(); ++number) {
      auto state = workspace.decided();
      for (auto const& unknown : domain.unknowns()) others.assume(*memory_at(state.frame, unknown.slot), number, 0.5);
      double const end = world.time() + duration;
      while (state.frame.time < end - same_time) domain.advance(state, std::min(domain.dt(), end - state.frame.time));
      for (auto const& unknown : domain.unknowns()) {
        if (std::ranges::find(near, unknown.slot) == near.end()) continue;
        auto const id = world.roster().agents[unknown.slot].id;
        auto const& then = state.frame.agents[unknown.slot].state;
        all.push_back({id, unknown.belief.probability(number), plain_state(then)});
      }
    }
    return all;
  }

 private:
  [[nodiscard]] static CourseMemory& course_of(Memory& memory) {
    if constexpr (learns)
      return memory.course;
    else
      return memory;
  }

  template <class View>
  [[nodiscard]] SearchResult<typename Domain::Action> const& search(View const& view, Memory& memory, double dt,
                                                                    Workspace& workspace) const {
    auto timed = options;
    timed.budget.start();
    std::optional<Slot> ego;
    auto world = predicted_for<PredictionWorld>(view, ActionSet<Actions>::behavior(actions), others, ego);
    std::vector<Slot> slots;
    if (ego) {
      slots.push_back(*ego);
      world.template memory<typename ActionSet<Actions>::Behavior>(view.id()) = course_of(memory);
      detail::expect(world, *ego, others,
                     {.keeps_speed = others_keep_speed, .insists = others_insist, .learns = learns});
      if (most_agents > 1) let_others_choose(world, slots);
    }
    double const weight = most_agents > 1 ? cooperation : 0.0;
    constexpr std::uint32_t purpose = 0x3c75;
    auto const seed = view.random(purpose)();
    Domain domain(std::move(world), slots, actions, reward, options.step, options.hold, weight);
    if constexpr (learns)
      if (ego) domain.set_unknowns(learn(domain.world(), *ego, memory, dt), others);
    return workspace.run(std::move(domain), timed, seed);
  }

  /// Adds to `slots` the agents that choose with ego.
  void let_others_choose(PredictionWorld& world, std::vector<Slot>& slots) const {
    for (auto const slot : nearest_agents(world, slots[0], static_cast<std::size_t>(most_agents - 1), range)) {
      if (reward.judge(world, slot, options.step).ends) continue;  // its own course is over
      if (is_slow_by_choice(world, slot) || detail::is_parked(world, slot) ||
          detail::moves_across(world.frame().agents[slot]) || detail::is_beside_lanes(world, slot))
        continue;
      auto its = ActionSet<Actions>::behavior(actions);
      if (others_insist && detail::goes_on(world.frame().agents[slot]))
        detail::let_insist(its, !detail::gives_up_lane(world, slot));
      world.set_behavior(world.roster().agents[slot].id, its);
      slots.push_back(slot);
    }
  }

  [[nodiscard]] bool is_slow_by_choice(PredictionWorld& world, Slot slot) const {
    auto const* const usual = detail::desired_speed_of(others);
    constexpr double slow = 0.7;  // of what others like
    return usual != nullptr && world.frame().agents[slot].state.speed < slow * *usual &&
           detail::likes_its_speed(world, slot);
  }

  /// The nearest agents that do not choose with ego.
  [[nodiscard]] std::vector<Slot> learnt_about(PredictionWorld const& world, Slot ego) const {
    constexpr std::size_t model = PredictionWorld::Behaviors::template index<Others>;
    auto near = nearest_agents(world, ego, Memory::capacity, belief.range);
    std::erase_if(near, [&](Slot slot) { return world.frame().agents[slot].memory.index() != model; });
    return near;
  }

  [[nodiscard]] static MemoryOf<Others>* memory_at(typename PredictionWorld::FrameType& frame, Slot slot) {
    return std::get_if<PredictionWorld::Behaviors::template index<Others>>(&frame.agents[slot].memory);
  }

  /// Updates the beliefs by what the others did since the last observation, and predicts what they will do until the
  /// next one, in `dt` [s]. Returns the belief about each. An observation that comes early or late, by up to half of
  /// that, is compared with what was expected for its own time; one that comes even earlier is left for the next; after
  /// one that comes even later, by up to a second, others are expected to come as late.
  [[nodiscard]] auto learn(PredictionWorld const& world, Slot ego, Memory& memory, double dt) const {
    auto frame = world.frame();
    auto const near = learnt_about(world, ego);
    std::size_t const hypotheses = others.hypotheses();
    bool const has_expected = memory.expected_at > memory.observed_at;
    double const since = world.time() - memory.observed_at;
    double const delay = (world.time() - memory.expected_at) / (memory.expected_at - memory.observed_at);
    constexpr double early = -0.5 - 1e-6, late = 0.5 + 1e-6, latest = 1.0 + 1e-6;  // [-], [-], [s]
    bool const is_too_early = has_expected && since >= 0.0 && delay < early;
    bool const was_expected = has_expected && delay >= early && delay <= late;
    if (has_expected && delay > late && since <= latest) dt = since;
    decltype(memory.tracked) tracked{};
    std::vector<typename Domain::Unknown> unknowns;
    for (std::size_t i = 0; i < near.size(); ++i) {
      auto const id = world.roster().agents[near[i]].id;
      auto const known = std::ranges::find(memory.tracked, id, &detail::TrackedAgent::id);
      bool const is_known = known != memory.tracked.end() && known->belief.size() == hypotheses;
      tracked[i] = is_known ? *known : detail::TrackedAgent{id, Belief(hypotheses)};
      double const speed = frame.agents[near[i]].state.speed;
      if (is_known && was_expected) observe(tracked[i], speed, delay);
      tracked[i].speed = static_cast<float>(speed);
      unknowns.push_back({near[i], tracked[i].belief});
    }
    // Nothing is known about the rest.
    for (Slot slot{}; index_of(slot) < world.size(); ++slot)
      if (memory_at(frame, slot) != nullptr && std::ranges::find(near, slot) == near.end())
        unknowns.push_back({slot, Belief(hypotheses)});
    if (is_too_early) return unknowns;
    memory.tracked = tracked;
    expect(world, near, memory, dt);
    return unknowns;
  }

  /// `delay`: of the observation, in the duration of the prediction.
  void observe(detail::TrackedAgent& other, double speed, double delay) const {
    std::array<double, Belief::capacity> likelihoods{};
    double nearest = 1e300;
    std::size_t const hypotheses = others.hypotheses();
    for (std::size_t r = 0; r < hypotheses; ++r) {
      double const expected = other.expected[r], change = expected - static_cast<double>(other.speed);
      double const off = (speed - (expected + delay * change)) / belief.speed_deviation;
      likelihoods[r] = 0.5 * off * off;
      nearest = std::min(nearest, likelihoods[r]);
    }
    // Relative to the best; otherwise all would underflow to 0 if no hypothesis explains the observation.
    for (std::size_t r = 0; r < hypotheses; ++r) likelihoods[r] = portable::exp(nearest - likelihoods[r]);
    other.belief.update({likelihoods.data(), hypotheses}, belief);
  }

  /// Predicts the speed of each of `slots` after `dt` [s] under each hypothesis.
  void expect(PredictionWorld const& world, std::span<Slot const> slots, Memory& memory, double dt) const {
    PredictionWorld trial = world;
    for (std::size_t r = 0; r < others.hypotheses(); ++r) {
      auto frame = world.frame();
      for (auto const slot : slots) others.assume(*memory_at(frame, slot), r, 0.5);
      trial.exchange(frame);
      (void)trial.step(dt);
      for (std::size_t i = 0; i < slots.size(); ++i)
        memory.tracked[i].expected[r] = static_cast<float>(trial.frame().agents[slots[i]].state.speed);
    }
    memory.observed_at = world.time();
    memory.expected_at = world.time() + dt;
  }
};

}  // namespace cambium::inline v0_1
