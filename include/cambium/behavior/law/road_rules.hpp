#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "cambium/behavior/law/braking.hpp"
#include "cambium/behavior/law/constraint.hpp"
#include "cambium/behavior/law/follow_lane.hpp"
#include "cambium/behavior/law/idm.hpp"
#include "cambium/behavior/law/passing.hpp"
#include "cambium/behavior/law/stepping_out.hpp"
#include "cambium/behavior/view.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/parameters.hpp"

namespace cambium {

/// What a driver heeds on the road besides other road users, shared by all driver models. A model that keeps its lane
/// gets everything in one call:
///
///   IdmLaw const law(idm, speed, rules.desired_speed(idm, view, speed));   // speed limits lower the desired speed
///   return rules.keep_lane(view, Strictest(law), idm, tolerance, dt, memory);
///
/// Other models use the parts in their `plan`:
///
///   rules.heed(view, ahead, memory);                                       // leader and lane end are constraints
///   rules.bound(view, idm, s, speed, law.motion(...), dt, memory);         // bends and signals bound the motion
///   rules.along_lane(view, motion, dt, memory);                            // where in the lane it drives
///
/// Bends, signals and those who are about to step onto the road bound the motion instead of being constraints of the
/// law, because a driver brakes for them evenly and exactly to a point, while IDM would keep a time headway to them.
///
/// As long as all agents drive in the middle of their lanes, the next road user in the lane is in the way, whatever
/// part of the lane it occupies. The driver passes a slower agent that drives aside if the lane has room for both and
/// for `passing_clearance` between them:
///
///    =======================================
///            . - - - - - - .                    the driver moves aside, passes, and returns when it is clear
///    [own] '   [cyclist] ->  ' - - - - ->
///    =======================================
///
/// The law follows it until the driver will be far enough aside when it comes up to it. An agent beside the own vehicle
/// is not in the way.
struct RoadRules {
  enum class LaneEnd : std::uint8_t {
    ignored,
    before_destination,  ///< brakes where its lane ends or leaves the route before the destination
    always,              ///< brakes before every end of its lane corridor, as BARK's option does
  };

  LaneEnd lane_end = LaneEnd::ignored;
  bool obey_speed_limits = false;
  bool slow_for_bends = false;
  bool obey_signals = false;
  Merging merging = Merging::counts;
  bool keep_to_side = false;
  double lane_end_distance = 60.0;
  double lane_end_offset = 15.0;
  double lateral_acceleration = 2.5;
  double stop_margin = 1.0;
  double safe_deceleration = 3.0;
  double merging_headway = 1.0;
  double late_at_red = 0.0;
  double speed_factor = 1.0;
  double passing_clearance = 1.5;
  double crossing_time = 4.0;
  double side_margin = 0.4;

