#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "cambium/behavior/wrap/headway_hypotheses.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/planner/detail/same_scene.hpp"
#include "cambium/planner/mcts/action_set.hpp"
#include "cambium/planner/mcts/belief.hpp"
#include "cambium/planner/mcts/traffic_reward.hpp"
#include "cambium/planner/search/search_domain.hpp"

namespace cambium::inline v0_1 {

/// Traffic as a game: a prediction world in which some agents, ego first, choose an action for the next `hold` steps of
/// `dt` [s], while the others behave as predicted. A state is a frame; all states share the roster. When the course of
/// one choosing agent ends, the game is over for all.
///
/// `step` copies nothing: it exchanges the state's frame with that of the one world, steps the world, judges it, and
/// exchanges the frames again.
template <class PredictionWorld, class Actions, class Reward>
class TrafficDomain {
  static_assert(SearchActions<Actions>,
                "cambium::TrafficDomain<World, Actions, Reward>: Actions must be described and have a "
                "cambium::ActionSet<Actions>, like MacroActions, MotionPrimitives and SampledInputs");
  using Set = ActionSet<Actions>;
  using Behavior = typename Set::Behavior;
  static_assert(
      PredictionWorld::Behaviors::template contains<Behavior>,
      "cambium::TrafficDomain<World, Actions, Reward>: the behaviour set of World must contain the model that "
      "carries out Actions (MacroActions, MotionPrimitives; ExternalInput for SampledInputs)");
  static_assert(RewardModel<Reward, PredictionWorld>,
                "cambium::TrafficDomain<World, Actions, Reward>: Reward must judge a world, as cambium::TrafficReward "
                "does (see RewardModel)");
  static_assert(!detail::is_terms<Reward>,
                "cambium::Mcts<PredictionWorld, Actions, Reward>: Terms alone know no collision and no goal; take "
                "cambium::Reward<Evaluators...>");
  static_assert(
      Described<Reward>,
      "cambium::TrafficDomain<World, Actions, Reward>: describe Reward's parameters, as cambium::TrafficReward "
      "does; if it has none: `static constexpr auto parameters() { return cambium::parameter_list(); }`");

 public:
  using World = PredictionWorld;
  using Action = typename Set::Choice;
  using Memory = typename Behavior::Memory;                                                  ///< of choosing agents
  static constexpr std::size_t behavior_index = World::Behaviors::template index<Behavior>;  ///< of choosing agents
  /// The world draws random numbers by seed, agent and step, so the same actions lead to the same frame.
  static constexpr bool is_deterministic = true;

  struct State {
    typename World::FrameType frame;
    bool over = false;

    static constexpr char const* name = "traffic_state";
    static constexpr auto parameters() {
      return parameter_list(parameter("frame", &State::frame, "time, and where the agents are"),
                            parameter("over", &State::over, "a course has ended"));
    }
  };

  /// A placeholder in which no agent chooses; assign another domain to it.
  explicit TrafficDomain(World world) : world_(std::move(world)) {}

  /// `slots`: the agents that choose, ego first; each must have the behaviour that carries out `actions`.
  /// `cooperation`, 0 to 1: weight of the other choosing agents' rewards in an agent's own (Lenz, Kessler, Knoll 2016).
  TrafficDomain(World world, std::span<Slot const> slots, Actions const& actions, Reward const& reward, double dt,
                int hold = 1, double cooperation = 0.0)
      : world_(std::move(world)),
        slots_(slots.begin(), slots.end()),
        actions_(actions),
        reward_(reward),
        dt_(dt),
        hold_(hold),
        cooperation_(cooperation) {}

  /// The world's frame as the root state. The game is over there if the reward ends a course.
  [[nodiscard]] State root() {
    return {world_.frame(),
            std::ranges::any_of(slots_, [&](auto slot) { return reward_.judge(world_, slot, dt_).ends; })};
  }
  [[nodiscard]] World const& world() const { return world_; }
  [[nodiscard]] std::span<Slot const> slots() const { return slots_; }
  [[nodiscard]] Actions const& action_set() const { return actions_; }
  [[nodiscard]] Reward const& reward() const { return reward_; }
  [[nodiscard]] double cooperation() const { return cooperation_; }
  [[nodiscard]] double dt() const { return dt_; }
  [[nodiscard]] int hold() const { return hold_; }

