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

/// Who is slower than this at a junction has hardly begun to move, or is about to stop [m/s].
inline constexpr double starting_speed = 2.5;

namespace detail {

inline constexpr double over_line = 0.1;  ///< [m] who stands at its line is not over it, whatever the rounding

/// How far a body reaches beyond that which conflicts are found for, as of one aslant or a larger one [m].
struct ExtraReach {
  double front{}, rear{};
};

/// Another one at position `at` [m] of its way to a conflict (see `map::Conflict::ways`).
struct ConflictUser {
  RoadUser const& user;
  double at;
  ExtraReach reach;

  /// Whether it is in the junction already.
  [[nodiscard]] bool is_inside(map::Conflict const& conflict, map::ConflictZone const& zone) const {
    return at + user.front > zone.other_line + over_line && at < conflict.other_lane_end;
  }
};

/// Whether conflicts count for a shape as for a large one.
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
  double waited{};      ///< has been standing there for [s]
  double patience{};    ///< see `Intersection::patience` [s]

  [[nodiscard]] bool is_inside(map::Conflict const& conflict, map::ConflictZone const& zone) const {
    return front > zone.line + over_line && s < conflict.lane_end;
  }
};

/// Whether the own vehicle, rather than `other`, goes first where both could still stop before the zone, `own_way` and
/// `way` [m] from there. Both find the same, as long as neither has lost its patience. O(1).
template <class View>
[[nodiscard]] bool goes_first(View const& view, map::Conflict const& conflict, map::ConflictZone const& zone,
                              ConflictUser const& other, double way, double own_way, ConflictAsker const& own) {
  constexpr double short_way = 15.0;  // [m] from the junction, to see who starts there
  constexpr double spread = 8.0;      // [s] over which ids spread those who lose their patience
  constexpr double later = 20.0;      // [s] the larger id of two, and where only one is in the junction
  auto const& [user, at, reach] = other;
  bool const stands = user.speed < standing_speed, own_stands = own.speed < standing_speed;
  // Ids part those who lose their patience together: of two who wait for each other the smaller goes long before the
  // other would; those of a ring are spread by the golden ratio.
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
