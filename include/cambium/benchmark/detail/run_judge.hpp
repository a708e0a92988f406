#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "cambium/behavior/view.hpp"
#include "cambium/benchmark/run_result.hpp"
#include "cambium/core/constants.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/one_of.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/evaluation/driving.hpp"
#include "cambium/evaluation/encounter.hpp"
#include "cambium/evaluation/infeasible.hpp"
#include "cambium/evaluation/metrics/closed_loop_score.hpp"
#include "cambium/evaluation/metrics/exposure.hpp"
#include "cambium/evaluation/metrics/over_time.hpp"
#include "cambium/evaluation/metrics/post_encroachment_time.hpp"
#include "cambium/evaluation/metrics/rss_compliance.hpp"
#include "cambium/evaluation/off_road.hpp"
#include "cambium/evaluation/rules/agent_labels.hpp"
#include "cambium/evaluation/rules/imposed_braking.hpp"
#include "cambium/evaluation/rules/junction_labels.hpp"
#include "cambium/evaluation/rules/label.hpp"
#include "cambium/evaluation/rules/rule_monitor.hpp"
#include "cambium/evaluation/rules/rule_sets.hpp"
#include "cambium/scenario/scenario_set.hpp"
#include "cambium/world/frame.hpp"

namespace cambium::inline v0_1::detail {

/// A rule that every run is judged by, and the field of the result that says whether it was broken.
struct RunRule {
  using Labels = OneOf<PassesSignal, SignalAhead, Exceeds<Progress>, MustGiveWay, InConflict, OncomingLane,
                       Exceeds<SpeedLimitExcess>, CrossesSolidLine>;

  char const* name;  ///< of the field
  bool RunResult::*is_broken;
  RuleMonitor<Labels> monitor;
};

/// All of them, before a run.
[[nodiscard]] inline std::vector<RunRule> const& run_rules() {
  static std::vector<RunRule> const all = [] {
    constexpr std::size_t others = 16, violations = 16;
    auto rules = intersection_rules<RunRule::Labels>();
    for (auto& rule : road_rules<RunRule::Labels>()) rules.push_back(std::move(rule));
    std::vector<RunRule> list;
    auto const add = [&](std::string_view rule, char const* name, bool RunResult::*field) {
      auto const at = std::ranges::find(rules, rule, &TrafficRule<RunRule::Labels>::name);
      list.push_back({name, field, RuleMonitor<RunRule::Labels>(*at, others, violations)});
    };
    add("red_light", "red_light", &RunResult::red_light);
    add("stop_sign", "stop_sign", &RunResult::stop_sign);
    add("give_way", "right_of_way", &RunResult::right_of_way);
    add("wrong_way", "wrong_way", &RunResult::wrong_way);
    add("speed_limit", "speeding", &RunResult::speeding);
    add("solid_line", "solid_line", &RunResult::solid_line);
    return list;
  }();
  return all;
}

/// Whether a run did what a criterion is about.
[[nodiscard]] inline bool meets(RunResult const& result, Criterion criterion, CriterionBounds const& bounds) {
  switch (criterion) {
    case Criterion::infeasible:
      return result.infeasible;
    case Criterion::red_light:
      return result.red_light;
    case Criterion::stop_sign:
      return result.stop_sign;
    case Criterion::right_of_way:
      return result.right_of_way;
    case Criterion::wrong_way:
      return result.wrong_way;
    case Criterion::speeding:
      return result.speeding;
    case Criterion::solid_line:
      return result.solid_line;
    case Criterion::off_road:
      return result.off_road;
    case Criterion::imposed_braking:
      return result.imposed_braking > bounds.imposed_braking;
    case Criterion::straddling:
      return result.straddling_s > bounds.straddling;
    case Criterion::discomfort:
      return result.discomfort;
  }
  return false;
}

/// The absolute value of evaluator `E`.
template <class E>
struct SizeOf {
  template <class World>
  [[nodiscard]] double operator()(World& world, Slot slot) const {
    return std::abs(E{}(world, slot));
  }
};

/// Judges a run of the agents `own`, of which the first is the ego: its metrics, and what all of `own` do that no
/// vehicle can do or that the rules forbid.
template <class World>
class RunJudge {
 public:
  RunJudge(World& world, std::span<AgentId const> own, CriterionBounds const& bounds)
      : ego_(world.slot_of(own.front())), bounds_(bounds) {
    for (auto const id : own) own_.push_back({id, world.slot_of(id)});
    std::get<Score>(metrics_).recorder = bounds.score;
    observe(world, 0.0);
  }

