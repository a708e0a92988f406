#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "cambium/core/ids.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/evaluation/collision.hpp"
#include "cambium/geometry/oriented_box.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/map.hpp"
#include "cambium/world/frame.hpp"

namespace cambium::inline v0_1 {

/// Whether an agent in traffic has left the drivable lanes of the map: a corner of its box, or the middle of a side,
/// lies in no drivable lane. O(log lanes); O(1) well inside its own lane.
struct OffRoad {
  static constexpr char const* name = "off_road";
  static constexpr char const* summary = "a corner, or the middle of a side, of its box is in no drivable lane";
  static constexpr auto parameters() { return parameter_list(); }

  template <class World>
  [[nodiscard]] bool operator()(World const& world, Slot slot) const {
    auto const& record = world.frame().agents[slot];
    auto const& agent = world.roster().agents[slot];
    return record.status == AgentStatus::driving &&
           leaves(world.map(), *agent.road, record.lane, record.state, agent.shape);
  }

  /// The same for a vehicle of `shape` in `state`, whose place on `road` is `at`.
  template <MotionState S>
  [[nodiscard]] static bool leaves(Map const& map, map::RoadCorridor const& road, map::LanePlace const& at,
                                   S const& state, geometry::Shape const& shape) {
    if (inside_lanes(road, at, shape)) return false;
    auto const corners = geometry::box_of(shape, state).corners();
    for (std::size_t i = 0; i < corners.size(); ++i) {
      auto const& corner = corners[i];
      geometry::Point const middle = 0.5 * (corner + corners[(i + 1) % corners.size()]);
      if (beyond_road(map, road, at, corner) || beyond_road(map, road, at, middle)) return true;
    }
    return false;
  }

 private:
  /// Quick test: a box is inside if it fits into the narrowest of the widths at its rear, middle and front, and the
  /// lane bends little. The widths include the adjacent lanes if these run along the whole box. [m, rad]
  [[nodiscard]] static bool inside_lanes(map::RoadCorridor const& road, map::LanePlace const& at,
                                         geometry::Shape const& shape) {
    auto const& corridor = road.corridors[at.corridor];
    auto const& piece = corridor.pieces[at.piece];
    double const rear = at.s - shape.rear, front = at.s + shape.front;
    if (rear < 0 || front > corridor.length()) return false;
    double const reach = std::max(shape.front, shape.rear);
    double bend = 0.0;  // sum of all turns between rear and front, left or right
    auto const segments = corridor.center.segments();
    auto at_rear = at.segment;
    corridor.center.segment_at(rear, at_rear);
    for (auto i = at_rear; i < segments.size() && segments[i].s < front; ++i)
      bend += std::abs(segments[i].curvature) * segments[i].length;
    double const margin = (std::abs(at.heading_error) + bend) * reach + 0.1;
    bool const has_beside = rear > piece.begin && front < piece.end;
    auto segment = at_rear;
    for (double const s : {rear, at.s, front}) {
      corridor.center.segment_at(s, segment);
      auto const widths = corridor.widths_at(s, segment);
      double left = widths.left, right = widths.right;
      if (has_beside && at.lateral + shape.left + margin >= left)
        left += width_beside(road, piece, piece.left, piece.left_piece, s);
      if (has_beside && at.lateral - shape.right - margin <= -right)
        right += width_beside(road, piece, piece.right, piece.right_piece, s);
      if (at.lateral + shape.left + margin >= left || at.lateral - shape.right - margin <= -right) return false;
    }
    return true;
  }

  /// Width of the lane beside a piece at the same share of its length; 0 without a drivable lane.
  [[nodiscard]] static double width_beside(map::RoadCorridor const& road, map::CorridorPiece const& from,
                                           CorridorId number, PieceId piece, double s) {
    if (number == none<CorridorId>) return 0.0;
    auto const& beside = road.corridors[number];
    auto const& to = beside.pieces[piece];
    if (!map::is_drivable(to.type)) return 0.0;
    return beside.width_at(to.begin + (s - from.begin) / (from.end - from.begin) * (to.end - to.begin));
  }

