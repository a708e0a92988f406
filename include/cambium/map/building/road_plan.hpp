#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "cambium/map/opendrive/document.hpp"
#include "cambium/map/road/cubic.hpp"
#include "cambium/map/road/lane_type.hpp"
#include "cambium/map/road/reference_line.hpp"

namespace cambium::inline v0_1::map {

/// A lane of one section.
struct LanePlan {
  LaneType type = LaneType::driving;
  double width = 3.5;                   ///< [m]
  std::optional<double> end_width{};    ///< [m] at the section's end, reached with borders that start and end parallel
  std::vector<CubicRecord> widths{};    ///< instead of the two before; sorted, s counts from the section's start
  std::optional<double> speed_limit{};  ///< [m/s]; else the road's
  /// Mark of the outer border; without one broken towards a lane of the same direction, else solid.
  std::optional<opendrive::RoadMark> mark{};
  /// Lane id in the road's next section that it goes on as, 0: it ends. Without one it goes on as the lane of the same
  /// id where that is drivable if and only if this one is.
  std::optional<int> next{};
};

/// Lanes from the road's middle outwards: `left` get the ids 1, 2, ..., `right` -1, -2, ...
struct SectionPlan {
  double s = 0.0;  ///< start station [m]; the first section's is 0
  std::vector<LanePlan> left{}, right{};
  std::optional<opendrive::RoadMark> middle_mark{};  ///< between left and right; without one solid
};

/// A road to be made.
struct RoadPlan {
  std::string id{};  ///< empty: the next free number
  std::string name{};
  std::vector<Geometry> line{};  ///< see `lay_from`, `lay_to`, `connecting_curve`, `curve_through`
  std::vector<SectionPlan> sections{};
  std::vector<CubicRecord> lane_offset{};  ///< t of the border between left and right lanes; sorted
  std::string type{};                      ///< OpenDRIVE's word, such as "town", "rural", "motorway"
  std::optional<double> speed_limit{};     ///< [m/s]
  opendrive::DrivingSide rule = opendrive::DrivingSide::right_hand;
  std::string junction{};  ///< the junction that it is a connecting road of; empty: none
};

/// One end of a road.
struct RoadEnd {
  std::string road;
  opendrive::ContactPoint end = opendrive::ContactPoint::end;

  friend bool operator==(RoadEnd const&, RoadEnd const&) = default;
};

/// `count` lanes of equal width [m].
[[nodiscard]] inline std::vector<LanePlan> equal_lanes(std::size_t count, double width = 3.5,
                                                       LaneType type = LaneType::driving) {
  return std::vector<LanePlan>(count, LanePlan{.type = type, .width = width});
}

/// A white mark, 0.15 m wide where it is not "none".
[[nodiscard]] inline opendrive::RoadMark make_mark(std::string const& type,
                                                   opendrive::LaneChangePermission lane_change) {
  return {0.0, type, "white", type == "none" ? 0.0 : 0.15, lane_change, "standard"};
}

/// From `from` at station `s` to `to` `length` [m] further on, with slope 0 at both.
[[nodiscard]] inline CubicRecord smooth_step(double s, double from, double to, double length) {
  double const rise = to - from;
  if (rise == 0.0) return {s, from, 0.0, 0.0, 0.0};
  return {s, from, 0.0, 3.0 * rise / (length * length), -2.0 * rise / (length * length * length)};
}

}  // namespace cambium::inline v0_1::map
