#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "cambium/behavior/lane_change/lane_change.hpp"
#include "cambium/behavior/law/idm.hpp"
#include "cambium/behavior/law/lane_ends.hpp"
#include "cambium/behavior/law/road_rules.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/core/macros.hpp"

namespace cambium {

/// A lane beside that a change may lead to.
struct LaneOption {
  map::LanePlace place;
  bool left = false;                    ///< on the left, else on the right
  std::optional<RoadUser> front, rear;  ///< who would be the leader and the follower
};

/// A driver that keeps its lane, as its rule for changing lanes sees it.
template <class View>
struct LaneKeeping {
  View const& view;
  IdmLaw const& law;                      ///< its car following, at its speed
  std::optional<RoadUser> const& leader;  ///< next ahead
  double lane_end;                        ///< see there
  bool may_change;                        ///< not in the time of rest
  Strictest<IdmLaw>& ahead;               ///< what it follows; a rule may add to it
};

/// How a driver goes along lanes that it may change, and changes them once it has decided to: what it assumes of
/// others, what it finds safe, when it gives up. It slows for bends, and for limits where it obeys them.
/// A change takes time and follows a smooth course. It is aborted where it has become unsafe, or where somebody comes
/// into the same gap from the other side, while the way back does not leave the old lane. Meanwhile the leaders in all
/// lanes that the vehicle is in count. Before objects and before the end of a lane that must be left it stops with
/// enough room to change; a long vehicle that stands nearer to it than its least course is long stays there. Other
/// drivers are taken to have the parameters `others` (long vehicles: `trucks`), and at least the desired speed that
/// they show.
struct LaneChanging {
  IdmParameters others{};
  IdmParameters trucks{.desired_speed = 23.0, .time_headway = 1.7, .maximum_acceleration = 0.9};
  double truck_length = 7.5;
  double safe_deceleration = 4.0;
  double abort_deceleration = 4.5;
  double safe_gap = 1.0;
  double rest = 3.0;
  bool heed_marks = true;
  LaneChangeCourse course{};

  static constexpr char const* name = "lane_changing";
  static constexpr char const* summary =
      "a change along a smooth course, with rest between changes; aborted where it becomes unsafe";
  static constexpr char const* source = "own";
  static constexpr auto parameters() {
    using P = LaneChanging;
    return parameter_list(
        parameter("others", &P::others, "-", {}, "what it assumes of other drivers"),
        parameter("trucks", &P::trucks, "-", {}, "what it assumes of drivers of long vehicles"),
        parameter("truck_length", &P::truck_length, "m", Range{0, 100}, "vehicles longer than this are trucks"),
        parameter("safe_deceleration", &P::safe_deceleration, "m/s^2", Range{0, 20}, "nobody is made to brake harder"),
        parameter("abort_deceleration", &P::abort_deceleration, "m/s^2", Range{0, 20},
                  "a change is aborted where somebody would have to brake harder"),
        parameter("safe_gap", &P::safe_gap, "m", Range{0, 100}, "no change into smaller gaps, whatever the speeds"),
        parameter("rest", &P::rest, "s", Range{0, 600}, "no further change within this time of the last"),
        parameter("heed_marks", &P::heed_marks, "-", Range{0, 1}, "change only where the road marks permit it"),
        parameter("course", &P::course, "-", {}, "how long a change takes"));
  }

  /// What the driver remembers.
  struct Memory {
    LaneChange change{};
    float rest{};  ///< [s] until the next change may begin
    RoadRules::Memory rules{};

    void fell_short(double way, bool left_course) { change.fell_short(way, left_course); }

    friend bool operator==(Memory const&, Memory const&) = default;
  };

  /// The plan of a driver who follows by IDM and changes lanes where `choose(LaneKeeping)` says so: it returns the side
  /// to change to, as the number of its lane corridor, or none. Not called during a change.
  template <class View, class Choose>
  [[nodiscard]] Plan<View> drive(View const& view, Memory& memory, IdmParameters const& idm, RoadRules const& rules,
                                 double tolerance, double dt, Choose const& choose) const {
    double const speed = std::max(0.0, view.state().speed);
    IdmLaw const law(idm, speed, rules.desired_speed(idm, view, speed));
    auto const leader = view.ahead({.merging = rules.merging});
    auto const home = view.place().corridor;
    memory.rest = std::max(0.0f, memory.rest - static_cast<float>(dt));
    course.renew(memory.change, view.shape(), speed);
    if (memory.change.target == home && speed < standing && way_to_stop(view, view.place()) < idm.minimum_gap + 1)
      memory.change = {};  // it must leave this lane, too: no way is left to come to its middle before
    Strictest ahead(law);
    if (memory.change.active()) {
      if (memory.change.target != home && !may_go_on(view, law, memory.change)) abort(view, speed, memory);
      ahead = ahead_while_changing(view, law, leader, memory.change);
    } else {
      ahead = ahead_in_lane(view, law, leader);
      bool const may_change = memory.rest == 0.0f;
      auto const target =
          choose(LaneKeeping<View>{view, law, leader, lane_end(view, home, view.place().piece), may_change, ahead});
      if (may_change && target != none<CorridorId> && is_wide_enough(view, target, 0.5 * speed * course.duration)) {
        memory.change = course.begin(target, view.shape(), speed, room(view, leader, target));
        memory.rest = static_cast<float>(rest + course.duration);
        ahead = ahead_while_changing(view, law, leader, memory.change);
      }
    }
    if (auto const end = rules.lane_end_ahead(view)) ahead.heed(*end);
    auto const motion = law.motion(ahead.constraint(), dt, tolerance);
    return plan_lane_change(view, memory.change,
                            rules.bound(view, idm, view.place().s, speed, motion, dt, memory.rules), dt);
  }