  void observe(World& world, double dt) {
    std::apply([&](auto&... metric) { (metric.recorder.observe(world, ego_, dt), ...); }, metrics_);
    for (auto& own : own_) {
      for (auto& rule : own.rules) rule.monitor(world, own.slot);
      own.in_oncoming_lanes.observe(world, own.slot, dt);
      own.off_road.see(OffRoad{}(world, own.slot), world.time());
      ask_whether_possible(world, own);
    }
    discomfort_.see(1.0 - std::get<Score>(metrics_).recorder.parts().comfort, world.time());
    imposed_.see(std::get<Imposed>(metrics_).recorder.value(), world.time());
    straddling_.see(std::get<Straddling>(metrics_).recorder.value(), world.time());
    for (auto const& own : own_) note_collisions(world, own.slot);
    auto const pair = AnyCollision{}.pair(world);
    bool const others = pair && !is_own(pair->first) && !is_own(pair->second);
    result_.others_collided += others && !others_collide_;
    others_collide_ = others;
  }

  [[nodiscard]] RunResult& result() { return result_; }

  /// The result of a run that has ended, in which what `fails` names is no success. After a collision of the
  /// ego, also one between two frames, the least times and the least clearance are 0.
  [[nodiscard]] RunResult finished(World const& world, std::span<Criterion const> fails) {
    result_.steps = static_cast<std::int64_t>(world.frame().step);
    result_.duration_s = world.time();
    std::apply([&](auto const&... metric) { (metric.write(result_), ...); }, metrics_);
    for (auto const& own : own_) result_.off_road = result_.off_road || own.off_road.value > 0.0;
    result_.discomfort = discomfort_.value > 0.0;
    if (touched_) result_.least_time_to_collision = result_.least_clearance = 0.0;
    if (touched_agent_) result_.post_encroachment_time = 0.0;
    add_violations(std::ranges::find(fails, Criterion::discomfort) != fails.end());
    for (auto const criterion : fails) {
      if (!meets(result_, criterion, bounds_)) continue;
      result_.success = false;
      result_.failed_by.append(result_.failed_by.empty() ? "" : " ").append(to_string(criterion));
    }
    if (!result_.success) result_.closed_loop_score = 0.0;  // it made no progress in nuPlan's sense
    return result_;
  }

 private:
  /// The largest value so far, and when it was reached.
  struct Peak {
    double value = 0.0, time = 0.0;
    void see(double next, double now) {
      if (next > value) *this = {next, now};
    }
  };

  /// An agent under test, and what is known of its way so far.
  struct Own {
    AgentId id;
    Slot slot;
    Infeasible::Drift drift{};
    std::vector<RunRule> rules = run_rules();
    Integral<OncomingLane> in_oncoming_lanes{};  ///< [s]
    Peak off_road{};                             ///< 0 or 1
  };

  void ask_whether_possible(World const& world, Own& own) {
    auto const finding = bounds_.infeasible.finding(world, own.slot, own.drift);
    if (finding.flaw == Infeasible::Flaw::none) return;
    if (!std::exchange(result_.infeasible, true)) first_ = {world.time(), own.id, finding};
    ++result_.infeasible_steps;
    if (finding.excess() > worst_.finding.excess()) worst_ = {world.time(), own.id, finding};
  }

  [[nodiscard]] bool is_own(AgentId agent) const { return std::ranges::find(own_, agent, &Own::id) != own_.end(); }

  /// Notes what the agent at `slot` touches or touched during the last step.
  void note_collisions(World const& world, Slot slot) {
    for_each_touched(world, slot, [&](Slot other) {
      note_contact(world, slot, world.roster().agents[other].id, relative_speed(world, slot, other));
    });
    if (touched_object_in_step(world, slot) != nullptr)
      note_contact(world, slot, none<AgentId>, speed_in_step(world, slot));
  }

