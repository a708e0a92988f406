#pragma once

#include <cstddef>
#include <cstdint>

#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/opendrive/document.hpp"
#include "cambium/map/road/road.hpp"

namespace cambium::map::detail {

[[nodiscard]] inline bool runs_both_ways(opendrive::Lane const& lane) {
  return lane.direction == opendrive::LaneDirection::both || lane.type == LaneType::bidirectional;
}

/// A lane of a road's section `k` as it is driven, without id, geometry and links.
[[nodiscard]] inline Lane unsampled_lane(opendrive::Lane const& written, Road const& road, std::size_t k) {
  Lane lane;
  lane.road = road.id;
  lane.section = static_cast<std::uint32_t>(k);
  lane.number = written.id;
  lane.type = written.type;
  lane.along_road = (written.id < 0) != road.left_hand_traffic;
  if (written.direction == opendrive::LaneDirection::reversed) lane.along_road = !lane.along_road;
  lane.road_begin = road.sections[k].begin;
  lane.road_end = road.sections[k].end;
  return lane;
}

}  // namespace cambium::map::detail
