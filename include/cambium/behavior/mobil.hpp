#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <tuple>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/idm.hpp"
#include "cambium/behavior/lane_change.hpp"

namespace cambium {

/// What the followers of a lane change would gain: accelerations [m/s^2] now and after the change.
struct MobilSituation {
  double own{}, own_after{};
  double new_follower{}, new_follower_after{};
  double old_follower{}, old_follower_after{};
};

/// MOBIL's parameters as fields of a parameter struct: what `mobil_incentive` and `mobil_is_safe` ask for.
template <class P>
concept HasMobilParameters = requires(P const p) {
  p.politeness;
  p.threshold;
  p.safe_deceleration;
};

/// Safety criterion (Kesting, Treiber, Helbing 2007, eq. 2), for the changing vehicle too.
template <HasMobilParameters P>
[[nodiscard]] bool mobil_is_safe(P const& p, MobilSituation const& at) {
  return at.new_follower_after >= -p.safe_deceleration && at.own_after >= -p.safe_deceleration;
}

/// How far the incentive exceeds the threshold (Kesting, Treiber, Helbing 2007, eq. 3) [m/s^2]: above 0, changing is
/// worth it.
template <HasMobilParameters P>
[[nodiscard]] double mobil_incentive(P const& p, MobilSituation const& at) {
  double const others = at.new_follower_after - at.new_follower + at.old_follower_after - at.old_follower;
  return at.own_after - at.own + p.politeness * others - p.threshold;
}

/// Lane changing by MOBIL (Kesting, Treiber, Helbing 2007, "General lane-changing model MOBIL for car-following
/// models"), car following by IDM. Changes where that pays for itself and, weighed by `politeness`, for the old and the
/// new follower, and nobody has to brake harder than `safe_deceleration`. A change takes time, follows a smooth course,
/// and is aborted as long as the vehicle is in its old lane, when it has become unsafe. Other drivers are taken to
/// have the parameters `others` (long vehicles: `trucks`), and at least the desired speed that they show.
struct Mobil {
  IdmParameters idm{};
  IdmParameters others{};
  IdmParameters trucks{.desired_speed = 23.0, .time_headway = 1.7, .maximum_acceleration = 0.9};
  double truck_length = 7.5;
  double politeness = 0.2;
  double threshold = 0.2;
  double safe_deceleration = 4.0;
  double bias = 0.0;
  bool keep_right = false;
  double critical_speed = 16.7;
  double route_bias = 2.0;
  double route_horizon = 300.0;
  double minimum_remaining = 60.0;
  double rest = 3.0;
  bool heed_marks = true;
  LaneChangeCourse course{};
  double tolerance = 1e-4;

