#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <span>

#include "cambium/core/ids.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/lanes/lane_tree.hpp"

namespace cambium::map::detail {

/// Where `pose` is in `lane`, searched from segment `hint` of its path; nothing where the lane does not hold it or runs
/// the other way.
[[nodiscard]] inline std::optional<LaneHit> place_in(Lane const& lane, geometry::Pose const& pose, std::uint32_t hint) {
  auto const foot = lane.path.project(pose.position(), hint);
  if (foot.s < 0.0 || foot.s > lane.length()) return std::nullopt;
  auto const widths = lane.widths_at(foot.s, foot.segment);
  if (foot.lateral > widths.left || foot.lateral < -widths.right) return std::nullopt;
  auto const& segment = lane.path.segments()[foot.segment];
  if (segment.ux * std::cos(pose.heading) + segment.uy * std::sin(pose.heading) <= 0.0) return std::nullopt;
  return LaneHit{lane.id, foot.s, foot.lateral, 0.0, foot.segment};
}

/// The lane of `previous`, or one behind, before or beside it, that holds `pose`: the first of these in this order.
[[nodiscard]] inline std::optional<LaneHit> follow_lane(std::span<Lane const> lanes, geometry::Pose const& pose,
                                                        LaneHit const& previous) {
  auto const& own = lanes[index_of(previous.lane)];
  if (auto const hit = place_in(own, pose, previous.segment)) return hit;
  constexpr std::uint32_t last = 0xffffffff;
  for (auto const next : own.successors)
    if (auto const hit = place_in(lanes[index_of(next)], pose, 0)) return hit;
  for (auto const before : own.predecessors)
    if (auto const hit = place_in(lanes[index_of(before)], pose, last)) return hit;
  for (auto const side : {own.left_neighbor, own.right_neighbor})
    if (is_valid(side)) {
      auto const& lane = lanes[index_of(side)];
      if (auto const hit = place_in(lane, pose, lane.path.find(previous.s * lane.length() / own.length()))) return hit;
    }
  return std::nullopt;
}

}  // namespace cambium::map::detail
