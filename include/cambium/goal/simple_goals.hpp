#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "cambium/core/error.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/collision.hpp"
#include "cambium/geometry/oriented_box.hpp"
#include "cambium/geometry/polygon.hpp"
#include "cambium/goal/goal_situation.hpp"

namespace cambium::inline v0_1 {

namespace detail {
/// All numbers, infinity included.
inline constexpr Range any_number{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
/// Throws `ParameterError` if no position lies between `from` and `to` [m].
inline void check_stretch(double from, double to, std::string const& where) {
  if (!(from <= to)) throw ParameterError(where, "its goal's stretch of lane ends before it begins", "give from <= to");
}

/// Throws `ParameterError` if no speed [m/s] lies between the limits.
inline void check_speeds(double lowest, double highest, std::string const& where) {
  if (!(lowest <= highest))
    throw ParameterError(where, "lowest_speed is above highest_speed: the goal can never be reached", "swap them");
}

}  // namespace detail

/// No goal. Without a given route, the agent drives straight on for 2 km (see `map::straight_route`), or until the
/// route would return to one of its lanes.
struct NoGoal {
  static constexpr char const* name = "no_goal";
  static constexpr char const* summary = "never reached; the route goes straight on";
  static constexpr auto parameters() { return parameter_list(); }
  [[nodiscard]] bool at_goal(GoalSituation const&) const { return false; }
};

/// Reached when the agent's whole shape is inside `area` (map frame).
struct ReachPolygon {
  static constexpr char const* name = "reach_polygon";
  static constexpr char const* summary = "the whole shape is within a polygon";
  geometry::Polygon area;

  static constexpr auto parameters() {
    return parameter_list(parameter("area", &ReachPolygon::area, "m", any_finite, "the corners of the polygon"));
  }
  void check(std::string const& where) const {
    if (area.size() == 0) throw ParameterError(where, "its area has no corners", "give at least three");
  }
  [[nodiscard]] bool at_goal(GoalSituation const& at) const {
    return geometry::contains(area, geometry::box_of(at.shape, at.pose));
  }
};

namespace detail {

/// Whether the reference point is between the borders of its lane; true without a road. O(log n).
[[nodiscard]] inline bool is_in_lane(GoalSituation const& at) {
  if (at.road == nullptr) return true;
  auto const sides = at.road->corridors[at.corridor].widths_at(at.s);
  return at.lateral <= sides.left && -at.lateral <= sides.right;
}

}  // namespace detail

/// Reached when the reference point is in `lane`, between its borders, and between `from` and `to` [m] along its path.
struct ReachLane {
  LaneId lane = none<LaneId>;
  double from = 0.0;
  double to = std::numeric_limits<double>::infinity();

  static constexpr char const* name = "reach_lane";
  static constexpr char const* summary = "the reference point is in a lane, between two positions along its path";
  static constexpr auto parameters() {
    return parameter_list(
        parameter("lane", &ReachLane::lane, "of the map"),
        parameter("from", &ReachLane::from, "m", detail::any_number, "along the path of the lane"),
        parameter("to", &ReachLane::to, "m", detail::any_number, "along the path of the lane, at least from"));
  }
  void check(std::string const& where) const { detail::check_stretch(from, to, where); }

  [[nodiscard]] bool at_goal(GoalSituation const& at) const {
    return at.lane == lane && at.lane_position >= from && at.lane_position <= to && detail::is_in_lane(at);
  }
};

/// Reached when heading and speed are within limits, bounds included, at any position. The headings run
/// counter-clockwise from `heading_from` to `heading_to`, also across pi; a range of 2 pi or more allows all headings.
struct StateLimits {
  double heading_from = -geometry::pi;                             ///< [rad], any turn
  double heading_to = geometry::pi;                                ///< [rad], not below `heading_from`, or a turn less
  double lowest_speed = -std::numeric_limits<double>::infinity();  ///< [m/s]
  double highest_speed = std::numeric_limits<double>::infinity();  ///< [m/s]

  static constexpr char const* name = "state_limits";
  static constexpr char const* summary = "heading (also across pi) and speed within limits";
  static constexpr auto parameters() {
    using P = StateLimits;
    return parameter_list(
        parameter("heading_from", &P::heading_from, "rad", any_finite, "counter-clockwise from here"),
        parameter("heading_to", &P::heading_to, "rad", any_finite, "to here; a range of 2 pi allows all headings"),
        parameter("lowest_speed", &P::lowest_speed, "m/s", detail::any_number, "lower bound of the speed"),
        parameter("highest_speed", &P::highest_speed, "m/s", detail::any_number, "upper bound of the speed"));
  }
  void check(std::string const& where) const {
    detail::check_speeds(lowest_speed, highest_speed, where);
    if (heading_to < heading_from - 2 * geometry::pi)
      throw ParameterError(where, "heading_to is more than a turn below heading_from: the goal is never reached",
                           "give the heading that follows counter-clockwise");
  }

  [[nodiscard]] bool at_goal(GoalSituation const& at) const {
    return has_heading(at.pose.heading) && at.speed >= lowest_speed && at.speed <= highest_speed;
  }

