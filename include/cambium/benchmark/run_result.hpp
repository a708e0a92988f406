#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "cambium/core/described.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/text.hpp"

namespace cambium::inline v0_1 {

/// What ended a run by an error: the run itself (also where there is no error), the limit of the time to plan, or the
/// death of its process. The machine may be to blame for the last two, so such scenarios are run again.
enum class RunErrorKind : std::uint8_t { run, plans_too_long, process_died };

/// Which values of a measure are better.
enum class Better { neither, more, less };

/// The result of one scenario with one behaviour. It depends on nothing but these two and the library: not on threads,
/// machine load or time of day (`RunTimes` does). Excepted are errors for which the machine may be to blame.
///
/// A number that a run has none of is NaN, and no value in the database: a gap where nobody was ahead, an impact
/// without a collision. A least time to collision of 10 s means that many or more; of 0, a collision.
struct RunResult {
  bool success = false;
  bool collision = false;
  bool at_fault = false;
  bool off_road = false;
  bool off_route = false;
  bool timed_out = false;
  std::string error{};
  RunErrorKind error_kind = RunErrorKind::run;
  std::int64_t steps = 0;
  double duration_s = 0.0;
  double progress_m = 0.0;
  double mean_speed = 0.0;
  double least_gap = undefined;
  double least_time_to_collision = undefined;
  double post_encroachment_time = undefined;
  double required_deceleration = 0.0;
  double hardest_braking = 0.0;
  double largest_jerk = 0.0;
  double largest_lateral_acceleration = 0.0;
  std::int64_t hard_brakings = 0;
  double rss_compliance = 1.0;
  double closed_loop_score = 0.0;
  std::int64_t others_collided = 0;
  std::int64_t others_failed = 0;
  AgentId hit = none<AgentId>;
  bool infeasible = false;
  bool red_light = false;
  bool stop_sign = false;
  bool right_of_way = false;
  bool wrong_way = false;
  bool speeding = false;
  bool solid_line = false;
  std::int64_t infeasible_steps = 0;
  double impact_speed = undefined;
  double least_clearance = undefined;
  double imposed_braking = 0.0;
  double straddling_s = 0.0;
  std::string violations{};
  std::string failed_by{};
  double time_headway = undefined;
  double time_exposed_s = 0.0;
  double time_integrated = 0.0;
  bool discomfort = false;
  double prediction_error_1s = undefined;
  double prediction_error_3s = undefined;
  double prediction_error_5s = undefined;
  double prediction_brier = undefined;

  static constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

  static constexpr char const* name = "result";
  static constexpr auto parameters() {
    using P = RunResult;
    constexpr Range share{0, 1};
    auto const outcome = parameter_list(
        parameter("success", &P::success,
                  "the ego reached its goal in time, without a collision and what its set calls a failure"),
        parameter("collision", &P::collision, "an agent under test touched another agent or an object"),
        parameter("at_fault", &P::at_fault, "it is to blame for that, by nuPlan's rules"),
        parameter("off_road", &P::off_road, "a part of it left the drivable lanes"),
        parameter("off_route", &P::off_route, "it left its route, or traffic before its goal"),
        parameter("timed_out", &P::timed_out, "the time limit passed"),
        parameter("error", &P::error, "why the run could not go on; empty: it could"),
        choice("error_kind", &P::error_kind, "run|plans_too_long|process_died",
               "what ended the run, where it has an error"),
        parameter("steps", &P::steps, "-", non_negative, "number of steps"),
        parameter("duration_s", &P::duration_s, "s", non_negative, "until the run ended"));
    auto const driving = parameter_list(
        parameter("progress_m", &P::progress_m, "m", any_finite, "way along the lanes"),
        parameter("mean_speed", &P::mean_speed, "m/s", non_negative, "over time"),
        parameter("least_gap", &P::least_gap, "m", any_finite, "to the next road user ahead in its lane"),
        parameter("least_time_to_collision", &P::least_time_to_collision, "s", non_negative,
                  "to any road user or object, if all keep their speeds and lanes; 10 s: that or more"),
        parameter("post_encroachment_time", &P::post_encroachment_time, "s", non_negative,
                  "least, where ways cross; to what a body takes to move on by its length"),
        parameter("required_deceleration", &P::required_deceleration, "m/s^2", non_negative,
                  "largest, to touch nobody, if all others keep their speeds and lanes"),
        parameter("hardest_braking", &P::hardest_braking, "m/s^2", non_negative, "deceleration"),
        parameter("largest_jerk", &P::largest_jerk, "m/s^3", non_negative, "either way"),
        parameter("largest_lateral_acceleration", &P::largest_lateral_acceleration, "m/s^2", non_negative,
                  "either way"),
        parameter("hard_brakings", &P::hard_brakings, "-", non_negative, "number of brakings harder than 4 m/s^2"),
        parameter("rss_compliance", &P::rss_compliance, "-", share, "share of steps with a proper response"),
        parameter("closed_loop_score", &P::closed_loop_score, "-", share,
                  "nuPlan's, without progress; 0 without success"),
        parameter("others_collided", &P::others_collided, "-", non_negative,
                  "number of steps in which a collision without the ego began"),
        parameter("others_failed", &P::others_failed, "-", non_negative,
                  "number of agents that found no plan, or an impossible one, and left traffic; not those under test"),
        parameter("hit", &P::hit, "the agent that was touched"));
    auto const rules = parameter_list(
        parameter("infeasible", &P::infeasible, "an agent under test made a motion that no vehicle can make"),
        parameter("red_light", &P::red_light, "an agent under test passed a red light"),
        parameter("stop_sign", &P::stop_sign, "an agent under test passed a stop sign without a stop"),
        parameter("right_of_way", &P::right_of_way,
                  "an agent under test did not let one go first who had the right of way"),
        parameter(
            "wrong_way", &P::wrong_way,
            "an agent under test drove in lanes of oncoming traffic, altogether for a second or what its set permits"),
        parameter("speeding", &P::speeding, "an agent under test drove faster than its lane permits"),
        parameter("solid_line", &P::solid_line, "an agent under test changed lanes where the road marks forbid it"),
        parameter("infeasible_steps", &P::infeasible_steps, "-", non_negative,
                  "number of such motions, of a step each"),
        parameter(
            "impact_speed", &P::impact_speed, "m/s", non_negative,
            "relative to what was touched, or a step before, where that was faster; undefined without a collision"),
        parameter("least_clearance", &P::least_clearance, "m", non_negative,
                  "to the nearest road user or object; 50 m: that or more"),
        parameter("imposed_braking", &P::imposed_braking, "m/s^2", non_negative,
                  "hardest of others because of the ego, beyond what the rules ask of them"),
        parameter("straddling_s", &P::straddling_s, "s", non_negative,
                  "longest time for which its body was beyond the borders of its lane"),
        parameter("violations", &P::violations, "when it did what no vehicle can do or the rules forbid"),
        parameter("failed_by", &P::failed_by, "which of the set's criteria it met, so that it is no success"),
        parameter("time_headway", &P::time_headway, "s", non_negative,
                  "least, to the next road user ahead in its lane; 10 s: that or more"),
        parameter("time_exposed_s", &P::time_exposed_s, "s", non_negative,
                  "time exposed TTC: with less than 2 s to a collision"),
        parameter("time_integrated", &P::time_integrated, "s^2", non_negative,
                  "time integrated TTC: what lacked of these 2 s, over time"),
        parameter("discomfort", &P::discomfort,
                  "accelerations, jerks or turns of the ego were beyond the bounds of its score"));
    auto const predictions = parameter_list(
        parameter("prediction_error_1s", &P::prediction_error_1s, "m", non_negative,
                  "mean distance of others from where the ego's planner expected them a second before"),
        parameter("prediction_error_3s", &P::prediction_error_3s, "m", non_negative, "3 s before"),
        parameter("prediction_error_5s", &P::prediction_error_5s, "m", non_negative, "5 s before"),
        parameter("prediction_brier", &P::prediction_brier, "-", Range{0, 2},
                  "Brier score of the probabilities that it gave to the ways of others, 3 s ahead; 0 is best"));
    return join_parameters(join_parameters(join_parameters(outcome, driving), rules), predictions);
  }

