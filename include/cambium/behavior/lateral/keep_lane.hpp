#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <variant>

#include "cambium/behavior/law/braking.hpp"
#include "cambium/behavior/law/constraint.hpp"
#include "cambium/behavior/law/follow_lane.hpp"
#include "cambium/behavior/law/passing.hpp"
#include "cambium/behavior/view.hpp"
#include "cambium/core/described.hpp"
#include "cambium/core/macros.hpp"

namespace cambium::inline v0_1 {

/// Keeps its lane, and its lateral offset there. As long as all agents drive in the middle of their lanes, the next
/// road user in the lane is in the way, whatever part of the lane it occupies. The driver passes a slower agent that
/// drives aside if the lane has room for both and for `passing_clearance` between them:
///
///    =======================================
///            . - - - - - - .                    the driver moves aside, passes, and returns when it is clear
///    [own] '   [cyclist] ->  ' - - - - ->
///    =======================================
///
/// The law follows it until the driver will be far enough aside when it comes up to it. An agent beside the own vehicle
/// is not in the way.
struct KeepLane {
  Merging merging = Merging::counts;
  double merging_headway = 1.0;
  double safe_deceleration = 3.0;
  double passing_clearance = 1.5;
  bool keep_to_side = false;
  double side_margin = 0.4;

  static constexpr char const* name = "keep_lane";
  static constexpr char const* summary =
      "keeps its lane; follows the next vehicle in it and in those that merge into it, or passes it within the lane";
  static constexpr char const* source = "own; clearance: StVO section 5 (4)";
  static constexpr auto parameters() {
    using P = KeepLane;
    return parameter_list(
        choice("merging", &P::merging, "counts|by_rule|ignored|gives_way",
               "road users in lanes that merge into the own one: followed; followed except in junctions; ignored until "
               "they have reached the merge, so that the driver opens no gap; followed, and let pass from behind where "
               "the gap before them is too short"),
        parameter("merging_headway", &P::merging_headway, "s", Range{0, 20},
                  "time gap before those behind with which a driver that gives way merges"),
        parameter("safe_deceleration", &P::safe_deceleration, "m/s^2", Range{0.1, 20},
                  "to which a driver that gives way forces nobody, and which suffices to wait for a gap"),
        parameter(
            "passing_clearance", &P::passing_clearance, "m", Range{0.3, 100},
            "to slower agents that drive aside, when it passes them within its lane; StVO: 1.5 in town, 2 outside"),
        parameter("keep_to_side", &P::keep_to_side,
                  "drive at the outer side of the lane (right; in left-hand traffic left), as cyclists do"),
        parameter("side_margin", &P::side_margin, "m", Range{0, 10}, "from the own side to the border there"));
  }

  /// How road users count that merge into the lane.
  [[nodiscard]] Merging counted() const { return merging; }

  struct Memory {
    std::int16_t aside = 0;  ///< offset to the left of the middle of the lane to which it steers, at the side or to
                             ///< pass [mm]; 1 towards the middle; 0: it keeps its offset
    bool adrift = true;      ///< it has entered or was set, and may still move across its lane

    void was_set() { adrift = true; }
    [[nodiscard]] double offset() const { return 1e-3 * aside; }  ///< `aside` [m]
    /// Steers to `offset` [m], to the left of the middle of the lane.
    void steer_to(double offset) {
      double const mm = std::clamp(std::round(1e3 * offset), -32'000.0, 32'000.0);
      aside = mm == 0.0 ? std::int16_t{1} : static_cast<std::int16_t>(mm);
    }

    static constexpr char const* name = "keep_lane_memory";
    static constexpr auto parameters() {
      using P = Memory;
      return parameter_list(
          parameter("aside", &P::aside, "mm", Range{-32768, 32767}, "offset to the left to which it steers; 0: none"),
          parameter("adrift", &P::adrift, "it may still move across its lane"));
    }

    friend bool operator==(Memory const&, Memory const&) = default;
  };

  /// Adds the next vehicle in the way, in the own lane and in those that merge into it, and a merge to wait for. O(1),
  /// O(agents nearby) if it passes somebody.
  template <class View, class Limits>
  std::monostate look(View const& view, Memory& memory, Limits& limits, double /*dt*/) const {
    if (!steers(view, memory)) [[likely]] {
      heed_next(view, limits);
      return {};
    }
    auto changed = memory;  // calls that are not inlined get copies, so that the originals can stay in registers
    auto of_all = limits;
    heed_in_way(View(view), of_all, changed);
    memory = changed;
    limits = of_all;
    return {};
  }

  /// The plan that drives along the lane over `dt` [s], at the side or past somebody.
  template <class View, class Limits>
  [[nodiscard]] Plan<View> drive(View const& view, Memory& memory, std::monostate, Limits const& limits,
                                 double dt) const {
    return along_lane(view, limits.within(limits.motion(dt), dt), dt, memory);
  }

