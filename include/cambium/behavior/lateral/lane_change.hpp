#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "cambium/behavior/law/braking.hpp"
#include "cambium/behavior/law/follow_lane.hpp"
#include "cambium/behavior/law/lane_ends.hpp"
#include "cambium/behavior/law/lane_reach.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/collision.hpp"
#include "cambium/geometry/oriented_box.hpp"
#include "cambium/geometry/shape.hpp"

namespace cambium::inline v0_1 {

/// Point at `distance` [m] on the course from `start` that ends on the line and parallel to it after `length` [m] with
/// the least squared jerk: a quintic polynomial (Takahashi, Hongo, Ninomiya, Sugimoto 1989; Werling, Ziegler, Kammel,
/// Thrun 2010, section IV). Beyond `length` > 0 it stays on the line.
template <class Scalar>
[[nodiscard]] LateralCourse<Scalar> converge(LateralCourse<Scalar> const& start, Scalar length, Scalar distance) {
  if (!(distance < length)) return {};
  Scalar const d = start.offset, v = start.slope * length, a = start.bend * length * length, u = distance / length;
  Scalar const c2 = a / Scalar(2), c3 = Scalar(-10) * d - Scalar(6) * v - Scalar(3) * c2,
               c4 = Scalar(15) * d + Scalar(8) * v + Scalar(3) * c2, c5 = Scalar(-6) * d - Scalar(3) * v - c2;
  Scalar const offset = d + u * (v + u * (c2 + u * (c3 + u * (c4 + u * c5))));
  Scalar const slope = v + u * (Scalar(2) * c2 + u * (Scalar(3) * c3 + u * (Scalar(4) * c4 + u * Scalar(5) * c5)));
  Scalar const bend = Scalar(2) * c2 + u * (Scalar(6) * c3 + u * (Scalar(12) * c4 + u * Scalar(20) * c5));
  return {offset, slope / length, bend / (length * length)};
}

/// A lane change in progress, as a behaviour remembers it.
struct LaneChange {
  CorridorId target = none<CorridorId>;  ///< lane corridor that it leads to; none: keeps its lane
  float left{};                          ///< remaining length [m]; 0: restarts from where the vehicle is
  float bend{};                          ///< of its course at the vehicle [1/m]

  [[nodiscard]] bool active() const { return target != none<CorridorId>; }

  /// See `cambium::fell_short`.
  void fell_short(double way, bool left_course) {
    if (left_course)
      left = bend = 0.0f;
    else if (active())
      left += static_cast<float>(way);
  }

  static constexpr char const* name = "lane_change";
  static constexpr auto parameters() {
    using P = LaneChange;
    return parameter_list(parameter("target", &P::target, "lane corridor that it leads to"),
                          parameter("left", &P::left, "m", any_finite, "remaining length"),
                          parameter("bend", &P::bend, "1/m", any_finite, "of its course at the vehicle"));
  }

