#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "cambium/behavior/law/braking.hpp"
#include "cambium/behavior/view.hpp"
#include "cambium/geometry/shape.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/lanes/signals.hpp"

namespace cambium {

namespace detail {

/// A vehicle slower than this at a junction has hardly begun to move, or is about to stop [m/s].
inline constexpr double starting_speed = 2.5;
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

  /// Whether it is inside the junction already.
  [[nodiscard]] bool is_inside(map::Conflict const& conflict, map::ConflictZone const& zone) const {
    return at + user.front > zone.other_line + over_line && at < conflict.other_lane_end;
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

/// The own vehicle before a conflict.
struct ConflictAsker {
  double s{}, front{};  ///< corridor positions of its reference point and its front end [m]
  double speed{};       ///< [m/s]
  double waited{};      ///< time at a standstill there [s]
  double patience{};    ///< see `Intersection::patience` [s]

  [[nodiscard]] bool is_inside(map::Conflict const& conflict, map::ConflictZone const& zone) const {
    return front > zone.line + over_line && s < conflict.lane_end;
  }
};

/// Whether the own vehicle goes before `other`, where both can still stop before the zone, `own_way` and `way` [m]
/// ahead of them. Both drivers must find the same answer without communication, so it depends only on what both can
/// see. The first rule that applies decides:
/// - Patience: a driver that has waited too long for a standing vehicle goes. Only here may the two disagree.
/// - A vehicle inside the junction goes before one outside. Of two inside, the nearer one goes.
/// - A vehicle before a red light waits.
/// - A standing driver lets a vehicle go that has just started close to its line.
/// - Right of way by map, signs and rules (`map::right_of_way`).
/// - Without right of way, the nearer vehicle goes; at about equal distance, the one with the smaller id.
///
/// O(1).
template <class View>
[[nodiscard]] bool goes_first(View const& view, map::Conflict const& conflict, map::ConflictZone const& zone,
                              ConflictUser const& other, double way, double own_way, ConflictAsker const& own) {
  constexpr double short_way = 15.0;  // [m] from the junction: a slow vehicle within it has just started
  constexpr double spread = 8.0;      // [s] range over which ids spread the end of patience
  constexpr double later = 20.0;      // [s] more for the larger id, and if only one of the two is in the junction
  auto const& [user, at, reach] = other;
  bool const stands = user.speed < standing_speed, own_stands = own.speed < standing_speed;
  // Two drivers must not lose their patience together. Of two that wait for each other, the smaller id goes long before
  // the other; the golden ratio spreads the ids of a ring of waiting drivers.
  bool const is_smaller = view.id() < user.agent;
  double const share = 0.6180339887498949 * static_cast<double>(static_cast<std::uint32_t>(view.id()));
  double const turn = spread * (share - std::floor(share)) + (is_smaller ? 0.0 : later);  // [s]
  bool const inside = other.is_inside(conflict, zone), own_inside = own.is_inside(conflict, zone);
  if (stands && own.waited >= own.patience + turn + (inside != own_inside ? later : 0.0)) return true;
  if (inside != own_inside) return own_inside;
  if (!inside && is_valid(conflict.other_light) && view.light(conflict.other_light) == map::LightColor::red)
    return true;
  if (inside) return own_way != way ? own_way < way : is_smaller;
  if (own_stands && !stands && user.speed < starting_speed && zone.other_line - at - user.front < short_way)
    return false;
  if (conflict.right_of_way != map::RightOfWay::equal) return conflict.right_of_way == map::RightOfWay::first;
  return std::abs(own_way - way) > 2.0 ? own_way < way : is_smaller;
}

}  // namespace detail

}  // namespace cambium
