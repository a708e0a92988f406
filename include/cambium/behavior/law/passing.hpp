#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "cambium/behavior/law/follow_lane.hpp"
#include "cambium/behavior/law/lane_reach.hpp"
#include "cambium/behavior/view.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/frenet.hpp"

namespace cambium::inline v0_1 {

/// Point at `way` [m] on the course from `start` that approaches the line critically damped: x'' = -2 x' / l - x / l^2
/// with `length` l [m]. The course depends on the place alone, so a vehicle that restarts it in each step stays on it.
template <class Scalar>
[[nodiscard]] LateralCourse<Scalar> approach(LateralCourse<Scalar> const& start, Scalar length, Scalar way) {
  using portable::exp;
  Scalar const rate = start.slope + start.offset / length, decay = exp(-way / length);
  Scalar const offset = (start.offset + rate * way) * decay, slope = (start.slope - rate * way / length) * decay;
  return {offset, slope, -(Scalar(2) * slope + offset / length) / length};
}

namespace detail {

/// Length l [m] of `approach` for a vehicle: its way in 1 s, so that 1 m to the side takes at most 1 m/s^2 and is done
/// but for 0.1 m after 4 s; longer at low speed, so that nobody moves sideways on the spot.
[[nodiscard]] inline double approach_length(geometry::Shape const& shape, double speed) {
  return std::max(5.0 + shape.front, speed);
}

/// The state of a vehicle that keeps its lane and approaches `offset` [m] to the left of its middle, after the motion
/// that follows the lane to `next`.
template <class View>
[[nodiscard]] typename View::State move_aside(View const& view, double offset, LongitudinalMotion<double> const& motion,
                                              typename View::State next) {
  auto const& at = view.place();
  if (std::abs(at.heading_error) > most_aslant) return next;
  auto const& corridor = view.corridor();
  double const stretch = stretch_beside(corridor, at, motion.distance);
  auto const [sin, cos] = portable::sin_cos(at.heading_error);
  double const along = motion.distance * cos / stretch;
  auto const course = approach(LateralCourse<double>{at.lateral - offset, stretch * (sin / cos), 0.0},
                               approach_length(view.shape(), motion.speed), along);
  place_on_lane(corridor, at.s + along, offset + course.offset, portable::atan(course.slope / stretch), at.segment,
                next);
  return next;
}

/// Whether a vehicle beside the middle of its lane extends over the border there by more than 0.1 m.
template <class View>
[[nodiscard]] bool sticks_out(View const& view) {
  constexpr double more = 0.1;  // [m]
  auto const& at = view.place();
  auto const widths = view.corridor().widths_at(at.s, at.segment);
  double const left = at.lateral + view.shape().left - widths.left,
               right = view.shape().right - at.lateral - widths.right;
  return (at.lateral > more && left > more) || (at.lateral < -more && right > more);
}

/// Which side of a lane is the inner one, where one passes: 1 the left, -1 the right (in left-hand traffic).
template <class View>
[[nodiscard]] double inner_side(View const& view) {
  auto const lane = view.corridor().pieces[view.place().piece].lane;
  return is_valid(lane) && view.map().road(view.map().lane(lane).road).left_hand_traffic ? -1.0 : 1.0;
}

/// The half of something that lies towards a `side` (1: left).
[[nodiscard]] constexpr double towards(double side, double left, double right) { return side > 0.0 ? left : right; }

/// How far from the middle of the lane [m] a vehicle may drive within the next `distance` [m]: where ways conflict, no
/// farther than the bodies reach for which the map computed them; infinite elsewhere. O(log conflicts + near).
template <class View>
[[nodiscard]] double widest_offset(View const& view, double distance) {
  auto const& conflicts = view.corridor().conflicts;
  double const s = view.place().s, rear = s - view.shape().rear, front = s + view.shape().front;
  auto next = std::partition_point(conflicts.begin(), conflicts.end(),
                                   [rear](map::Conflict const& c) { return c.farthest_end < rear; });
  for (; next != conflicts.end() && next->first_hold() < front + distance; ++next)
    if (next->hull().end > rear)
      return std::max(0.0, view.map().options().conflict_shape.left - std::max(view.shape().left, view.shape().right));
  return std::numeric_limits<double>::infinity();
}

/// Offset [m] to the left of the middle at which a vehicle drives `margin` [m] beside the outer border of its lane; the
/// middle, where the lane is too narrow.
template <class View>
[[nodiscard]] double offset_at_side(View const& view, double margin) {
  auto const& at = view.place();
  auto const& shape = view.shape();
  double const side = inner_side(view), soon = 2.0 * approach_length(shape, view.state().speed);
  double width = std::numeric_limits<double>::infinity();
  for (double const way : {0.0, soon}) {
    auto const sides = view.corridor().widths_at(at.s + way);
    width = std::min(width, towards(side, sides.right, sides.left));
  }
  double const outwards = std::max(0.0, width - margin - towards(side, shape.right, shape.left));
  return -side * std::min(outwards, widest_offset(view, soon));
}

/// Where a vehicle passes another one within its lane: offsets towards the inner side from the middle [m].
struct PassingOffset {
  double least;  ///< that leaves the clearance, 0 or more
  double aim;    ///< a bit more, within the lane
};

/// Where a vehicle passes `other` within its lane, with at least `clearance` [m] between the bodies, on the inner
/// `side` (see `inner_side`); none if the lane does not have that much room, or if the other reaches over the border of
/// the lane, because it may be about to leave or enter it. Expects the other to move on to the side for 3 s. A vehicle
/// that does not pass yet (`begins`) needs 0.1 m more. O(1) near the vehicle.
template <class View>
[[nodiscard]] std::optional<PassingOffset> offset_to_pass(View const& view, RoadUser const& other, double clearance,
                                                          double side, bool begins) {
  constexpr double more = 0.1, moves_on = 3.0, beyond = 15.0, touches = 0.05;  // [m], [s], [m], [m]
  auto const& at = view.place();
  auto const& corridor = view.corridor();
  auto const& shape = view.shape();
  auto hint = at.segment;
  auto const frenet = geometry::to_frenet(corridor.center, view.state(other), hint);
  auto const reach = lane_reach(corridor.center, view.state(other), view.shape(other), hint);
  double const inwards = std::max(0.0, side * frenet.lateral_speed) * moves_on;
  double const inner = towards(side, reach.left, -reach.right), outer = towards(side, -reach.right, reach.left);
  double const away = inner + inwards + clearance + towards(side, shape.right, shape.left);
  double most = widest_offset(view, other.gap + shape.length() + beyond);
  for (double const s : {at.s + shape.front, reach.begin, reach.end, reach.end + shape.length() + beyond}) {
    auto const sides = corridor.widths_at(s);
    most = std::min(most, towards(side, sides.left, sides.right) - towards(side, shape.left, shape.right) + 1e-9);
    if (s == reach.begin && outer > towards(side, sides.right, sides.left) + touches) return std::nullopt;
  }
  double const least = std::max(0.0, away);
  if (std::max(0.0, begins ? away + more : away) > most) return std::nullopt;
  return PassingOffset{least, std::max(0.0, std::min(away + more, most))};
}

/// Whether a vehicle that moves over to pass will leave the clearance by the time it comes up to `other`, even if it
/// goes 2 m/s faster until then.
template <class View>
[[nodiscard]] bool is_aside_in_time(View const& view, RoadUser const& other, double speed, PassingOffset const& offset,
                                    double side) {
  constexpr double faster = 2.0;  // [m/s]
  auto const& at = view.place();
  double const fast = speed + faster, closing = fast - other.speed;
  if (side * at.lateral >= offset.least) return true;
  if (other.gap <= 0.0 || closing <= 0.0 || std::abs(at.heading_error) > most_aslant) return false;
  LateralCourse<double> const now{at.lateral - side * offset.aim, portable::tan(at.heading_error), 0.0};
  double const way = fast * other.gap / closing;
  return side * approach(now, approach_length(view.shape(), fast), way).offset + offset.aim >= offset.least;
}

/// Whether an agent is beside a vehicle at `offset` [m], with air between the bodies.
template <class View>
[[nodiscard]] bool is_beside(View const& view, RoadUser const& other, double offset) {
  constexpr double air = 0.3;  // [m]
  return is_valid(other.agent) && leaves_room(view, view.place().corridor, other, offset, air);
}

}  // namespace detail

}  // namespace cambium::inline v0_1