  /// `other`: none for an object. Of several contacts, the hardest is on record.
  void note_contact(World const& world, Slot slot, AgentId other, double speed) {
    touched_ = touched_ || slot == ego_;
    touched_agent_ = touched_agent_ || (slot == ego_ && is_valid(other));
    result_.at_fault = result_.at_fault || AtFaultCollision{}.in_last_step(world, slot);
    if (std::exchange(result_.collision, true) && speed <= result_.impact_speed) return;
    result_.impact_speed = speed;
    result_.hit = other;
    hit_by_ = slot == ego_ ? none<AgentId> : world.roster().agents[slot].id;
  }

  /// The higher of the relative speeds of two agents before and after the last step [m/s].
  [[nodiscard]] static double relative_speed(World const& world, Slot a, Slot b) {
    auto const of = [](auto const& records, Slot x, Slot y) {
      auto const &one = records[x].state, &two = records[y].state;
      auto const along = portable::sin_cos(one.heading), its = portable::sin_cos(two.heading);
      return portable::hypot(one.speed * along.cos - two.speed * its.cos, one.speed * along.sin - two.speed * its.sin);
    };
    double const now = of(world.frame().agents, a, b);
    auto const* const before = world.before_step();
    bool const is_known =
        before != nullptr && (*before)[a].status == AgentStatus::driving && (*before)[b].status == AgentStatus::driving;
    return is_known ? std::max(now, of(*before, a, b)) : now;
  }

  /// Writes what was violated, in the order of time: "3.4 s red_light; 5 s wrong_way until 7.2 s".
  void add_violations(bool with_discomfort) {
    struct Item {
      double time;
      std::string text;
    };
    std::vector<Item> items;
    auto const by = [&](AgentId agent) {
      return agent == own_.front().id ? std::string() : " by agent " + to_string(agent);
    };
    auto const seconds = [](double time) { return rounded_text(time) + " s"; };
    for (auto& own : own_)
      for (auto& rule : own.rules) {
        rule.monitor.finish();
        bool const is_short = own.in_oncoming_lanes.value() < bounds_.wrong_way - same_time;
        if (rule.is_broken == &RunResult::wrong_way && is_short) continue;
        auto const& located = rule.monitor.violations();
        for (auto const& violation : located) {
          result_.*rule.is_broken = true;
          auto text = rule.name + by(own.id);
          if (is_valid(violation.other)) text += " to agent " + to_string(violation.other);
          if (violation.end > violation.begin) text += " until " + seconds(violation.end);
          if (&violation == &located.back() && rule.monitor.count() > located.size())
            text += " (and " + std::to_string(rule.monitor.count() - located.size()) + " more)";
          items.push_back({violation.begin, std::move(text)});
        }
      }
    if (is_valid(hit_by_)) items.push_back({result_.duration_s, "collision" + by(hit_by_)});
    if (result_.infeasible) {
      auto text = "infeasible: agent " + to_string(first_.agent) + " " + to_string(first_.finding);
      if (result_.infeasible_steps > 1) text += ", the first of " + std::to_string(result_.infeasible_steps) + " steps";
      if (worst_.time > first_.time)
        text += ", the worst at " + seconds(worst_.time) + ": agent " + to_string(worst_.agent) + " " +
                to_string(worst_.finding);
      items.push_back({first_.time, std::move(text)});
    }
    for (auto const& own : own_)
      if (own.off_road.value > 0.0) items.push_back({own.off_road.time, "off_road" + by(own.id)});
    if (with_discomfort && result_.discomfort) items.push_back({discomfort_.time, "discomfort"});
    if (meets(result_, Criterion::imposed_braking, bounds_))
      items.push_back({imposed_.time, "imposed_braking of " + rounded_text(imposed_.value) + " m/s^2"});
    if (meets(result_, Criterion::straddling, bounds_))
      items.push_back({straddling_.time - straddling_.value, "straddling until " + seconds(straddling_.time)});
    std::ranges::stable_sort(items, {}, &Item::time);
    for (auto const& item : items)
      result_.violations += (result_.violations.empty() ? "" : "; ") + seconds(item.time) + " " + item.text;
  }