  friend bool operator==(LaneChange const&, LaneChange const&) = default;
};

namespace detail {

/// Share of a change after which the vehicle has left its old lane.
inline constexpr double out_of_lane = 0.7;

/// A road user slower than this stands or hardly moves [m/s]; own choice.
inline constexpr double at_rest_below = 0.5;

/// Extra length of a course for each metre that the vehicle's front is farther from its rear axle than a car's [-]. It
/// keeps long vehicles from swinging out into the lane beyond, for lanes 3.5 m wide.
inline constexpr double longer_by_front = 5.0;
/// The same where there is room for more: for lanes 3 m wide in a bend, with a truck in the lane beyond.
inline constexpr double longer_by_front_with_room = 8.0;

/// The same for a course back to the middle of the own lane from `lateral` [m] beside it. It is smaller because the way
/// is shorter, and because an early return is worth 0.1 m beyond the border.
[[nodiscard]] inline double longer_by_front_back(double lateral) { return 4.0 * std::min(1.0, std::abs(lateral)); }

/// Whether there is a line at which one waits, of a signal or before others who cross, on the way to a road user in the
/// own lane and up to 30 m beyond it.
template <class View>
CAMBIUM_NOINLINE [[nodiscard]] bool waits_at_line(View const& view, RoadUser const& user) {
  double const near = std::min(view.place().s, user.s), far = user.s + user.front + 30.0;
  auto const& corridor = view.corridor();
  return std::ranges::any_of(corridor.signals,
                             [&](auto const& signal) { return signal.line > near && signal.line < far; }) ||
         std::ranges::any_of(corridor.conflicts, [&](auto const& conflict) {
           return conflict.hull().end > near && conflict.first_hold() < far;
         });
}

/// Whether `user`, who stands in the own lane or is about to, has no reason to that shows, so that it is parked or has
/// broken down: no line as in `waits_at_line`, no queue before it, and nobody off the lanes near. A user may be the own
/// vehicle. O(agents off the lanes + agents within 60 m ahead of it in the lane).
template <class View>
CAMBIUM_NOINLINE [[nodiscard]] bool is_parked(View const& view, RoadUser const& user) {
  constexpr double near = 30.0, far = 60.0;  // [m]
  constexpr int most = 1;                    // parked ahead of it
  if (waits_at_line(view, user)) return false;
  int ahead = 0;
  double const way = std::max(0.0, user.s - view.place().s);
  view.off_lanes(way + near, [&](RoadUser const&) { ahead = most + 1; });
  view.around(view.place(), way + far, [&](RoadUser const& other) {
    if (other.s <= user.s || other.s > user.s + far || other.agent == user.agent) return;
    ahead += other.speed >= at_rest_below && other.s < user.s + near ? most + 1 : 1;
  });
  return ahead <= most;
}

/// Free road [m] to one that is parked in the own lane and leaves no room to pass there, where there is a lane beside;
/// infinite without one. O(1) but before one that stands.
template <class View>
[[nodiscard]] double free_until_parked(View const& view) {
  constexpr double aside = 1.0, clearance = 0.3;  // [m]
  constexpr double infinite = std::numeric_limits<double>::infinity();
  auto const& at = view.place();
  auto const& piece = view.corridor().pieces[at.piece];
  if (piece.left == none<CorridorId> && piece.right == none<CorridorId>) return infinite;
  auto const next = view.ahead({.merging = Merging::by_rule});
  if (!next || next->speed >= at_rest_below) [[likely]]
    return infinite;
  for (double const offset : {0.0, -aside, aside})
    if (leaves_room(view, at.corridor, *next, offset, clearance)) return infinite;
  return is_parked(view, *next) ? std::max(0.0, next->gap) : infinite;
}

[[nodiscard]] constexpr double least_course_length(double of_car, geometry::Shape const& shape, double by_front) {
  return of_car + by_front * std::max(0.0, shape.front - geometry::car().front);
}

}  // namespace detail

/// How long a lane change takes, in time and distance.
struct LaneChangeCourse {
  double duration = 4.0;
  double shortest_duration = 2.5;
  double minimum_length = 15.0;

  static constexpr char const* name = "lane_change_course";
  static constexpr char const* summary = "quintic course over the distance driven: no jump of heading or curvature";
  static constexpr char const* source = "own";
  static constexpr auto parameters() {
    return parameter_list(
        parameter("duration", &LaneChangeCourse::duration, "s", Range{0.5, 30}, "from one centre line to the other"),
        parameter("shortest_duration", &LaneChangeCourse::shortest_duration, "s", Range{0.5, 30},
                  "if less room is left, and for the way back of an aborted change; at most duration"),
        parameter(
            "minimum_length", &LaneChangeCourse::minimum_length, "m", Range{5, 200},
            "however slow a car drives; 5 m more for each metre that a longer vehicle's front is farther ahead, 8 m "
            "where there is room"));
  }

  /// Shortest length of a change [m], however slow a vehicle of this shape drives.
  [[nodiscard]] double least_length(geometry::Shape const& shape) const {
    return detail::least_course_length(minimum_length, shape, detail::longer_by_front);
  }

