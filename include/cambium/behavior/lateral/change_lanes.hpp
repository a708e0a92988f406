#pragma once

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>

#include "cambium/behavior/lateral/keep_lane.hpp"
#include "cambium/behavior/lateral/lane_change.hpp"
#include "cambium/behavior/law/braking.hpp"
#include "cambium/behavior/law/constraint.hpp"
#include "cambium/behavior/law/idm.hpp"
#include "cambium/behavior/law/lane_ends.hpp"
#include "cambium/behavior/law/lane_option.hpp"
#include "cambium/core/described.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/angle.hpp"

namespace cambium::inline v0_1 {

namespace detail {
/// How a driver who changes lanes looks along its own lane and those beside: whoever merges there counts, even for one
/// that opens no gap, but in junctions the right of way decides (`Merging::by_rule`).
[[nodiscard]] inline Look look_beside(Merging counted) {
  return {.merging = counted == Merging::by_rule ? counted : Merging::counts};
}
}  // namespace detail

/// A driver that keeps its lane, as seen by the rule that decides on lane changes.
template <class View, class Limits, class Changing>
struct LaneChoice {
  View const& view;
  Limits& limits;                         ///< what it follows; the rule may add to it
  std::optional<RoadUser> const& leader;  ///< next ahead
  double lane_end;                        ///< see `cambium::lane_end`
  bool may_change;                        ///< the rest since the last change is over
  Changing const& changing;               ///< knows what is safe

  /// The lane beside on that side, with its leader and its follower; nothing where there is none, or the road marks
  /// forbid a change.
  [[nodiscard]] std::optional<LaneOption> beside(bool left) const {
    auto const side = view.corridor().pieces[view.place().piece].beside(left);
    if (side == none<CorridorId> || !changing.marks_permit(view, view.place(), left)) return std::nullopt;
    LaneOption option{view.place(side), left, {}, {}};
    option.front = view.ahead(option.place, look());
    option.rear = view.behind(option.place, look());
    return option;
  }

  [[nodiscard]] Look look() const { return detail::look_beside(limits.merging); }  ///< along these lanes

  /// Whether nobody has to brake hard if it changes there now.
  [[nodiscard]] bool is_safe(LaneOption const& option) const {
    return changing.is_safe(view, limits, option, changing.safe_deceleration);
  }

  /// Whether it may come back from the lane of `option`, of which `remaining` [m] are left, after which at least
  /// `minimum` [m] must be left; always if that lane does not end.
  [[nodiscard]] bool may_return(LaneOption const& option, double remaining, double minimum) const {
    return remaining == std::numeric_limits<double>::infinity() ||
           (remaining >= minimum + changing.there_and_back(limits.response().speed()) &&
            changing.marks_permit(view, option.place, !option.left));
  }

  /// The acceleration behind the leader in a lane beside, or on a free road [m/s^2].
  [[nodiscard]] double response(LaneOption const& option) const {
    using Response = typename Limits::Response;
    return limits.response()(option.front ? detail::constraint_of<Response>(view, *option.front, option.place)
                                          : Constraint{});
  }

