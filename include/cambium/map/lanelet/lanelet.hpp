#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cambium/geometry/pose.hpp"
#include "cambium/map/lanes/signals.hpp"
#include "cambium/map/opendrive/element.hpp"
#include "cambium/map/road/lane_type.hpp"

/// Lanelets: the form in which Lanelet2 and CommonRoad describe roads. A lanelet is a piece of one lane between two
/// polylines; what follows it and what lies beside it is said by ids.
namespace cambium::inline v0_1::map {

/// A sign or light for the traffic of a lanelet.
struct LaneletSignal {
  SignalKind kind = SignalKind::priority;
  double before_end = 0.0;  ///< how far before the lanelet's end it counts, as at a stop line [m]
  std::string light{};      ///< name of the traffic light; only of a light

  friend bool operator==(LaneletSignal const&, LaneletSignal const&) = default;
};

/// A piece of a lane. `left` and `right` run in the direction of travel; neighbours run the same way.
struct Lanelet {
  std::int64_t id = 0;
  std::vector<geometry::Point> left{}, right{};         ///< at least two points each, map frame [m]
  std::vector<double> left_heights{}, right_heights{};  ///< of these points [m]; empty: not known
  std::vector<std::int64_t> predecessors{}, successors{};
  std::optional<std::int64_t> left_neighbor{}, right_neighbor{};
  bool may_change_left = true, may_change_right = true;  ///< as the marks say
  LaneType type = LaneType::driving;
  std::optional<double> speed_limit{};  ///< [m/s]
  bool both_directions = false;         ///< driven either way
  bool in_junction = false;             ///< the file says that it lies in an intersection
  std::vector<LaneletSignal> signals{};
  std::vector<std::int64_t> goes_before{};  ///< lanelets of its junction whose traffic gives way to its own
  opendrive::FileLine line{};               ///< for messages

  friend bool operator==(Lanelet const&, Lanelet const&) = default;
};

}  // namespace cambium::inline v0_1::map