  /// How a follower drives, as this driver assumes it.
  [[nodiscard]] IdmLaw law_of(RoadUser const& who) const {
    auto const& assumed = who.length() > truck_length ? trucks : others;
    return IdmLaw(assumed, std::max(0.0, who.speed), std::max(assumed.desired_speed, who.speed));
  }

  /// Acceleration of a follower as this driver assumes it [m/s^2]. Objects stand: they neither gain nor lose.
  [[nodiscard]] double follower(std::optional<RoadUser> const& who, double gap, double leader_speed) const {
    return who && is_valid(who->agent) ? law_of(*who)(gap, leader_speed) : 0.0;
  }

  /// Whether nobody has to brake harder than `deceleration` [m/s^2], gaps are left, and nobody comes into the same gap
  /// from the lane beyond for whom that would not hold.
  template <class View>
  CAMBIUM_NOINLINE [[nodiscard]] bool is_safe(View const& view, IdmLaw const& law, LaneOption const& option,
                                              double deceleration) const {
    auto const front_is_safe = [&](RoadUser const& n) {
      return n.gap > safe_gap && law(n.gap, n.speed) >= -deceleration;
    };
    auto const rear_is_safe = [&](RoadUser const& n) {
      return n.gap > safe_gap && follower(n, n.gap, law.speed()) >= -deceleration;
    };
    if (option.front && !front_is_safe(*option.front)) return false;
    if (option.rear && !rear_is_safe(*option.rear)) return false;
    auto const& there = view.road().corridors[option.place.corridor].pieces[option.place.piece];
    auto const beyond = there.beside(option.left);
    if (beyond == none<CorridorId> || beyond == view.place().corridor) return true;
    auto const others_there = view.place(beyond);
    auto const front = view.ahead(others_there), rear = view.behind(others_there);
    if (front && comes(view, *front, option, true) && !front_is_safe(*front)) return false;
    return !(rear && comes(view, *rear, option, false) && !rear_is_safe(*rear));
  }

  /// The way of two changes at `speed` [m/s] and the rest between them [m].
  [[nodiscard]] double there_and_back(double speed) const { return speed * (2.0 * course.duration + rest); }

  /// Whether the road marks permit a change, or do not count.
  template <class View>
  [[nodiscard]] bool marks_permit(View const& view, bool left) const {
    if (!heed_marks) return true;
    auto const& at = view.place();
    auto const& piece = view.corridor().pieces[at.piece];
    auto const& lane = view.map().lane(piece.lane);
    double const s = at.s + piece.lane_offset;
    return left ? lane.may_change_left(s) : lane.may_change_right(s);
  }

 private:
  static constexpr double infinite = std::numeric_limits<double>::infinity();
  /// Part of a change's length after which the vehicle has left its old lane.
  static constexpr double out_of_lane = 0.7;
  static constexpr double standing = 0.1;  ///< who is slower stands [m/s]: the law only creeps up to its stop
  /// Lateral speed that shows the intention to change [m/s].
  static constexpr double drift = 0.12;

  [[nodiscard]] static bool is_object(RoadUser const& n) { return is_valid(n.object); }

  /// Whether a neighbour in the lane beyond `option`'s comes into it.
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
    double const leftwards = state.speed * std::sin(state.heading - along);
    return (option.left ? -leftwards : leftwards) > drift;
  }

  template <class View>
  CAMBIUM_NOINLINE [[nodiscard]] bool may_go_on(View const& view, IdmLaw const& law, LaneChange const& change) const {
    auto const& at = view.place();
    auto const& piece = view.corridor().pieces[at.piece];
    LaneOption option{view.place(change.target), change.target == piece.left, {}, {}};
    if (!option.left && change.target != piece.right) return true;  // no longer beside: it has merged
    option.front = view.ahead(option.place);
    option.rear = view.behind(option.place);
    return is_safe(view, law, option, abort_deceleration);
  }

  /// Turns back, if that is still possible. How long it then rests is drawn: who has met somebody in the same gap does
  /// not meet him there again.
  template <class View>
  CAMBIUM_NOINLINE void abort(View const& view, double speed, Memory& memory) const {
    constexpr std::uint32_t purpose = 0x4c43u;
    auto const& at = view.place();
    auto const back = course.back(at.corridor, view.shape(), speed, at.lateral, memory.change.bend);
    if (!stays_within_lane(view, back)) return;
    auto random = view.random(purpose);
    memory.change = back;
    memory.rest = static_cast<float>(course.shortest_duration + rest * (0.5 + uniform01(random)));
  }