  /// Whether the point is in no lane. Points beyond the end of the agent's road do not count: the map ends there, not
  /// the real road.
  [[nodiscard]] static bool beyond_road(Map const& map, map::RoadCorridor const& road, map::LanePlace const& at,
                                        geometry::Point const& p) {
    if (map.on_drivable_lane(p)) return false;
    auto const& corridor = road.corridors[at.corridor];
    auto const foot = corridor.center.project(p, at.segment);
    if (foot.s > 0.0 && foot.s < corridor.length()) return true;
    bool const is_before = foot.s <= 0.0;
    auto const end = is_before ? corridor.widths.front() : corridor.widths.back();
    if (foot.lateral <= end.left && foot.lateral >= -end.right) return false;
    // It may be beyond the end of a lane beside.
    constexpr double inside = 0.01;  // [m]
    auto const at_end = corridor.center.pose(is_before ? inside : corridor.length() - inside);
    auto const along = portable::sin_cos(at_end.heading);
    return !map.on_drivable_lane({at_end.x - foot.lateral * along.sin, at_end.y + foot.lateral * along.cos});
  }
};

/// Whether a part of the body of an agent in traffic is beyond the borders of its lane. O(1).
struct Straddles {
  double tolerance = 0.1;

  static constexpr char const* name = "straddles";
  static constexpr char const* summary = "a part of it is beyond the borders of its lane";
  static constexpr auto parameters() {
    return parameter_list(
        parameter("tolerance", &Straddles::tolerance, "m", Range{0, 10}, "that a part may be beyond a border"));
  }

  template <class World>
  [[nodiscard]] bool operator()(World const& world, Slot slot) const {
    return in_traffic(world, slot) && !detail::within_lane(world, slot, tolerance);
  }
};

namespace detail {

/// Whether the middle of `box` is in a lane of the opposite direction, and in no lane of its own direction.
[[nodiscard]] inline bool is_against_traffic(Map const& map, geometry::OrientedBox const& box) {
  auto const hit = map.nearest_lane({box.x, box.y, portable::atan2(box.sin, box.cos)}, 0.0);
  if (!hit) return false;
  auto const along = portable::sin_cos(map.lane(hit->lane).path.pose(hit->s).heading);
  return along.cos * box.cos + along.sin * box.sin < 0.0;
}

}  // namespace detail

/// Whether an agent in traffic drives in a lane of oncoming traffic, outside all lanes of its route, or drives back in
/// its own lane.
struct OncomingLane {
  static constexpr char const* name = "oncoming_lane";
  static constexpr char const* summary = "drives in a lane of oncoming traffic";
  static constexpr auto parameters() { return parameter_list(); }

  template <class World>
  [[nodiscard]] bool operator()(World const& world, Slot slot) const {
    auto const& record = world.frame().agents[slot];
    auto const& agent = world.roster().agents[slot];
    return record.status == AgentStatus::driving &&
           enters(world.map(), *agent.road, record.lane, record.state, agent.shape);
  }

  /// The same for a vehicle of `shape` in `state`, whose place on `road` is `at`.
  template <MotionState S>
  [[nodiscard]] static bool enters(Map const& map, map::RoadCorridor const& road, map::LanePlace const& at,
                                   S const& state, geometry::Shape const& shape) {
    auto const sides = road.corridors[at.corridor].widths_at(at.s, at.segment);
    bool const is_in_lane = at.lateral < sides.left && -at.lateral < sides.right;
    if (is_in_lane) return std::abs(at.heading_error) > 0.5 * geometry::pi && state.speed > blameless_speed;
    return detail::is_against_traffic(map, geometry::box_of(shape, state));
  }
};

}  // namespace cambium::inline v0_1