  [[nodiscard]] std::size_t agents() const { return slots_.size(); }
  [[nodiscard]] bool is_terminal(State const& state) { return state.over || !all_drive(state); }

  static constexpr std::size_t max_actions = [] {
    if constexpr (detail::ListsChoices<Actions>)
      return Set::capacity;
    else
      return std::size_t{1};
  }();

  [[nodiscard]] std::size_t actions(State const& state, std::size_t agent,
                                    std::span<Action> out) requires detail::ListsChoices<Actions> {
    return in_world(state, [&] {
      auto const& memory = *std::get_if<behavior_index>(&world_.frame().agents[slots_[agent]].memory);
      return Set::list(actions_, world_.observe(slots_[agent]), memory, out);
    });
  }

  [[nodiscard]] Action sample_action(State const&, std::size_t,
                                     RandomStream& random) requires(!detail::ListsChoices<Actions>) {
    return Set::sample(actions_, random);
  }

  /// The action of a driver without any manoeuvre in mind.
  [[nodiscard]] Action policy_action(State const&, std::size_t, RandomStream&) const { return Set::usual(actions_); }

  bool step(State& state, std::span<Action const> joint, RandomStream&, std::span<AgentOutcome> outcomes) {
    choose(state, joint);
    world_.exchange(state.frame);
    for (int i = 0; i < hold_ && !state.over; ++i) {
      (void)world_.step(dt_);
      for (std::size_t k = 0; k < slots_.size(); ++k) {
        auto const judgement = reward_.judge(world_, slots_[k], dt_);
        outcomes[k].reward += judgement.reward;
        outcomes[k].cost = std::max(outcomes[k].cost, judgement.cost);
        state.over = state.over || judgement.ends;
      }
    }
    double sum = 0.0, highest = 0.0;
    for (auto const& outcome : outcomes) {
      sum += outcome.reward;
      highest = std::max(highest, outcome.cost);
    }
    for (auto& outcome : outcomes) {
      outcome.reward += cooperation_ * (sum - outcome.reward);
      outcome.cost = std::max(outcome.cost, cooperation_ * highest);
    }
    world_.exchange(state.frame);
    state.over = state.over || !all_drive(state);
    return state.over;
  }

  /// The reward's value of the rest of the course, plus that of the other choosing agents weighted by the cooperation.
  [[nodiscard]] double value(State const& state, std::size_t agent) requires detail::ValuesCourses<Reward, World> {
    return in_world(state, [&] {
      double sum = 0.0;
      for (std::size_t k = 0; k < slots_.size(); ++k)
        if (k == agent || cooperation_ != 0.0)
          sum += (k == agent ? 1.0 : cooperation_) * reward_.value(world_, slots_[k], dt_);
      return sum;
    });
  }

  /// The reward's prior weight of each action; without one, what a driver without any manoeuvre in mind would do is as
  /// likely as all else together.
  void priors([[maybe_unused]] State const& state, [[maybe_unused]] std::size_t agent, std::span<Action const> actions,
              std::span<double> out) {
    if constexpr (detail::HasPrior<Reward, World, Set>) {
      in_world(state, [&] {
        for (std::size_t i = 0; i < actions.size(); ++i)
          out[i] = reward_.prior(world_, slots_[agent], Set::action(actions_, actions[i]));
      });
    } else {
      auto const usual = Set::usual(actions_);
      for (std::size_t i = 0; i < actions.size(); ++i)
        if (actions[i] == usual) out[i] = std::max<double>(1.0, static_cast<double>(actions.size()) - 1.0);
    }
  }

  /// Lets the agents go on with these actions until they choose again.
  void choose(State& state, std::span<Action const> joint) const {
    for (std::size_t k = 0; k < slots_.size(); ++k)
      Set::set(*std::get_if<behavior_index>(&state.frame.agents[slots_[k]].memory), joint[k]);
  }

  /// Steps `state` by `duration` [s], at most `dt`, without judging it.
  void advance(State& state, double duration) {
    world_.exchange(state.frame);
    (void)world_.step(duration);
    world_.exchange(state.frame);
  }