  /// Whether the vehicle fits into the lane `beside` where it comes in, `ahead` [m]: lanes may open slowly.
  template <class View>
  CAMBIUM_NOINLINE [[nodiscard]] static bool is_wide_enough(View const& view, CorridorId beside, double ahead) {
    auto const& lane = view.road().corridors[beside];
    double const s = std::min(view.place(beside).s + ahead, lane.length());
    return lane.width_at(s) > view.shape().width();
  }

  /// How far the vehicle's front may go on from `at`, on a lane corridor whose lane must be left; infinite where it
  /// need not be [m]. For each lane to be crossed there has to be room for the shortest change. Who goes to the left
  /// stops earlier: two who need each other's lanes do not come to stand side by side.
  template <class View, class Place>
  [[nodiscard]] double way_to_stop(View const& view, Place const& at) const {
    double const until_end = dead_end(view, at.corridor, at.piece) - at.s;
    if (until_end == infinite) return infinite;
    auto const lanes = lanes_to_cross(view, at.corridor, at.piece, at.s);
    double const changes = lanes.left > 0 ? lanes.left + 0.5 : std::max(1, lanes.right);
    return until_end - view.shape().front - changes * course.least_length(view.shape());
  }

  /// How long a change may be: it must lead around a standing object, to before the end of the lane, and to where the
  /// next change can begin [m].
  template <class View>
  CAMBIUM_NOINLINE [[nodiscard]] double room(View const& view, std::optional<RoadUser> const& leader,
                                             CorridorId target) const {
    auto const& at = view.place();
    double const until_end =
        std::min(dead_end(view, at.corridor, at.piece) - at.s, way_to_stop(view, view.place(target)));
    double const beside_object = (1.0 - out_of_lane) * course.least_length(view.shape());
    return leader && is_object(*leader) ? std::min(until_end, leader->gap + beside_object) : until_end;
  }

  /// Adds a leader in a lane that the vehicle stays in: before an object it leaves room to change.
  void add_leader(Strictest<IdmLaw>& ahead, geometry::Shape const& shape, std::optional<RoadUser> const& leader,
                  bool has_side) const {
    if (!leader) return;
    double const room = is_object(*leader) && has_side ? out_of_lane * course.least_length(shape) : 0.0;
    ahead.heed({leader->gap - room, leader->speed});
  }

  static void add_stop(Strictest<IdmLaw>& ahead, double way) {
    if (way < infinite) ahead.heed({way, 0.0});
  }

  template <class View>
  [[nodiscard]] Strictest<IdmLaw> ahead_in_lane(View const& view, IdmLaw const& law,
                                                std::optional<RoadUser> const& leader) const {
    auto const& at = view.place();
    auto const& piece = view.corridor().pieces[at.piece];
    Strictest<IdmLaw> ahead(law);
    add_leader(ahead, view.shape(), leader, piece.left != none<CorridorId> || piece.right != none<CorridorId>);
    add_stop(ahead, way_to_stop(view, at));
    return ahead;
  }

  template <class View>
  CAMBIUM_NOINLINE [[nodiscard]] Strictest<IdmLaw> ahead_while_changing(View const& view, IdmLaw const& law,
                                                                        std::optional<RoadUser> const& leader,
                                                                        LaneChange const& change) const {
    auto const& at = view.place();
    auto const& corridor = view.corridor();
    auto const& piece = corridor.pieces[at.piece];
    double const left = change.left, around = (1.0 - out_of_lane) * course.least_length(view.shape());
    auto const is_passed = [&](RoadUser const& n, double until) {  // the course leads around it
      return n.speed < 0.5 && n.gap > until;
    };
    Strictest<IdmLaw> ahead(law);
    if (change.target == at.corridor) {
      add_leader(ahead, view.shape(), leader, true);
      add_stop(ahead, way_to_stop(view, at));
      // While it reaches over the border, the leader there counts, too.
      auto const sides = corridor.widths_at(at.s, at.segment);
      auto const beside = at.lateral + view.shape().left > sides.left     ? piece.left
                          : view.shape().right - at.lateral > sides.right ? piece.right
                                                                          : none<CorridorId>;
      if (beside == none<CorridorId>) return ahead;
      auto const other = view.ahead(view.place(beside));
      if (other && other->gap > 0.0 && !is_passed(*other, left - 0.5 * course.least_length(view.shape())))
        ahead.heed({other->gap, other->speed});
      return ahead;
    }
    if (leader && !is_passed(*leader, left - around)) ahead.heed({leader->gap, leader->speed});
    double const until_end = dead_end(view, at.corridor, at.piece) - at.s;
    if (until_end < 0.6 * left) ahead.heed({until_end - view.shape().front, 0.0});
    auto const there = view.place(change.target);
    add_leader(ahead, view.shape(), view.ahead(there), true);
    // Into the lane beside it may go on, even if that ends soon.
    add_stop(ahead, std::max(way_to_stop(view, there), 0.6 * left + law.minimum_gap() + 1.0));
    return ahead;
  }
};

}  // namespace cambium
