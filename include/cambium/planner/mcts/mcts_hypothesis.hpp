#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/following/idm_hypotheses.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/planner/detail/predicted.hpp"
#include "cambium/planner/mcts/belief.hpp"
#include "cambium/planner/mcts/mcts_workspace.hpp"

namespace cambium {

/// Plans by tree search among others whose time headways are not known: it believes one of a few regions of each, with
/// probabilities that follow what the nearest do (Bayes), and draws headways anew for each iteration (root sampling).
/// `PredictionWorld` must have `IdmHypotheses` in its behaviour set. Nodes stand for ego's actions only.
template <class PredictionWorld, class Actions = MacroActions, class Reward = TrafficReward,
          class Options = MctsOptions<>>
struct MctsHypothesis {
  static_assert(detail::check_planner<PredictionWorld>());
  static_assert(PredictionWorld::Behaviors::template contains<IdmHypotheses>,
                "cambium::MctsHypothesis<PredictionWorld>: the behaviour set of PredictionWorld must contain "
                "cambium::IdmHypotheses, as which the others are predicted");

  using Domain = HypothesisDomain<PredictionWorld, Actions, Reward>;
  using Workspace = MctsWorkspace<Domain, Options>;

  /// Those about whom something is believed.
  static constexpr std::size_t capacity = 6;

  struct Tracked {
    AgentId id = none<AgentId>;
    Belief belief{};
    std::array<float, IdmHypotheses::most_regions> expected{};  ///< speed at the next step, by region [m/s]

    friend bool operator==(Tracked const&, Tracked const&) = default;
  };
  struct Memory {
    std::array<Tracked, capacity> tracked{};
    double expected_at = -1.0;               ///< when those speeds are expected [s]
    detail::ActionMemory<Actions> course{};  ///< the manoeuvre under way

    /// What is believed of an agent; null where nothing is.
    [[nodiscard]] Belief const* belief(AgentId id) const {
      auto const at = std::ranges::find(tracked, id, &Tracked::id);
      return is_valid(id) && at != tracked.end() ? &at->belief : nullptr;
    }
    friend bool operator==(Memory const&, Memory const&) = default;
  };

  Actions actions{};
  IdmHypotheses others{};
  Reward reward{};
  Options options{};
  BeliefParameters belief{};
  double speed_deviation = 0.05;
  double range = 60.0;
  double interval = 0.2;

  static constexpr char const* name = "mcts_hypothesis";
  static constexpr char const* summary =
      "tree search (UCT) among others whose time headways are drawn by what is believed of each, from what it did";
  static constexpr char const* source = "Bernhard, Knoll 2020 (RSBG); Silver, Veness 2010 (root sampling)";
  static constexpr auto parameters() {
    using P = MctsHypothesis;
    return parameter_list(parameter("actions", &P::actions, "-", {}, "what ego may do"),
                          parameter("others", &P::others, "-", {}, "what the others may be like"),
                          parameter("reward", &P::reward, "-", {}, "what ego wants"),
                          parameter("options", &P::options, "-", {}, "how it is searched"),
                          parameter("belief", &P::belief, "-", {}, "how it follows what is observed"),
                          parameter("speed_deviation", &P::speed_deviation, "m/s", Range{1e-3, 10},
                                    "standard deviation of a speed after a step, from what a headway predicts"),
                          parameter("range", &P::range, "m", non_negative,
                                    "the 6 nearest within it are told apart; of the rest all is as likely"),
                          parameter("interval", &P::interval, "s", Range{0.01, 60},
                                    "between two looks by `think`; as a behaviour it looks in each step"));
  }

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory& memory, double dt, Workspace& workspace) const {
    return detail::plan_by_search<PredictionWorld>(
        view, memory.course, workspace, dt, [&](auto& w) -> auto const& { return search(view, memory, dt, w); });
  }