  /// Whether `seen` is close to `predicted`: for every agent within 0.5 m, 0.5 m/s and 0.05 rad, within 20 ms; and
  /// whether the choosing agents are in the middle of the same manoeuvres.
  [[nodiscard]] bool same_state(State const& predicted, State const& seen) const {
    auto const is_near = [](auto const& a, auto const& b) {
      return a.status == b.status && a.lane.corridor == b.lane.corridor && std::abs(a.lane.s - b.lane.s) < 0.5 &&
             portable::hypot(a.state.x - b.state.x, a.state.y - b.state.y) < 0.5 &&
             std::abs(geometry::angle_difference(a.state.heading, b.state.heading)) < 0.05 &&
             std::abs(a.state.speed - b.state.speed) < 0.5;
    };
    auto const goes_on_alike = [&](Slot slot) {
      return Set::goes_on_alike(*std::get_if<behavior_index>(&predicted.frame.agents[slot].memory),
                                *std::get_if<behavior_index>(&seen.frame.agents[slot].memory));
    };
    return std::abs(predicted.frame.time - seen.frame.time) < 0.02 &&
           std::ranges::equal(predicted.frame.agents, seen.frame.agents, is_near) &&
           std::ranges::all_of(slots_, goes_on_alike);
  }

  /// Whether results for states of `other` hold here as well: the same agents choose among the same actions, at the
  /// same time step and for the same reward, and the worlds differ only in their frames.
  [[nodiscard]] bool is_same_game(TrafficDomain const& other) const {
    return std::ranges::equal(slots_, other.slots_) && equal_parameters(actions_, other.actions_) && dt_ == other.dt_ &&
           hold_ == other.hold_ && cooperation_ == other.cooperation_ &&
           detail::is_same_value(reward_, other.reward_) && detail::is_same_scene(world_, other.world_);
  }

  [[nodiscard]] std::size_t heap_bytes(State const& state) const {
    return state.frame.agents.size() * sizeof(typename World::Record);
  }

 private:
  /// Returns `f()`, called while the world is in `state`. Puts both frames back afterwards, even if `f` throws.
  template <class F>
  decltype(auto) in_world(State const& state, F&& f) {
    struct Visit {
      World& world;
      typename World::FrameType& frame;
      Visit(World& w, typename World::FrameType& f) : world(w), frame(f) { world.exchange(frame); }
      Visit(Visit const&) = delete;
      ~Visit() { world.exchange(frame); }
    } const visit(world_, const_cast<State&>(state).frame);
    return f();
  }

  [[nodiscard]] bool all_drive(State const& state) const {
    return std::ranges::all_of(slots_, [&](Slot slot) {
      return index_of(slot) < state.frame.agents.size() && state.frame.agents[slot].status == AgentStatus::driving;
    });
  }

  World world_;
  std::vector<Slot> slots_;
  Actions actions_{};
  Reward reward_{};
  double dt_ = 0.2;
  int hold_ = 1;
  double cooperation_ = 0.0;
};

/// Traffic in which each iteration draws what is unknown about the others anew, by the belief about each. Nodes then
/// stand only for the actions of the choosing agents, not for states.
template <class PredictionWorld, class Actions, class Reward, class Others>
class HypothesisDomain : public TrafficDomain<PredictionWorld, Actions, Reward> {
  using Base = TrafficDomain<PredictionWorld, Actions, Reward>;

 public:
  using State = typename Base::State;
  static constexpr bool is_deterministic = false;

  using Base::Base;

  /// The belief about the agent at `slot`, whose behaviour must be `Others`.
  struct Unknown {
    Slot slot;
    Belief belief;
  };

  void set_unknowns(std::span<Unknown const> unknowns, Others const& hypotheses) {
    unknowns_.assign(unknowns.begin(), unknowns.end());
    hypotheses_ = hypotheses;
  }

  [[nodiscard]] std::span<Unknown const> unknowns() const { return unknowns_; }

  void sample_root(State& state, RandomStream& random) const {
    constexpr auto index = PredictionWorld::Behaviors::template index<Others>;
    for (auto const& unknown : unknowns_) {
      auto const number = unknown.belief.sample(random);
      hypotheses_.assume(*std::get_if<index>(&state.frame.agents[unknown.slot].memory), number, uniform01(random));
    }
  }

 private:
  std::vector<Unknown> unknowns_;
  Others hypotheses_{};
};

}  // namespace cambium::inline v0_1
