#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "cambium/core/macros.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/map/building/road_plan.hpp"
#include "cambium/map/detail/geometry_fault.hpp"
#include "cambium/map/road/cubic.hpp"
#include "cambium/map/road/lane_type.hpp"
#include "cambium/map/road/reference_line.hpp"

namespace cambium::map {

CAMBIUM_COLD std::vector<LanePlan> equal_lanes(std::size_t count, double width, LaneType type) {
  return std::vector<LanePlan>(count, LanePlan{.type = type, .width = width});
}

CAMBIUM_COLD opendrive::RoadMark make_mark(std::string type, opendrive::LaneChangePermission lane_change) {
  opendrive::RoadMark mark;
  mark.width = type == "none" ? 0.0 : 0.15;
  mark.type = std::move(type);
  mark.color = "white";
  mark.lane_change = lane_change;
  mark.weight = "standard";
  return mark;
}

CAMBIUM_COLD CubicRecord smooth_step(double s, double from, double to, double length) {
  double const rise = to - from;
  if (rise == 0.0) return {s, from, 0.0, 0.0, 0.0};
  return {s, from, 0.0, 3.0 * rise / (length * length), -2.0 * rise / (length * length * length)};
}

}  // namespace cambium::map
