#pragma once

#include <cmath>
#include <optional>

#include "cambium/core/ids.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/map/map.hpp"

namespace cambium::inline v0_1::map {

/// Which of two connecting roads goes first by the junction's priorities; nothing where these do not say.
[[nodiscard]] inline std::optional<RoadId> goes_first(Junction const& junction, RoadId a, RoadId b) {
  for (auto const& priority : junction.priorities)
    if ((priority.high == a && priority.low == b) || (priority.high == b && priority.low == a)) return priority.high;
  return std::nullopt;
}

namespace detail {

/// What the signs and lights before a junction tell a lane's traffic.
struct SignsBefore {
  int rank{};          ///< 1: it has priority; -1: it gives way; 0: neither
  bool stops = false;  ///< it stops before it gives way
  LightId light = none<LightId>;
};

/// The last signs before the junction that the lane lies in, on its way there or at its begin.
[[nodiscard]] inline SignsBefore signs_before(Map const& map, Lane const& lane) {
  constexpr double near = 60.0;  // [m] before the junction
  SignsBefore signs;
  auto const take = [&signs](Lane const& from, double begin) {
    for (auto const& signal : from.signals) {
      if (signal.s < begin) continue;
      if (signal.kind == SignalKind::light)
        signs.light = signal.light;
      else
        signs.rank = signal.kind == SignalKind::priority ? 1 : -1, signs.stops = signal.kind == SignalKind::stop;
    }
  };
  auto const junction = map.road(lane.road).junction;
  auto const* at = &lane;
  take(*at, -1.0);
  for (double way = 0.0; way < near && signs.rank == 0 && !is_valid(signs.light) && !at->predecessors.empty();) {
    at = &map.lane(at->predecessors.front());
    if (map.road(at->road).junction == junction && is_valid(junction)) {
      take(*at, -1.0);
    } else {
      take(*at, at->length() - (near - way));
      way += at->length();
      if (is_valid(map.road(at->road).junction)) break;  // another junction's
    }
  }
  return signs;
}

/// How a lane comes to an overlap: its direction where the junction begins, and how far it turns in it, left positive.
struct Approach {
  double heading{}, turn{};  ///< [rad]
};

[[nodiscard]] inline Approach approach_of(Map const& map, Lane const& lane, double overlap_begin) {
  if (!is_valid(map.road(lane.road).junction)) return {lane.path.pose(overlap_begin).heading, 0.0};
  double const begin = lane.path.pose(0.0).heading;
  return {begin, lane.path.pose(lane.length()).heading - begin};
}

/// The rule where neither signs nor the junction say: whoever comes from the right goes first (where traffic keeps to
/// the left: from the left), and who turns across oncoming traffic waits.
[[nodiscard]] inline RightOfWay right_before_left(Approach own, Approach other, bool left_hand_traffic) {
  constexpr double straight = geometry::pi / 6;  // [rad]
  double const mirror = left_hand_traffic ? -1.0 : 1.0;
  double const across = mirror * geometry::angle_difference(other.heading, own.heading);  // positive: from the right
  if (std::abs(across) < straight) return RightOfWay::equal;
  if (std::abs(across) <= geometry::pi - straight) return across > 0.0 ? RightOfWay::yields : RightOfWay::first;
  bool const crosses = mirror * own.turn > straight, other_crosses = mirror * other.turn > straight;
  if (crosses == other_crosses) return RightOfWay::equal;
  return crosses ? RightOfWay::yields : RightOfWay::first;
}

}  // namespace detail

/// Who goes first where `overlap` of lane `id` lies, by the junction's priorities, else by signs; nothing where neither
/// says.
[[nodiscard]] inline std::optional<RightOfWay> signed_right_of_way(Map const& map, LaneId id, Overlap const& overlap) {
  auto const &lane = map.lane(id), &other = map.lane(overlap.other);
  auto const &road = map.road(lane.road), &other_road = map.road(other.road);
  if (is_valid(road.junction) && road.junction == other_road.junction)
    if (auto const first = goes_first(map.junction(road.junction), lane.road, other.road))
      return *first == lane.road ? RightOfWay::first : RightOfWay::yields;
  int const rank = detail::signs_before(map, lane).rank, other_rank = detail::signs_before(map, other).rank;
  if (rank != other_rank) return rank > other_rank ? RightOfWay::first : RightOfWay::yields;
  return std::nullopt;
}

/// Who goes first where `overlap` of lane `id` lies: by the junction's priorities, else by signs, else right before
/// left; where traffic keeps to the left, left before right. For the other lane's overlap the answer is the opposite
/// one.
[[nodiscard]] inline RightOfWay right_of_way(Map const& map, LaneId id, Overlap const& overlap) {
  if (auto const by_signs = signed_right_of_way(map, id, overlap)) return *by_signs;
  auto const &lane = map.lane(id), &other = map.lane(overlap.other);
  return detail::right_before_left(detail::approach_of(map, lane, overlap.begin),
                                   detail::approach_of(map, other, overlap.other_begin),
                                   map.road(lane.road).left_hand_traffic);
}

}  // namespace cambium::inline v0_1::map