  /// Follows a vehicle in another lane, but as if the gap were at least the desired headway, because nobody brakes hard
  /// for it; behind one that is not slower, at least that of steady following. So the driver comes to the other's speed
  /// and keeps it: who followed slower ones alone would brake and accelerate by turns.
  void adapt_to(std::optional<RoadUser> const& front) const {
    constexpr double slower = 2.0;  // [m/s] from which the desired headway counts
    if (!front || !(front->gap > 0.0)) return;
    auto const& law = limits.law();
    auto const& response = limits.response();
    double const speed = response.speed(), headway = law.minimum_gap + speed * law.time_headway;
    double const free = response(Constraint{}), behind = response(Constraint{headway, speed});
    // In most laws the inverse square of the gap counts; in steady following it takes away all of `free`.
    double const steady = free > 0.0 ? free / (free - std::min(behind, 0.0)) : 0.0;
    double const share = std::clamp((speed - front->speed) / slower, 0.0, 1.0);
    double const inverse_square = steady + share * (1.0 - steady);
    if (inverse_square > 0.0) limits.heed({std::max(front->gap, headway / std::sqrt(inverse_square)), front->speed});
  }
};

namespace detail {
/// A rule of lane changes, see `ChangeLanes`.
template <class R, class Choice>
concept LaneRule = std::copyable<R> && Described<R> && requires(R const rule, Choice const& choice) {
  { R::name } -> std::convertible_to<char const*>;
  { rule(choice) } -> std::same_as<CorridorId>;
};
}  // namespace detail

/// Keeps its lane, and changes lanes where a rule such as `MobilRule` says so: a described struct with
///   `template <class Choice> CorridorId operator()(Choice const& choice) const`
/// that returns the lane corridor beside to change to, or none, for a `LaneChoice`; another corridor counts as none.
/// Whether the change is safe is up to the rule (`LaneChoice::is_safe`). It is not called during a change. This
/// part knows what the driver assumes of others, which gaps are safe, how the vehicle gets there and when it gives up.
///
///    ======================================================  lane beyond
///      [rear]                . - - - - - - - ->   [front]    target lane: new follower, new leader
///    - - - - - - - - - - . ' - - - - - - - - - - - - - - -
///            [own] - - '   quintic course          [leader]  own lane
///    ======================================================
///
/// - Before: the vehicle follows its leader. Before static objects and lane ends that it must avoid, it stops early
///   enough that the shortest change still fits. (A long vehicle that already stands closer stays there.)
/// - Safe: nobody has to brake harder than `safe_deceleration`, assuming IDM with the parameters `others` (`trucks` for
///   long vehicles) and a desired speed not below the present one. Vehicles that enter the same gap from the lane
///   beyond count, too.
/// - During: the vehicle follows the leaders in all lanes that it occupies. It turns back if the change becomes unsafe
///   (`abort_deceleration`) and the way back stays within the old lane.
/// - Junctions: a driver that heeds conflicts begins no change that would last until ways cross.
/// - After: it rests for `rest` before the next change; after an abort for a random time, so that two drivers who
///   aborted for each other do not meet again.
template <class Rule>
struct ChangeLanes {
  Rule rule{};
  KeepLane keep{};
  Idm others{};
  Idm trucks = detail::assumed_truck;
  double truck_length = detail::assumed_truck_length;
  double safe_deceleration = 4.0;
  double abort_deceleration = 4.5;
  double safe_gap = 1.0;
  double rest = 3.0;
  bool heed_marks = true;
  bool leaves_room = false;
  LaneChangeCourse course{};

  static constexpr char const* name = "change_lanes";
  static constexpr char const* summary =
      "keeps its lane, and changes lanes by a rule: along a smooth course, followed by a rest; aborted if it becomes "
      "unsafe";
  static constexpr char const* source = "own";
  static constexpr auto parameters() {
    using P = ChangeLanes;
    return parameter_list(
        parameter("rule", &P::rule, "decides when to change, and where to"),
        parameter("keep", &P::keep, "how it keeps its lane"),
        parameter("others", &P::others, "what it assumes of other drivers"),
        parameter("trucks", &P::trucks, "what it assumes of drivers of long vehicles"),
        parameter("truck_length", &P::truck_length, "m", Range{0, 100}, "vehicles longer than this are trucks"),
        parameter("safe_deceleration", &P::safe_deceleration, "m/s^2", Range{0, 20}, "nobody is made to brake harder"),
        parameter("abort_deceleration", &P::abort_deceleration, "m/s^2", Range{0, 20},
                  "a change is aborted if somebody would have to brake harder"),
        parameter("safe_gap", &P::safe_gap, "m", Range{0, 100}, "smallest gap for a change, whatever the speeds"),
        parameter("rest", &P::rest, "s", Range{0, 600}, "from the end of a change to the next one"),
        parameter("heed_marks", &P::heed_marks, "change only where the road marks permit it"),
        parameter("leaves_room", &P::leaves_room,
                  "stays far enough behind those who stand that a change fits, see `LaneChangeCourse::leave_room`"),
        parameter("course", &P::course, "how long a change takes"));
  }

