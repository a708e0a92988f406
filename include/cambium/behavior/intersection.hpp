#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/idm.hpp"
#include "cambium/behavior/leader.hpp"

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

/// The farthest that a vehicle of `speed` [m/s] may go in `dt` [s] if it is to stop within `distance` [m] by braking
/// with `deceleration` [m/s^2], or harder where that is too late, up to `hardest`: the safe speed of Krauss (1998, eq.
/// 3.6) before a standing obstacle, at the end of a step of even acceleration.
[[nodiscard]] inline LongitudinalMotion<double> motion_before_stop(double speed, double distance, double deceleration,
                                                                   double hardest, double dt) {
  double const needed = distance > 0.0 ? speed * speed / (2.0 * distance) : std::numeric_limits<double>::infinity();
  double const braking = std::min(std::max(deceleration, needed), hardest), change = braking * dt;
  if (needed > hardest) {
    double const end = std::max(0.0, speed - change);
    return {end > 0.0 ? 0.5 * (speed + end) * dt : speed * speed / (2.0 * braking), end};
  }
  double const root = change * change - 4.0 * braking * (speed * dt - 2.0 * distance);
  double const end = 0.5 * (std::sqrt(std::max(0.0, root)) - change);
  if (end <= 0.0) return {std::min(distance, 0.5 * speed * dt), 0.0};  // it stands before the step is over
  return {0.5 * (speed + end) * dt, end};
}

/// Crosses junctions by the rules of the road, else follows its lane by IDM. Before a junction it lets those go first
/// who have the right of way (`map::right_of_way`), if they would come into its way; enters when all conflicts there
/// are its own, and only if there is room behind them; then it goes first before all who are still outside. Whoever
/// cannot stop any more before a conflict, or is in it, is never driven into. It stops at red lights
/// (`World::set_light`) and stop signs. Where each one waits for another, one after the other goes after some patience.
/// Others are taken to come by the ways that they signal, with their speed, and faster where that is the worse.
///
/// Conflicts are those of bodies no larger than `MapOptions::conflict_shape`, a car by default: where longer vehicles
/// cross, load the map with theirs. No two vehicles commit themselves to the same conflict: on the same frame each pair
/// finds the same one to go first, and one who can still stop is never gone before by more than that one.
struct Intersection {
  IdmParameters idm{};
  RoadRules rules{.obey_speed_limits = true};
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
        parameter("rules", &P::rules, "-", {}, "what it heeds beside other road users"),
        parameter("look_ahead", &P::look_ahead, "m", Range{0, 1000},
                  "conflicts nearer than this, or than the way to brake comfortably, are heeded"),
        parameter("time_margin", &P::time_margin, "s", Range{0, 20}, "between two vehicles in one place"),
        parameter("stop_margin", &P::stop_margin, "m", Range{0, 20}, "from the front end to the junction when waiting"),
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
    float waited{};            ///< has been standing before a junction for [s]
    float stopped_at = -1.0f;  ///< corridor position of the last stop sign that it has stopped at [m]