  /// Distance [m] that the vehicle's front may still drive from `at` in a lane that it must leave; infinite if it may
  /// stay. It leaves room for the shortest change for each lane to cross. A vehicle that goes to the left stops
  /// earlier, so that two vehicles that need each other's lanes do not stop side by side.
  template <class View, class Place>
  [[nodiscard]] double distance_to_stop(View const& view, Place const& at) const {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    double const until_end = dead_end(view, at.corridor, at.piece) - at.s;
    if (until_end == infinite) return infinite;
    auto const lanes = lanes_to_cross(view, at.corridor, at.piece, at.s);
    double const changes = lanes.left > 0 ? lanes.left + 0.5 : std::max(1, lanes.right);
    return until_end - view.shape().front - changes * least_length(view.shape());
  }

  /// `motion` over `dt` [s], but with moderate braking wherever that keeps room for the shortest change behind `next`,
  /// a road user in the own lane that stands or is about to. Only where `may_pass` holds.
  template <class View>
  [[nodiscard]] LongitudinalMotion<double> leave_room(View const& view, RoadUser const& next,
                                                      LongitudinalMotion<double> const& motion, double dt) const {
    constexpr double moderate = 3.5, closest = 2.0;  // [m/s^2], [m]
    if (!may_pass(view, next)) [[likely]]
      return motion;
    double const room =
        detail::out_of_lane * least_length(view.shape()) * (1.0 - std::clamp(next.speed / slow, 0.0, 1.0));
    auto const bound =
        motion_before_stop(std::max(0.0, view.state().speed), next.gap - closest - room, moderate, moderate, dt);
    return bound.speed < motion.speed ? bound : motion;
  }

  /// Whether `next`, a road user in the own lane, stands or is about to, with a lane beside, and no line of a signal or
  /// a junction before it or within 30 m beyond it.
  template <class View>
  [[nodiscard]] bool may_pass(View const& view, RoadUser const& next) const {
    if (next.speed > slow) [[likely]]
      return false;
    auto const& piece = view.corridor().pieces[view.place().piece];
    bool const has_lane_beside = piece.left != none<CorridorId> || piece.right != none<CorridorId>;
    return has_lane_beside && !detail::waits_at_line(view, next);
  }

  /// A new change to lane corridor `target` at `speed` [m/s], within `room` [m] if possible. A slow long vehicle takes
  /// more than its shortest course where it has room.
  [[nodiscard]] LaneChange begin(CorridorId target, geometry::Shape const& shape, double speed,
                                 double room = std::numeric_limits<double>::infinity()) const {
    double const shortest = std::max(least_length(shape), speed * std::min(shortest_duration, duration));
    double const roomy = detail::least_course_length(minimum_length, shape, detail::longer_by_front_with_room);
    double const wanted = std::max(roomy, speed * duration);
    return {target, static_cast<float>(std::max(shortest, std::min(wanted, room))), 0.0f};
  }

  /// Whether a vehicle that drives `change` from its place keeps `air` [m] to `other`, a road user that stands. O(1).
  template <class View>
  CAMBIUM_NOINLINE [[nodiscard]] bool leads_around(View const& view, LaneChange const& change, RoadUser const& other,
                                                   double air = 0.1) const {
    constexpr int samples = 16;
    auto const at = view.place(change.target);
    if (!(change.left > 0.0f) || std::abs(at.heading_error) > detail::most_aslant) return false;
    auto const& corridor = view.road().corridors[change.target];
    double const length = change.left, stretch = detail::stretch_beside(corridor, at, length);
    LateralCourse<double> const start{at.lateral, stretch * portable::tan(at.heading_error), change.bend};
    auto state = view.state();
    for (int i = 1; i <= samples; ++i) {
      double const along = length * i / samples;
      auto const course = converge(start, length, along);
      place_on_lane(corridor, at.s + along, course.offset, portable::atan(course.slope / stretch), at.segment, state);
      auto box = geometry::box_of(view.shape(), state);
      box.half_length += air;
      box.half_width += air;
      bool const touches = is_valid(other.agent)
                               ? geometry::intersects(box, geometry::box_of(view.shape(other), view.state(other)))
                               : geometry::intersects(box, view.outline(other));
      if (touches) return false;
    }
    return true;
  }

