#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cambium/behavior/actions/driver_actions.hpp"
#include "cambium/behavior/actions/macro_actions.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/portable_math.hpp"

namespace cambium::inline v0_1 {

/// Ten actions: keep the lane, change left or change right, each at constant speed, faster or slower, but never faster
/// than car following permits (Ding, Zhang, Chen, Shen 2020, section IV); and an emergency stop, so that one is
/// among what is simulated. `faster`, `slower` and `stop` are accelerations [m/s^2].
template <class Macro = MacroActions>
[[nodiscard]] Macro semantic_actions(double faster = 1.5, double slower = -2.0, double stop = -6.0) {
  using Kind = MacroAction::Kind;
  Macro result;
  result.actions.clear();
  for (auto const kind : {Kind::stay, Kind::change_left, Kind::change_right})
    for (double const acceleration : {0.0, faster, slower}) result.actions.push_back({kind, acceleration, true});
  result.actions.push_back({Kind::stay, stop, true});
  return result;
}

/// What another driver may be about to do. The value is the number of its action in `intended_actions`.
enum class Intention : std::uint8_t {
  keep_lane,     ///< keeps its speed, but slows down behind others; `DriverActions` drive like the driver instead
  not_yield,     ///< keeps its speed even if somebody cuts in
  change_left,   ///< changes lanes; slows down behind others
  change_right,  ///< likewise
};

/// The others' actions, one for each `Intention`. `law`: how they keep gaps; its desired speed is ignored.
template <class Macro = MacroActions>
[[nodiscard]] Macro intended_actions(Idm const& law = {}) {
  using Kind = MacroAction::Kind;
  Macro result;
  result.actions = {{Kind::stay, 0.0, true},
                    {Kind::stay, 0.0, false},
                    {Kind::change_left, 0.0, true},
                    {Kind::change_right, 0.0, true}};
  result.law = law;
  result.law.desired_speed = 100.0;  // no pull towards a desired speed: they keep the speed that they have
  return result;
}

/// How a `PolicyTreePlanner` uses `Actions`: ego's semantic actions (`usual`), and those by which others, who keep gaps
/// like `Others`, carry out their intentions (`intended`). `macro` gives the macro actions among actions, or the part
/// of a memory that belongs to them.
template <class Actions>
struct SemanticActions;

template <class... Heeds>
struct SemanticActions<BasicMacroActions<Idm, Heeds...>> {
  using Macro = BasicMacroActions<Idm, Heeds...>;
  using Others = Idm;
  static constexpr bool drives = false;  ///< whether `MacroActions::nothing` is a choice: to drive like a driver

  static Macro usual() { return semantic_actions<Macro>(); }
  static Macro intended(Idm const& others) { return intended_actions<Macro>(others); }
  template <class Part>
  static Part& macro(Part& part) {
    return part;
  }
};

template <class Driver>
struct SemanticActions<DriverActions<Driver>> {
  using Others = Driver;
  static constexpr bool drives = true;

  static DriverActions<Driver> usual() {
    DriverActions<Driver> all;
    all.macro.actions = semantic_actions<typename DriverActions<Driver>::Macro>().actions;
    return all;
  }
  static DriverActions<Driver> intended(Driver const& others) {
    using Macro = typename DriverActions<Driver>::Macro;
    if constexpr (requires { intended_actions<Macro>(others.law); })
      return {.macro = intended_actions<Macro>(others.law), .driver = others};
    else
      return {.macro = intended_actions<Macro>(), .driver = others};
  }
  template <class Part>
  static auto& macro(Part& part) {
    return part.macro;
  }
};

/// Prior probabilities of the others' intentions, and the lateral speeds by which a lane change is recognised.
struct IntentionPrior {
  double change = 0.05;
  double not_yield = 0.2;
  double lateral_speed = 0.8;
  double deviation = 0.3;

  static constexpr char const* name = "intention_prior";
  static constexpr char const* summary =
      "a lane change shows in the lateral speed, normally distributed about its mean";
  static constexpr char const* source = "own";
  static constexpr auto parameters() {
    using P = IntentionPrior;
    return parameter_list(
        parameter("change", &P::change, "-", Range{0, 0.45}, "prior probability of a change to one side"),
        parameter("not_yield", &P::not_yield, "-", Range{0, 1},
                  "probability that it does not yield to somebody who cuts in"),
        parameter("lateral_speed", &P::lateral_speed, "m/s", Range{0.01, 10},
                  "mean during a change; it is 0 in the lane"),
        parameter("deviation", &P::deviation, "m/s", Range{0.01, 10}, "standard deviation of the lateral speed"));
  }
};

/// Probabilities that an agent is changing lanes.
struct ChangeProbabilities {
  double left{}, right{};
};

/// The probabilities, by Bayes' rule, given the lateral speed in its lane [m/s], left positive.
[[nodiscard]] inline ChangeProbabilities change_probabilities(IntentionPrior const& prior, double lateral_speed) {
  auto const exponent = [&](double mean) {
    double const off = (lateral_speed - mean) / prior.deviation;
    return 0.5 * off * off;
  };
  double const keep = exponent(0.0), left = exponent(prior.lateral_speed), right = exponent(-prior.lateral_speed);
  double const nearest = std::min({keep, left, right});
  double const l = prior.change * portable::exp(nearest - left), r = prior.change * portable::exp(nearest - right),
               k = (1.0 - 2.0 * prior.change) * portable::exp(nearest - keep);
  return {l / (l + r + k), r / (l + r + k)};
}

/// A sequence of ego's actions, as choices of their `ActionSet`: `first` for `layers_of_first` layers of the tree,
/// `then` for the rest.
struct PolicySequence {
  std::uint8_t first{}, then{};
  std::uint8_t layers_of_first{};