  struct Impossible {
    double time = 0.0;
    AgentId agent = none<AgentId>;
    Infeasible::Finding finding{};
  };

  struct Speed {
    [[nodiscard]] double operator()(World const& world, Slot slot) const {
      return world.frame().agents[slot].state.speed;
    }
  };
  struct Braking {
    [[nodiscard]] double operator()(World const& world, Slot slot) const { return -Acceleration{}(world, slot); }
  };
  /// Of those that are in its lane already; infinite where nobody is ahead.
  struct GapAhead {
    [[nodiscard]] double operator()(World& world, Slot slot) const {
      auto const next = next_in_lane(world, slot);
      return next ? next->gap : std::numeric_limits<double>::infinity();
    }
  };
  /// Of a run in which another road user or an object was there.
  template <class M>
  struct WithOthers : M {
    bool has_others = false;

    void observe(World& world, Slot slot, double dt) {
      has_others = has_others || !world.roster().objects.empty();
      for (Slot other{}; index_of(other) < world.size() && !has_others; ++other)
        has_others = other != slot && in_traffic(world, other);
      M::observe(world, slot, dt);
    }
    [[nodiscard]] double value() const { return has_others ? M::value() : std::numeric_limits<double>::quiet_NaN(); }
  };
  /// Writes a recorder's value into a field of the result; a size is at least 0.
  template <auto field, class Recorder, bool is_size = false>
  struct Metric {
    Recorder recorder{};

    void write(RunResult& result) const {
      auto value = recorder.value();
      if constexpr (is_size) value = std::max(0.0, value);
      if (std::isinf(value)) value = std::numeric_limits<double>::quiet_NaN();  // there was none
      result.*field = static_cast<std::remove_reference_t<decltype(result.*field)>>(value);
    }
  };
  struct Exposed {
    WithOthers<Exposure> recorder{};

    void write(RunResult& result) const {
      if (!recorder.has_others) return;
      result.least_time_to_collision = recorder.least();
      result.time_exposed_s = recorder.value();
      result.time_integrated = recorder.integrated();
    }
  };
  template <auto field, class Recorder>
  using NonNegative = Metric<field, Recorder, true>;
  using R = RunResult;
  using Imposed = Metric<&R::imposed_braking, ImposedBraking>;
  using Score = Metric<&R::closed_loop_score, ClosedLoopScore>;
  using Straddling = Metric<&R::straddling_s, LongestTime<Straddles>>;
  using Metrics =
      std::tuple<Metric<&R::progress_m, Integral<Progress>>, NonNegative<&R::mean_speed, MeanOf<Speed>>,
                 Metric<&R::least_gap, Least<GapAhead>>, Metric<&R::time_headway, WithOthers<Least<TimeHeadway>>>,
                 Exposed, Metric<&R::post_encroachment_time, PostEncroachmentTime>,
                 NonNegative<&R::required_deceleration, Most<RequiredDeceleration>>,
                 Metric<&R::least_clearance, WithOthers<Least<Clearance>>>, Imposed, Straddling,
                 NonNegative<&R::hardest_braking, Most<Braking>>, NonNegative<&R::largest_jerk, Most<SizeOf<Jerk>>>,
                 NonNegative<&R::largest_lateral_acceleration, Most<SizeOf<LateralAcceleration>>>,
                 Metric<&R::hard_brakings, Times<HardBraking>>, Metric<&R::rss_compliance, RssCompliance>, Score>;

  std::vector<Own> own_;
  Slot ego_;
  CriterionBounds bounds_;
  RunResult result_;
  bool others_collide_ = false;
  bool touched_ = false, touched_agent_ = false;  ///< by the ego
  AgentId hit_by_ = none<AgentId>;                ///< who has hit `hit`, if it was not the ego
  Peak discomfort_{};                             ///< 0 or 1
  Peak imposed_{}, straddling_{};                 ///< [m/s^2], [s]
  Impossible first_{}, worst_{};
  Metrics metrics_{};
};

}  // namespace cambium::inline v0_1::detail
