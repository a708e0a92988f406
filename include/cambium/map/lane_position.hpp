#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/line.hpp"
#include "cambium/map/corridor.hpp"

namespace cambium::map {

/// Where a vehicle is on a road corridor. `corridor` and `piece` number the lane corridor and its lane.
struct LanePosition {
  double s{};               ///< along the lane corridor's centre line [m]
  double lateral{};         ///< from the centre line, left positive [m]
  double heading_error{};   ///< vehicle's heading minus the lane's [rad], in (-pi, pi]
  double index{};           ///< the map-wide lane coordinate (see `Lane::index_begin`)
  std::uint32_t segment{};  ///< of the centre line: the hint for the next projection
  std::uint16_t corridor = no_corridor;
  std::uint16_t piece{};

  friend bool operator==(LanePosition const&, LanePosition const&) = default;
};

/// Places `pose` on lane corridor `number` of `road`; `hint` is the last position there. O(segments moved since).
[[nodiscard]] inline LanePosition locate(RoadCorridor const& road, std::uint16_t number, geometry::Pose const& pose,
                                         LanePosition const& hint) {
  auto const& corridor = road.corridors[number];
  auto const foot = corridor.center.project(pose.position(), hint.segment);
  auto const& segment = corridor.center.segments()[foot.segment];
  double const inside = std::min(std::max(foot.s - segment.s, 0.0), segment.length);
  double error = pose.heading - (segment.heading + segment.curvature * inside);
  if (std::abs(error) > geometry::pi) error = geometry::normalize_angle(error);
  auto const piece = corridor.piece_at(foot.s, hint.piece);
  auto const& on = corridor.pieces[piece];
  // A vehicle beyond an end of its corridor stays in its lane's own range of the lane coordinate.
  double const index = std::min(std::max(foot.s, on.begin - 1.0), on.end + 1.0) + on.index_offset;
  return {foot.s, foot.lateral, error, index, foot.segment, number, piece};
}

/// As above without a hint: exact. O(segments).
[[nodiscard]] inline LanePosition locate(RoadCorridor const& road, std::uint16_t number, geometry::Pose const& pose) {
  LanePosition hint;
  hint.segment = road.corridors[number].center.project(pose.position()).segment;
  return locate(road, number, pose, hint);
}

}  // namespace cambium::map
