#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <optional>
#include <string>

#include <boost/container/static_vector.hpp>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/driver/heeding.hpp"
#include "cambium/behavior/driver/limits.hpp"
#include "cambium/behavior/lateral/keep_lane.hpp"
#include "cambium/behavior/lateral/lane_change.hpp"
#include "cambium/behavior/law/idm.hpp"
#include "cambium/behavior/law/lane_ends.hpp"
#include "cambium/behavior/law/lane_option.hpp"
#include "cambium/behavior/open_loop/constant_acceleration.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/parameters.hpp"

namespace cambium::inline v0_1 {

/// A manoeuvre of `MacroActions`.
struct MacroAction {
  enum class Kind : std::uint8_t {
    stay,          ///< keeps the lane at `acceleration`
    change_left,   ///< changes to the lane on the left at `acceleration`
    change_right,  ///< likewise to the right
    keep_gap,      ///< keeps the lane, and a gap by its law and `leave_room`; ignores `acceleration`
  };

  Kind kind = Kind::stay;
  double acceleration = 0.0;  ///< [m/s^2]
  bool keeps_gap = false;  ///< no faster than its law and `LaneChangeCourse::leave_room` permit; implied by `keep_gap`

  static constexpr char const* name = "macro_action";
  static constexpr char const* summary = "one manoeuvre of `MacroActions`";
  static constexpr auto parameters() {
    using P = MacroAction;
    return parameter_list(choice("kind", &P::kind, "stay|change_left|change_right|keep_gap", "the manoeuvre"),
                          parameter("acceleration", &P::acceleration, "m/s^2", Range{-50, 50}, "ignored by keep_gap"),
                          parameter("keeps_gap", &P::keeps_gap, "no faster than the law permits"));
  }

  friend bool operator==(MacroAction const&, MacroAction const&) = default;
};

/// The name, as in messages and tables.
[[nodiscard]] constexpr char const* to_string(MacroAction::Kind kind) {
  constexpr char const* names[] = {"stay", "change_left", "change_right", "keep_gap"};
  return names[static_cast<std::size_t>(kind)];
}

/// Drives by one of a few manoeuvres along its lanes. Its `Heeds`, such as `SpeedLimit`, `Bends` and `Signals`, bound
/// each manoeuvre; `Law` keeps gaps. A search or a learner chooses a manoeuvre in the agent's memory
/// (`World::memory<MacroActions>(id).choose(number)`); it continues until the next is chosen. A lane change in progress
/// is completed whatever is chosen meanwhile, except a change back. If a manoeuvre is not `available` when chosen, the
/// vehicle keeps its lane at the manoeuvre's acceleration. The plan fails if the number does not exist.
template <CarFollowingLaw Law, class... Heeds>
struct BasicMacroActions {
  using Kind = MacroAction::Kind;
  static constexpr std::size_t capacity = 16;
  static constexpr std::uint8_t nothing = 255;  ///< chosen instead of an action: keep the lane and the speed

  struct Memory {
    LaneChange change{};  ///< towards the target corridor
    [[no_unique_address]] typename Heeding<Heeds...>::Memory heeds{};
    std::uint8_t chosen = 0;  ///< number of the action
    bool is_new = true;       ///< it has not begun yet
    bool adrift = true;       ///< it has entered or was set, and may be amid a lane change

    /// Begins action `number`, or `nothing`.
    void choose(std::size_t number) {
      chosen = static_cast<std::uint8_t>(number <= nothing ? number : nothing - 1);
      is_new = true;
    }

    void fell_short(double way, bool left_course) { change.fell_short(way, left_course); }
    void was_set() { adrift = true; }

    static constexpr char const* name = "macro_actions_memory";
    static constexpr auto parameters() {
      using P = Memory;
      return parameter_list(parameter("change", &P::change, "towards the target corridor"),
                            parameter("heeds", &P::heeds, "of what it heeds"),
                            parameter("chosen", &P::chosen, "-", Range{0, 255}, "number of the action"),
                            parameter("is_new", &P::is_new, "it has not begun yet"),
                            parameter("adrift", &P::adrift, "it may be amid a lane change"));
    }

    friend bool operator==(Memory const&, Memory const&) = default;
  };

  /// The default actions. (Not a braced list: g++ 12 reports that as uninitialised at -O2.)
  static constexpr MacroAction usual[] = {{Kind::keep_gap},    {Kind::stay, 0.0},  {Kind::stay, 1.5},
                                          {Kind::stay, -2.0},  {Kind::stay, -5.0}, {Kind::change_left},
                                          {Kind::change_right}};

