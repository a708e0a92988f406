#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "cambium/behavior/law/braking.hpp"
#include "cambium/behavior/view.hpp"
#include "cambium/core/described.hpp"
#include "cambium/geometry/shape.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/lanes/signals.hpp"

namespace cambium {

namespace detail {

/// A slow vehicle so close to its line has just started, or is about to stop there [m].
inline constexpr double short_way = 15.0;
/// A vehicle that stands at its line is not beyond it, whatever the rounding [m].
inline constexpr double over_line = 0.1;

/// Length [m] by which a body exceeds the shape for which conflicts are computed, for instance a larger one or one at
/// an angle.
struct ExtraReach {
  double front{}, rear{};
};

/// Another vehicle at position `at` [m] of its way to a conflict (see `map::Conflict::ways`).
struct ConflictUser {
  RoadUser const& user;
  double at;
  ExtraReach reach;
  bool is_behind_slow = false;                            ///< behind a slow vehicle that is not in the junction yet
  double hold = std::numeric_limits<double>::infinity();  ///< where it waits, see `ViewArchetype::waiting_place` [m]

  /// Whether it has passed the line, or the place where it waits.
  [[nodiscard]] bool has_entered(map::ConflictZone const& zone) const {
    return at + user.front > zone.other_line + over_line || at > hold + over_line;
  }
  /// Whether it is inside the junction.
  [[nodiscard]] bool is_inside(map::Conflict const& conflict, map::ConflictZone const& zone) const {
    return has_entered(zone) && at < conflict.other_lane_end;
  }
};

/// Whether a shape needs the conflicts of the large shape.
template <class View>
[[nodiscard]] bool is_large(View const& view, geometry::Shape const& shape) {
  return !view.map().options().conflict_shape.holds(shape);
}

template <class View>
[[nodiscard]] ExtraReach extra_reach(View const& view, bool large, double front, double rear) {
  auto const& options = view.map().options();
  auto const& known = large ? options.large_conflict_shape : options.conflict_shape;
  return {std::max(0.0, front - known.front), std::max(0.0, rear - known.rear)};
}

/// When a vehicle stopped before a junction, as another driver there remembers it.
enum class Arrival : std::uint8_t { earlier, together, later };

/// The vehicles that stood before a junction when a driver stopped there, or had stood there and were about to enter.
/// It holds the lower halves of seven ids; where more stood, unknown vehicles count as earlier.
class StandingAgents {
 public:
  [[nodiscard]] Arrival arrival_of(AgentId id) const {
    auto const at = find(id);
    if (at == size_) return size_ < ids_.size() ? Arrival::later : Arrival::earlier;
    return (together_ >> at & 1) != 0 ? Arrival::together : Arrival::earlier;
  }
  [[nodiscard]] bool holds(AgentId id) const { return find(id) < size_; }
  void add(AgentId id) {
    if (find(id) == size_ && size_ < ids_.size()) ids_[size_++] = lower_half(id);
  }
  /// Marks those that `before`, a step ago, did not hold: they stopped in the same step as the driver.
  void mark_new(StandingAgents const& before) {
    for (std::uint8_t i = 0; i < size_; ++i)
      if (std::find(before.ids_.begin(), before.ids_.begin() + before.size_, ids_[i]) ==
          before.ids_.begin() + before.size_)
        together_ = static_cast<std::uint8_t>(together_ | 1u << i);
  }
  static constexpr char const* name = "standing_agents";
  static constexpr auto parameters() {
    using P = StandingAgents;
    return parameter_list(
        parameter("ids", &P::ids_, "-", Range{0, 65535}, "lower halves of their ids"),
        parameter("size", &P::size_, "-", Range{0, 7}, "how many"),
        parameter("together", &P::together_, "-", Range{0, 255}, "bits: who stopped in the same step"));
  }

  friend bool operator==(StandingAgents const&, StandingAgents const&) = default;

