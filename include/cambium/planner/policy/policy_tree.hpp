#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cambium/behavior/lane_change/macro_actions.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/core/parameters.hpp"

namespace cambium {

/// Keep the lane, change left, change right; each at constant speed, faster, slower; never faster than car following
/// allows (Ding, Zhang, Chen, Shen 2020, section IV).
[[nodiscard]] inline MacroActions semantic_actions(double faster = 1.5, double slower = -2.0) {
  using Kind = MacroAction::Kind;
  MacroActions result;
  result.actions.clear();
  for (auto const kind : {Kind::stay, Kind::change_left, Kind::change_right})
    for (double const acceleration : {0.0, faster, slower}) result.actions.push_back({kind, acceleration, true});
  return result;
}

/// What another driver may be about to do, by its number among `intended_actions`.
enum class Intention : std::uint8_t {
  keep_lane,     ///< keeps its speed, slower behind others
  not_yield,     ///< keeps its speed whoever comes in front of it
  change_left,   ///< slower behind others
  change_right,  ///< likewise
};

/// The others' actions, one per `Intention`; `idm`: how they keep gaps.
[[nodiscard]] inline MacroActions intended_actions(IdmParameters idm) {
  using Kind = MacroAction::Kind;
  idm.desired_speed = 100.0;  // they keep theirs
  MacroActions result;
  result.actions = {{Kind::stay, 0.0, true},
                    {Kind::stay, 0.0, false},
                    {Kind::change_left, 0.0, true},
                    {Kind::change_right, 0.0, true}};
  result.idm = idm;
  return result;
}

/// What is assumed of intentions before, and of what they look like.
struct IntentionPrior {
  double change = 0.05;
  double not_yield = 0.2;
  double lateral_speed = 0.8;
  double deviation = 0.3;

  static constexpr char const* name = "intention_prior";
  static constexpr char const* summary = "lane changes are seen by the lateral speed, normal about its mean";
  static constexpr char const* source = "own";
  static constexpr auto parameters() {
    using P = IntentionPrior;
    return parameter_list(
        parameter("change", &P::change, "-", Range{0, 0.45}, "probability of a change to one side"),
        parameter("not_yield", &P::not_yield, "-", Range{0, 1}, "of not yielding to who comes in front of it"),
        parameter("lateral_speed", &P::lateral_speed, "m/s", Range{0.01, 10}, "mean in a change; 0 in the lane"),
        parameter("deviation", &P::deviation, "m/s", Range{0.01, 10}, "standard deviation of it"));
  }
};

/// Probabilities of changing lanes.
struct ChangeProbabilities {
  double left{}, right{};
};

/// By Bayes' rule from a lateral speed in its lane, left positive [m/s].
[[nodiscard]] inline ChangeProbabilities change_probabilities(IntentionPrior const& prior, double lateral_speed) {
  auto const exponent = [&](double mean) {
    double const off = (lateral_speed - mean) / prior.deviation;
    return 0.5 * off * off;
  };
  double const keep = exponent(0.0), left = exponent(prior.lateral_speed), right = exponent(-prior.lateral_speed);
  double const nearest = std::min({keep, left, right});
  using detail::portable_exp;
  double const l = prior.change * portable_exp(nearest - left), r = prior.change * portable_exp(nearest - right),
               k = (1.0 - 2.0 * prior.change) * portable_exp(nearest - keep);
  return {l / (l + r + k), r / (l + r + k)};
}

/// A sequence of ego's actions: `first` for some layers of the tree, then `then` for the rest.
struct PolicySequence {
  std::uint8_t first{}, then{};
  std::uint8_t layers_of_first{};

  friend bool operator==(PolicySequence, PolicySequence) = default;
};

/// The sequences with one change at most from the `ongoing` action, over `layers` >= 1: the domain-specific closed-loop
/// policy tree of Ding et al. 2020. (actions - 1) layers + 1 of them; the ongoing action alone is first.
[[nodiscard]] inline std::vector<PolicySequence> policy_sequences(std::size_t actions, std::size_t ongoing,
                                                                  std::size_t layers) {
  auto const first = static_cast<std::uint8_t>(ongoing);
  std::vector<PolicySequence> sequences{{first, first, static_cast<std::uint8_t>(layers)}};
  for (std::size_t kept = 0; kept < layers; ++kept)
    for (std::size_t then = 0; then < actions; ++then)
      if (then != ongoing)
        sequences.push_back({kept == 0 ? static_cast<std::uint8_t>(then) : first, static_cast<std::uint8_t>(then),
                             static_cast<std::uint8_t>(kept == 0 ? layers : kept)});
  return sequences;
}

/// Another's intention, other than to keep its lane and yield, as far as it matters to ego.
struct IntentionBranch {
  Slot slot{};
  Intention intention{};
  double probability{};
  int side = 0;  ///< matters only to sequences that change to the left (1), to the right (-1), or to all (0)
};

/// What a course costs by its parts: 0 is best.
struct PolicyCost {
  double efficiency{};  ///< mean share of the desired speed that it lacks or exceeds
  double safety{};      ///< share of the time with unsafe gaps; collisions and leaving the road on top
  double navigation{};  ///< mean number of lanes between it and the one that the route ends in
};

/// How a `PolicyTreePlanner` weighs these.
struct PolicyWeights {
  double efficiency = 1.0;
  double safety = 1.0;
  double navigation = 1.0;
  double collision = 20.0;
  double change = 0.01;
  double worst_case = 0.2;
  double least_odds = 0.05;
  double reaction_time = 0.5;
  double braking = 4.0;
  double minimum_gap = 1.0;

  static constexpr char const* name = "policy_weights";
  static constexpr char const* summary =
      "cost of a sequence: (1 - worst_case) expected + worst_case of the worst scenario that is not too unlikely";
  static constexpr char const* source = "after Ding et al. 2020";
  static constexpr auto parameters() {
    using P = PolicyWeights;
    return parameter_list(
        parameter("efficiency", &P::efficiency, "-", non_negative, "of the deviation from the desired speed"),
        parameter("safety", &P::safety, "-", non_negative, "of unsafe gaps"),
        parameter("navigation", &P::navigation, "-", non_negative, "of not being in the lane that the route ends in"),
        parameter("collision", &P::collision, "-", non_negative, "and of leaving the road, in units of safety"),
        parameter("change", &P::change, "-", non_negative, "of giving up the ongoing action now"),
        parameter("worst_case", &P::worst_case, "-", Range{0, 1},
                  "weight of the worst of the scenarios with odds of least_odds, against the mean"),
        parameter("least_odds", &P::least_odds, "-", non_negative,
                  "of another's intention against its keeping the lane: less likely ones count in the mean only"),
        parameter("reaction_time", &P::reaction_time, "s", Range{0, 10}, "of safe gaps"),
        parameter("braking", &P::braking, "m/s^2", Range{0.1, 50}, "of both at safe gaps"),
        parameter("minimum_gap", &P::minimum_gap, "m", Range{0, 100}, "of safe gaps"));
  }

  /// The gap [m] that a follower at `speed` behind one at `leader_speed` [m/s] needs to stop behind it.
  [[nodiscard]] double safe_gap(double speed, double leader_speed) const {
    double const ways = (speed * speed - leader_speed * leader_speed) / (2.0 * braking);
    return minimum_gap + reaction_time * speed + std::max(0.0, ways);
  }

  [[nodiscard]] double total(PolicyCost const& cost) const {
    return efficiency * cost.efficiency + safety * cost.safety + navigation * cost.navigation;
  }
};

}  // namespace cambium
