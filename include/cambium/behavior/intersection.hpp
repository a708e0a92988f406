#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/idm.hpp"

namespace cambium {

/// The time [s] in which a vehicle of `speed` [m/s] that accelerates by `acceleration` up to `highest` [m/s] covers
/// `distance` [m]; 0 for what lies behind it, infinite where it never gets there.
[[nodiscard]] inline double time_to_cover(double distance, double speed, double acceleration, double highest) {
  if (distance <= 0.0) return 0.0;
  if (acceleration <= 0.0 || speed >= highest)
    return speed > 0.0 ? distance / speed : std::numeric_limits<double>::infinity();
  double const until_highest = (highest - speed) / acceleration;
  double const there = until_highest * 0.5 * (speed + highest);
  if (distance >= there) return until_highest + (distance - there) / highest;
  return (std::sqrt(speed * speed + 2.0 * acceleration * distance) - speed) / acceleration;
}

/// Crosses junctions by the rules of the road, else follows its lane by IDM: lets those go first who have the right of
/// way (`map::right_of_way`: priorities of the map, right before left, oncoming traffic before those who turn across
/// it), as long as it has not come too far to stop, and waits outside of the junction for those who are in its way,
/// and until there is room behind it. Others are predicted with their speed, and faster where that is the worse; where
/// each one waits for another, after `patience` the smallest id goes first.
struct Intersection {
  IdmParameters idm{};
  double look_ahead = 80.0;
  double time_margin = 1.0;
  double stop_margin = 1.0;
  double safe_deceleration = 3.0;
  double assumed_acceleration = 1.5;
  double patience = 1.0;
  bool keep_clear = true;
  double tolerance = 1e-4;

  static constexpr char const* name = "intersection";
  static constexpr char const* summary =
      "IDM; gives way by priorities of the map, right before left, oncoming before turning; stops where somebody "
      "predicted would come too close in time; resolves deadlocks";
  static constexpr char const* source = "rules of the road (StVO sections 8 and 9); prediction: own";
  static constexpr auto parameters() {
    using P = Intersection;
    return std::make_tuple(
        parameter("idm", &P::idm, "-", {}, "car following"),
        parameter("look_ahead", &P::look_ahead, "m", Range{0, 1000}, "conflicts nearer than this are heeded"),
        parameter("time_margin", &P::time_margin, "s", Range{0, 20}, "between two vehicles in one place"),
        parameter("stop_margin", &P::stop_margin, "m", Range{0, 20}, "from the front end to the conflict when waiting"),
        parameter("safe_deceleration", &P::safe_deceleration, "m/s^2", Range{0.1, 20},
                  "who would have to brake harder does not stop any more"),
        parameter("assumed_acceleration", &P::assumed_acceleration, "m/s^2", Range{0, 20},
                  "of others on their way to the conflict"),
        parameter("patience", &P::patience, "s", Range{0, 600}, "standing time before a deadlock is resolved"),
        parameter("keep_clear", &P::keep_clear, "-", Range{0, 1}, "do not stop within the junction"),
        parameter("tolerance", &P::tolerance, "m/s^2", Range{1e-12, 1},
                  "error of the exact integration, as speed per second"));
  }

  struct Memory {
    float waited{};  ///< has been standing for [s]

    friend bool operator==(Memory const&, Memory const&) = default;
  };

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory& memory, double dt) const {
    double const speed = std::max(0.0, view.state().speed);
    memory.waited = speed < standing ? memory.waited + static_cast<float>(dt) : 0.0f;
    auto const front = view.front_by_rule();
    double gap = front ? front->gap : std::numeric_limits<double>::infinity();
    double leader_speed = front ? front->speed : 0.0;
    if (auto const stop = distance_to_stop(view, front, speed, memory.waited)) {
      // A standing leader, so far ahead that its follower stops at the line.
      double const to_line = std::max(0.0, *stop - stop_margin) + idm.minimum_gap;
      if (idm_acceleration(idm, speed, to_line, 0.0) < idm_acceleration(idm, speed, gap, leader_speed)) {
        gap = to_line;
        leader_speed = 0.0;
      }
    }
    return plan_along_lane(view, idm_motion(idm, speed, gap, leader_speed, dt, tolerance), dt);
  }

 private:
  static constexpr double standing = 0.1;  // [m/s]

  /// When a vehicle is in a conflict [s from now].
  struct Window {
    double begin, end;
    [[nodiscard]] bool overlaps(Window const& other, double margin) const {
      return begin < other.end + margin && other.begin < end + margin;
    }
  };

