#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/map/opendrive/document.hpp"
#include "cambium/map/road/cubic.hpp"
#include "cambium/map/road/road.hpp"

namespace cambium::inline v0_1::map::detail {

/// What lies across the road's elevation.
inline void set_surface(opendrive::RoadElement const& source, Road& road) {
  road.superelevation = CubicProfile(source.superelevation);
  std::vector<CubicRecord> left, right;
  for (auto const& crossfall : source.crossfall) {
    if (crossfall.side != opendrive::Side::right) left.push_back(crossfall.record);
    if (crossfall.side != opendrive::Side::left) right.push_back(crossfall.record);
  }
  road.crossfall_left = CubicProfile(std::move(left));
  road.crossfall_right = CubicProfile(std::move(right));
  for (std::size_t i = 0; i < source.shape.size();) {
    std::vector<CubicRecord> records;
    double const s = source.shape[i].s;
    for (; i < source.shape.size() && source.shape[i].s == s; ++i) records.push_back(source.shape[i].record);
    road.shape.push_back({s, CubicProfile(std::move(records), BeforeFirst::hold)});
  }
}

[[nodiscard]] inline RoadLane make_road_lane(opendrive::LaneElement const& lane) {
  std::vector<LaneHeight> heights;
  for (auto const& height : lane.heights) heights.push_back({height.s_offset, height.inner, height.outer});
  return {lane.id,
          none<LaneId>,
          none<LaneId>,
          CubicProfile(lane.widths, BeforeFirst::hold),
          CubicProfile(lane.widths.empty() ? lane.borders : std::vector<CubicRecord>(), BeforeFirst::hold),
          std::move(heights)};
}

[[nodiscard]] inline Road make_road(opendrive::RoadElement const& source, RoadId id,
                                    opendrive::HeaderOffset const& offset) {
  Road road;
  road.id = id;
  road.name = source.id;
  road.left_hand_traffic = source.rule == opendrive::DrivingSide::left_hand;
  road.reference_line = opendrive::make_reference_line(source, offset);
  road.lane_offset = CubicProfile(source.lane_offset);
  road.elevation = CubicProfile(source.elevation);
  road.elevation_offset = offset.z;
  set_surface(source, road);
  road.length = source.geometry_length();
  for (std::size_t k = 0; k < source.lane_sections.size(); ++k) {
    auto const& section = source.lane_sections[k];
    RoadSection result;
    result.begin = section.s;
    result.end = k + 1 < source.lane_sections.size() ? source.lane_sections[k + 1].s : road.length;
    for (auto const& lane : section.lanes)
      if (lane.id != 0) result.lanes.push_back(make_road_lane(lane));
    road.sections.push_back(std::move(result));
  }
  return road;
}

}  // namespace cambium::inline v0_1::map::detail