  static constexpr char const* name = "mobil";
  static constexpr auto parameters() {
    return std::make_tuple(
        parameter("idm", &Mobil::idm, "-", {}, "the driver's own car following"),
        parameter("others", &Mobil::others, "-", {}, "what it assumes of other drivers"),
        parameter("trucks", &Mobil::trucks, "-", {}, "what it assumes of drivers of long vehicles"),
        parameter("truck_length", &Mobil::truck_length, "m", Range{0, 100}, "vehicles longer than this are trucks"),
        parameter("politeness", &Mobil::politeness, "-", Range{-1, 10}, "weight of the followers' accelerations"),
        parameter("threshold", &Mobil::threshold, "m/s^2", Range{0, 10}, "advantage that makes a change worth it"),
        parameter("safe_deceleration", &Mobil::safe_deceleration, "m/s^2", Range{0, 20},
                  "nobody is made to brake harder"),
        parameter("bias", &Mobil::bias, "m/s^2", Range{-10, 10}, "in favour of the right lane; left: negative"),
        parameter("keep_right", &Mobil::keep_right, "-", Range{0, 1},
                  "European rule: no passing on the right above critical_speed (eq. 5 to 7)"),
        parameter("critical_speed", &Mobil::critical_speed, "m/s", Range{0, 100},
                  "below it, in congestion, keep_right lets pass on the right"),
        parameter("route_bias", &Mobil::route_bias, "m/s^2", Range{0, 20},
                  "in favour of the lane that the route needs, at its end"),
        parameter("route_horizon", &Mobil::route_horizon, "m", Range{0, 10'000},
                  "from how far before a lane's end it counts"),
        parameter("minimum_remaining", &Mobil::minimum_remaining, "m", Range{0, 10'000},
                  "no change, but for the route, into a lane that ends sooner"),
        parameter("rest", &Mobil::rest, "s", Range{0, 600}, "no further change within this time of the last"),
        parameter("heed_marks", &Mobil::heed_marks, "-", Range{0, 1}, "change only where the road marks permit it"),
        parameter("course", &Mobil::course, "-", {}, "how long a change takes"),
        parameter("tolerance", &Mobil::tolerance, "m/s^2", Range{1e-12, 1},
                  "error of the exact integration, as speed per second"));
  }

  struct Memory {
    LaneChange change{};
    float rest{};  ///< [s] until the next change may begin

    friend bool operator==(Memory const&, Memory const&) = default;
  };

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory& memory, double dt) const {
    double const speed = std::max(0.0, view.state().speed);
    auto const follow = [&](std::optional<Neighbor> const& leader) {
      return leader ? idm_acceleration(idm, speed, leader->gap, leader->speed)
                    : idm_acceleration(idm, speed, free_road, 0.0);
    };
    auto leader = view.front();
    memory.rest = std::max(0.0f, memory.rest - static_cast<float>(dt));
    if (!memory.change.active()) {
      if (memory.rest == 0.0f) consider(view, follow, leader, memory);
    } else if (memory.change.target != view.lane_position().corridor &&
               !is_safe(view, follow, view.neighbors(memory.change.target))) {
      memory.change = course.begin(view.lane_position().corridor, speed);
    }
    if (memory.change.active() && memory.change.target != view.lane_position().corridor)
      leader = more_restrictive(leader, view.neighbors(memory.change.target).front,
                                [&](Neighbor const& n) { return follow(n); });
    double const gap = leader ? leader->gap : free_road, leader_speed = leader ? leader->speed : 0.0;
    return plan_lane_change(view, memory.change, idm_motion(idm, speed, gap, leader_speed, dt, tolerance), dt);
  }

 private:
  static constexpr double free_road = std::numeric_limits<double>::infinity();

  /// IDM of a follower as this driver assumes it. Objects stand: they neither gain nor lose.
  [[nodiscard]] double follower(std::optional<Neighbor> const& who, double gap, double leader_speed) const {
    if (!who || !is_valid(who->agent)) return 0.0;
    auto assumed = who->length > truck_length ? trucks : others;
    assumed.desired_speed = std::max(assumed.desired_speed, who->speed);
    return idm_acceleration(assumed, std::max(0.0, who->speed), gap, leader_speed);
  }

  template <class View, class Follow>
  [[nodiscard]] bool is_safe(View const& view, Follow const& follow, Neighbors const& there) const {
    double const gap = there.rear ? there.rear->gap : free_road;
    return mobil_is_safe(
        *this, {.own_after = follow(there.front), .new_follower_after = follower(there.rear, gap, view.state().speed)});
  }

  /// Begins the change that pays most, if one pays.
  template <class View, class Follow>
  void consider(View const& view, Follow const& follow, std::optional<Neighbor> const& front, Memory& memory) const {
    auto const& at = view.lane_position();
    auto const& piece = view.corridor().pieces[at.piece];
    if (piece.left == map::no_corridor && piece.right == map::no_corridor) return;
    double const own = follow(front), length = view.shape().length();
    auto const rear = view.rear();
    MobilSituation situation{.own = own};
    situation.old_follower = follower(rear, rear ? rear->gap : 0.0, view.state().speed);
    situation.old_follower_after = follower(rear, gap_without(rear, front, length), front ? front->speed : 0.0);
    double best = 0.0;
    for (bool const left : {true, false}) {
      auto const side = left ? piece.left : piece.right;
      if (side == map::no_corridor || !marks_permit(view, left)) continue;
      auto const there = view.neighbors(side);
      auto const& corridor = view.road().corridors[side];
      if (!corridor.reaches_destination && corridor.length_until_end(there.position.s) < minimum_remaining) continue;
      double const gap = there.rear ? there.rear->gap : free_road;
      situation.own_after = follow(there.front);
      situation.new_follower =
          follower(there.rear, gap_without(there.rear, there.front, length), there.front ? there.front->speed : 0.0);
      situation.new_follower_after = follower(there.rear, gap, view.state().speed);
      if (!mobil_is_safe(*this, situation)) continue;
      double const worth =
          incentive(situation, front, there.front, view.state().speed, left) + towards_route(view, left);
      if (worth <= best) continue;
      best = worth;
      memory.change = course.begin(side, view.state().speed);
      memory.rest = static_cast<float>(rest + course.duration);
    }
  }

  /// The gap that a follower has when this vehicle, between it and its leader, is not there.
  [[nodiscard]] static double gap_without(std::optional<Neighbor> const& rear, std::optional<Neighbor> const& front,
                                          double length) {
    return rear && front ? rear->gap + length + front->gap : free_road;
  }

  [[nodiscard]] double incentive(MobilSituation situation, std::optional<Neighbor> const& front,
                                 std::optional<Neighbor> const& beside, double speed, bool left) const {
    double const to_the_right = left ? -bias : bias;
    if (!keep_right) return mobil_incentive(*this, situation) + to_the_right;
    // Eq. 5 to 7: on the right nobody is passed, and only the follower on the left counts.
    auto const& in_left_lane = left ? beside : front;
    if (in_left_lane && speed > in_left_lane->speed && in_left_lane->speed > critical_speed)
      (left ? situation.own : situation.own_after) = std::min(situation.own, situation.own_after);
    if (left)
      situation.old_follower = situation.old_follower_after = 0.0;
    else
      situation.new_follower = situation.new_follower_after = 0.0;
    return mobil_incentive(*this, situation) + to_the_right;
  }

  template <class View>
  [[nodiscard]] bool marks_permit(View const& view, bool left) const {
    if (!heed_marks) return true;
    auto const& at = view.lane_position();
    auto const& piece = view.corridor().pieces[at.piece];
    auto const& lane = view.map().lane(piece.lane);
    double const s = at.s + piece.lane_offset;
    return left ? lane.may_change_left(s) : lane.may_change_right(s);
  }

  /// Bonus of a change to the side where the lane is that the route needs; malus of one that leads away.
  template <class View>
  [[nodiscard]] double towards_route(View const& view, bool left) const {
    auto const& at = view.lane_position();
    auto const& road = view.road();
    double const remaining = view.corridor().length_until_end(at.s);
    if (route_bias == 0.0 || remaining > route_horizon || !road.corridors[road.main].reaches_destination) return 0.0;
    auto const needs = [&](bool leftwards) {
      for (LaneId lane = view.corridor().pieces[at.piece].lane; is_valid(lane);) {
        lane = leftwards ? view.map().lane(lane).left_neighbor : view.map().lane(lane).right_neighbor;
        if (is_valid(lane) && road.corridor_of(lane) == road.main) return true;
      }
      return false;
    };
    double const bonus = route_bias * (1.0 - remaining / route_horizon);
    if (at.corridor == road.main) return -bonus;
    return needs(left) ? bonus : needs(!left) ? -bonus : 0.0;
  }
};
static_assert(BehaviorModel<Mobil>);

}  // namespace cambium