  /// How road users count that merge into the lane.
  [[nodiscard]] Merging counted() const { return keep.merging; }

  /// What the driver remembers.
  struct Memory {
    LaneChange change{};
    float rest{};  ///< time until the next change may begin [s]
    KeepLane::Memory lane{};

    void fell_short(double way, bool left_course) { change.fell_short(way, left_course); }
    void was_set() { lane.was_set(); }

    static constexpr char const* name = "change_lanes_memory";
    static constexpr auto parameters() {
      using P = Memory;
      return parameter_list(parameter("change", &P::change, "the change under way"),
                            parameter("rest", &P::rest, "s", any_finite, "until the next change may begin"),
                            parameter("lane", &P::lane, "where in its lane it drives"));
    }

    friend bool operator==(Memory const&, Memory const&) = default;
  };

  static constexpr bool looks_beside = true;

  /// Decides on changes, and adds the leaders in all lanes that the vehicle occupies, those who merge, and the end of a
  /// lane that it must leave. Returns the leader in its lane.
  template <class View, class Limits>
  [[nodiscard]] std::optional<RoadUser> look(View const& view, Memory& memory, Limits& limits, double dt) const {
    using Choice = LaneChoice<View, Limits, ChangeLanes>;
    static_assert(
        detail::LaneRule<Rule, Choice>,
        "cambium::ChangeLanes<Rule>: the rule must be a struct with a name, parameters() and `template <class Choice> "
        "cambium::CorridorId operator()(Choice const& choice) const` (see ChangeLanes)");
    double const speed = limits.response().speed();
    auto const leader = memory.change.active() ? detail::next_ahead(view, {.merging = limits.merging})
                                               : keep.next_in_way(view, limits, memory.lane, passes_in_lane(view));
    auto const home = view.place().corridor;
    memory.rest = std::max(0.0f, memory.rest - static_cast<float>(dt));
    course.renew(memory.change, view.shape(), speed);
    if (memory.lane.adrift) [[unlikely]]
      enter(view, memory);
    if (memory.change.target == home && speed < standing_speed &&
        course.distance_to_stop(view, view.place()) < limits.law().minimum_gap + 1)
      memory.change = {};  // the vehicle must leave this lane, too, and has no room left to reach its middle first
    bool const leader_stands = leader && leader->speed < detail::at_rest_below;
    // On its way back behind one that stands, it has no room for that, either, and may decide anew.
    bool const is_stuck = memory.change.target == home && speed < standing_speed && leader_stands;
    if (memory.change.active() && !is_stuck) {
      if (memory.change.target != home && !may_go_on(view, limits, memory.change)) abort(view, speed, memory);
      limits = while_changing(view, limits, leader, memory.change);
    } else {
      heed_in_lane(view, limits, leader);
      double const end = lane_end(view, home, view.place().piece);
      bool const is_passing = memory.lane.aside != 0 && !keep.keep_to_side && end == infinite;
      bool const may_change = memory.rest == 0.0f && !is_passing;
      Choice const choice{view, limits, leader, end, may_change, *this};
      auto const target = rule(choice);
      std::optional<LaneChange> change;
      if (may_change && is_beside(view, target) && is_wide_enough(view, target, 0.5 * speed * course.duration)) {
        change = course.begin(target, view.shape(), speed, longest_change(view, leader, target));
        if (leader_stands) change = course.around(view, *change, *leader);
        if (change && limits.gives_way && enters_crossing(view, *change)) change.reset();
      }
      if (change) {
        memory.change = *change;
        memory.rest = static_cast<float>(rest + course.duration);
        limits.forget_constraints();
      }
      if (change || is_stuck) limits = while_changing(view, limits, leader, memory.change);
    }
    if (!view.corridor().feeders.empty()) [[unlikely]]
      limits = with_merging(view, leader, memory.change.active() && memory.change.target != home, limits);
    return leader;
  }