  /// Whether more or less of a field is better. Outcomes, safety and the closed-loop score are judged. Speeds and gaps
  /// are not, because a good driver may have more or less; nor are time-outs, which already lack success, and errors of
  /// predictions, which also depend on where the ego drives.
  [[nodiscard]] static Better better(std::string_view field) {
    for (char const* more : {"success", "rss_compliance", "closed_loop_score"})
      if (field == more) return Better::more;
    for (char const* less : {"collision", "at_fault", "off_road", "off_route", "error", "hard_brakings",
                             "others_collided", "infeasible", "red_light", "stop_sign", "right_of_way", "wrong_way",
                             "speeding", "solid_line", "impact_speed", "imposed_braking"})
      if (field == less) return Better::less;
    return Better::neither;
  }
};

namespace detail {

/// How a run ended; each run ends in one way.
inline constexpr std::array<char const*, 7> run_outcomes = {
    "success", "collision, at fault", "collision, not at fault", "time-out", "error", "left its route", "violation"};

[[nodiscard]] inline std::size_t outcome_of(RunResult const& result) {
  if (!result.error.empty()) return 4;
  if (result.collision) return result.at_fault ? 1 : 2;
  if (result.success) return 0;
  return result.timed_out ? 3 : result.off_route ? 5 : 6;
}

}  // namespace detail

/// A part of `RunResult::violations`.
struct RunViolation {
  double time = 0.0;   ///< [s]
  std::string text{};  ///< "wrong_way until 7.2 s"
};

/// What a run violated, in the order of time.
[[nodiscard]] inline std::vector<RunViolation> violations_of(RunResult const& result) {
  std::vector<RunViolation> list;
  std::string_view rest = result.violations;
  while (!rest.empty()) {
    auto const end = std::min(rest.find("; "), rest.size());
    auto const item = rest.substr(0, end);
    auto const blank = std::min(item.find(" s "), item.size());
    list.push_back({detail::parse_number<double>(item.substr(0, blank)).value_or(0.0),
                    std::string(item.substr(std::min(blank + 3, item.size())))});
    rest.remove_prefix(std::min(end + 2, rest.size()));
  }
  return list;
}

/// How long the ego's decisions took. Apart from `RunResult`, because it differs from run to run.
struct RunTimes {
  std::int64_t decisions = 0;
  double mean_ms = 0.0;
  double longest_ms = 0.0;
  std::int64_t overruns = 0;
  double run_s = 0.0;

  static constexpr char const* name = "times";
  static constexpr auto parameters() {
    using P = RunTimes;
    return parameter_list(parameter("decisions", &P::decisions, "-", non_negative, "number of the ego's plans"),
                          parameter("mean_ms", &P::mean_ms, "ms", non_negative, "mean time of a plan"),
                          parameter("longest_ms", &P::longest_ms, "ms", non_negative, "longest time of a plan"),
                          parameter("overruns", &P::overruns, "-", non_negative, "plans that took longer than a step"),
                          parameter("run_s", &P::run_s, "s", non_negative, "wall clock time of the run"));
  }
};

}  // namespace cambium::inline v0_1