  /// The same for a driver that passes nobody within its lane.
  template <class View, class Limits>
  void heed_next(View const& view, Limits& limits) const {
    if (!view.corridor().feeders.empty()) [[unlikely]]
      limits.heed(strictest_merging(view, limits));
    else if (auto const next = detail::next_ahead(view, {.merging = limits.merging}))
      limits.heed(detail::constraint_of<typename Limits::Response>(view, *next));
  }

  /// Adds the next vehicle in the own lane and in each lane that merges into it, and a merge to wait for.
  template <class View, class Limits>
  void heed_merging(View const& view, Limits& limits) const {
    view.each_ahead({.merging = limits.merging}, [&](RoadUser const& next) {
      limits.heed(detail::constraint_of<typename Limits::Response>(view, next));
    });
    if (auto const gap = gap_to_wait_for(view, limits.merging, -limits.law().lowest_acceleration, limits.jerk_bound))
      limits.heed(*gap);
  }

  /// The merge before which a driver that gives way (`Merging::gives_way`) must wait, because the next vehicle behind,
  /// in a lane that merges with its own, would have to brake harder than `safe_deceleration` or come closer than
  /// `merging_headway`, if it keeps its speed until then. A driver that can stop only by harder braking, up to
  /// `hardest` [m/s^2], does so only for one that would have to brake behind it as hard. `bound`: of its acceleration.
  /// Gap acceptance as at junctions without signals (Highway Capacity Manual 2000, chapter 17); safety as in MOBIL
  /// (Kesting, Treiber, Helbing 2007). O(feeders), plus a search in each.
  template <class View>
  [[nodiscard]] std::optional<Constraint> gap_to_wait_for(View const& view, Merging counted, double hardest,
                                                          JerkBound const& bound = {}) const {
    if (counted != Merging::gives_way) [[likely]]
      return std::nullopt;
    return gap_before_merge(view, hardest, bound);
  }

  /// Whether it may choose where in its lane it drives, and whom it passes there. O(1).
  template <class View>
  [[nodiscard]] bool steers(View const& view, Memory const& memory) const {
    return keep_to_side || memory.aside != 0 || view.anybody_leaves_room();
  }

  /// The next road user that is in the way, in the own lane and in those that merge into it. Decides where in the lane
  /// the driver is to be, `Memory::aside`; without `may_pass` it passes nobody. O(1), O(agents nearby) if it passes.
  template <class View, class Limits>
  [[nodiscard]] std::optional<RoadUser> next_in_way(View const& view, Limits const& limits, Memory& memory,
                                                    bool may_pass = true) const {
    if (!steers(view, memory)) [[likely]]
      return detail::next_ahead(view, {.merging = limits.merging});
    return next_aside(view, limits, memory, may_pass).next;
  }

  /// The plan that drives `motion` along the lane over `dt` [s], at the side or past somebody; else as
  /// `plan_into_lane`.
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

 private:
  /// The strictest of `heed_merging`, as a value so that the caller's limits can stay in registers.
  template <class View, class Limits>
  CAMBIUM_NOINLINE [[nodiscard]] Constraint strictest_merging(View const& view, Limits const& before) const {
    auto limits = before;
    heed_merging(view, limits);
    return limits.constraint();
  }

  template <class View>
  CAMBIUM_NOINLINE [[nodiscard]] std::optional<Constraint> gap_before_merge(View const& view, double hardest,
                                                                            JerkBound const& bound) const {
    using detail::pull_away;
    constexpr double room = 2.0;  // [m]
    double const s = view.place().s, front = s + view.shape().front, speed = std::max(0.0, view.state().speed);
    double merge = std::numeric_limits<double>::infinity();
    for (auto const& feeder : view.corridor().feeders)
      if (feeder.is_still_to_merge() && feeder.free_until >= front) merge = std::min(merge, feeder.free_until);
    double const way = merge - front;
    bool const is_late = speed >= standing_speed &&
                         stopping_distance(speed, bound.acceleration, safe_deceleration, bound) > std::max(0.0, way);
    if (way > speed * (1.0 + speed / (2.0 * pull_away)) + 10.0 || (is_late && !can_stop(speed, way, hardest)))
      return std::nullopt;
    auto const next = view.merging(merge, s);
    double const theirs = next ? next->speed : 0.0, highest = std::max(speed, theirs);
    if (theirs < detail::starting_speed) return std::nullopt;
    // Too late to wait in comfort, it counts neither on its own acceleration nor on the other's braking, which may be
    // for somebody else.
    double const gains = is_late ? 0.0 : pull_away;
    // With a bounded jerk it gains speed later, as if it began so much slower.
    double const rise = std::max(0.0, gains - bound.acceleration);
    double const from = bound.matters() ? std::max(0.0, speed - rise * rise / (2.0 * bound.jerk)) : speed;
    double const time = time_to_cover(way, from, gains, highest);
    double const then = is_late ? theirs + std::max(0.0, view.acceleration(*next)) * time : theirs;
    double const slower = std::max(0.0, then - std::min(highest, from + gains * time));
    double const gap = s - view.shape().rear - (next->s + next->front) + way - 0.5 * (theirs + then) * time;
    double const needed = is_late ? slower * slower / (2.0 * hardest)
                                  : merging_headway * theirs + slower * slower / (2.0 * safe_deceleration);
    if (gap > room + needed) return std::nullopt;
    return Constraint{way, 0.0, 0.0};
  }

