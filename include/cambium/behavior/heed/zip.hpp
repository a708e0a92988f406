#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "cambium/behavior/law/constraint.hpp"
#include "cambium/behavior/law/gap_before_merge.hpp"
#include "cambium/behavior/view.hpp"
#include "cambium/core/described.hpp"

namespace cambium::inline v0_1 {

/// Zip merge: the driver keeps its lane up to the merge and there lets one vehicle of the other lane in between itself
/// and its leader. This is the alternating order of the German StVO, section 7 (4):
///
///   own lane        [4]       [2] -----.
///                                       merge ----->    order: 1, 2, 3, 4
///   other lane          [3]       [1] -'
///
/// The vehicle to let in is the first one of the other lane behind the own leader, if it is ahead, beside, or at most
/// `reach` behind. A driver without a leader lets a vehicle in that is closer to the merge. The gap opens gradually, in
/// proportion to the distance to the merge. After `patience` at a standstill the driver goes as soon as there is room.
struct Zip {
  double zone = 200.0;
  double reach = 12.0;
  double patience = 4.0;

  static constexpr char const* name = "zip";
  static constexpr char const* summary = "at a merge, lets one vehicle from the other lane in before itself";
  static constexpr char const* source = "rule: StVO section 7 (4); control of the gap: own";
  static constexpr auto parameters() {
    using P = Zip;
    return parameter_list(
        parameter("zone", &P::zone, "m", Range{1, 400}, "distance before a merge at which it begins to give way"),
        parameter("reach", &P::reach, "m", Range{0, 100}, "how far behind a vehicle may be and still be let in"),
        parameter("patience", &P::patience, "s", Range{0, 600},
                  "at a standstill, until it stops waiting for vehicles behind"));
  }

  struct Memory {
    AgentId ahead = none<AgentId>;  ///< the last leader in the own lane before the merge
    float stood{};                  ///< time at a standstill [s]

    static constexpr char const* name = "zip_memory";
    static constexpr auto parameters() {
      using P = Memory;
      return parameter_list(parameter("ahead", &P::ahead, "the last leader in the own lane before the merge"),
                            parameter("stood", &P::stood, "s", any_finite, "at a standstill"));
    }

    friend bool operator==(Memory const&, Memory const&) = default;
  };

  /// Before a merge the law ignores the other lane: the driver opens a gap for those alone whom it lets in.
  template <class View>
  [[nodiscard]] Merging merging(View const& view, Merging counted) const {
    return next_merge(view) < infinite ? Merging::ignored : counted;
  }

  template <class View, class Limits>
  void heed(View const& view, Memory& memory, Limits& limits, double dt) const {
    double const speed = limits.response().speed(), merge = next_merge(view);
    wait(memory, speed, dt);
    auto const leader = view.ahead({.merging = limits.merging});
    if (merge == infinite) {
      if (leader) memory.ahead = leader->agent;
      return;
    }
    if (auto const other = let_in(view, limits.law().minimum_gap, memory, leader, merge)) {
      double const front = view.place().s + view.shape().front;
      double const to_merge = merge - front - speed * dt;  // when the step ends: the law takes the gap as given
      auto constraint = detail::constraint_beside<typename Limits::Response>(view, *other);
      constraint.gap = gap_to_open(to_merge, other->s - other->rear - front, speed, other->speed);
      limits.heed(constraint);
    }
  }

 private:
  static constexpr double infinite = std::numeric_limits<double>::infinity();
  /// Highest deceleration of a vehicle ahead to let another one in [m/s^2].
  static constexpr double comfortable = 2.0;

  /// Gap [m] for following a vehicle of the other lane, where `gap` is the actual one. It is larger the farther the
  /// merge is, so that the gap opens gradually, and includes most of what a faster vehicle opens by itself. It never
  /// exceeds the larger of `gap` and the distance to the merge.
  [[nodiscard]] static double gap_to_open(double to_merge, double gap, double speed, double other_speed) {
    constexpr double trust = 0.7;
    if (!(to_merge > 0.0)) return gap;
    double const opening = trust * (other_speed - speed) * to_merge / std::max(speed, 1.0);
    return std::min(gap + std::max(opening_share * to_merge, opening), std::max(gap, to_merge));
  }

  /// Counts the time at a standstill. A driver that has lost its patience and starts regains it only at driving speed.
  void wait(Memory& memory, double speed, double dt) const {
    constexpr double creeps = 0.3, drives = 5.0;  // [m/s] who creeps in a queue waits as well
    if (speed < creeps)
      memory.stood += static_cast<float>(dt);
    else if (memory.stood <= static_cast<float>(patience) || speed > drives)
      memory.stood = 0.0f;
  }

