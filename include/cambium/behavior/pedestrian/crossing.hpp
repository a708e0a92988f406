#pragma once

#include <algorithm>
#include <limits>

#include "cambium/behavior/law/braking.hpp"
#include "cambium/behavior/law/follow_lane.hpp"
#include "cambium/behavior/pedestrian/social_force.hpp"
#include "cambium/behavior/view.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/map/corridor/corridor.hpp"

namespace cambium::inline v0_1 {

/// When a pedestrian crosses the lanes of vehicles. It accepts a gap that is longer than the time to cross plus
/// `time_margin`, as in the Highway Capacity Manual 2000 (eq. 18-17), where start-up and clearance take 3 s together
/// (quoted second-hand, not compared with the manual).
struct CrossingParameters {
  double time_margin = 3.0;
  double margin_behind = 0.5;
  double stop_margin = 0.3;
  double assumed_acceleration = 1.5;
  double assumed_speed = 50 / 3.6;
  double demanded_deceleration = 0.0;

  static constexpr char const* name = "crossing";
  static constexpr char const* summary =
      "crosses a lane if no vehicle arrives before it is across and a margin is over, or if arriving vehicles can "
      "still stop";
  static constexpr char const* source =
      "critical gap: Highway Capacity Manual 2000, eq. 18-17 (second-hand); the rest: own";
  static constexpr auto parameters() {
    using P = CrossingParameters;
    return parameter_list(
        parameter("time_margin", &P::time_margin, "s", Range{0, 60},
                  "from leaving a lane to the arrival of the next vehicle"),
        parameter("margin_behind", &P::margin_behind, "s", Range{0, 60},
                  "from the passing of a vehicle's rear end to entering its lane"),
        parameter("stop_margin", &P::stop_margin, "m", Range{0, 10}, "from the body to the lane while waiting"),
        parameter("assumed_acceleration", &P::assumed_acceleration, "m/s^2", Range{0, 20}, "of arriving vehicles"),
        parameter("assumed_speed", &P::assumed_speed, "m/s", Range{0, 100}, "up to which arriving vehicles accelerate"),
        parameter("demanded_deceleration", &P::demanded_deceleration, "m/s^2", Range{0, 20},
                  "crosses in front of vehicles that can stop with this deceleration; 0: all vehicles go first"));
  }
};

namespace detail {

/// Stretch [m] along a crossed lane that a pedestrian occupies who walks `lateral` [m] beside the centre line of its
/// way.
struct CrossingStrip {
  double begin = std::numeric_limits<double>::infinity(), end = -begin;
};

template <class View>
[[nodiscard]] CrossingStrip strip_of(View const& view, map::LaneCrossing const& crossing) {
  auto const& lane = view.map().lane(crossing.lane);
  auto const& at = view.place();
  auto hint = lane.path.find(0.5 * (crossing.lane_begin + crossing.lane_end));
  CrossingStrip strip;
  for (double const s : {crossing.begin, crossing.end}) {
    State there;
    place_on_lane(view.corridor(), s, at.lateral, 0.0, at.segment, there);
    double const along = lane.path.project({there.x, there.y}, hint).s;
    strip.begin = std::min(strip.begin, along - view.shape().radius());
    strip.end = std::max(strip.end, along + view.shape().radius());
  }
  return strip;
}

/// Whether the traffic of a crossed lane leaves no gap. `to_begin`, `to_end` [m]: from the front and the rear of the
/// body to the borders of the lane; `margin` [s]: see `CrossingParameters::time_margin`; `demanded` [m/s^2]: see
/// `CrossingParameters::demanded_deceleration`.
template <class View>
[[nodiscard]] bool is_blocked(CrossingParameters const& p, SocialForceParameters const& social, View const& view,
                              map::LaneCrossing const& crossing, double speed, double to_begin, double to_end,
                              double margin, double demanded) {
  double const walking = social.desired_speed;
  double const arrival = std::max(0.0, to_begin) / (social.highest_speed_ratio * walking);
  double const clearance =
      std::max(0.0, to_end) / walking + social.relaxation_time * std::max(0.0, 1.0 - speed / walking);
  auto const strip = strip_of(view, crossing);
  bool blocked = false;
  // `position`: along the vehicle's way, from the begin of the crossed lane.
  auto const heed = [&](RoadUser const& user, double position) {
    if (blocked || position - user.rear > strip.end || !view.signals_way(user, crossing.lane)) return;
    double const distance = strip.begin - position - user.front, theirs = std::max(0.0, user.speed);
    if (distance > 0.0 && theirs * theirs < 2.0 * demanded * distance) return;
    double const first = time_to_cover(distance, theirs, p.assumed_acceleration, std::max(theirs, p.assumed_speed));
    double const way = strip.end - position + user.rear;
    double const last = theirs > standing_speed ? way / theirs : std::numeric_limits<double>::infinity();
    blocked = first < clearance + margin && arrival < last + p.margin_behind;
  };
  for (auto const& way : crossing.ways)
    view.on_lane(way.index_begin, way.index_end,
                 [&](RoadUser const& user) { heed(user, way.begin + user.s - way.index_begin); });
  return blocked;
}

/// How far the reference point of a pedestrian at `speed` [m/s] may go along its corridor [m], so that its front does
/// not pass the border of a lane without a gap; infinite if it may go on. Adjacent lanes are crossed in one go. A
/// pedestrian on its way across goes on, unless a vehicle unexpectedly enters a lane still ahead and can no longer
/// brake for it comfortably. O(arriving vehicles).
template <class View>
[[nodiscard]] double distance_to_stop(CrossingParameters const& p, SocialForceParameters const& social,
                                      View const& view, double speed) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  constexpr double near = 5.0;         // [m]
  constexpr double comfortable = 1.5;  // [m/s^2]
  constexpr double toe = 0.2;          // [m] a pedestrian that extends over the kerb by less has not begun to cross
  double const s = view.place().s, front = s + view.shape().front, rear = s - view.shape().rear;
  double row_begin = -infinite, row_end = -infinite;
  for (auto const& crossing : view.corridor().crossings) {
    bool const is_next_row = crossing.begin > row_end + view.shape().length() + 2.0 * p.stop_margin;
    if (is_next_row && crossing.begin > front + near) break;
    if (is_next_row) row_begin = crossing.begin;
    row_end = std::max(row_end, crossing.end);
    if (crossing.end < rear || crossing.begin + toe < front) continue;  // behind it, or inside it
    bool const on_the_way = row_begin + toe < front;
    if (detail::is_blocked(p, social, view, crossing, speed, crossing.begin - front, crossing.end - rear,
                           on_the_way ? 0.0 : p.time_margin,
                           on_the_way ? std::max(p.demanded_deceleration, comfortable) : p.demanded_deceleration))
      return (on_the_way ? crossing.begin : row_begin) - view.shape().front - s;
  }
  return infinite;
}

}  // namespace detail

}  // namespace cambium::inline v0_1
