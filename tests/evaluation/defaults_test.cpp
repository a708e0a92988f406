// Defaults and ranges of evaluators, metrics and labels; those of BARK and nuPlan among them.
#include <cambium/cambium.hpp>
#include <cambium/evaluation/rules.hpp>
#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "../support/parameter_rows.hpp"

using namespace cambium;

TEST_CASE("evaluators, metrics and labels have the documented defaults, units and ranges") {
  CHECK(support::parameter_rows<
            Collision, AtFaultCollision, SpeedDeviation, LaneChangeUrgency, HardBraking, OthersBraking, Gap, Closeness,
            TimeToCollision, RequiredDeceleration, Clearance, Weighted<Progress>, ClosedLoopScore, Constant,
            SafeDistance, Exceeds<Acceleration>, DenseTraffic, AtLaneEnd, RightmostLane, LeftmostLane, BeyondPoint,
            AgentNear, RelativeSpeed, ZipPartner, SignalAhead, MustGiveWay, PassesSignal, Infeasible, TimeHeadway,
            BrakeThreatNumber, Exposure, ImposedBraking, PostEncroachmentTime, RssCompliance>() == &R"(
collision | margin | 0 | m | [0, 100]
at_fault_collision | blameless_speed | 0.05 | m/s | [0, 10]
at_fault_collision | look_ahead | 0 | s | [0, 60]
speed_deviation | desired_speed | 15 | m/s | [0, 200]
lane_change_urgency | horizon | 300 | m | [1, 10000]
lane_change_urgency | time_horizon | 25 | s | [0, 1000]
hard_braking | deceleration | 4 | m/s^2 | [0, 50]
others_braking | comfortable | 1 | m/s^2 | [0, 50]
others_braking | range | 60 | m | [0, inf)
gap | farthest | 400 | m | [0, 400]
closeness | minimum_gap | 2 | m | [0.1, 100]
closeness | time_headway | 0.6 | s | [0, 20]
time_to_collision | longest | 10 | s | [0, 1000]
time_to_collision | bearing | 2.6179938779914944 | rad | [0, 3.2]
required_deceleration | most | 50 | m/s^2 | [0, 1e+06]
required_deceleration | longest | 10 | s | [0, 1000]
required_deceleration | bearing | 2.6179938779914944 | rad | [0, 3.2]
clearance | farthest | 50 | m | [0, 1e+06]
weighted | weight | 0 | - | (-inf, inf)
weighted | cost | 0 | - | [0, 1]
weighted | per_second | false | - | -
weighted | ends | false | - | -
closed_loop_score | expected_progress | 0 | m | [0, inf)
closed_loop_score | least_progress | 0.2 | - | [0, 1]
closed_loop_score | least_time_to_collision | 0.95 | s | [0, 60]
closed_loop_score | bearing_in_lane | 0.5235987755982988 | rad | [0, 3.2]
closed_loop_score | bearing | 2.6179938779914944 | rad | [0, 3.2]
closed_loop_score | way_against | 2 | m | [0, inf)
closed_loop_score | long_way_against | 6 | m | [0, inf)
closed_loop_score | most_excess | 2.23 | m/s | (0, inf)
closed_loop_score | deceleration | 4.05 | m/s^2 | [0, 100]
closed_loop_score | acceleration | 2.4 | m/s^2 | [0, 100]
closed_loop_score | lateral_acceleration | 4.89 | m/s^2 | [0, 100]
closed_loop_score | jerk | 4.13 | m/s^3 | [0, 100]
closed_loop_score | size_of_jerk | 8.37 | m/s^3 | [0, 100]
closed_loop_score | yaw_rate | 0.95 | rad/s | [0, 100]
closed_loop_score | yaw_acceleration | 1.93 | rad/s^2 | [0, 100]
constant | value | true | - | -
safe_distance | side | ahead | - | ahead, behind
safe_distance | reaction_time | 1 | s | [0, 10]
safe_distance | deceleration | 7.84 | m/s^2 | [0.1, 50]
safe_distance | other_deceleration | 7.84 | m/s^2 | [0.1, 50]
exceeds | threshold | 0 | - | (-inf, inf)
dense_traffic | radius | 20 | m | [0, 1e+05]
dense_traffic | agents | 8 | - | [0, 1e+06]
at_lane_end | distance | 50 | m | [0, 1e+05]
rightmost_lane | distance | 100 | m | [0, 1e+05]
leftmost_lane | distance | 100 | m | [0, 1e+05]
beyond_point | x | 0 | m | (-inf, inf)
beyond_point | y | 0 | m | (-inf, inf)
agent_near | distance | 6 | m | [0, 1e+05]
relative_speed | difference | 2.7777777777777777 | m/s | (-inf, inf)
zip_partner | reach | 6 | m | [0, 1000]
zip_partner | distance | 55 | m | [0, 1e+05]
signal_ahead | of | light | - | light, red_light, stop_sign
signal_ahead | distance | 20 | m | [0, 1000]
must_give_way | time | 2 | s | [0, 60]
must_give_way | distance | 20 | m | [0, 400]
must_give_way | braking | 3 | m/s^2 | [0, 20]
passes_signal | of | red_light | - | light, red_light, stop_sign
passes_signal | tolerance | 0.05 | m | [0, 10]
infeasible | grip | 10 | m/s^2 | [0.1, 100]
infeasible | place | 0.05 | m | [0, 10]
infeasible | heading | 0.01 | rad | [0, 1]
infeasible | speed | 0.05 | m/s | [0, 10]
infeasible | drift | 0.1 | m | [0, 10]
time_headway | longest | 10 | s | [0, 1000]
brake_threat_number | required.most | 50 | m/s^2 | [0, 1e+06]
brake_threat_number | required.longest | 10 | s | [0, 1000]
brake_threat_number | required.bearing | 2.6179938779914944 | rad | [0, 3.2]
brake_threat_number | possible | 8 | m/s^2 | [0.1, 50]
exposure | time_to_collision.longest | 10 | s | [0, 1000]
exposure | time_to_collision.bearing | 2.6179938779914944 | rad | [0, 3.2]
exposure | threshold | 2 | s | [0, 1000]
imposed_braking | comfortable | 2 | m/s^2 | [0, 50]
imposed_braking | hard | 4 | m/s^2 | [0, 50]
imposed_braking | memory | 5 | s | [0, 1000]
imposed_braking | reaction | 2 | s | [0, 1000]
imposed_braking | horizon | 4 | s | [0, 100]
imposed_braking | headway | 3 | s | [0, 100]
post_encroachment_time | longest | 5 | s | [0, 1000]
post_encroachment_time | crossing_angle | 0.5 | rad | [0, 3.2]
rss_compliance | rss.response_time | 1 | s | [0, 10]
rss_compliance | rss.maximum_acceleration | 3.5 | m/s^2 | [0, 50]
rss_compliance | rss.maximum_deceleration | 8 | m/s^2 | [0.01, 50]
rss_compliance | rss.minimum_deceleration | 4 | m/s^2 | [0.01, 50]
rss_compliance | rss.correct_deceleration | 3 | m/s^2 | [0.01, 50]
rss_compliance | rss.lateral_acceleration | 0.2 | m/s^2 | [0, 50]
rss_compliance | rss.lateral_deceleration | 0.8 | m/s^2 | [0.01, 50]
rss_compliance | rss.lateral_margin | 0.1 | m | [0, 10]
)"[1]);
}

