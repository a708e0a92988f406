#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "cambium/behavior/view.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/map/corridor/lane_place.hpp"
#include "cambium/map/map.hpp"
#include "cambium/world/frame.hpp"
#include "cambium/world/plane_index.hpp"
#include "cambium/world/traffic_index.hpp"

namespace cambium::inline v0_1::detail {

/// A square that contains all points within `distance` [m] of an agent, whatever its heading.
template <class State>
[[nodiscard]] geometry::Box box_around(geometry::Shape const& shape, State const& state, double distance) {
  double const reach = distance + std::max(shape.front, shape.rear) + std::max(shape.left, shape.right);
  return {state.x - reach, state.y - reach, state.x + reach, state.y + reach};
}

/// Lateral offset [m] up to which an agent stays in its lane even beyond the lane's border: the path of an ending lane
/// crosses that border.
inline constexpr double on_path = 0.3;

/// An approximate place beside `at` on the adjacent lane corridor, for use as a hint. Lanes of one section are mostly
/// sampled at the same stations.
[[nodiscard]] inline map::LanePlace hint_beside(map::RoadCorridor const& road, map::LanePlace const& at,
                                                map::CorridorPiece const& from, CorridorId number) {
  map::LanePlace hint;
  hint.piece = number == from.left ? from.left_piece : from.right_piece;
  auto const& to = road.corridors[number].pieces[hint.piece];
  auto const passed = at.segment > from.first_segment ? at.segment - from.first_segment : 0;
  hint.segment =
      to.first_segment + (to.segments == from.segments ? passed : passed * to.segments / std::max(from.segments, 1u));
  return hint;
}

/// `locate_beside` for a lane corridor that is not adjacent to that of `at`.
CAMBIUM_NOINLINE [[nodiscard]] inline map::LanePlace locate_farther_beside(Map const& map,
                                                                           map::RoadCorridor const& road,
                                                                           map::LanePlace const& at, CorridorId number,
                                                                           geometry::Pose const& pose) {
  auto const& from = road.corridors[at.corridor].pieces[at.piece];
  auto const& corridor = road.corridors[number];
  map::LanePlace hint;
  double const share = (at.s - from.begin) / (from.end - from.begin);
  for (bool const leftwards : {true, false})
    for (LaneId lane = from.lane; is_valid(lane);
         lane = leftwards ? map.lane(lane).left_neighbor : map.lane(lane).right_neighbor)
      for (std::size_t i = 0; i < corridor.pieces.size(); ++i) {
        auto const& piece = corridor.pieces[i];
        if (piece.lane != lane) continue;
        hint.piece = static_cast<PieceId>(i);
        hint.segment = corridor.center.find(piece.begin + share * (piece.end - piece.begin));
        return map::locate(road, number, pose, hint);
      }
  return map::locate(road, number, pose);
}

/// The place beside `at` on lane corridor `number` of the same road, for an agent at `pose`. The search starts from the
/// adjacent lanes, because a corridor may pass the same position twice. O(1) for an adjacent corridor, else O(lanes of
/// the corridor).
[[nodiscard]] inline map::LanePlace locate_beside(Map const& map, map::RoadCorridor const& road,
                                                  map::LanePlace const& at, CorridorId number,
                                                  geometry::Pose const& pose) {
  auto const& from = road.corridors[at.corridor].pieces[at.piece];
  if (number == from.left || number == from.right) [[likely]]
    return map::locate(road, number, pose, hint_beside(road, at, from, number));
  return locate_farther_beside(map, road, at, number, pose);
}

/// The adjacent lane corridor whose lane a vehicle at `at` is in because it is beyond the border; none if it is not.
[[nodiscard]] inline CorridorId crossed_into(map::LaneCorridor const& corridor, map::LanePlace const& at) {
  auto const& piece = corridor.pieces[at.piece];
  auto const widths = corridor.widths_at(at.s, at.segment);
  return at.lateral > widths.left ? piece.left : at.lateral < -widths.right ? piece.right : none<CorridorId>;
}

/// The place of an agent seen at `pose` that truly is at `truth`; in another lane if it `may_cross` the borders.
[[nodiscard]] inline map::LanePlace seen_place(Map const& map, map::RoadCorridor const& road,
                                               map::LanePlace const& truth, geometry::Pose const& pose,
                                               bool may_cross) {
  auto at = map::locate(road, truth.corridor, pose, truth);
  for (auto from = none<CorridorId>; may_cross && std::abs(at.lateral) > on_path;) {
    auto const beside = crossed_into(road.corridors[at.corridor], at);
    if (beside == none<CorridorId> || beside == from) break;
    from = at.corridor;
    at = locate_beside(map, road, at, beside, pose);
  }
  return at;
}

/// Finds the new place of an agent that has driven `distance` [m] on its road: in its lane corridor or, once it has
/// crossed the border, in the adjacent one.
template <class Record>
void move_on_lane(Map const& map, map::RoadCorridor const& road, double distance, Record& next) {
  geometry::Pose const pose{next.state.x, next.state.y, next.state.heading};
  auto& at = next.lane;
  if (distance > 10.0)  // a long way may bend back on itself
    road.corridors[at.corridor].center.segment_at(at.s + distance, at.segment);
  at = map::locate(road, at.corridor, pose, at);
  auto const& corridor = road.corridors[at.corridor];
  if (std::abs(at.lateral) > on_path) {
    auto const beside = crossed_into(corridor, at);
    if (beside != none<CorridorId>) {
      at = locate_beside(map, road, at, beside, pose);
      return;
    }
  }
  if (at.s <= corridor.length()) return;
  next.status = !corridor.continues            ? AgentStatus::left_map
                : corridor.reaches_destination ? AgentStatus::arrived
                                               : AgentStatus::off_route;
}

/// The distance of a place from its lane corridor [m].
[[nodiscard]] inline double distance_from(map::RoadCorridor const& road, map::LanePlace const& at) {
  return portable::hypot(at.lateral, std::max({-at.s, at.s - road.corridors[at.corridor].length(), 0.0}));
}

/// The place of `pose` on `road` for an agent that was at `last`: in the same lane corridor if the pose fits, else on
/// the nearest one, where each radian of heading error counts as 3 m.
[[nodiscard]] inline map::LanePlace relocate(map::RoadCorridor const& road, map::LanePlace const& last,
                                             geometry::Pose const& pose) {
  constexpr double near = 2.0;  // [m]
  auto const measure = [&road](map::LanePlace const& at) {
    return distance_from(road, at) + 3.0 * std::abs(at.heading_error);
  };
  auto best = map::locate(road, last.corridor, pose, last);
  if (measure(best) < near) return best;
  for (CorridorId i{}; index_of(i) < road.corridors.size(); ++i) {
    auto const candidate = map::locate(road, i, pose);
    if (measure(candidate) < measure(best) - 1e-9) best = candidate;
  }
  return best;
}

/// A body that reaches up to this far [m] to the side of its path counts as within its lane. Lanes whose paths are
/// closer than that overlap, and the index covers overlaps anyway.
inline constexpr double usual_reach = 1.4;

/// The first lane coordinate beyond all lanes, where the ranges of free corridors begin [m].
[[nodiscard]] inline double lane_coordinate_end(Map const& map) {
  if (map.lanes().empty()) return 0.0;
  auto const& last = map.lanes().back();
  return last.index_begin + std::ceil(last.length() + 10.0);  // agents beyond its end still count as in it
}

/// A road user's shape, place and motion on its road.
struct BodyOnRoad {
  geometry::Shape const& shape;
  map::RoadCorridor const& road;
  map::LanePlace const& at;
  geometry::Pose pose;
  double speed;  ///< [m/s]
};

/// Adds an entry for each further lane that the agent's body reaches into: the adjacent lane, or, where there is none,
/// an oncoming lane. If the agent has left its own lane, adds an entry for the lane it is in and returns false: its own
/// entry no longer counts. `entry` is the entry of its own lane.
[[nodiscard]] bool straddle(Map const& map, BodyOnRoad const& body, TrafficEntry const& entry, ReachingEntries& list);

/// Updates the traffic index for the agents of a frame.
template <class Roster, class Frame>
void refresh_traffic(TrafficIndex& index, Map const& map, Roster const& roster, Frame const& frame) {
  constexpr double nowhere = std::numeric_limits<double>::infinity();
  double const lanes_end = lane_coordinate_end(map);
  auto const add = [&](Slot slot, ReachingEntries& reaching) {
    auto const& record = frame.agents[slot];
    auto const& agent = roster.agents[slot];
    double const speed = record.state.speed * portable::sin_cos_often_slight(record.lane.heading_error).cos;
    TrafficEntry entry{
        record.lane.index, agent.shape.front, agent.shape.rear, speed, slot, static_cast<std::uint32_t>(agent.id)};
    if (record.status != AgentStatus::driving) {
      entry.position = nowhere;
      return entry;
    }
    auto const& [front, rear, left, right] = agent.shape;
    double const lateral = std::abs(record.lane.lateral);
    double const reach = lateral + std::max(left, right) + std::max(front, rear) * std::abs(record.lane.heading_error);
    if (reach <= usual_reach && lateral <= on_path && record.lane.index < lanes_end) return entry;
    geometry::Pose const pose{record.state.x, record.state.y, record.state.heading};
    if (!straddle(map, {agent.shape, *agent.road, record.lane, pose, record.state.speed}, entry, reaching))
      entry.position = nowhere;
    return entry;
  };
  index.refresh(frame.agents.size(), add, [&](Slot slot) {
    auto const& at = frame.agents[slot].lane;
    auto const& piece = roster.agents[slot].road->corridors[at.corridor].pieces[at.piece];
    return LaneStretch{piece.begin + piece.index_offset, piece.end + piece.index_offset};
  });
}

/// Updates the plane index for the agents of a frame.
template <class Roster, class Frame>
void refresh_plane(PlaneIndex& index, Roster const& roster, Frame const& frame) {
  index.refresh(frame.agents.size(), [&](Slot slot) {
    auto const& record = frame.agents[slot];
    if (record.status != AgentStatus::driving) return geometry::Box{};
    return box_around(roster.agents[slot].shape, record.state, 0.0);
  });
}

}  // namespace cambium::inline v0_1::detail

#ifndef CAMBIUM_COMPILED
#include "cambium/world/detail/on_lanes_impl.hpp"
#endif