  friend bool operator==(PolicySequence, PolicySequence) = default;
};

/// All sequences of `choices` over `layers` >= 1 that leave the `ongoing` one at most once: the domain-specific
/// closed-loop policy tree of Ding et al. 2020. There are (choices - 1) layers + 1; the first keeps the ongoing action
/// throughout.
[[nodiscard]] inline std::vector<PolicySequence> policy_sequences(std::span<std::uint8_t const> choices,
                                                                  std::uint8_t ongoing, std::size_t layers) {
  std::vector<PolicySequence> sequences{{ongoing, ongoing, static_cast<std::uint8_t>(layers)}};
  for (std::size_t kept = 0; kept < layers; ++kept)
    for (auto const then : choices)
      if (then != ongoing)
        sequences.push_back({kept == 0 ? then : ongoing, then, static_cast<std::uint8_t>(kept == 0 ? layers : kept)});
  return sequences;
}

/// An intention of another agent that matters to ego: anything but to keep its lane and yield.
struct IntentionBranch {
  Slot slot{};
  Intention intention{};
  double probability{};
  int side = 0;  ///< matters to sequences that change to the left (1), to the right (-1), or to all (0)
};

/// The cost of a course in parts; 0 is best.
struct PolicyCost {
  double efficiency{};  ///< mean deviation from the desired speed, as a share of it
  double safety{};      ///< share of the time with unsafe gaps, plus collisions and leaving the road
  double navigation{};  ///< mean urgency of lane changes, see `LaneChangeUrgency`
  double terms{};       ///< negative sum of the planner's `terms`
  double courtesy{};    ///< mean of how hard others brake, see `OthersBraking` [m^2/s^4]
};

/// How a `PolicyTreePlanner` weighs the parts of the cost, and what counts as a safe gap.
struct PolicyWeights {
  double efficiency = 1.0;
  double safety = 1.0;
  double navigation = 4.0;
  double collision = 20.0;
  double change = 0.01;
  double worst_case = 0.2;
  double least_odds = 0.05;
  double reaction_time = 0.5;
  double braking = 4.0;
  double minimum_gap = 1.0;
  double courtesy = 0.1;
  double clearance = 0.3;

  static constexpr char const* name = "policy_weights";
  static constexpr char const* summary =
      "cost of a sequence: (1 - worst_case) expected + worst_case times the worst scenario that is not too unlikely";
  static constexpr char const* source = "after Ding et al. 2020";
  static constexpr auto parameters() {
    using P = PolicyWeights;
    return parameter_list(
        parameter("efficiency", &P::efficiency, "-", non_negative, "weight of the deviation from the desired speed"),
        parameter("safety", &P::safety, "-", non_negative, "weight of unsafe gaps"),
        parameter("navigation", &P::navigation, "-", non_negative,
                  "weight of the urgency of lane changes to the destination"),
        parameter("collision", &P::collision, "-", non_negative,
                  "cost of a collision, or of leaving the road, in units of safety"),
        parameter("change", &P::change, "-", non_negative, "cost of leaving the ongoing action now"),
        parameter("worst_case", &P::worst_case, "-", Range{0, 1},
                  "weight of the worst scenario, against the mean over all"),
        parameter("least_odds", &P::least_odds, "-", non_negative,
                  "a scenario less likely than this, relative to all keeping their lanes, counts in the mean only"),
        parameter("reaction_time", &P::reaction_time, "s", Range{0, 10}, "of the follower, in a safe gap"),
        parameter("braking", &P::braking, "m/s^2", Range{0.1, 50}, "deceleration of both vehicles, in a safe gap"),
        parameter("minimum_gap", &P::minimum_gap, "m", Range{0, 100}, "left at standstill, in a safe gap"),
        parameter("courtesy", &P::courtesy, "s^4/m^2", non_negative, "weight of how hard others brake"),
        parameter("clearance", &P::clearance, "m", Range{0, 10},
                  "a smaller distance to others counts as a collision, unless it begins so"));
  }

  /// Gap [m] with which a follower at `speed` can stop behind a leader that brakes from `leader_speed` [m/s].
  [[nodiscard]] double safe_gap(double speed, double leader_speed) const {
    double const ways = (speed * speed - leader_speed * leader_speed) / (2.0 * braking);
    return minimum_gap + reaction_time * speed + std::max(0.0, ways);
  }

  /// The weighted sum of the parts.
  [[nodiscard]] double total(PolicyCost const& cost) const {
    return efficiency * cost.efficiency + safety * cost.safety + navigation * cost.navigation +
           courtesy * cost.courtesy + cost.terms;
  }
};

}  // namespace cambium::inline v0_1