  /// `change`, which begins, or the longest shorter one that leads around `other`, a road user that stands; nothing if
  /// none does. At walking speed a car or van may take a course as short as it can steer, the shorter the less it moves
  /// sideways; longer vehicles would swing out into the lane beyond. O(1).
  template <class View>
  [[nodiscard]] std::optional<LaneChange> around(View const& view, LaneChange change, RoadUser const& other) const {
    constexpr double tightest = 0.75, width = 3.5, shorter = 0.9;  // share of the least length for [m]; of the last one
    constexpr double air = 0.2;                                    // [m]; twice that of a change under way
    double const speed = std::max(0.0, view.state().speed), across = std::abs(view.place(change.target).lateral);
    double const share =
        view.shape().front > geometry::van().front ? 1.0 : tightest * std::sqrt(std::min(1.0, across / width));
    double const shortest = std::max(share * least_length(view.shape()), speed * std::min(shortest_duration, duration));
    for (double length = change.left;; length = std::max(shortest, shorter * length)) {
      change.left = static_cast<float>(length);
      if (leads_around(view, change, other, air)) return change;
      if (length <= shortest) return std::nullopt;
    }
  }

  /// The change that the motion of a vehicle shows, such as when it enters or is set in the middle of one; not active
  /// if it shows none. The course goes on from the present lateral speed, which counts as the highest of the change.
  template <class View>
  CAMBIUM_NOINLINE [[nodiscard]] LaneChange under_way(View const& view) const {
    constexpr double steepest = 1.875;  // slope halfway, relative to the mean slope of the course
    auto const& at = view.place();
    double const speed = std::max(0.0, view.state().speed), aslant = std::abs(at.heading_error);
    if (speed * portable::sin(aslant) < detail::least_drift || aslant > detail::most_aslant) return {};
    double const slope = portable::tan(at.heading_error);
    auto const drift = detail::drift_of(view, slope);
    if (drift.target == at.corridor && drift.rest != 0.0) return {};
    // The lateral speed falls by at most 2 m/s^2 on average.
    double const gentle = speed * speed * std::abs(slope) / 2.0;
    double const least = std::max(least_length(view.shape()), gentle), most = std::max(least, speed * duration);
    double const length = steepest * std::abs((drift.rest - at.lateral) / slope);
    return {drift.target, static_cast<float>(std::clamp(length, least, most)), 0.0f};
  }

  /// Restarts a change whose course the vehicle had to leave.
  void renew(LaneChange& change, geometry::Shape const& shape, double speed) const {
    if (change.active() && !(change.left > 0.0f)) change = begin(change.target, shape, speed);
  }

  /// The way back to lane corridor `home`, from `lateral` [m] beside its middle, at `speed` [m/s]; `bend` [1/m] of the
  /// present course at the vehicle.
  [[nodiscard]] LaneChange back(CorridorId home, geometry::Shape const& shape, double speed, double lateral,
                                float bend) const {
    constexpr double least_share = 0.6;  // of a car's shortest course, for a bicycle
    double const share = std::clamp(shape.front / geometry::car().front, least_share, 1.0);
    double const least =
        detail::least_course_length(share * minimum_length, shape, detail::longer_by_front_back(lateral));
    return {home, static_cast<float>(std::max(least, speed * std::min(shortest_duration, duration))), bend};
  }