  template <class View, class Limits>
  [[nodiscard]] Plan<View> drive(View const& view, Memory& memory, std::optional<RoadUser> const& leader,
                                 Limits const& limits, double dt) const {
    auto motion = limits.motion(dt);
    if (leaves_room && leader && !memory.change.active()) motion = course.leave_room(view, *leader, motion, dt);
    auto const bounded = limits.within(motion, dt);
    if (memory.lane.aside != 0) [[unlikely]] {
      if (!memory.change.active()) {
        memory.change.bend = 0.0f;
        return keep.along_lane(view, bounded, dt, memory.lane);
      }
      memory.lane.aside = 0;
    }
    return plan_lane_change(view, memory.change, bounded, dt);
  }

  /// The car following that this driver assumes of a follower.
  [[nodiscard]] IdmLaw law_of(RoadUser const& who) const {
    return detail::assumed_law(who, others, trucks, truck_length);
  }

  /// Whether a change is safe: all gaps exceed `safe_gap` and nobody has to brake harder than `deceleration` [m/s^2].
  /// This includes vehicles that enter the same gap from the lane beyond.
  template <class View, class Limits>
  CAMBIUM_NOINLINE [[nodiscard]] bool is_safe(View const& view, Limits const& limits, LaneOption const& option,
                                              double deceleration) const {
    using Response = typename Limits::Response;
    auto const& law = limits.response();
    auto const front_is_safe = [&](RoadUser const& n, map::LanePlace const& place) {
      return n.gap > safe_gap && law(detail::constraint_of<Response>(view, n, place)) >= -deceleration;
    };
    auto const rear_is_safe = [&](RoadUser const& n) {
      return n.gap > safe_gap && (is_object(n) || law_of(n)(n.gap, law.speed()) >= -deceleration);
    };
    if (option.front && !front_is_safe(*option.front, option.place)) return false;
    if (option.rear && !rear_is_safe(*option.rear)) return false;
    if (!view.road().corridors[option.place.corridor].feeders.empty()) {  // one that merges may be the nearer one
      auto const follower = view.behind(option.place, {.merging = Merging::ignored});
      if (follower && !rear_is_safe(*follower)) return false;
    }
    auto const& there = view.road().corridors[option.place.corridor].pieces[option.place.piece];
    auto const beyond = there.beside(option.left);
    if (beyond == none<CorridorId> || beyond == view.place().corridor) return true;
    auto const others_there = view.place(beyond);
    auto const look = detail::look_beside(limits.merging);
    auto const front = view.ahead(others_there, look), rear = view.behind(others_there, look);
    if (front && comes(view, *front, option, true) && !front_is_safe(*front, others_there)) return false;
    return !(rear && comes(view, *rear, option, false) && !rear_is_safe(*rear));
  }

  /// Distance [m] of two changes at `speed` [m/s] and the rest between them.
  [[nodiscard]] double there_and_back(double speed) const { return speed * (2.0 * course.duration + rest); }

  /// Whether the road marks permit a change from `at`, or are ignored.
  template <class View>
  [[nodiscard]] bool marks_permit(View const& view, map::LanePlace const& at, bool left) const {
    if (!heed_marks) return true;
    auto const& piece = view.road().corridors[at.corridor].pieces[at.piece];
    auto const& lane = view.map().lane(piece.lane);
    double const s = at.s + piece.lane_offset;
    return left ? lane.may_change_left(s) : lane.may_change_right(s);
  }

  /// Adds the end of a lane that it must leave, so that it stops where the changes still fit.
  template <class View, class Limits>
  void heed_lane_end(View const& view, Limits& limits) const {
    add_stop(limits, course.distance_to_stop(view, view.place()));
  }

 private:
  template <class View>
  [[nodiscard]] static bool is_beside(View const& view, CorridorId target) {
    if (target == none<CorridorId>) return false;
    auto const& piece = view.corridor().pieces[view.place().piece];
    return target == piece.left || target == piece.right;
  }