  /// Distance [m] from the front end to the conflict, or the first of a row of conflicts, before which the vehicle has
  /// to stop.
  template <class View>
  [[nodiscard]] std::optional<double> distance_to_stop(View const& view, std::optional<Neighbor> const& leader,
                                                       double speed, double waited) const {
    auto const& conflicts = view.corridor().conflicts;
    double const s = view.lane_position().s, front = s + view.shape().front, rear = s - view.shape().rear;
    double const braking = speed * speed / (2.0 * safe_deceleration);
    double row_begin = -std::numeric_limits<double>::infinity(), row_end = row_begin;
    for (auto const& conflict : conflicts) {
      if (conflict.begin > front + look_ahead) break;
      if (conflict.end < rear) continue;
      if (conflict.begin > row_end + view.shape().length() + 2.0 * stop_margin) row_begin = conflict.begin;
      row_end = std::max(row_end, conflict.end);
      double const to_row = row_begin - front, to_conflict = conflict.begin - front;
      if (to_conflict < 0.0) continue;  // it is in there already
      double const to_stop = to_row >= 0.0 ? to_row : to_conflict;
      bool const too_late = to_stop < braking;
      if (is_taken(view, conflict, front, speed) ||
          (!too_late && lets_go_first(view, conflict, front, speed, waited)) ||
          (!too_late && is_full_behind(view, conflict, leader, front)))
        return to_stop;
    }
    return std::nullopt;
  }

  /// Whether somebody is in the conflict who will not be out of it in time.
  template <class View>
  [[nodiscard]] bool is_taken(View const& view, map::Conflict const& conflict, double front, double speed) const {
    double const arrival =
        time_to_cover(conflict.begin - front, speed, idm.maximum_acceleration, std::max(speed, idm.desired_speed));
    bool taken = false;
    view.for_each_on_lane(conflict.index_begin, conflict.index_end, [&](LaneUser const& user) {
      // In a merge, who is ahead is followed.
      if (conflict.kind == map::OverlapKind::merge && user.position - conflict.index_begin > front - conflict.begin)
        return;
      double const way = conflict.index_end + user.rear - user.position;
      taken = taken || way / std::max(user.speed, standing) + 0.5 * time_margin > arrival;
    });
    return taken;
  }

  template <class View>
  [[nodiscard]] bool lets_go_first(View const& view, map::Conflict const& conflict, double front, double speed,
                                   double waited) const {
    double const to_begin = conflict.begin - front, highest = std::max(speed, idm.desired_speed);
    double const to_end = conflict.end - front + view.shape().length();
    Window const own{time_to_cover(to_begin, speed, idm.maximum_acceleration, highest),
                     time_to_cover(to_end, speed, idm.maximum_acceleration, highest)};
    bool lets = false;
    for (auto const& approach : conflict.approaches)
      view.for_each_on_lane(approach.index_begin, approach.index_end, [&](LaneUser const& user) {
        if (lets || !view.signals_way(user, conflict.other)) return;
        double const distance = approach.to_conflict + approach.index_end - user.position - user.front;
        if (distance < 0.0) return;  // it is in there: see is_taken
        if (!goes_before(view, conflict, user, distance, to_begin, waited)) return;
        double const way = distance + conflict.index_end - conflict.index_begin + user.front + user.rear;
        double const user_highest = std::max(user.speed, idm.desired_speed);
        Window const theirs{time_to_cover(distance, user.speed, assumed_acceleration, user_highest),
                            way / std::max(user.speed, standing)};
        lets = own.overlaps(theirs, time_margin);
      });
    return lets;
  }

  /// Whether the rules, or that it cannot stop any more, say that `user` goes before this vehicle.
  template <class View>
  [[nodiscard]] bool goes_before(View const& view, map::Conflict const& conflict, LaneUser const& user, double distance,
                                 double own_distance, double waited) const {
    double const user_speed = std::max(0.0, user.speed);
    if (user_speed >= standing && user_speed * user_speed > 2.0 * safe_deceleration * distance) return true;
    if (user_speed < standing && waited >= patience) {  // each waits for another, or stands in a queue
      auto const ahead = view.front_of(user);
      bool const queues = ahead && ahead->gap < 2.0 * idm.minimum_gap;
      return !queues && user.agent < view.id();
    }
    switch (conflict.right_of_way) {
      case map::RightOfWay::first:
        return false;
      case map::RightOfWay::yields:
        return true;
      default:
        break;
    }
    double const nearer = own_distance - distance;
    return std::abs(nearer) > 0.5 ? nearer > 0.0 : user.agent < view.id();
  }

  /// Whether there would be no room behind the conflict, as in a queue.
  template <class View>
  [[nodiscard]] bool is_full_behind(View const& view, map::Conflict const& conflict,
                                    std::optional<Neighbor> const& leader, double front) const {
    if (!keep_clear || !leader || leader->speed > 2.0) return false;
    double const room = front + leader->gap - conflict.end;
    return room > -leader->length && room < view.shape().length() + idm.minimum_gap;
  }
};
static_assert(BehaviorModel<Intersection>);

}  // namespace cambium