  /// What it thinks of what `view` shows, having seen what `memory` says; notes there what it sees, to be compared with
  /// what it sees `interval` later, and leaves `memory.course`, the manoeuvre under way, to be set to the report's
  /// `memory`. Throws `SearchError` where there is nothing to search, `ParameterError` where a parameter is out of its
  /// range.
  template <class View>
  [[nodiscard]] MctsReport<Domain> think(View const& view, Memory& memory, Workspace& workspace) const {
    check_parameters(*this);
    detail::throw_if(search(view, memory, interval, workspace), workspace, view.id());
    return workspace.report();
  }

 private:
  static constexpr auto index = PredictionWorld::Behaviors::template index<IdmHypotheses>;

  template <class View>
  [[nodiscard]] SearchResult<typename Domain::Action> const& search(View const& view, Memory& memory, double dt,
                                                                    Workspace& workspace) const {
    std::vector<Slot> slots;
    auto world = detail::world_to_search<PredictionWorld>(view, actions, memory.course, others, slots);
    std::vector<typename Domain::Unknown> unknowns;
    if (!slots.empty()) unknowns = update(world, slots[0], memory, dt);
    Domain domain(std::move(world), slots, actions, reward, options.step);
    domain.set_unknowns(unknowns, others);
    return workspace.run(std::move(domain), options, view.random(detail::search_purpose)());
  }

  /// Takes in what the others did since the last step, and notes what they are expected to do in the next one.
  [[nodiscard]] std::vector<typename Domain::Unknown> update(PredictionWorld const& world, Slot ego, Memory& memory,
                                                             double dt) const {
    auto const near = detail::nearest_agents(world, ego, capacity, range);
    auto const regions = static_cast<std::size_t>(others.regions);
    bool const was_expected = std::abs(memory.expected_at - world.time()) < 1e-6;
    std::array<Tracked, capacity> tracked{};
    std::vector<typename Domain::Unknown> unknowns;
    for (std::size_t i = 0; i < near.size(); ++i) {
      auto const id = world.roster().agents[near[i]].id;
      auto const known = std::ranges::find(memory.tracked, id, &Tracked::id);
      bool const is_known = known != memory.tracked.end() && known->belief.size() == regions;
      tracked[i] = is_known ? *known : Tracked{id, Belief(regions), {}};
      if (is_known && was_expected) observe(tracked[i], world.frame().agents[near[i]].state.speed);
      unknowns.push_back({near[i], tracked[i].belief});
    }
    // Of the rest nothing is known.
    for (Slot slot{}; index_of(slot) < world.size(); ++slot)
      if (std::get_if<index>(&world.frame().agents[slot].memory) != nullptr &&
          std::ranges::find(near, slot) == near.end())
        unknowns.push_back({slot, Belief(regions)});
    memory.tracked = tracked;
    expect(world, near, memory, dt);
    return unknowns;
  }

  void observe(Tracked& other, double speed) const {
    std::array<double, IdmHypotheses::most_regions> likelihoods{};
    double nearest = 1e300;
    auto const regions = static_cast<std::size_t>(others.regions);
    for (std::size_t r = 0; r < regions; ++r) {
      double const off = (speed - static_cast<double>(other.expected[r])) / speed_deviation;
      likelihoods[r] = 0.5 * off * off;
      nearest = std::min(nearest, likelihoods[r]);
    }
    // Relative to the best, lest all of them vanish where no headway explains what was seen.
    for (std::size_t r = 0; r < regions; ++r) likelihoods[r] = detail::portable_exp(nearest - likelihoods[r]);
    other.belief.update({likelihoods.data(), regions}, belief);
  }

  void expect(PredictionWorld const& world, std::span<Slot const> slots, Memory& memory, double dt) const {
    PredictionWorld trial = world;
    for (std::size_t r = 0; r < static_cast<std::size_t>(others.regions); ++r) {
      auto frame = world.frame();
      for (auto const slot : slots)
        std::get_if<index>(&frame.agents[slot].memory)->time_headway = static_cast<float>(others.headway(r, 0.5));
      trial.exchange(frame);
      (void)trial.step(dt);
      for (std::size_t i = 0; i < slots.size(); ++i)
        memory.tracked[i].expected[r] = static_cast<float>(trial.frame().agents[slots[i]].state.speed);
    }
    memory.expected_at = world.time() + dt;
  }
};

}  // namespace cambium