TEST_CASE("the rule sets have these formulas, and these numbers where they differ from the labels' own") {
  auto const text_of = [](std::vector<TrafficRule<RuleLabels<>>> const& rules) {
    std::string text;
    for (auto const& rule : rules) {
      text += rule.name + ": " + to_string(rule.formula) + '\n';
      for (auto const& named : rule.labels)
        named.label.visit([&]<class Label>(Label const& label) {
          if (!equal_parameters(label, Label{})) text += named.name + " = " + to_string(label) + '\n';
        });
    }
    return text;
  };
  CHECK(text_of(highway_rules()) == &R"(
safe_distance: G safe_ahead
safe_lane_change: G(lane_change -> safe_behind)
safe_behind = safe_distance: side=behind, reaction_time=1 s, deceleration=7.84 m/s^2, other_deceleration=7.84 m/s^2
no_passing_on_the_right: G(!dense & behind -> !X(behind U right U front))
being_overtaken: G(right & near -> !accelerates)
near = agent_near: distance=3 m
accelerates = exceeds: threshold=0.5
speed_advantage: G(behind & X(!behind & left U front) -> X(faster U front))
speed_limit: G !speeding
speeding = exceeds: threshold=0.1
solid_line: G !crosses_solid_line
wrong_way: G !oncoming_lane
)"[1]);
  CHECK(text_of(zip_merge_rules({500, 3})) == &R"(
zip_merge: G(zip_partner & precedes & !ego_merged & (precedes | merged) U ego_merged -> G(ego_merged & merged -> !precedes))
ego_merged = beyond_point: x=500 m, y=3 m
merged = of_other: label.x=500 m, label.y=3 m
)"[1]);
  CHECK(text_of(intersection_rules()) == &R"(
red_light: G !passes_red
stop_sign: !passes_stop W (at_line & !moves) & G(passes_stop -> N(!passes_stop W (at_line & !moves)))
passes_stop = passes_signal: of=stop_sign, tolerance=0.05 m
at_line = signal_ahead: of=stop_sign, distance=3 m
moves = exceeds: threshold=0.1
give_way: G(must_give_way & !in_conflict -> N !in_conflict)
)"[1]);
}

TEST_CASE("terms add up: their rewards, the highest of their costs, and whether one of them ends the course") {
  auto const sum = Judgement{.reward = 1.0, .cost = 0.2} + Judgement{.reward = -3.0, .cost = 0.5, .ends = true};
  CHECK(sum.reward == -2.0);
  CHECK(sum.cost == 0.5);
  CHECK(sum.ends);
}