 private:
  [[nodiscard]] static std::uint16_t lower_half(AgentId id) { return static_cast<std::uint16_t>(id); }
  [[nodiscard]] std::size_t find(AgentId id) const {
    return static_cast<std::size_t>(std::find(ids_.begin(), ids_.begin() + size_, lower_half(id)) - ids_.begin());
  }

  std::array<std::uint16_t, 7> ids_{};
  std::uint8_t size_{}, together_{};
};

/// Among the vehicles offered, the one that is next to enter the junction, at most `short_way` before its line.
struct NextToEnter {
  std::optional<RoadUser> user;
  double to_line = short_way;

  void offer(RoadUser const& other, double other_to_line) {
    if (other_to_line < -over_line || other_to_line > to_line) return;
    to_line = other_to_line;
    user = other;
  }
};

/// The own vehicle before a conflict.
struct ConflictAsker {
  double s{}, front{};                     ///< corridor positions of its reference point and its front end [m]
  double speed{};                          ///< [m/s]
  double waited{};                         ///< time at a standstill there [s]
  double patience{};                       ///< see `Intersection::patience` [s]
  StandingAgents const* stopped_before{};  ///< those that stood there when it stopped
  bool is_large = false;                   ///< see `map::ConflictZones`
  double dt{};                             ///< length of the step [s]
  double braking{};                        ///< deceleration by which vehicles can stop [m/s^2]