  static constexpr double slow = 4.0;  ///< a road user up to this speed stands or is about to [m/s]; own choice
};

namespace detail {

/// The plan that drives `motion` from `at` along the course of `change`, which ends `offset` [m] to the left of the
/// centre line of `corridor`.
template <class View>
[[nodiscard]] Plan<View> plan_course(View const& view, map::LaneCorridor const& corridor, map::LanePlace const& at,
                                     LaneChange& change, LongitudinalMotion<double> const& motion, double dt,
                                     double offset = 0.0) {
  double const stretch = stretch_beside(corridor, at, motion.distance);
  auto const [sin, cos] = portable::sin_cos(at.heading_error);
  LateralCourse<double> const start{at.lateral - offset, stretch * (sin / cos), change.bend};
  double const along = motion.distance * cos / stretch;
  auto const course = converge(start, static_cast<double>(change.left), along);
  typename View::State next = view.state();
  next.time = view.time() + dt;
  place_on_lane(corridor, at.s + along, offset + course.offset, portable::atan(course.slope / stretch), at.segment,
                next);
  next.speed = motion.speed;
  change.left -= static_cast<float>(along);
  change.bend = static_cast<float>(course.bend);
  return plan_to(view, next, dt);
}

}  // namespace detail

/// The plan that keeps the lane. A vehicle off the centre line or its direction, such as after an aborted change or an
/// observation error, returns smoothly on a course that restarts in each step; `bend` [1/m] is that of the course at
/// the vehicle. `offset` [m]: keeps this far to the left of the centre line.
template <class View>
[[nodiscard]] Plan<View> plan_to_center(View const& view, float& bend, LongitudinalMotion<double> const& motion,
                                        double dt, double offset = 0.0) {
  constexpr double near = 1e-3, shortest = 15.0, duration = 3.0;  // [m or rad], [m], [s]
  auto const& at = view.place();
  double const aslant = std::abs(at.heading_error);
  if ((std::abs(at.lateral - offset) < near && aslant < near) || aslant > detail::most_aslant) {
    bend = 0.0f;
    return plan_along_lane(view, motion, dt);
  }
  double const length =
      std::max(detail::least_course_length(shortest, view.shape(), detail::longer_by_front_back(at.lateral - offset)),
               duration * motion.speed);
  LaneChange back{at.corridor, static_cast<float>(length), bend};
  auto const plan = detail::plan_course(view, view.corridor(), at, back, motion, dt, offset);
  bend = back.bend;
  return plan;
}

/// The plan that drives `motion` along the course of a lane change, from the observed place of the vehicle. Ends the
/// change when it is complete or its lane ends. Without a change it equals `plan_to_center`.
template <class View>
[[nodiscard]] Plan<View> plan_lane_change(View const& view, LaneChange& change,
                                          LongitudinalMotion<double> const& motion, double dt) {
  if (!change.active()) return plan_to_center(view, change.bend, motion, dt);
  map::LanePlace const at = view.place(change.target);
  auto const& corridor = view.road().corridors[change.target];
  bool const is_over = at.s >= corridor.length() || !(change.left > 0.0f);
  if (is_over || std::abs(at.heading_error) > detail::most_aslant) {  // the lane ends, or the course was left
    change = {};
    return plan_to_center(view, change.bend, motion, dt);
  }
  auto const plan = detail::plan_course(view, corridor, at, change, motion, dt);
  if (!(change.left > 0.0f)) change = {};
  return plan;
}

namespace detail {

/// Whether the vehicle stays within the target lane of `change`, if the change begins now within that lane.
template <class View>
[[nodiscard]] bool stays_within_lane(View const& view, LaneChange const& change) {
  map::LanePlace const at = view.place(change.target);
  auto const& corridor = view.road().corridors[change.target];
  auto const sides = corridor.widths_at(at.s, at.segment);
  LateralCourse<double> const start{at.lateral, portable::tan(std::clamp(at.heading_error, -1.0, 1.0)), change.bend};
  constexpr int samples = 8;
  for (int i = 0; i < samples; ++i) {
    double const length = change.left;
    double const offset = converge(start, length, length * i / samples).offset;
    if (offset > sides.left || -offset > sides.right) return false;
  }
  return true;
}

}  // namespace detail

}  // namespace cambium::inline v0_1