 private:
  [[nodiscard]] bool has_heading(double heading) const {
    constexpr double turn = 2 * geometry::pi, rounding = 1e-12;
    double const wide = heading_to - heading_from;
    if (wide >= turn) return true;
    double const half = 0.5 * (wide < 0.0 ? wide + turn : wide);
    return std::abs(geometry::angle_difference(heading, heading_from + half)) <= half + rounding;
  }
};

/// Reached when the agent drives along a lane within limits in its Frenet frame, bounds included. `lane` none means the
/// agent's current lane; without `left` and `right`, its reference point is between the borders.
struct LaneLimits {
  LaneId lane = none<LaneId>;
  double from = 0.0;                                               ///< along the lane's path [m]
  double to = std::numeric_limits<double>::infinity();             ///< [m]
  double left = std::numeric_limits<double>::infinity();           ///< farthest to the left of the path [m]
  double right = std::numeric_limits<double>::infinity();          ///< farthest to the right of the path [m]
  double heading_error = geometry::pi;                             ///< largest angle to the path, either way [rad]
  double lowest_speed = -std::numeric_limits<double>::infinity();  ///< [m/s]
  double highest_speed = std::numeric_limits<double>::infinity();  ///< [m/s]

  static constexpr char const* name = "lane_limits";
  static constexpr char const* summary = "within limits in the Frenet frame of a lane, or of the agent's current lane";
  static constexpr auto parameters() {
    using P = LaneLimits;
    return parameter_list(
        parameter("lane", &P::lane, "a lane of the map; none: the agent's current lane"),
        parameter("from", &P::from, "m", detail::any_number, "along the path of the lane"),
        parameter("to", &P::to, "m", detail::any_number, "along the path of the lane, at least from"),
        parameter("left", &P::left, "m", detail::any_number, "farthest to the left of the path"),
        parameter("right", &P::right, "m", detail::any_number, "farthest to the right of the path"),
        parameter("heading_error", &P::heading_error, "rad", non_negative, "largest angle to the path, either way"),
        parameter("lowest_speed", &P::lowest_speed, "m/s", detail::any_number, "lower bound of the speed"),
        parameter("highest_speed", &P::highest_speed, "m/s", detail::any_number, "upper bound of the speed"));
  }
  void check(std::string const& where) const {
    detail::check_stretch(from, to, where);
    detail::check_speeds(lowest_speed, highest_speed, where);
    if (!(-right <= left))
      throw ParameterError(where, "left and right leave no room: the goal can never be reached", "give left >= -right");
  }

  [[nodiscard]] bool at_goal(GoalSituation const& at) const {
    return (!is_valid(lane) || at.lane == lane) && at.lane_position >= from && at.lane_position <= to &&
           at.lateral <= left && at.lateral >= -right && std::abs(at.heading_error) <= heading_error &&
           at.speed >= lowest_speed && at.speed <= highest_speed &&
           (std::isfinite(left) || std::isfinite(right) || detail::is_in_lane(at));
  }
};

/// Reached within `distance` [m] of the end of the agent's current lane corridor: where its lane, with its successors
/// on the route, ends.
struct ReachLaneEnd {
  double distance = 10.0;

  static constexpr char const* name = "reach_lane_end";
  static constexpr char const* summary = "near the end of the lane corridor";
  static constexpr auto parameters() {
    return parameter_list(
        parameter("distance", &ReachLaneEnd::distance, "m", non_negative, "to the end of the lane corridor"));
  }

  [[nodiscard]] bool at_goal(GoalSituation const& at) const {
    return at.road != nullptr && at.road->corridors[at.corridor].length_until_end(at.s) <= distance;
  }
};

/// Reached in the lane corridor to the left or right of the corridor of lane `from`, within `tolerance` [m] of its
/// centre line. `from` none means the lane in which the agent enters; `World::add` fills it in.
struct ReachLaneBeside {
  enum class Side : std::uint8_t { left, right };

  Side side = Side::left;
  LaneId from = none<LaneId>;
  double tolerance = 0.5;

  static constexpr char const* name = "reach_lane_beside";
  static constexpr char const* summary =
      "in the lane corridor to the left or right of the one where it entered: a lane change";
  static constexpr auto parameters() {
    using P = ReachLaneBeside;
    return parameter_list(
        choice("side", &P::side, "left|right", "side of the lane corridor of `from`"),
        parameter("from", &P::from, "reference lane of the map; none: the lane in which the agent enters"),
        parameter("tolerance", &P::tolerance, "m", non_negative, "from the centre line of that corridor"));
  }

  [[nodiscard]] bool at_goal(GoalSituation const& at) const {
    if (at.road == nullptr || !is_valid(from) || std::abs(at.lateral) > tolerance) return false;
    auto const holds = [&](CorridorId corridor) {
      auto const& pieces = at.road->corridors[corridor].pieces;
      return std::any_of(pieces.begin(), pieces.end(), [&](auto const& piece) { return piece.lane == from; });
    };
    if (holds(at.corridor)) return false;
    for (auto const& piece : at.road->corridors[at.corridor].pieces) {
      auto const back = side == Side::left ? piece.right : piece.left;
      if (back != none<CorridorId> && holds(back)) return true;
    }
    return false;
  }
};

}  // namespace cambium::inline v0_1
