#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/map.hpp"

namespace cambium::inline v0_1::map {

/// What can be odd about the links between lanes.
enum class NetworkFault : std::uint8_t {
  dangling,       ///< a successor or predecessor that is not in the map
  one_sided,      ///< a successor that does not have the lane as predecessor, or the other way round
  gap,            ///< the path of a successor does not begin where this lane's path ends
  border_step,    ///< the paths meet without a kink, but the borders do not: the width jumps
  kink,           ///< a successor begins in another direction
  possible_link,  ///< the lane has no successor, but ends where a lane without predecessor begins
  dead_end,       ///< the lane has no successor, and nothing begins at its end
  no_way_in,      ///< the lane has no predecessor, and nothing ends at its begin
};

/// The name of a fault, such as "border_step".
[[nodiscard]] constexpr std::string_view to_string(NetworkFault fault) {
  constexpr std::string_view words[] = {"dangling", "one_sided",     "gap",      "border_step",
                                        "kink",     "possible_link", "dead_end", "no_way_in"};
  return words[static_cast<std::size_t>(fault)];
}

/// One finding about a lane's end (or for `no_way_in` its begin).
struct NetworkFinding {
  NetworkFault fault = NetworkFault::gap;
  LaneId lane = none<LaneId>;
  LaneId other = none<LaneId>;  ///< the lane that it is joined with, or could be; none for dead ends and no way in
  double size{};                ///< distance [m]; of a kink the angle [rad], positive to the left

  friend bool operator==(NetworkFinding const&, NetworkFinding const&) = default;
};

/// Thresholds above which a deviation is reported.
struct NetworkTolerances {
  double gap = 0.01;            ///< between path ends, and between border ends [m]
  double kink = 0.1;            ///< [rad]
  double link_distance = 0.5;   ///< of a possible link [m]
  double link_direction = 0.2;  ///< of a possible link [rad]
};

/// What is odd about the links between the lanes, in the order of the lanes' ids. It checks the links of all lanes, but
/// joints and ends of drivable ones only. At the border of a map, dead ends and lanes without a way in are no fault.
/// The number of a lane must be its place in `lanes`. O(n log n).
[[nodiscard]] std::vector<NetworkFinding> check_lane_network(std::span<Lane const> lanes,
                                                             NetworkTolerances const& tolerances = {});

/// As above, for a map.
[[nodiscard]] std::vector<NetworkFinding> check_lane_network(Map const& map, NetworkTolerances const& tolerances = {});

}  // namespace cambium::inline v0_1::map

namespace cambium::inline v0_1 {
using map::check_lane_network;
using map::NetworkFault;
using map::NetworkFinding;
}  // namespace cambium::inline v0_1

#ifndef CAMBIUM_COMPILED
#include "cambium/map/lanes/lane_network_impl.hpp"
#endif