  struct InWay {
    std::optional<RoadUser> next;
    bool passes = false;  ///< `next` is the next one beyond those beside the way at `offset`, `clearance` away
    double offset{}, clearance{};
  };

  template <class View, class Limits>
  CAMBIUM_NOINLINE [[nodiscard]] InWay next_aside(View const& view, Limits const& limits, Memory& memory,
                                                  bool may_pass) const {
    constexpr double least_gain = 1.5, begin = 8.0;                // [m/s], [s]
    constexpr double farthest = 100.0, near = 20.0, beside = 1.0;  // [m]
    auto const& at = view.place();
    auto const& law = limits.response();
    double const side = detail::inner_side(view), speed = law.speed();
    double const home = keep_to_side ? detail::offset_at_side(view, side_margin) : 0.0;
    auto const past = [&](double offset, double clearance) -> InWay {
      return {detail::next_in_way(view, offset, clearance, limits.merging), true, offset, clearance};
    };
    auto const next = detail::next_ahead(view, {.merging = limits.merging});
    bool const is_agent = next && is_valid(next->agent);
    bool const is_aside = memory.aside != 0;
    if (is_agent && may_pass && next->speed < law.desired_speed() - least_gain && next->gap < farthest)
      if (auto offset = detail::offset_to_pass(view, *next, passing_clearance, side, !is_aside)) {
        offset->aim = std::max(offset->aim, side * home);
        bool const begins = is_aside || next->gap < std::max(near, begin * (speed - next->speed));
        if (begins && !steer_to(view, side * offset->aim, next, limits, memory)) return {next};
        if (!detail::is_aside_in_time(view, *next, speed, *offset, side)) return {next};
        return past(side * offset->aim, passing_clearance);
      }
    constexpr double there = 2e-3;  // [m or rad]
    bool const steers =
        keep_to_side || (memory.aside != 0 && (std::abs(at.lateral) > there || std::abs(at.heading_error) > there));
    if (steers)
      steer_to(view, home, next, limits, memory);
    else
      memory.aside = 0;
    bool const goes_by = is_agent && (next->gap < beside || next->speed > speed);
    if (goes_by && detail::is_beside(view, *next, at.lateral)) return past(at.lateral, 0.3);
    return {next};
  }

  /// Steers to `offset` [m], unless somebody beside or coming up beside the vehicle is in the way there; whom it passes
  /// counts with the full clearance. Else it stays where it is. Returns whether it may go there.
  template <class View, class Limits>
  bool steer_to(View const& view, double offset, std::optional<RoadUser> const& next, Limits const& limits,
                Memory& memory) const {
    constexpr double clear = 3.0, soon = 2.0, air = 0.3;  // [m], [s], [m]
    auto const& at = view.place();
    auto const is_free = [&](std::optional<RoadUser> const& other, double clearance) {
      return !other || !detail::is_beside(view, *other, at.lateral) ||
             leaves_room(view, at.corridor, *other, offset, clearance);
    };
    double const speed = limits.response().speed();
    auto const behind = view.behind({.merging = limits.merging});
    bool const is_near = behind && behind->gap < clear + soon * std::max(0.0, behind->speed - speed);
    bool const may =
        is_free(next && next->gap < clear ? next : std::nullopt, air) &&
        is_free(is_near ? behind : std::nullopt, behind && behind->speed < speed ? passing_clearance : air);
    memory.steer_to(may ? offset : at.lateral);
    return may;
  }

  template <class View, class Limits>
  CAMBIUM_NOINLINE void heed_in_way(View const& view, Limits& limits, Memory& memory) const {
    using Response = typename Limits::Response;
    auto const found = next_aside(view, limits, memory, true);
    if (found.next) limits.heed(detail::constraint_of<Response>(view, *found.next));
    if (view.corridor().feeders.empty()) return;
    if (!found.passes) return heed_merging(view, limits);
    detail::for_each_on_feeders(view, Look::horizon, limits.merging, [&](RoadUser const& other) {
      if (!leaves_room(view, view.place().corridor, other, found.offset, found.clearance))
        limits.heed(detail::constraint_of<Response>(view, other));
    });
    if (auto const gap = gap_to_wait_for(view, limits.merging, -limits.law().lowest_acceleration, limits.jerk_bound))
      limits.heed(*gap);
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

}  // namespace cambium::inline v0_1
