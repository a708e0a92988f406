#pragma once

#include <algorithm>
#include <iterator>
#include <type_traits>
#include <utility>

#include "cambium/core/macros.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/geometry/shape.hpp"
#include "cambium/map/corridor/lane_place.hpp"
#include "cambium/map/map.hpp"
#include "cambium/observer/observer_model.hpp"
#include "cambium/world/detail/seen.hpp"
#include "cambium/world/traffic_query.hpp"

namespace cambium::inline v0_1::detail {

/// Whether observers of `World` may see an agent elsewhere than it is. One that returns the state itself only hides.
template <class World>
inline constexpr bool misplaces =
    !World::Observer::perfect &&
    (past_steps_of<typename World::Observer> > 0 ||
     !std::is_reference_v<decltype(std::declval<typename World::Observer const&>().observe(
         std::declval<typename World::State const&>(), false, std::declval<RandomStream const&>()))>);

/// Whether a body reaches into a lane of these `widths`; its reference point is `lateral` [m] to the left of the lane's
/// centre line, and it is turned by `turn` [rad] against the lane.
[[nodiscard]] inline bool reaches_into(geometry::Shape const& shape, double lateral, double turn,
                                       map::SideWidths const& widths) {
  auto const [sin, cos] = portable::sin_cos(turn);
  auto const reach = geometry::extent_along(shape, sin, -cos);
  return lateral + reach.positive > -widths.right && lateral - reach.negative < widths.left;
}

/// Whether the agent in slot `own` sees the agent of `entry` elsewhere than it is.
template <class World>
[[nodiscard]] bool is_misplaced(World const& world, Slot own, Slot other) {
  auto const& truth = world.frame().agents[other].state;
  auto const& seen = seen_state(world, own, other);
  return seen.x != truth.x || seen.y != truth.y || seen.heading != truth.heading;
}

/// Whether the agent in slot `own` sees the agent of `entry` reach into the entry's lane. O(log lanes).
template <class World>
CAMBIUM_NOINLINE [[nodiscard]] bool is_seen_in_lane(World const& world, Slot own, TrafficEntry const& entry) {
  if (!is_misplaced(world, own, entry.slot)) return true;
  auto const& lanes = world.map().lanes();
  auto const next =
      std::upper_bound(lanes.begin(), lanes.end(), entry.position,
                       [](double position, map::Lane const& lane) { return position < lane.index_begin; });
  if (next == lanes.begin()) return true;
  auto const& lane = *std::prev(next);
  double const s = entry.position - lane.index_begin;
  if (s > lane.length() + 2.0) return true;  // on a free corridor
  auto const& seen = seen_state(world, own, entry.slot);
  auto const foot = lane.path.project({seen.x, seen.y}, lane.path.find(std::clamp(s, 0.0, lane.length())));
  double const turn = geometry::angle_difference(seen.heading, lane.path.pose(foot.s).heading);
  return reaches_into(world.roster().agents[entry.slot].shape, foot.lateral, turn,
                      lane.widths_at(std::clamp(foot.s, 0.0, lane.length())));
}

}  // namespace cambium::inline v0_1::detail