  /// Deceleration [m/s^2] with which `one` arrives at the merge after `other` has cleared it. Here and below, the `gap`
  /// of a vehicle is that from its front end to the merge.
  [[nodiscard]] static double braking_after(RoadUser const& other, RoadUser const& one, double minimum_gap) {
    if (!(one.speed > 0.0)) return 0.0;
    if (!(one.gap > 0.0)) return infinite;
    double const way = std::max(0.0, other.gap + other.length() + minimum_gap);
    double const time = way / std::max(other.speed, 1.0);
    double const too_far = one.speed * time - one.gap;
    if (too_far <= 0.0) return 0.0;
    double const evenly = 2.0 * too_far / (time * time);
    return evenly * time < one.speed ? evenly : one.speed * one.speed / (2.0 * one.gap);
  }

  /// Whether `one` lets `other` in when it is that one's turn: `other` must not be too far behind, and `one` must not
  /// have to brake hard, unless `other` would have to brake even harder. Both drivers come to the same result.
  [[nodiscard]] bool gives_way(RoadUser const& one, RoadUser const& other, double minimum_gap) const {
    return other.gap < one.gap + reach &&
           braking_after(other, one, minimum_gap) <= std::max(comfortable, braking_after(one, other, minimum_gap));
  }

  /// Whether the vehicle ahead is on the own path; near the merge, vehicles of the other lane are still beside it.
  template <class View>
  [[nodiscard]] bool is_on_path(View const& view, RoadUser const& leader, double s) const {
    constexpr double beside = 1.5;  // [m]
    if (!is_valid(leader.agent)) return true;
    auto const& center = view.corridor().center;
    auto const& state = view.state(leader);
    return std::abs(center.project({state.x, state.y}, center.find(s)).lateral) < beside;
  }

  /// Position of the next merge within the zone on the own corridor [m]; infinite without one.
  template <class View>
  [[nodiscard]] double next_merge(View const& view) const {
    double const s = view.place().s;
    for (auto const& feeder : view.corridor().feeders) {
      if (feeder.begin > s + zone) break;
      if (feeder.is_still_to_merge() && feeder.free_until > s && feeder.free_until < s + zone) return feeder.free_until;
    }
    return infinite;
  }

  /// The vehicle of the other lane that goes before this one, if any.
  template <class View>
  [[nodiscard]] std::optional<RoadUser> let_in(View const& view, double minimum_gap, Memory& memory,
                                               std::optional<RoadUser> const& leader, double merge) const {
    auto const& at = view.place();
    auto const& shape = view.shape();
    RoadUser const own{.gap = merge - (at.s + shape.front),
                       .s = at.s,
                       .front = shape.front,
                       .rear = shape.rear,
                       .speed = std::max(0.0, view.state().speed)};
    auto const coming = [&](RoadUser other) {
      other.gap = merge - other.s - other.front;
      other.speed = std::max(0.0, other.speed);
      return other;
    };
    auto first = whose_turn(view, minimum_gap, memory, leader, merge, own, coming);
    // Vehicles behind it go first, too, even though it is not their turn, if they do not give way. Drivers of other
    // kinds follow whoever is ahead: one that is still ahead where it is high time to brake for it, and does not brake
    // itself, may be one of these.
    constexpr double high_time = 3.0, brakes = 1.0;  // [m/s^2]
    auto const insists = [&](RoadUser const& other) {
      return !gives_way(coming(other), own, minimum_gap) ||
             (other.s > at.s && braking_after(coming(other), own, minimum_gap) > high_time &&
              !(is_valid(other.agent) && view.acceleration(other) < -brakes));
    };
    for (auto next = view.merging(merge, first ? first->s - first->rear : infinite);
         next && (!first || next->s < first->s) && insists(*next); next = view.merging(merge, first->s - first->rear))
      first = next;
    return first;
  }

  /// The vehicle of the other lane that is next by turns, unless it is the own turn.
  template <class View, class Measure>
  [[nodiscard]] std::optional<RoadUser> whose_turn(View const& view, double minimum_gap, Memory& memory,
                                                   std::optional<RoadUser> const& leader, double merge,
                                                   RoadUser const& own, Measure const& coming) const {
    double const s = view.place().s;
    auto const is_impatient = [&](RoadUser const& other) { return memory.stood > patience && other.s < s; };
    if (!leader) {  // without a leader, the vehicle closer to the merge goes first
      auto const other = view.merging(merge, infinite);
      constexpr double equal = 0.5;  // [m]
      bool const is_first = other && other->s > s - (other->agent < view.id() ? equal : -equal);
      return is_first && !is_impatient(*other) ? other : std::nullopt;
    }
    double const rear_of_leader = merge - own.gap + leader->gap;
    if (rear_of_leader < merge && is_on_path(view, *leader, rear_of_leader)) memory.ahead = leader->agent;
    if (leader->agent != memory.ahead) return std::nullopt;  // the other lane has had its turn
    auto const other = view.merging(merge, rear_of_leader);
    if (!other || !gives_way(own, coming(*other), minimum_gap)) return std::nullopt;
    return is_impatient(*other) ? std::nullopt : other;
  }
};
}  // namespace cambium::inline v0_1
