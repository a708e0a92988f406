#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "cambium/core/error.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/lanes/lane_tree.hpp"
#include "cambium/map/road/road.hpp"

namespace cambium::inline v0_1::map::detail {

/// "from 0 to 30 m, from 50 to 80 m": where `road` has lane `number`; empty where nowhere.
[[nodiscard]] inline std::string stations_text(Road const& road, int number) {
  using cambium::detail::rounded_text;
  std::string text;
  RoadSection const* last = nullptr;
  double begin = 0.0;
  auto const finish = [&] {
    if (last == nullptr) return;
    text += (text.empty() ? "from " : ", from ") + rounded_text(begin) + " to " + rounded_text(last->end) + " m";
    last = nullptr;
  };
  for (auto const& section : road.sections)
    for (auto const& lane : section.lanes) {
      if (lane.number != number || !is_valid(lane.id)) continue;
      if (last != nullptr && last->end != section.begin) finish();
      if (last == nullptr) begin = section.begin;
      last = &section;
    }
  finish();
  return text;
}

/// "2, 1, -1": the lanes of a section that are in the map.
[[nodiscard]] inline std::string lanes_text(RoadSection const& section) {
  std::string text;
  for (auto const& lane : section.lanes)
    if (is_valid(lane.id)) text += (text.empty() ? "" : ", ") + std::to_string(lane.number);
  return text;
}

/// Lane `number` of `road` at station `s` [m]. Throws `MapError` that says where the road has it.
[[nodiscard]] inline RoadLane const& lane_at(Road const& road, double s, int number) {
  using cambium::detail::rounded_text;
  std::string const where = "road " + road.name + ", s " + rounded_text(s);
  auto const* section = s >= 0.0 ? road.section_at(s) : nullptr;
  if (section == nullptr) {
    double const begin = road.sections.empty() ? 0.0 : road.sections.front().begin;
    std::string const what = s < begin    ? "it lies before the road's lanes"
                             : s >= begin ? "the road is " + rounded_text(road.length) + " m long"
                                          : "it is no number";
    throw MapError(where, what,
                   "give a place from s " + rounded_text(begin) + " to " + rounded_text(road.length) + " m");
  }
  for (auto const& lane : section->lanes)
    if (lane.number == number && is_valid(lane.id)) return lane;
  auto const stations = stations_text(road, number), lanes = lanes_text(*section);
  std::string const what = "there is no lane " + std::to_string(number) +
                           (stations.empty() ? ", nor elsewhere on the road" : "; the road has it " + stations);
  throw MapError(where, what, lanes.empty() ? "ask for another place: it has none here" : "ask for one of " + lanes);
}

/// Where `pose` is in `lane`, searched from segment `hint` of its path; nothing where the lane does not hold it or runs
/// the other way.
[[nodiscard]] inline std::optional<LaneHit> place_in(Lane const& lane, geometry::Pose const& pose, std::uint32_t hint) {
  auto const foot = lane.path.project(pose.position(), hint);
  if (foot.s < 0.0 || foot.s > lane.length()) return std::nullopt;
  auto const widths = lane.widths_at(foot.s, foot.segment);
  if (foot.lateral > widths.left || foot.lateral < -widths.right) return std::nullopt;
  auto const& segment = lane.path.segments()[foot.segment];
  auto const [sin, cos] = portable::sin_cos(pose.heading);
  if (segment.ux * cos + segment.uy * sin <= 0.0) return std::nullopt;
  return LaneHit{lane.id, foot.s, foot.lateral, 0.0, foot.segment};
}

/// The lane that holds `pose`: that of `previous`, else one of its successors, predecessors or neighbours, in this
/// order.
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

}  // namespace cambium::inline v0_1::map::detail