  [[nodiscard]] bool is_inside(map::Conflict const& conflict, map::ConflictZone const& zone) const {
    return (front > zone.line + over_line || s > conflict.hold_among_equals(is_large) + over_line) &&
           s < conflict.lane_end;
  }
};

/// Whether neither priorities nor lights say who goes first.
template <class View>
[[nodiscard]] bool is_by_arrival(View const& view, map::Conflict const& conflict) {
  auto const is_off = [&](LightId light) { return !is_valid(light) || view.light(light) == map::LightColor::off; };
  if (conflict.is_signed) return false;
  return conflict.right_of_way == map::RightOfWay::equal || (is_off(conflict.light) && is_off(conflict.other_light));
}

/// Whether lights let both go at the same time, as those that turn left and oncoming traffic.
template <class View>
[[nodiscard]] bool go_together(View const& view, map::Conflict const& conflict) {
  auto const goes = [&](LightId light) {
    if (!is_valid(light)) return false;
    auto const color = view.light(light);
    return color == map::LightColor::green || color == map::LightColor::yellow;
  };
  return goes(conflict.light) && goes(conflict.other_light);
}

/// Whether the other vehicle leaves its place to wait before the own one, while both are outside: it can no longer stop
/// there, or will not be able to after this step if it accelerates by `pull_away`, and it is nearer (at equal distance:
/// has the smaller id). All drivers find the same order, so only one of the vehicles in conflict leaves per step,
/// unless some accelerate harder. If several left at once, each would be inside for the others a step later, and three
/// could form a ring.
[[nodiscard]] inline bool leaves_first(map::Conflict const& conflict, ConflictUser const& other,
                                       ConflictAsker const& own, bool is_smaller) {
  auto const& user = other.user;
  double const to_hold = other.hold - other.at, own_to_hold = conflict.hold_among_equals(own.is_large) - own.s;
  if (user.speed < standing_speed || !can_stop(own.speed, own_to_hold, own.braking)) return false;
  if (!can_stop(user.speed, to_hold, own.braking)) return true;
  double const speed = user.speed + pull_away * own.dt;
  if (can_stop(speed, to_hold - 0.5 * (user.speed + speed) * own.dt, own.braking)) return false;
  return to_hold != own_to_hold ? to_hold < own_to_hold : !is_smaller;
}

/// Whether the own vehicle goes before `other`, where both can still stop before the zone, `own_way` and `way` [m]
/// ahead of them. The first rule that applies decides:
/// - One by one: where neither priorities nor lights say who goes first, a driver does not leave its place to wait in
///   the same step as another driver that is nearer to its own (`leaves_first`).
/// - First come, first served: where neither priorities nor lights say who goes first, a driver that stands at its line
///   goes before one that stopped there later or has yet to stop. With right before left alone, four drivers would wait
///   for each other again and again.
/// - Patience: a driver that has waited too long for a standing vehicle goes.
/// - At green, oncoming traffic goes before a vehicle that waits in the junction to turn across it.
/// - A vehicle inside the junction goes before one outside. Of two inside, the one that can leave it first goes.
/// - A vehicle before a red light waits.
/// - A standing driver lets a vehicle go that has just started close to its line.
/// - Right of way by map, signs and rules (`map::right_of_way`).
/// - Without right of way, the nearer vehicle goes; at about equal distance, the one with the smaller id.
///
/// Two drivers disagree only by the second and third rules, which ask how long a driver has stood: both may start at
/// once. Then the first to leave its place has the zone, and the other one stops, as it can.
///
/// O(1).
template <class View>
[[nodiscard]] bool goes_first(View const& view, map::Conflict const& conflict, map::ConflictZone const& zone,
                              ConflictUser const& other, double way, double own_way, ConflictAsker const& own) {
  constexpr double spread = 8.0;      // [s] range over which ids spread the end of patience
  constexpr double later = 20.0;      // [s] more for the larger id, and if only one of the two is in the junction
  constexpr double for_order = 10.0;  // [s] more where those who came earlier go first
  auto const& [user, at, reach, is_behind_slow, hold] = other;
  bool const stands = user.speed < standing_speed, own_stands = own.speed < standing_speed;
  bool const is_smaller = view.id() < user.agent, is_patient = own.waited < own.patience;
  bool const inside = other.is_inside(conflict, zone), own_inside = own.is_inside(conflict, zone);
  bool const in_order = !inside && !own_inside && is_by_arrival(view, conflict);
  if (in_order && leaves_first(conflict, other, own, is_smaller)) return false;
  bool const by_arrival = in_order && !is_patient;
  double const to_line = zone.other_line - at - user.front;
  // Without that order, all count as having come together.
  auto const arrival = by_arrival ? own.stopped_before->arrival_of(user.agent) : Arrival::together;
  bool const has_to_stop = is_behind_slow || (user.speed < starting_speed && to_line < short_way);
  if (arrival == Arrival::later && has_to_stop) return true;
  if (stands && !is_patient) {
    // Two drivers must not lose their patience together. Of two that wait for each other, the smaller id goes long
    // before the other; the golden ratio spreads the ids of a ring of waiting drivers.
    double const share = 0.6180339887498949 * static_cast<double>(static_cast<std::uint32_t>(view.id()));
    double const turn = spread * (share - std::floor(share)) + (is_smaller ? 0.0 : later);  // [s]
    double const extra = inside != own_inside ? later : arrival == Arrival::earlier ? for_order : 0.0;
    if (own.waited >= own.patience + turn + extra) return true;
  }
  bool const has_way = conflict.right_of_way == map::RightOfWay::first;
  bool const is_decided = conflict.right_of_way != map::RightOfWay::equal;
  bool const at_green = is_decided && go_together(view, conflict);
  if (inside != own_inside) return at_green && own_inside != has_way ? has_way : own_inside;
  if (!inside && is_valid(conflict.other_light) && view.light(conflict.other_light) == map::LightColor::red)
    return true;
  if (inside) {
    // Both drivers find the same two times, which keep their order once one of the two brakes and the other does not.
    constexpr double highest = std::numeric_limits<double>::infinity();
    double const later_by = time_to_cover(conflict.other_lane_end - at, user.speed, pull_away, highest) -
                            time_to_cover(conflict.lane_end - own.s, own.speed, pull_away, highest);
    return std::abs(later_by) > 1e-6 ? later_by > 0.0 : is_smaller;
  }
  if (arrival == Arrival::earlier && to_line < short_way) return false;
  if (own_stands && !stands && !at_green && user.speed < starting_speed && to_line < short_way) return false;
  if (is_decided) return has_way;
  return std::abs(own_way - way) > 2.0 ? own_way < way : is_smaller;
}

}  // namespace detail

}  // namespace cambium