  /// Whether the driver may pass slower road users within its lane: not where other lanes merge in, because their
  /// traffic counts as a whole. Merges beyond the corridor's end do not matter.
  template <class View>
  [[nodiscard]] static bool passes_in_lane(View const& view) {
    auto const& corridor = view.corridor();
    return corridor.feeders.empty() || corridor.feeders.front().begin >= corridor.length();
  }

  static constexpr double infinite = std::numeric_limits<double>::infinity();

  /// Goes on with the change that the vehicle is in when it enters.
  template <class View>
  void enter(View const& view, Memory& memory) const {
    memory.lane.adrift = false;
    if (memory.change.active()) return;
    memory.change = course.under_way(view);
    if (memory.change.active()) memory.rest = std::max(memory.rest, static_cast<float>(rest + course.duration));
  }

  [[nodiscard]] static bool is_object(RoadUser const& n) { return is_valid(n.object); }

  /// Whether a neighbour in the lane beyond that of `option` moves into it.
  template <class View>
  [[nodiscard]] static bool comes(View const& view, RoadUser const& who, LaneOption const& option, bool ahead) {
    if (!is_valid(who.agent)) return false;
    auto const& shape = view.shape(who);
    auto const& state = view.state(who);
    double const distance =
        ahead ? view.shape().front + who.gap + shape.rear : -(view.shape().rear + who.gap + shape.front);
    auto segment = option.place.segment;
    double const along =
        view.road().corridors[option.place.corridor].center.pose(option.place.s + distance, segment).heading;
    double const leftwards = state.speed * portable::sin(state.heading - along);
    return (option.left ? -leftwards : leftwards) > detail::least_drift;
  }

  template <class View, class Limits>
  CAMBIUM_NOINLINE [[nodiscard]] bool may_go_on(View const& view, Limits const& limits,
                                                LaneChange const& change) const {
    auto const& at = view.place();
    auto const& piece = view.corridor().pieces[at.piece];
    LaneOption option{view.place(change.target), change.target == piece.left, {}, {}};
    if (!option.left && change.target != piece.right) return true;  // no longer beside: the lanes have merged
    option.front = view.ahead(option.place, detail::look_beside(limits.merging));
    option.rear = view.behind(option.place, detail::look_beside(limits.merging));
    return is_safe(view, limits, option, abort_deceleration);
  }

  /// Turns back if the way back stays within the old lane; a vehicle that hardly moves straightens its wheels first,
  /// else its front end would swing out farther. The rest that follows is random, see above.
  template <class View>
  CAMBIUM_NOINLINE void abort(View const& view, double speed, Memory& memory) const {
    constexpr std::uint32_t purpose = 0x4c43u;
    auto const& at = view.place();
    float const bend = speed < detail::at_rest_below ? 0.0f : memory.change.bend;
    auto const back = course.back(at.corridor, view.shape(), speed, at.lateral, bend);
    if (!detail::stays_within_lane(view, back)) return;
    auto random = view.random(purpose);
    memory.change = back;
    memory.rest = static_cast<float>(course.shortest_duration + rest * (0.5 + uniform01(random)));
  }

  /// Whether the vehicle would be where ways cross before the change ends. Others cannot tell where it goes there.
  template <class View>
  CAMBIUM_NOINLINE [[nodiscard]] static bool enters_crossing(View const& view, LaneChange const& change) {
    double const s = view.place().s, end = s + static_cast<double>(change.left);
    return std::ranges::any_of(view.corridor().conflicts, [&](map::Conflict const& conflict) {
      return conflict.kind == map::OverlapKind::crossing && conflict.hull().end > s && conflict.first_hold() < end;
    });
  }

  /// Whether the vehicle fits into the lane `beside` when it arrives there, `ahead` [m]: lanes may open slowly.
  template <class View>
  CAMBIUM_NOINLINE [[nodiscard]] static bool is_wide_enough(View const& view, CorridorId beside, double ahead) {
    auto const& lane = view.road().corridors[beside];
    double const s = std::min(view.place(beside).s + ahead, lane.length());
    return lane.width_at(s) > view.shape().width();
  }

