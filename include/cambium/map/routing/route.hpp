#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "cambium/core/described.hpp"
#include "cambium/core/ids.hpp"
#include "cambium/map/lanes/lane.hpp"

namespace cambium::inline v0_1::map {

/// The way from a start to a destination: lanes in order; neighbours in the list are successors, or beside each other
/// (a lane change).
struct Route {
  std::vector<LaneId> lanes;
  double length{};  ///< driven [m]: of lanes beside each other only the last one counts
  double cost{};    ///< by the options that it was found with

  static constexpr char const* name = "route";
  static constexpr auto parameters() {
    return parameter_list(parameter("lanes", &Route::lanes, "in order"),
                          parameter("length", &Route::length, "m", non_negative, "driven"),
                          parameter("cost", &Route::cost, "-", non_negative, "by the options it was found with"));
  }
};

/// What a route search minimises.
enum class RouteCost : std::uint8_t {
  length,  ///< [m]
  time,    ///< [s] at the speed limit
};

/// Options of a route search.
struct RouteOptions {
  RouteCost cost = RouteCost::length;
  /// Cost of driving a whole lane, instead of `cost`; not negative, infinite closes the lane. Called once a lane and
  /// query. A part of a lane costs its share.
  std::function<double(Lane const&)> own_cost{};
  double lane_change_cost =
      10.0;  ///< of a change to a neighbouring lane, in the unit of the cost; infinite: no changes
  /// A change needs a place where the road marks permit it (behind the start, before the destination on their lanes).
  bool obey_lane_marks = true;
  double default_speed = 50.0 / 3.6;  ///< where there is no speed limit [m/s]
  std::size_t max_routes = 3;         ///< how many `Map::routes` gives at most
};

/// A lane that can be reached, and what it costs to come into it.
struct ReachedLane {
  LaneId lane = none<LaneId>;
  double cost{};
};

}  // namespace cambium::inline v0_1::map
