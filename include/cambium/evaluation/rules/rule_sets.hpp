#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cambium/core/constants.hpp"
#include "cambium/core/one_of.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/evaluation/driving.hpp"
#include "cambium/evaluation/off_road.hpp"
#include "cambium/evaluation/rules/agent_labels.hpp"
#include "cambium/evaluation/rules/formula.hpp"
#include "cambium/evaluation/rules/junction_labels.hpp"
#include "cambium/evaluation/rules/label.hpp"
#include "cambium/evaluation/rules/pair_labels.hpp"
#include "cambium/evaluation/rules/rule_monitor.hpp"
#include "cambium/evaluation/rules/safe_distance.hpp"
#include "cambium/geometry/pose.hpp"

namespace cambium::inline v0_1 {

/// All labels that cambium brings, and the user's `Own` ones: the argument of rules, rule sets and monitors.
template <class... Own>
using RuleLabels =
    OneOf<Constant, Collision, OffRoad, Exceeds<Acceleration>, Exceeds<Progress>, Exceeds<SpeedLimitExcess>,
          SafeDistance, ChangesLane, DenseTraffic, AtLaneEnd, RightmostLane, LeftmostLane, BeyondPoint, ZipPartner,
          SignalAhead, AgentNear, RelativeSpeed, LeftOf, RightOf, FrontOf, BehindOf, PrecedingAgent, SucceedingAgent,
          MustGiveWay, InConflict, PassesSignal, CrossesSolidLine, OncomingLane, OfOther<OffRoad>,
          OfOther<Exceeds<SpeedLimitExcess>>, OfOther<AtLaneEnd>, OfOther<RightmostLane>, OfOther<BeyondPoint>, Own...>;

/// Rules for every road.
///
/// | rule | formula |
/// |---|---|
/// | `speed_limit` | `G !speeding` |
/// | `solid_line` | `G !crosses_solid_line` |
/// | `wrong_way` | `G !oncoming_lane` |
template <class Labels = RuleLabels<>>
[[nodiscard]] std::vector<TrafficRule<Labels>> road_rules() {
  constexpr double tolerance = 0.1;  // [m/s]
  return {{.name = "speed_limit",
           .summary = "drives no faster than its lane permits",
           .source = "StVO section 3; Maierhofer et al. 2020, G3",
           .formula = "G !speeding",
           .labels = {{"speeding", Exceeds<SpeedLimitExcess>{.threshold = tolerance}}}},
          {.name = "solid_line",
           .summary = "does not change lanes where the road marks forbid it",
           .source = "StVO sign 295",
           .formula = "G !crosses_solid_line",
           .labels = {CrossesSolidLine{}}},
          {.name = "wrong_way",
           .summary = "does not drive in lanes of oncoming traffic",
           .source = "StVO section 2 (2)",
           .formula = "G !oncoming_lane",
           .labels = {OncomingLane{}}}};
}

/// Rules for motorways and other carriageways of one direction. Sources: Esterle, Gressenbuch, Knoll 2020, "Formalizing
/// Traffic Rules for Machine Interpretability" (arXiv 2007.00330), as BARK's evaluators have them; Rizaldi et al. 2017;
/// Maierhofer et al. 2020, "Formalization of Interstate Traffic Rules in Temporal Logic". The StVO is German law.
///
/// | rule | formula |
/// |---|---|
/// | `safe_distance` | `G safe_ahead` |
/// | `safe_lane_change` | `G(lane_change -> safe_behind)`; needs a history |
/// | `no_passing_on_the_right` | `G(!dense & behind -> !X(behind U right U front))` |
/// | `being_overtaken` | `G(right & near -> !accelerates)` |
/// | `speed_advantage` | `G(behind & X(!behind & (left U front)) -> X(faster U front))` |
/// | those of `road_rules` | |
///
/// The published rule of speed advantage demands it from the first step behind the other on, even where the agent
/// follows it for a while; here, from the step on at which it draws level. Left out: keeping right, where courts
/// disagree on what is a free right lane; the emergency lane, the ban on stopping, reversing and turning, and entering
/// vehicles (Maierhofer et al. 2020, I1, I3 to I5); abrupt braking without reason (G2), which needs "there is another
/// agent such that".
template <class Labels = RuleLabels<>>
[[nodiscard]] std::vector<TrafficRule<Labels>> highway_rules() {
  constexpr double level = 3.0, pushes = 0.5;  // [m], [m/s^2]
  std::vector<TrafficRule<Labels>> rules{
      {.name = "safe_distance",
       .summary = "keeps a distance from which it can stop behind the vehicle ahead",
       .source = "StVO section 4 (1); Rizaldi et al. 2017, theorem 4; Esterle et al. 2020; Maierhofer et al. 2020, G1",
       .formula = "G safe_ahead",
       .labels = {{"safe_ahead", SafeDistance{}}}},
      {.name = "safe_lane_change",
       .summary = "changes lanes only where the vehicle behind it there can stop",
       .source = "StVO section 7 (5); Rizaldi et al. 2017; Esterle et al. 2020",
       .formula = "G(lane_change -> safe_behind)",
       .labels = {ChangesLane{}, {"safe_behind", SafeDistance{.side = SafeDistance::Side::behind}}}},
      {.name = "no_passing_on_the_right",
       .summary = "does not pass another vehicle on its right, unless traffic is dense",
       .source = "StVO sections 5 (1) and 7 (2a); Esterle et al. 2020",
       .formula = "G(!dense & behind -> !X(behind U right U front))",
       .labels = {{"dense", DenseTraffic{}}, {"behind", BehindOf{}}, {"right", RightOf{}}, {"front", FrontOf{}}}},
      {.name = "being_overtaken",
       .summary = "does not accelerate while another vehicle passes it on its left",
       .source = "StVO section 5 (6); Esterle et al. 2020",
       .formula = "G(right & near -> !accelerates)",
       .labels = {{"right", RightOf{}},
                  {"near", AgentNear{.distance = level}},
                  {"accelerates", Exceeds<Acceleration>{.threshold = pushes}}}},
      {.name = "speed_advantage",
       .summary = "is at least 10 km/h faster than a vehicle that it passes on the left, from drawing level on",
       .source = "StVO section 5 (2); Esterle et al. 2020, corrected",
       .formula = "G(behind & X(!behind & (left U front)) -> X(faster U front))",
       .labels = {{"behind", BehindOf{}}, {"left", LeftOf{}}, {"front", FrontOf{}}, {"faster", RelativeSpeed{}}}},
  };
  for (auto& rule : road_rules<Labels>()) rules.push_back(std::move(rule));
  return rules;
}

/// The zip merge: where a lane ends, the vehicle that is close ahead in the lane beside goes in between an agent and
/// its leader. `merge` is a point behind which the two lanes are one. After Esterle, Gressenbuch, Knoll 2020, as BARK's
/// evaluators for the INTERACTION maps have it; StVO section 7 (4). `precedes` and `merged` are of the other agent, the
/// leader:
///
///     G(zip_partner & precedes & !ego_merged & ((precedes | merged) U ego_merged)
///       -> G(ego_merged & merged -> !precedes))
///
/// The published formula ranges over two other agents, the leader and the one to let in. That the latter exists is here
/// a label, which says the same, because its place matters at one step only. There, it is on the right and may be ahead
/// of the leader, too; here, it may be on either side, and either of the two lanes may end. Left out: that the ending
/// lane is used up to its end.
template <class Labels = RuleLabels<>>
[[nodiscard]] std::vector<TrafficRule<Labels>> zip_merge_rules(geometry::Point const& merge) {
  BeyondPoint const beyond{merge.x(), merge.y()};
  Formula const starts =
      Formula("zip_partner") && "precedes" && "!ego_merged" && until(Formula("precedes") || "merged", "ego_merged");
  return {{.name = "zip_merge",
           .summary = "lets one vehicle of the other lane in between itself and its leader",
           .source = "StVO section 7 (4); Esterle et al. 2020",
           .formula = always(implies(starts, "G(ego_merged & merged -> !precedes)")),
           .labels = {ZipPartner{},
                      {"precedes", PrecedingAgent{}},
                      {"ego_merged", beyond},
                      {"merged", OfOther<BeyondPoint>{beyond}}}}};
}

/// Rules for intersections, after Maierhofer, Moosbrugger, Althoff 2022, "Formalization of Intersection Traffic Rules
/// in Temporal Logic" (rules on lights, stop signs and the right of way).
///
/// | rule | formula |
/// |---|---|
/// | `red_light` | `G !passes_red` |
/// | `stop_sign` | `stops & G(passes_stop -> N stops)` with `stops` = `!passes_stop W (at_line & !moves)` |
/// | `give_way` | `G(must_give_way & !in_conflict -> N !in_conflict)` |
///
/// The published rules of the right of way ask whether a vehicle that has it must brake; here, whether it would be
/// there within 2 s. The right of way is that of the map: priorities, signs, right before left, oncoming traffic before
/// those who turn. Left out: three seconds of standing at a stop sign, turning right at red, and keeping the junction
/// clear.
template <class Labels = RuleLabels<>>
[[nodiscard]] std::vector<TrafficRule<Labels>> intersection_rules() {
  using Of = SignalAhead::Of;
  constexpr double line = 3.0;  // [m]
  Formula const stops("!passes_stop W (at_line & !moves)");
  return {
      {.name = "red_light",
       .summary = "does not pass a red light",
       .source = "StVO section 37; Maierhofer et al. 2022",
       .formula = "G !passes_red",
       .labels = {{"passes_red", PassesSignal{.of = Of::red_light}}}},
      {.name = "stop_sign",
       .summary = "stands still at the line of a stop sign before it passes it",
       .source = "StVO sign 206; Maierhofer et al. 2022",
       .formula = stops && always(implies("passes_stop", weak_next(stops))),
       .labels = {{"passes_stop", PassesSignal{.of = Of::stop_sign}},
                  {"at_line", SignalAhead{.of = Of::stop_sign, .distance = line}},
                  {"moves", Exceeds<Progress>{.threshold = standing_speed}}}},
      {.name = "give_way",
       .summary = "does not enter a conflict where a vehicle with the right of way is due",
       .source = "StVO sections 8 (2) and 9 (3); Maierhofer et al. 2022",
       .formula = "G(must_give_way & !in_conflict -> N !in_conflict)",
       .labels = {MustGiveWay{}, InConflict{}}},
  };
}

}  // namespace cambium::inline v0_1