  /// 1 to `capacity` of them.
  boost::container::static_vector<MacroAction, capacity> actions{std::begin(usual), std::end(usual)};
  double highest_speed = 50.0;
  double minimum_remaining = 20.0;
  Law law{};
  [[no_unique_address]] Heeding<Heeds...> heeds{};
  LaneChangeCourse course{};
  double safe_deceleration = 4.0;
  bool stops_before_end = false;

  static constexpr char const* name = "macro_actions";
  static constexpr char const* summary =
      "carries out what a search chooses: stay with an acceleration, change left or right, keep the gap; each "
      "if its precondition holds";
  static constexpr char const* source = "after BARK";
  static constexpr auto parameters() {
    using P = BasicMacroActions;
    return parameter_list(
        parameter("actions", &P::actions, "the actions to choose from, 1 to 16"),
        parameter("highest_speed", &P::highest_speed, "m/s", Range{0, 200}, "limit when accelerating"),
        parameter("minimum_remaining", &P::minimum_remaining, "m", Range{0, 10'000},
                  "no change into a lane that ends, or begins to merge into its neighbour, within this distance; "
                  "longer vehicles need more, as in their course"),
        parameter("law", &P::law, "by which it keeps gaps"),
        parameter("heeds", &P::heeds, "what each action heeds besides other road users"),
        parameter("course", &P::course, "how long a change takes"),
        parameter("safe_deceleration", &P::safe_deceleration, "m/s^2", Range{0, 50},
                  "no change for which the new follower has to brake harder by IDM"),
        parameter("stops_before_end", &P::stops_before_end,
                  "stops in a lane that it must leave where the changes still fit, unless a change is under way"));
  }

  void check(std::string const& where) const {
    if (actions.empty()) throw ParameterError(where + ".actions", "has none", "give 1 to 16");
  }

  /// Creates the behaviour from a list of actions. Throws `ParameterError` for none, or more than `capacity`.
  [[nodiscard]] static BasicMacroActions of(std::initializer_list<MacroAction> list) {
    if (list.size() == 0 || list.size() > capacity)
      throw ParameterError(name, "has " + std::to_string(list.size()) + " actions", "give 1 to 16");
    return {.actions = list};
  }

  [[nodiscard]] std::size_t size() const { return actions.size(); }

  /// The number of the first action that keeps the lane and a gap: `keep_gap`, or else to `stay` at about the same
  /// speed; `nothing` without one.
  [[nodiscard]] std::uint8_t keeping_gap() const {
    for (std::size_t i = 0; i < size(); ++i)
      if (actions[i].kind == Kind::keep_gap) return static_cast<std::uint8_t>(i);
    for (std::size_t i = 0; i < size(); ++i)
      if (actions[i] == MacroAction{Kind::stay, 0.0, true}) return static_cast<std::uint8_t>(i);
    return nothing;
  }

  /// Whether action `number` could begin now, with `change` in progress. A change needs a sufficiently long lane of the
  /// road on that side, with nobody beside and no follower who would have to brake hard; a change back can always
  /// begin.
  template <class View>
  [[nodiscard]] bool available(View const& view, std::size_t number, LaneChange const& change = {}) const {
    if (number >= size()) return false;
    return !is_change(actions[number].kind) || side_of(view, actions[number].kind, change) != none<CorridorId>;
  }

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory& memory, double dt) const {
    if (memory.chosen >= size() && memory.chosen != nothing) {
      Plan<View> failed;
      failed.status = PlanStatus::failed;
      return failed;
    }
    return carry_out(view, memory, memory.chosen != nothing ? actions[memory.chosen] : MacroAction{}, dt);
  }

  /// As `plan` with the action `keep_gap`, which need not be one of `actions`; a change in progress is completed.
  template <class View>
  [[nodiscard]] Plan<View> keep_gap(View const& view, Memory& memory, double dt) const {
    return carry_out(view, memory, {Kind::keep_gap}, dt);
  }

 private:
  [[nodiscard]] static bool is_change(Kind kind) { return kind == Kind::change_left || kind == Kind::change_right; }

  template <class View>
  [[nodiscard]] Plan<View> carry_out(View const& view, Memory& memory, MacroAction const& action, double dt) const {
    double const speed = std::max(0.0, view.state().speed);
    course.renew(memory.change, view.shape(), speed);
    if (memory.adrift) [[unlikely]] {
      memory.adrift = false;
      if (!memory.change.active()) memory.change = course.under_way(view);
    }
    if (memory.is_new && is_change(action.kind)) {
      auto const side = side_of(view, action.kind, memory.change);
      if (side != none<CorridorId> && side != memory.change.target) {
        bool const is_back = side == view.place().corridor;
        float const bend = memory.change.bend;
        memory.change = is_back ? course.back(side, view.shape(), speed, view.place().lateral, bend)
                                : course.begin(side, view.shape(), speed);
        memory.change.bend = bend;
        if (auto const next = view.ahead(); next && !is_back && next->speed < detail::at_rest_below)
          memory.change = course.around(view, memory.change, *next).value_or(memory.change);
      }
    }
    memory.is_new = false;
    return plan_lane_change(view, memory.change, motion(view, memory, action, speed, dt), dt);
  }