  static constexpr char const* name = "road_rules";
  static constexpr char const* summary =
      "what a driver heeds besides the next vehicle: the end of its lane, speed limits, bends, lights and stop signs, "
      "those beside it in its lane, those who step onto the road";
  static constexpr char const* source = "own; lane end: BARK; clearance: StVO section 5 (4)";
  static constexpr auto parameters() {
    using P = RoadRules;
    return parameter_list(
        choice("lane_end", &P::lane_end, "ignored|before_destination|always",
               "ends of its lane for which the driver brakes"),
        parameter(
            "lane_end_distance", &P::lane_end_distance, "m", Range{0, 10'000},
            "distance from the end at which braking begins; the default is too short to stop from above about 15 m/s"),
        parameter("lane_end_offset", &P::lane_end_offset, "m", Range{0, 1000},
                  "distance from the end at which it would stop"),
        parameter("obey_speed_limits", &P::obey_speed_limits,
                  "desire no more than the limit, and slow down in time for a lower one ahead"),
        parameter("slow_for_bends", &P::slow_for_bends, "brake in time for bends"),
        parameter("lateral_acceleration", &P::lateral_acceleration, "m/s^2", Range{0.1, 50}, "highest in bends"),
        parameter("obey_signals", &P::obey_signals, "stop at red lights and stop signs"),
        parameter("stop_margin", &P::stop_margin, "m", Range{0, 20}, "from the front end to a line where it waits"),
        parameter("safe_deceleration", &P::safe_deceleration, "m/s^2", Range{0.1, 20},
                  "a driver who would have to brake harder passes a light that has just turned yellow"),
        choice("merging", &P::merging, "counts|by_rule|ignored|gives_way",
               "road users in lanes that merge into the own one: followed; followed except in junctions; ignored until "
               "they have reached the merge, so that the driver opens no gap; followed, and let pass from behind where "
               "the gap before them is too short"),
        parameter("merging_headway", &P::merging_headway, "s", Range{0, 20},
                  "time gap before those behind with which a driver that gives way merges"),
        parameter("late_at_red", &P::late_at_red, "s", Range{0, 60},
                  "the driver still passes a light that has been red for less than this when it gets there"),
        parameter("speed_factor", &P::speed_factor, "-", Range{0.1, 3},
                  "speed on a free road, in shares of the limit that the driver obeys"),
        parameter(
            "passing_clearance", &P::passing_clearance, "m", Range{0.3, 100},
            "to slower agents that drive aside, when it passes them within its lane; StVO: 1.5 in town, 2 outside"),
        parameter("crossing_time", &P::crossing_time, "s", Range{0, 60},
                  "brakes for agents on no lane, such as pedestrians, who will step into its way within this time; 0: "
                  "only for those in its lane"),
        parameter("keep_to_side", &P::keep_to_side,
                  "drive at the outer side of the lane (right; in left-hand traffic left), as cyclists do"),
        parameter("side_margin", &P::side_margin, "m", Range{0, 10}, "from the own side to the border there"));
  }

  /// What a driver remembers for the rules, and whether it has found into its lane.
  struct Memory {
    float stopped_at = -1.0f;  ///< corridor position of the stop sign at which it stopped last [m]
    std::int16_t aside = 0;    ///< offset to the left of the middle of the lane to which it steers, at the side or to
                               ///< pass [mm]; 1 towards the middle; 0: the rules leave the offset to the driver
    bool adrift = true;        ///< it has entered or was set, and may still move across its lane

    void was_set() { adrift = true; }
    [[nodiscard]] double offset() const { return 1e-3 * aside; }  ///< `aside` [m]
    void steer_to(double offset) {
      double const mm = std::clamp(std::round(1e3 * offset), -32'000.0, 32'000.0);
      aside = mm == 0.0 ? std::int16_t{1} : static_cast<std::int16_t>(mm);
    }

    static constexpr char const* name = "road_rules_memory";
    static constexpr auto parameters() {
      using P = Memory;
      return parameter_list(
          parameter("stopped_at", &P::stopped_at, "m", any_finite,
                    "corridor position of the stop sign at which it stopped last"),
          parameter("aside", &P::aside, "mm", Range{-32768, 32767}, "offset to the left to which it steers; 0: none"),
          parameter("adrift", &P::adrift, "it may still move across its lane"));
    }

    friend bool operator==(Memory const&, Memory const&) = default;
  };

  /// Desired speed [m/s] of a driver with parameters `driver` at its place and `speed` [m/s]: within the limits if it
  /// obeys them.
  template <HasDriverParameters P, class View>
  [[nodiscard]] double desired_speed(P const& driver, View const& view, double speed) const {
    if (!obey_speed_limits) [[likely]]
      return driver.desired_speed;
    double const permitted =
        detail::permitted_speed(view.corridor(), view.place().s, speed, driver.comfortable_deceleration);
    return std::clamp(speed_factor * permitted, 0.1, driver.desired_speed);
  }

  /// The end of the lane, if the driver has to brake for it.
  template <class View>
  [[nodiscard]] std::optional<Constraint> lane_end_ahead(View const& view) const {
    if (lane_end == LaneEnd::ignored) [[likely]]
      return std::nullopt;
    auto const& corridor = view.corridor();
    if (lane_end == LaneEnd::before_destination && corridor.reaches_destination) return std::nullopt;
    double const left = corridor.length_until_end(view.place().s) - view.shape().front;
    if (left > lane_end_distance) return std::nullopt;
    return Constraint{std::max(0.0, left - lane_end_offset), 0.0, 0.0};
  }

  /// Adds the next vehicle ahead, `next`, a merge to wait for, and the end of the lane to the constraints.
  template <class View, class Law>
  void heed(View const& view, std::optional<RoadUser> const& next, Strictest<Law>& ahead) const {
    if (next) ahead.heed(detail::constraint_of<Law>(view, *next));
    if (auto const gap = gap_to_wait_for(view)) ahead.heed(*gap);
    if (auto const end = lane_end_ahead(view)) ahead.heed(*end);
  }
  /// The same with the next vehicle in the own lane that is in the way, and the next one in each lane that merges in.
  template <class View, class Law>
  void heed(View const& view, Strictest<Law>& ahead, Memory& memory) const {
    if (!steers(view, memory)) [[likely]]
      return heed(view, ahead);
    auto changed = memory;
    auto of_all = ahead;
    heed_in_way(View(view), of_all, changed);
    memory = changed;
    ahead = of_all;
    if (auto const end = lane_end_ahead(view)) ahead.heed(*end);
  }
  /// The same for a driver that passes nobody within its lane.
  template <class View, class Law>
  void heed(View const& view, Strictest<Law>& ahead) const {
    if (view.corridor().feeders.empty()) [[likely]] {
      if (auto const next = view.ahead({.merging = merging})) ahead.heed(detail::constraint_of<Law>(view, *next));
    } else {
      ahead.heed(strictest_merging(view, ahead.law()));
    }
    if (auto const end = lane_end_ahead(view)) ahead.heed(*end);
  }

  /// Adds the next vehicle in the own lane and in each lane that merges into it to the constraints.
  template <class View, class Law>
  void heed_merging(View const& view, Strictest<Law>& ahead) const {
    view.each_ahead({.merging = merging},
                    [&](RoadUser const& next) { ahead.heed(detail::constraint_of<Law>(view, next)); });
    if (auto const gap = gap_to_wait_for(view)) ahead.heed(*gap);
  }

  /// The merge before which a driver that gives way (`Merging::gives_way`) must wait, because the next vehicle behind,
  /// in a lane that merges with its own, would have to brake harder than `safe_deceleration` or come closer than
  /// `merging_headway`, if it keeps its speed until then. Nothing if the driver can no longer stop: it then goes first.
  /// Gap acceptance as at junctions without signals (Highway Capacity Manual 2000, chapter 17); safety as in MOBIL
  /// (Kesting, Treiber, Helbing 2007). O(feeders), plus a search in each.
  template <class View>
  [[nodiscard]] std::optional<Constraint> gap_to_wait_for(View const& view) const {
    if (merging != Merging::gives_way) [[likely]]
      return std::nullopt;
    return gap_before_merge(view);
  }

  /// Whether the rules may choose where in its lane the vehicle drives, and whom it passes there. O(1).
  template <class View>
  [[nodiscard]] bool steers(View const& view, Memory const& memory) const {
    return keep_to_side || memory.aside != 0 || view.anybody_leaves_room();
  }

  /// The next road user that is in the way, in the own lane and in those that merge into it. Decides where in the lane
  /// the driver is to be, `Memory::aside`; without `may_pass` it passes nobody. O(1), O(agents nearby) if it passes.
  template <class View, class Law>
  [[nodiscard]] std::optional<RoadUser> next_in_way(View const& view, Law const& law, Memory& memory,
                                                    bool may_pass = true) const {
    if (!steers(view, memory)) [[likely]]
      return view.ahead({.merging = merging});
    return next_aside(view, law, memory, may_pass).next;
  }

  /// The plan that drives `motion` along the lane over `dt` [s], at the side or past somebody if the rules say so; else
  /// as `plan_into_lane`.
  template <class View>
  [[nodiscard]] Plan<View> along_lane(View const& view, LongitudinalMotion<double> const& motion, double dt,
                                      Memory& memory) const {
    auto next = follow_lane(view, motion, dt);
    if (memory.adrift || memory.aside != 0) [[unlikely]] {
      Memory changed = memory;
      next = across_lane(View(view), LongitudinalMotion<double>(motion), next, changed);
      memory = changed;
    }
    return detail::plan_to(view, next, dt);
  }

  /// The plan over `dt` [s] of a driver with parameters `driver` that keeps its lane: its law answers what the model
  /// heeds by itself, `ahead`, and what the rules add to it, within their bounds. `tolerance` [m/s^2]: see
  /// `idm_motion`.
  template <class View, CarFollowingLaw Law, HasDriverParameters P>
  [[nodiscard]] Plan<View> keep_lane(View const& view, Strictest<Law> ahead, P const& driver, double tolerance,
                                     double dt, Memory& memory) const {
    if (!only_follows(view, memory)) [[unlikely]] {
      Memory changed = memory;  // calls that are not inlined get copies, so that the originals can stay in registers
      auto plan = keep_lane_by_rules(View(view), ahead, driver, tolerance, dt, changed);
      memory = changed;
      return plan;
    }
    if (!view.corridor().feeders.empty()) [[unlikely]]
      ahead.heed(strictest_merging(view, ahead.law()));
    else if (auto const next = view.ahead({.merging = merging}))
      ahead.heed(detail::constraint_of<Law>(view, *next));
    return plan_along_lane(view, ahead.law().motion(ahead.constraint(), dt, tolerance), dt);
  }

  /// Bounds the `motion` of a step of `dt` [s] from `s` [m] at `speed` [m/s] by bends, signals and those who step into
  /// the way. A driver with parameters `driver` brakes comfortably for them, and harder only if that no longer
  /// suffices.
  template <class View, HasDriverParameters P>
  [[nodiscard]] LongitudinalMotion<double> bound(View const& view, P const& driver, double s, double speed,
                                                 LongitudinalMotion<double> const& motion, double dt,
                                                 Memory& memory) const {
    double const fastest = std::max(speed, motion.speed);
    bool const bends = slow_for_bends && fastest * fastest * view.corridor().sharpest_bend > lateral_acceleration;
    bool const crossing = crossing_time > 0.0 && view.anybody_off_lanes();
    if (!bends && !obey_signals && !crossing) [[likely]]
      return motion;
    double const comfortable = driver.comfortable_deceleration, hardest = -driver.lowest_acceleration;
    auto bounded = motion;
    if (slow_for_bends)
      bounded = nearer(
          bounded,
          detail::bends_ahead(view.corridor(), s, speed, speed, lateral_acceleration, comfortable, hardest, dt).bound);
    if (!crossing && (!obey_signals || view.corridor().signals.empty())) return bounded;
    View const here = view;  // functions that are not inlined get copies, so that the originals can stay in registers
    Memory changed = memory;
    bounded = before_stops(here, {comfortable, hardest}, s, speed, bounded, dt, changed);
    memory = changed;
    return bounded;
  }

  /// The signals that stop a driver with its front end at `front` [m] within `look_ahead` [m].
  template <class View>
  [[nodiscard]] detail::SignalStop signals_ahead(View const& view, double front, double speed, double look_ahead,
                                                 Memory& memory) const {
    if (!obey_signals) return {};
    return detail::stop_at_signals(view, front, speed, look_ahead, stop_margin, safe_deceleration, late_at_red,
                                   memory.stopped_at);
  }

 private:
  template <class View>
  CAMBIUM_NOINLINE [[nodiscard]] std::optional<Constraint> gap_before_merge(View const& view) const {
    using detail::pull_away;
    constexpr double room = 2.0;  // [m]
    double const s = view.place().s, front = s + view.shape().front, speed = std::max(0.0, view.state().speed);
    double merge = std::numeric_limits<double>::infinity();
    for (auto const& feeder : view.corridor().feeders)
      if (feeder.is_still_to_merge() && feeder.free_until >= front) merge = std::min(merge, feeder.free_until);
    double const way = merge - front;
    if (way > speed * (1.0 + speed / (2.0 * pull_away)) + 10.0 || !can_stop(speed, way, safe_deceleration))
      return std::nullopt;
    auto const next = view.merging(merge, s);
    double const theirs = next ? next->speed : 0.0, highest = std::max(speed, theirs);
    if (theirs < detail::starting_speed) return std::nullopt;
    double const time = time_to_cover(way, speed, pull_away, highest);
    double const slower = std::max(0.0, theirs - std::min(highest, speed + pull_away * time));
    double const gap = s - view.shape().rear - (next->s + next->front) + way - theirs * time;
    if (gap > room + merging_headway * theirs + slower * slower / (2.0 * safe_deceleration)) return std::nullopt;
    return Constraint{way, 0.0, 0.0};
  }

  /// Whether nothing matters to the driver but the next vehicle in its lane. O(1).
  template <class View>
  [[nodiscard]] bool only_follows(View const& view, Memory const& memory) const {
    bool const heeds_more = (lane_end != LaneEnd::ignored) | slow_for_bends | obey_signals | keep_to_side;
    bool const moves_aside = memory.adrift | (memory.aside != 0) | view.anybody_leaves_room();
    return !(heeds_more | moves_aside) && !(view.anybody_off_lanes() && crossing_time > 0.0);
  }

  /// The strictest of `heed_merging`, as a value so that the caller's constraints can stay in registers.
  template <class View, class Law>
  CAMBIUM_NOINLINE [[nodiscard]] Constraint strictest_merging(View const& view, Law const& law) const {
    Strictest ahead(law);
    heed_merging(view, ahead);
    return ahead.constraint();
  }

  template <class View, class Law, HasDriverParameters P>
  CAMBIUM_NOINLINE [[nodiscard]] Plan<View> keep_lane_by_rules(View const& view, Strictest<Law> ahead, P const& driver,
                                                               double tolerance, double dt, Memory& memory) const {
    heed(view, ahead, memory);
    auto const motion = ahead.law().motion(ahead.constraint(), dt, tolerance);
    return along_lane(view, bound(view, driver, view.place().s, ahead.law().speed(), motion, dt, memory), dt, memory);
  }

  struct Braking {
    double comfortable, hardest;  // [m/s^2]
  };

  [[nodiscard]] static LongitudinalMotion<double> nearer(LongitudinalMotion<double> const& motion,
                                                         LongitudinalMotion<double> const& bound) {
    return bound.distance < motion.distance ? bound : motion;
  }

  template <class View>
  CAMBIUM_NOINLINE [[nodiscard]] LongitudinalMotion<double> before_stops(View const& view, Braking const& braking,
                                                                         double s, double speed,
                                                                         LongitudinalMotion<double> motion, double dt,
                                                                         Memory& memory) const {
    auto const bound_by = [&motion](LongitudinalMotion<double> const& other) { motion = nearer(motion, other); };
    double const look_ahead = speed * (dt + speed / (2.0 * braking.comfortable)) + 20.0;
    auto const stop = signals_ahead(view, s + view.shape().front, speed, look_ahead, memory);
    if (std::isfinite(stop.distance))
      bound_by(motion_before_stop(speed, stop.distance, braking.comfortable, braking.hardest, dt));
    if (crossing_time > 0.0 && view.anybody_off_lanes()) {
      double const way = detail::distance_before_crossing(view, s, speed, crossing_time, look_ahead);
      if (std::isfinite(way))
        bound_by(motion_before_stop(speed, std::max(0.0, way - stop_margin), braking.comfortable, braking.hardest, dt));
    }
    return motion;
  }

  struct InWay {
    std::optional<RoadUser> next;
    bool passes = false;  ///< `next` is the next one beyond those beside the way at `offset`, `clearance` away
    double offset{}, clearance{};
  };

  template <class View, class Law>
  CAMBIUM_NOINLINE [[nodiscard]] InWay next_aside(View const& view, Law const& law, Memory& memory,
                                                  bool may_pass) const {
    constexpr double least_gain = 1.5, begin = 8.0;                // [m/s], [s]
    constexpr double farthest = 100.0, near = 20.0, beside = 1.0;  // [m]
    auto const& at = view.place();
    double const side = detail::inner_side(view), speed = law.speed();
    double const home = keep_to_side ? detail::offset_at_side(view, side_margin) : 0.0;
    auto const past = [&](double offset, double clearance) -> InWay {
      return {detail::next_in_way(view, offset, clearance, merging), true, offset, clearance};
    };
    auto const next = view.ahead({.merging = merging});
    bool const is_agent = next && is_valid(next->agent);
    bool const is_aside = memory.aside != 0;
    if (is_agent && may_pass && next->speed < law.desired_speed() - least_gain && next->gap < farthest)
      if (auto offset = detail::offset_to_pass(view, *next, passing_clearance, side, !is_aside)) {
        offset->aim = std::max(offset->aim, side * home);
        bool const begins = is_aside || next->gap < std::max(near, begin * (speed - next->speed));
        if (begins && !steer_to(view, side * offset->aim, next, speed, memory)) return {next};
        if (!detail::is_aside_in_time(view, *next, speed, *offset, side)) return {next};
        return past(side * offset->aim, passing_clearance);
      }
    constexpr double there = 2e-3;  // [m or rad]
    bool const steers =
        keep_to_side || (memory.aside != 0 && (std::abs(at.lateral) > there || std::abs(at.heading_error) > there));
    if (steers)
      steer_to(view, home, next, speed, memory);
    else
      memory.aside = 0;
    bool const goes_by = is_agent && (next->gap < beside || next->speed > speed);
    if (goes_by && detail::is_beside(view, *next, at.lateral)) return past(at.lateral, 0.3);
    return {next};
  }

  /// Steers to `offset` [m], unless somebody beside or coming up beside the vehicle is in the way there; whom it passes
  /// counts with the full clearance. Else it stays where it is. Returns whether it may go there.
  template <class View>
  bool steer_to(View const& view, double offset, std::optional<RoadUser> const& next, double speed,
                Memory& memory) const {
    constexpr double clear = 3.0, soon = 2.0, air = 0.3;  // [m], [s], [m]
    auto const& at = view.place();
    auto const is_free = [&](std::optional<RoadUser> const& other, double clearance) {
      return !other || !detail::is_beside(view, *other, at.lateral) ||
             leaves_room(view, at.corridor, *other, offset, clearance);
    };
    auto const behind = view.behind({.merging = merging});
    bool const is_near = behind && behind->gap < clear + soon * std::max(0.0, behind->speed - speed);
    bool const may =
        is_free(next && next->gap < clear ? next : std::nullopt, air) &&
        is_free(is_near ? behind : std::nullopt, behind && behind->speed < speed ? passing_clearance : air);
    memory.steer_to(may ? offset : at.lateral);
    return may;
  }

  template <class View, class Law>
  CAMBIUM_NOINLINE void heed_in_way(View const& view, Strictest<Law>& ahead, Memory& memory) const {
    auto const found = next_aside(view, ahead.law(), memory, true);
    if (found.next) ahead.heed(detail::constraint_of<Law>(view, *found.next));
    if (view.corridor().feeders.empty()) return;
    if (!found.passes) return heed_merging(view, ahead);
    detail::for_each_on_feeders(view, Look::horizon, merging, [&](RoadUser const& other) {
      if (!leaves_room(view, view.place().corridor, other, found.offset, found.clearance))
        ahead.heed(detail::constraint_of<Law>(view, other));
    });
    if (auto const gap = gap_to_wait_for(view)) ahead.heed(*gap);
  }

  template <class View>
  CAMBIUM_NOINLINE [[nodiscard]] static typename View::State across_lane(View const& view,
                                                                         LongitudinalMotion<double> const& motion,
                                                                         typename View::State const& next,
                                                                         Memory& memory) {
    if (memory.aside == 0) {
      auto const drifted = detail::drift_on(view, motion, next, memory.adrift);
      if (!memory.adrift && detail::sticks_out(view)) memory.steer_to(0.0);
      return drifted;
    }
    memory.adrift = false;
    return detail::move_aside(view, memory.offset(), motion, next);
  }
};

}  // namespace cambium
