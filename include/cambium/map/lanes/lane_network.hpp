#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/lanes/network_finding.hpp"
#include "cambium/map/map.hpp"

namespace cambium::map {

/// What is odd about how the lanes hang together, lane by lane in the order of their ids. Links of all lanes are
/// looked at; joints and ends only of drivable ones. Dead ends and lanes without a way in are no fault at the border
/// of a map. The number of a lane must be its place in `lanes`. O(n log n).
[[nodiscard]] std::vector<NetworkFinding> check_lane_network(std::span<Lane const> lanes,
                                                             NetworkTolerances const& tolerances = {});

/// As above, for a map, whoever built it.
[[nodiscard]] std::vector<NetworkFinding> check_lane_network(Map const& map, NetworkTolerances const& tolerances = {});

}  // namespace cambium::map

namespace cambium {
using map::check_lane_network;
using map::NetworkFault;
using map::NetworkFinding;
}  // namespace cambium

#ifndef CAMBIUM_COMPILED
#include "cambium/map/lanes/lane_network_impl.hpp"
#endif