  /// Longest permissible length of a change [m]: it must end before the lane does, stay on the road, lead around a
  /// standing object, and leave room for the next change.
  template <class View>
  CAMBIUM_NOINLINE [[nodiscard]] double longest_change(View const& view, std::optional<RoadUser> const& leader,
                                                       CorridorId target) const {
    auto const& at = view.place();
    auto const there = view.place(target);
    double const until_end =
        std::min({dead_end(view, at.corridor, at.piece) - at.s, course.distance_to_stop(view, there),
                  until_together(view, there), until_it_swings(view, there)});
    double const beside_object = (1.0 - detail::out_of_lane) * course.least_length(view.shape());
    return leader && is_object(*leader) ? std::min(until_end, leader->gap + beside_object) : until_end;
  }

  /// The longest change to the lane of `there` [m] that does not leave the road where the two lanes become one: twice
  /// the way to where they are half as far apart as here, on a grid of 5 m; infinite if a change is over by then.
  template <class View>
  [[nodiscard]] double until_together(View const& view, map::LanePlace const& there) const {
    constexpr double step = 5.0;  // [m]
    double const wanted = course.begin(there.corridor, view.shape(), std::max(0.0, view.state().speed)).left;
    auto const &from = view.corridor().center, &to = view.road().corridors[there.corridor].center;
    auto hint = view.place().segment, hint_there = there.segment;
    auto const apart = [&](double way) {  // across: in a bend the two are not at the same place along
      auto const here = from.pose(view.place().s + way, hint), beside = to.pose(there.s + way, hint_there);
      return std::abs(geometry::to_local(here, beside.position()).y());
    };
    double const half = 0.5 * apart(0.0);
    for (double way = step; 2.0 * way < wanted; way += step)
      if (apart(way) < half) return 2.0 * (way - step);
    return infinite;
  }

  /// The longest change to the lane of `there` [m] before which the vehicle does not swing out the other way by more
  /// than half a metre. A lane that opens leads away, so that the course begins with a slope away from it, and a
  /// quintic course swings by a fifth of its slope times its length. Infinite along lanes that do not part.
  template <class View>
  [[nodiscard]] double until_it_swings(View const& view, map::LanePlace const& there) const {
    constexpr double most = 0.5, share = 0.2;  // [m]
    auto hint = view.place().segment, hint_there = there.segment;
    auto const here = view.corridor().center.pose(view.place().s, hint),
               beside = view.road().corridors[there.corridor].center.pose(there.s, hint_there);
    double const turn = geometry::angle_difference(beside.heading, here.heading);
    double const away = there.lateral < 0.0 ? turn : -turn;  // it lies to the left if the vehicle is right of it
    return away > 0.0 ? most / (share * away) : infinite;
  }

  /// Adds a leader in the lane of `place` that the vehicle stays in; where there is a lane beside (`has_side`), it
  /// leaves room to change before an object, and before one that is parked.
  template <class View, class Limits>
  void add_leader(View const& view, Limits& limits, std::optional<RoadUser> const& leader, map::LanePlace const& place,
                  bool has_side) const {
    if (!leader) return;
    auto constraint = detail::constraint_of<typename Limits::Response>(view, *leader, place);
    if (has_side && is_object(*leader))
      constraint.gap -= detail::out_of_lane * course.least_length(view.shape());
    else if (has_side && leader->speed < course.slow) [[unlikely]]
      constraint.gap -= room_before(view, *leader, limits.law().minimum_gap);
    limits.heed(constraint);
  }

  /// Room [m] that a driver leaves before one that is parked, so that a tight change leads around it, as far as it can
  /// stop for it with comfort.
  template <class View>
  CAMBIUM_NOINLINE [[nodiscard]] double room_before(View const& view, RoadUser const& leader, double gap) const {
    constexpr double share = 0.3, comfortable = 2.5;  // of the least length, [m/s^2]
    double const speed = std::max(0.0, view.state().speed),
                 spare = leader.gap - gap - speed * speed / (2.0 * comfortable);
    if (spare <= 0.0 || !detail::is_parked(view, leader)) return 0.0;
    return std::min(spare,
                    share * course.least_length(view.shape()) * (1.0 - std::max(0.0, leader.speed) / course.slow));
  }