    friend bool operator==(Memory const&, Memory const&) = default;
  };

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory& memory, double dt) const {
    Own own;
    own.speed = std::max(0.0, view.state().speed);
    own.idm = within_limits(rules, idm, view, own.speed);
    own.look_ahead = std::max(look_ahead, own.speed * own.speed / (2.0 * idm.comfortable_deceleration) + 20.0);
    own.s = view.lane_position().s;
    own.front = own.s + view.shape().front;
    own.reach = extra_reach(view, view.shape().front, view.shape().rear, view.shape().width());
    own.waited = memory.waited;
    follow(own, leader_of<false>(view, view.front_by_rule()));
    heed_conflicts(view, own, dt);
    heed_signals(view, own, memory, dt);
    if (own.speed > starting || (own.speed >= standing && own.at_line))
      memory.waited = 0.0f;
    else if (own.at_line)
      memory.waited += static_cast<float>(dt);
    auto motion = idm_motion(own.idm, own.speed, own.leader.gap, own.leader.speed, dt, tolerance);
    if (own.bound.distance < motion.distance) motion = own.bound;
    return plan_along_lane(view, motion, dt);
  }

 private:
  static constexpr double standing = 0.1;   // [m/s] slower than this
  static constexpr double starting = 2.5;   // [m/s] slower than this
  static constexpr double short_way = 6.0;  // [m] from the conflict, to see who starts there
  static constexpr double air = 0.3;        // [m] before a conflict
  static constexpr double infinite = std::numeric_limits<double>::infinity();

  /// How far a body reaches beyond that of `MapOptions::conflict_shape` [m].
  struct Reach {
    double front{}, rear{};
  };

  /// Where one is, what it has seen, and what it may do.
  struct Own {
    IdmParameters idm;
    double s{}, front{}, speed{}, waited{};
    double look_ahead{};  ///< [m]
    Reach reach;
    Leader leader;
    LongitudinalMotion<double> bound{infinite, infinite};  ///< goes no farther in this step
    bool at_line = false;                                  ///< has come to where it waits
  };

  /// What a conflict asks for, the strongest last.
  enum class Claim : std::uint8_t {
    free,
    watch,   ///< goes on, but so that it can still stop: it will be free in time
    yield,   ///< waits, if it can still stop
    blocked  ///< does not drive in there
  };

  /// When a vehicle is in a conflict [s from now].
  struct Window {
    double begin, end;
  };

  template <class View>
  [[nodiscard]] static Reach extra_reach(View const& view, double front, double rear, double width) {
    auto const& known = view.map().options().conflict_shape;
    double const aside = std::max(0.0, width - known.width());
    return {std::max(0.0, front - known.front) + aside, std::max(0.0, rear - known.rear) + aside};
  }

  static void follow(Own& own, Leader const& leader) {
    if (idm_acceleration(own.idm, own.speed, leader.gap, leader.speed) <
        idm_acceleration(own.idm, own.speed, own.leader.gap, own.leader.speed))
      own.leader = leader;
  }

  [[nodiscard]] bool can_stop(double speed, double distance) const {
    return speed * speed <= 2.0 * safe_deceleration * std::max(0.0, distance) || speed < standing;
  }

  template <class View>
  void heed_conflicts(View const& view, Own& own, double dt) const {
    for (auto const& conflict : view.corridor().conflicts) {
      if (conflict.begin > own.front + own.look_ahead) break;
      if (conflict.end + own.reach.rear < own.s) continue;
      auto claim = claim_of(view, conflict, own);
      if (claim < Claim::yield && is_full_behind(view, conflict, own)) claim = Claim::yield;
      if (claim != Claim::free) obey(claim, conflict, own, dt);
    }
  }

  /// Stops at stop signs, and at lights that are red, or yellow as long as it can.
  template <class View>
  void heed_signals(View const& view, Own& own, Memory& memory, double dt) const {
    for (auto const& signal : view.corridor().signals) {
      double const to_line = signal.line - own.front;
      if (to_line > own.look_ahead) break;
      if (to_line < 0.0) continue;
      if (signal.kind == map::SignalKind::stop) {
        bool const stands_there = own.speed < standing && to_line < stop_margin + 1.0;
        if (stands_there) memory.stopped_at = static_cast<float>(signal.line);
        if (std::abs(static_cast<double>(memory.stopped_at) - signal.line) < 0.1) continue;
      } else {
        auto const color = view.light(signal.light);
        if (color == map::LightColor::off || color == map::LightColor::green) continue;
        if (color == map::LightColor::yellow && !can_stop(own.speed, to_line)) continue;
      }
      double const margin = can_stop(own.speed, to_line - stop_margin) ? stop_margin : 0.0;
      bound(own, std::max(0.0, to_line - margin), own.idm.comfortable_deceleration, dt);
    }
  }

  void bound(Own& own, double to_stop, double braking, double dt) const {
    auto const motion = motion_before_stop(own.speed, to_stop, braking, -own.idm.lowest_acceleration, dt);
    if (motion.distance < own.bound.distance) own.bound = motion;
  }

  /// Bounds the step's motion by what a conflict asks for.
  void obey(Claim claim, map::Conflict const& conflict, Own& own, double dt) const {
    double const to_conflict = conflict.begin - own.reach.front - air - own.s;
    if (to_conflict + air < 0.0) return;  // it is in there already
    double const to_stop = distance_to_stop(claim, conflict, own, to_conflict);
    if (claim == Claim::yield && !can_stop(own.speed, to_stop)) return;
    double const braking = claim == Claim::watch ? safe_deceleration : own.idm.comfortable_deceleration;
    bound(own, to_stop, braking, dt);
    own.at_line = own.at_line || to_stop < 2.0;
  }

  /// How far it goes to where it waits: before the line if it can still stop there, else before the conflict [m].
  [[nodiscard]] double distance_to_stop(Claim claim, map::Conflict const& conflict, Own const& own,
                                        double to_conflict) const {
    double const to_line = std::min(conflict.line - own.front, to_conflict);
    if (to_line < 0.0 || !can_stop(own.speed, to_line)) return to_conflict;
    for (double const margin : {claim == Claim::watch ? air : stop_margin, air})
      if (can_stop(own.speed, to_line - margin)) return std::max(0.0, to_line - margin);
    return to_line;
  }

  /// The strongest claim of all who are on their way to the conflict; merging leaders are followed.
  template <class View>
  [[nodiscard]] Claim claim_of(View const& view, map::Conflict const& conflict, Own& own) const {
    auto claim = Claim::free;
    for (auto const& way : conflict.ways)
      view.for_each_on_lane(way.index_begin, way.index_end, [&](LaneUser const& user) {
        if (user.position < way.index_begin || user.position > way.index_end || !is_valid(user.agent)) return;
        claim = std::max(claim, claim_of(view, conflict, user, way.begin + user.position - way.index_begin, own));
      });
    return claim;
  }

  /// The claim of one at position `at` on its way.
  template <class View>
  [[nodiscard]] Claim claim_of(View const& view, map::Conflict const& conflict, LaneUser const& user, double at,
                               Own& own) const {
    auto const reach = extra_reach(view, user.front, user.rear, 0.0);
    if (at > conflict.other_end + reach.rear) return Claim::free;
    if (at < 0.0 && !view.signals_way(user, conflict.other)) return Claim::free;
    double const way = conflict.other_begin - reach.front - at;
    double const own_way = conflict.begin - own.reach.front - own.s;
    bool const is_in = way <= 0.0, own_is_in = own_way <= 0.0;
    if (conflict.kind != map::OverlapKind::crossing && (is_in || conflict.kind == map::OverlapKind::split)) {
      double const place = at + conflict.shift, gap = place - user.rear - own.front;
      if (place > own.s && (gap > 0.0 || own_is_in)) follow(own, {gap, user.speed});
      if (gap > 0.0 || conflict.kind == map::OverlapKind::split) return Claim::free;
    }
    if (own_is_in) return Claim::free;
    if (is_in || !can_stop(user.speed, way)) {
      double const out = (conflict.other_end + reach.rear - at) / std::max(user.speed, standing);
      return out + 0.5 * time_margin < arrival(own, own_way) ? Claim::watch : Claim::blocked;
    }
    if (goes_first(view, conflict, user, at, way, own_way, own)) return Claim::free;
    Window const theirs{
        time_to_cover(way, user.speed, assumed_acceleration, std::max(user.speed, own.idm.desired_speed)),
        (way + conflict.other_end - conflict.other_begin + reach.front + reach.rear) / std::max(user.speed, standing)};
    Window const ours{arrival(own, own_way), arrival(own, conflict.end + own.reach.rear - own.s)};
    if (theirs.end + time_margin < ours.begin) return is_inside(user, at, conflict) ? Claim::watch : Claim::free;
    bool const slips_through = ours.end + time_margin < theirs.begin && !is_inside(user, at, conflict);
    return slips_through ? Claim::free : Claim::yield;
  }

  /// Whether one at position `at` of its way is in the junction already.
  [[nodiscard]] static bool is_inside(LaneUser const& user, double at, map::Conflict const& conflict) {
    return at + user.front > conflict.other_line;
  }

  /// The earliest time [s] at which it has gone `distance` [m].
  [[nodiscard]] static double arrival(Own const& own, double distance) {
    return time_to_cover(distance, own.speed, own.idm.maximum_acceleration, std::max(own.speed, own.idm.desired_speed));
  }

  /// Whether this vehicle, rather than `user`, goes first where both could still stop. Both find the same, as long as
  /// neither has lost its patience.
  template <class View>
  [[nodiscard]] bool goes_first(View const& view, map::Conflict const& conflict, LaneUser const& user, double at,
                                double way, double own_way, Own const& own) const {
    bool const inside = is_inside(user, at, conflict), own_inside = own.front > conflict.line;
    if (inside != own_inside) return own_inside;
    if (!inside && is_valid(conflict.other_light) && view.light(conflict.other_light) == map::LightColor::red)
      return true;
    if (inside) return own_way != way ? own_way < way : view.id() < user.agent;
    bool const stands = user.speed < standing, own_stands = own.speed < standing;
    // Ids part those who lose their patience together: by the golden ratio few are close, and of these the smaller
    // goes.
    bool const is_smaller = view.id() < user.agent;
    double const share = 0.6180339887498949 * static_cast<double>(static_cast<std::uint32_t>(view.id()));
    double const turn = 8.0 * (share - std::floor(share)) + (is_smaller ? 0.0 : 1.0);  // [s]
    if (stands && own.waited >= patience + turn) return true;
    if (own_stands && !stands && user.speed < starting && conflict.other_line - at - user.front < short_way)
      return false;
    if (conflict.right_of_way != map::RightOfWay::equal) return conflict.right_of_way == map::RightOfWay::first;
    return std::abs(own_way - way) > 2.0 ? own_way < way : is_smaller;
  }

  /// Whether there would be no room behind the conflict, as in a queue.
  template <class View>
  [[nodiscard]] bool is_full_behind(View const& view, map::Conflict const& conflict, Own const& own) const {
    if (!keep_clear || own.leader.speed > starting) return false;
    double const end = conflict.end + own.reach.rear - view.shape().rear;  // of the conflict, for rear ends
    double const room = own.front + own.leader.gap - end;
    return room < view.shape().length() + own.idm.minimum_gap;
  }
};
static_assert(BehaviorModel<Intersection>);

}  // namespace cambium
