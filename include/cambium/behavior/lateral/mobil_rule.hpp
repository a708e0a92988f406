#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "cambium/behavior/lateral/change_lanes.hpp"
#include "cambium/behavior/lateral/corridor_filters.hpp"
#include "cambium/core/macros.hpp"

namespace cambium::inline v0_1 {

/// Accelerations [m/s^2] of the driver and both followers, now and after a lane change.
struct MobilSituation {
  double own{}, own_after{};
  double new_follower{}, new_follower_after{};
  double old_follower{}, old_follower_after{};
};

/// Incentive of a lane change above the threshold [m/s^2] (Kesting, Treiber, Helbing 2007, eq. 3); a change is
/// worthwhile if it is above 0. `P` has the parameters `politeness` [-] and `threshold` [m/s^2].
template <class P>
[[nodiscard]] double mobil_incentive(P const& p, MobilSituation const& at) {
  double const others = at.new_follower_after - at.new_follower + at.old_follower_after - at.old_follower;
  return at.own_after - at.own + p.politeness * others - p.threshold;
}

/// Lane changing by MOBIL (Kesting, Treiber, Helbing 2007, "General lane-changing model MOBIL for car-following
/// models"). The driver compares accelerations, its own by its law and the followers' by IDM, now and after a change:
///
///   own_after - own + politeness (new_follower_after - new_follower + old_follower_after - old_follower) > threshold
///
///   target lane   [new follower]  ->   ( own after )   [new leader]
///   own lane       [old follower]  ->   [own]              [leader]
///
/// It changes to the side with the largest incentive if that is also safe. `ChangeLanes` defines what is safe and
/// carries out the change. `bias` and `keep_right` shift the incentive between the sides, `route_bias` towards the
/// lanes that go further. A driver without a goal does not pass in an exit lane within `route_horizon` before the exit.
/// A driver who must leave its lane adapts its speed to the lane that it needs. Without `keep_right`, a gain of the new
/// follower does not count: nobody cuts in to keep a vehicle from braking for another.
///
/// `Filters`: further conditions, see `corridor_filters.hpp`; MOBIL as published has none.
template <class... Filters>
struct MobilRule {
  double politeness = 0.2;
  double threshold = 0.2;
  double bias = 0.0;
  bool keep_right = false;
  double critical_speed = 16.7;
  double route_bias = 2.0;
  double route_horizon = 300.0;
  double minimum_remaining = 60.0;
  [[no_unique_address]] AllOf<Filters...> filters{};