  /// `limits` with the vehicles that merge, and the next one in the own lane: not only the nearest of them all,
  /// `leader`. A vehicle that leaves its lane passes those that stand there. It takes copies, so that the originals can
  /// stay in registers.
  template <class View, class Limits>
  CAMBIUM_NOINLINE [[nodiscard]] Limits with_merging(View view, std::optional<RoadUser> leader, bool leaves,
                                                     Limits limits) const {
    view.each_ahead({.merging = limits.merging}, [&](RoadUser const& next) {
      if ((leader && next.agent == leader->agent && next.object == leader->object) ||
          (leaves && next.speed < detail::at_rest_below))
        return;
      limits.heed(detail::constraint_of<typename Limits::Response>(view, next));
    });
    if (auto const gap =
            keep.gap_to_wait_for(view, limits.merging, -limits.law().lowest_acceleration, limits.jerk_bound))
      limits.heed(*gap);
    return limits;
  }

  template <class Limits>
  static void add_stop(Limits& limits, double way) {
    if (way < infinite) limits.heed({way, 0.0});
  }

  template <class View, class Limits>
  void heed_in_lane(View const& view, Limits& limits, std::optional<RoadUser> const& leader) const {
    auto const& at = view.place();
    auto const& piece = view.corridor().pieces[at.piece];
    add_leader(view, limits, leader, at, piece.left != none<CorridorId> || piece.right != none<CorridorId>);
    heed_lane_end(view, limits);
  }

  /// `limits` with those that count during a change.
  template <class View, class Limits>
  CAMBIUM_NOINLINE [[nodiscard]] Limits while_changing(View const& view, Limits limits,
                                                       std::optional<RoadUser> const& leader,
                                                       LaneChange const& change) const {
    auto const& at = view.place();
    auto const& corridor = view.corridor();
    auto const& piece = corridor.pieces[at.piece];
    double const left = change.left, around = (1.0 - detail::out_of_lane) * course.least_length(view.shape());
    auto const is_passed = [&](RoadUser const& n, double until) {  // the course leads around it
      return n.speed < detail::at_rest_below && (n.gap > until || course.leads_around(view, change, n));
    };
    if (change.target == at.corridor) {
      add_leader(view, limits, leader, at, true);
      heed_lane_end(view, limits);
      // Where the body extends over a border, or its front end still swings out to it, the leader there counts, too.
      constexpr double soon = 3.0;  // [m]
      auto const sides = corridor.widths_at(at.s, at.segment);
      double const swing = (view.shape().front + soon) * at.heading_error;
      auto const heed_beside = [&](CorridorId beside) {
        if (beside == none<CorridorId>) return;
        auto const there = view.place(beside);
        auto const other = view.ahead(there, detail::look_beside(limits.merging));
        if (other && other->gap > 0.0 && !is_passed(*other, left - 0.5 * course.least_length(view.shape())))
          limits.heed(detail::constraint_of<typename Limits::Response>(view, *other, there));
      };
      if (at.lateral + std::max(0.0, swing) + view.shape().left > sides.left) heed_beside(piece.left);
      if (view.shape().right - at.lateral + std::max(0.0, -swing) > sides.right) heed_beside(piece.right);
      return limits;
    }
    if (leader && !is_passed(*leader, left - around))
      limits.heed(detail::constraint_of<typename Limits::Response>(view, *leader));
    double const until_end = dead_end(view, at.corridor, at.piece) - at.s;
    if (until_end < 0.6 * left) limits.heed({until_end - view.shape().front, 0.0});
    auto const there = view.place(change.target);
    add_leader(view, limits, view.ahead(there, detail::look_beside(limits.merging)), there, true);
    // The vehicle may enter the neighbouring lane even if that ends soon.
    add_stop(limits, std::max(course.distance_to_stop(view, there), 0.6 * left + limits.law().minimum_gap + 1.0));
    return limits;
  }
};

}  // namespace cambium::inline v0_1