  /// Target lane corridor of a change: the own one if a change to the other side is in progress.
  template <class View>
  [[nodiscard]] CorridorId side_of(View const& view, Kind kind, LaneChange const& change) const {
    auto const& at = view.place();
    auto const& piece = view.corridor().pieces[at.piece];
    bool const left = kind == Kind::change_left;
    auto const side = piece.beside(left);
    if (change.active() && change.target == piece.beside(!left)) return at.corridor;
    if (side == none<CorridorId>) return side;
    auto const there = view.place(side);
    double const least = detail::least_course_length(minimum_remaining, view.shape(), detail::longer_by_front);
    if (lane_end(view, side, there.piece) - there.s < least) return none<CorridorId>;
    return side == change.target || is_free(view, there) ? side : none<CorridorId>;
  }

  /// Whether nobody is beside it in the other lane, and a follower there need not brake hard.
  template <class View>
  [[nodiscard]] bool is_free(View const& view, map::LanePlace const& there) const {
    Look const look{.merging = heeds.merging(view, Merging::counts)};
    constexpr double safe_gap = 1.0;  // [m]
    if (auto const leader = view.ahead(there, look); leader && !(leader->gap > safe_gap)) return false;
    auto const follower = view.behind(there, look);
    if (!follower || !is_valid(follower->agent)) return true;
    double const speed = std::max(0.0, view.state().speed);
    return follower->gap > safe_gap && detail::assumed_law(*follower)(follower->gap, speed) >= -safe_deceleration;
  }

  template <class View>
  [[nodiscard]] LongitudinalMotion<double> motion(View const& view, Memory& memory, MacroAction const& action,
                                                  double speed, double dt) const {
    bool const gap_alone = action.kind == Kind::keep_gap, keeps_gap = gap_alone || action.keeps_gap;
    auto const& change = memory.change;
    Limits<Law> limits(law, speed, heeds.desired_speed(law, view, speed), heeds.merging(view, Merging::counts));
    if (keeps_gap) {
      auto const leader = change.active() ? view.ahead({.merging = limits.merging}) : std::nullopt;
      if (!leader || leader->speed >= detail::at_rest_below || !course.leads_around(view, change, *leader))
        KeepLane{}.heed_next(view, limits);
      if (change.active() && change.target != view.place().corridor) {
        auto const there = view.place(change.target);
        if (auto const next = view.ahead(there, {.merging = limits.merging}))
          limits.heed(detail::constraint_of<typename Limits<Law>::Response>(view, *next, there));
      }
    }
    heeds.heed(view, memory.heeds, limits, dt);
    auto motion = gap_alone ? limits.motion(dt) : wanted(view, action, speed, dt);
    if (!gap_alone && limits.is_constrained()) {
      auto const allowed = limits.motion(dt);
      if (allowed.speed < motion.speed) motion = allowed;
    }
    bool const stays = !change.active() || change.target == view.place().corridor;
    if (keeps_gap && stays)
      if (auto const next = view.ahead({.merging = limits.merging}))
        motion = course.leave_room(view, *next, motion, dt);
    constexpr double braking = 3.0;  // [m/s^2]
    if (stops_before_end && stays)
      if (double const way = course.distance_to_stop(view, view.place()); std::isfinite(way))
        limits.bound(motion_before_stop(speed, std::max(0.0, way), braking, braking, dt));
    return limits.within(motion, dt);
  }

  /// Motion by the acceleration of an action, no faster than the limits that it heeds.
  template <class View>
  [[nodiscard]] LongitudinalMotion<double> wanted(View const& view, MacroAction const& action, double speed,
                                                  double dt) const {
    auto const motion = ConstantAcceleration{action.acceleration, highest_speed}.motion(speed, dt);
    auto limit = law;
    limit.desired_speed = highest_speed;
    double const permitted = heeds.desired_speed(limit, view, speed), braking = law.comfortable_deceleration;
    if (permitted >= highest_speed) return motion;
    auto const slower = motion_before_bend(speed, 0.0, permitted, braking, braking, dt);
    return slower.speed < motion.speed ? slower : motion;
  }
};

/// Those that heed nothing but the leader.
using MacroActions = BasicMacroActions<Idm>;
static_assert(BehaviorModel<MacroActions>);

}  // namespace cambium::inline v0_1