  static constexpr char const* name = "mobil";
  static constexpr char const* summary =
      "changes lanes if a_new - a_old + politeness (gains of new and old follower) > threshold + bias, and the "
      "new follower need not brake harder than is safe; parameters are the driver's own";
  static constexpr char const* source = "Kesting, Treiber, Helbing 2007, eq. 2 to 7";
  static constexpr auto parameters() {
    using P = MobilRule;
    auto const own = parameter_list(
        parameter("politeness", &P::politeness, "-", Range{-1, 10}, "weight of the followers' accelerations"),
        parameter("threshold", &P::threshold, "m/s^2", Range{0, 10}, "advantage that makes a change worthwhile"),
        parameter("bias", &P::bias, "m/s^2", Range{-10, 10},
                  "in favour of the outer lane (right; in left-hand traffic left); negative: of the inner lane"),
        parameter("keep_right", &P::keep_right,
                  "European rule: no passing on the outer side above critical_speed (eq. 5 to 7)"),
        parameter("critical_speed", &P::critical_speed, "m/s", Range{0, 100},
                  "below it, in congestion, keep_right permits passing on the outer side"),
        parameter("route_bias", &P::route_bias, "m/s^2", Range{0, 20},
                  "in favour of a lane that goes further than the own one"),
        parameter("route_horizon", &P::route_horizon, "m", Range{1, 10'000},
                  "distance before a lane's end from which it counts, for each lane to cross"),
        parameter("minimum_remaining", &P::minimum_remaining, "m", Range{0, 10'000},
                  "length of the new lane that must remain after changing there and back, unless the route needs the "
                  "change"));
    if constexpr (sizeof...(Filters) > 0)
      return join_parameters(own, parameter_list(parameter("filters", &P::filters, "further conditions")));
    else
      return own;
  }

  template <class Choice>
  [[nodiscard]] CorridorId operator()(Choice const& now) const {
    if (keep_right) pass_nobody_outside(now);
    return now.may_change ? best_side(now) : none<CorridorId>;
  }

 private:
  /// The side with the largest incentive, or none.
  template <class Choice>
  [[nodiscard]] CorridorId best_side(Choice const& now) const {
    auto const& view = now.view;
    auto const& piece = view.corridor().pieces[view.place().piece];
    if (piece.left == none<CorridorId> && piece.right == none<CorridorId>) return none<CorridorId>;
    MobilSituation situation{.own = now.limits.acceleration()};
    if (auto const rear = view.behind(now.look()))
      std::tie(situation.old_follower, situation.old_follower_after) = followers_view(now, rear, now.leader);
    // The incentive without the own acceleration after the change: a side that cannot become worthwhile is skipped.
    double const others =
        politeness * (situation.old_follower_after - situation.old_follower) - situation.own - threshold;
    bool const goes_on = now.lane_end == free_road, is_prejudged = politeness >= 0.0 && !keep_right;
    if (is_prejudged && goes_on && others + std::abs(bias) + now.limits.response()(Constraint{}) <= 0.0)
      return none<CorridorId>;
    auto const urgency = goes_on ? LaneUrgency{} : lane_urgency(view, route_horizon);
    bool const inner_is_left = !keeps_left(view, piece.lane);
    double best = 0.0;
    auto target = none<CorridorId>;
    for (bool const left : {true, false}) {
      auto const side = piece.beside(left);
      if (side == none<CorridorId> || !now.changing.marks_permit(view, view.place(), left)) continue;
      bool const inwards = left == inner_is_left;
      LaneOption option{view.place(side), left, {}, {}};
      double const end = lane_end(view, side, option.place.piece), remaining = end - option.place.s;
      double const urge =
          !goes_on ? (left ? urgency.left : urgency.right) : -std::max(0.0, 1.0 - remaining / route_horizon);
      if (urge <= 0.0 && !now.may_return(option, remaining, minimum_remaining)) continue;
      if (urge <= 0.0 && remaining < route_horizon && is_way_out(view, side, end)) continue;
      double const pull = (inwards ? -bias : bias) + route_bias * urge;
      option.front = view.ahead(option.place, now.look());
      if (urge > 0.0 && !goes_on) now.adapt_to(option.front);
      situation.own_after = now.response(option);
      if (is_prejudged && others + situation.own_after + pull <= best) continue;
      option.rear = view.behind(option.place, now.look());
      double const worth = worth_of(now, situation, option, inwards) + pull;
      if (!(worth > best) || !now.is_safe(option) || !filters(view, option)) continue;
      best = worth;
      target = side;
    }
    return target;
  }

  /// Acceleration of a follower behind this vehicle, and behind `front` once this vehicle has left.
  template <class Choice>
  [[nodiscard]] std::pair<double, double> followers_view(Choice const& now, std::optional<RoadUser> const& rear,
                                                         std::optional<RoadUser> const& front) const {
    if (!rear || !is_valid(rear->agent)) return {0.0, 0.0};
    auto const law = now.changing.law_of(*rear);
    double const behind = law(rear->gap, now.limits.response().speed());
    if (!front) return {behind, law.free()};
    return {behind, law(rear->gap + now.view.shape().length() + front->gap, front->speed)};
  }

  template <class Choice>
  [[nodiscard]] double worth_of(Choice const& now, MobilSituation situation, LaneOption const& option,
                                bool inwards) const {
    std::tie(situation.new_follower_after, situation.new_follower) = followers_view(now, option.rear, option.front);
    if (keep_right) {
      // Eq. 5 to 7: nobody passes on the outer side, and only the follower in the inner lane counts.
      auto const& in_inner_lane = inwards ? option.front : now.leader;
      if (in_inner_lane && now.limits.response().speed() > in_inner_lane->speed &&
          in_inner_lane->speed > critical_speed)
        (inwards ? situation.own : situation.own_after) = std::min(situation.own, situation.own_after);
      if (inwards)
        situation.old_follower = situation.old_follower_after = 0.0;
      else
        situation.new_follower = situation.new_follower_after = 0.0;
    } else if (situation.new_follower_after > situation.new_follower) {
      situation.new_follower_after = situation.new_follower;  // so that `best_side` may reject without knowing it
    }
    return mobil_incentive(*this, situation);
  }

  /// Eq. 5 for the own lane: a driver faster than the leader in the inner lane follows that leader, too.
  template <class Choice>
  CAMBIUM_NOINLINE void pass_nobody_outside(Choice const& now) const {
    auto const& piece = now.view.corridor().pieces[now.view.place().piece];
    auto const inner = keeps_left(now.view, piece.lane) ? piece.right : piece.left;
    if (inner == none<CorridorId>) return;
    auto const there = now.view.ahead(now.view.place(inner));
    if (there && there->speed > critical_speed) now.adapt_to(there);
  }

  template <class View>
  [[nodiscard]] bool keeps_left(View const& view, LaneId lane) const {
    if ((bias == 0.0 && !keep_right) || !is_valid(lane)) return false;
    return view.map().road(view.map().lane(lane).road).left_hand_traffic;
  }

  static constexpr double free_road = std::numeric_limits<double>::infinity();
};

}  // namespace cambium::inline v0_1
