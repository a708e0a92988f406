#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cambium/core/diagnostic.hpp"
#include "cambium/core/error.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/map/lanes/signals.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/road/lane_type.hpp"

/// Lanelets: the form in which Lanelet2 and CommonRoad describe roads. A lanelet is a piece of one lane between two
/// polylines; what follows it and what lies beside it is said by ids.
namespace cambium::map {

/// A sign or light for the traffic of a lanelet.
struct LaneletSignal {
  SignalKind kind = SignalKind::priority;
  double before_end = 0.0;  ///< how far before the lanelet's end it counts, as at a stop line [m]
  std::string light{};      ///< name of the traffic light; only of a light

  friend bool operator==(LaneletSignal const&, LaneletSignal const&) = default;
};

/// A piece of a lane. `left` and `right` run in the direction of travel; what a neighbour is travels the same way.
struct Lanelet {
  std::int64_t id = 0;
  std::vector<geometry::Point> left{}, right{};  ///< at least two points each, map frame [m]
  std::vector<std::int64_t> predecessors{}, successors{};
  std::optional<std::int64_t> left_neighbor{}, right_neighbor{};
  bool may_change_left = true, may_change_right = true;  ///< as the marks say
  LaneType type = LaneType::driving;
  std::optional<double> speed_limit{};  ///< [m/s]
  bool both_directions = false;         ///< driven either way
  bool in_junction = false;             ///< the file says that it lies in an intersection
  std::vector<LaneletSignal> signals{};
  int line = 0;  ///< of the file, for messages; 0: unknown

  /// Compares all but the line.
  friend bool operator==(Lanelet const& a, Lanelet const& b) {
    return a.id == b.id && a.left == b.left && a.right == b.right && a.predecessors == b.predecessors &&
           a.successors == b.successors && a.left_neighbor == b.left_neighbor && a.right_neighbor == b.right_neighbor &&
           a.may_change_left == b.may_change_left && a.may_change_right == b.may_change_right && a.type == b.type &&
           a.speed_limit == b.speed_limit && a.both_directions == b.both_directions && a.in_junction == b.in_junction &&
           a.signals == b.signals;
  }
};

/// A map made of lanelets.
struct LaneletMap {
  std::shared_ptr<Map const> map;
  std::map<std::int64_t, LaneId> lanes;  ///< by the id of the lanelet; without those that were left out
  std::vector<Diagnostic> diagnostics;
};

/// The map of `lanelets`; `file` names them in messages. Lanelets side by side become one road (named by the id of the
/// leftmost), those that cross others, with those that leave or enter the road beside them, a junction. What cannot be
/// used is left out, with a diagnostic: bounds that cross or have fewer than two points, links to lanelets that are not
/// there or do not begin where the other ends (to 0.5 m and 0.5 rad), neighbours that do not lie beside each other.
/// Traffic keeps to the right. Throws `MapError` where no lanelet is left, and as `build_map`. O(n^2) comparisons of
/// boxes for n lanelets.
[[nodiscard]] LaneletMap build_lanelet_map(std::vector<Lanelet> lanelets, MapOptions const& options = {},
                                           std::string const& file = "lanelets");

/// The drivable lanes of a map as lanelets, whose ids are those of the lanes plus `first_id`: what a writer of lanelet
/// formats needs. Linear in the map.
[[nodiscard]] std::vector<Lanelet> lanelets_of(Map const& map, std::int64_t first_id = 1);

}  // namespace cambium::map

#ifndef CAMBIUM_COMPILED
#include "cambium/map/lanelet/lanelet_map_impl.hpp"
#endif
