#pragma once

#include "cambium/core/macros.hpp"
#include "cambium/map/detail/network_check.hpp"
#include "cambium/map/lanes/lane_network.hpp"

namespace cambium::inline v0_1::map {

CAMBIUM_COLD std::vector<NetworkFinding> check_lane_network(std::span<Lane const> lanes,
                                                            NetworkTolerances const& tolerances) {
  return detail::NetworkCheck(lanes, tolerances).run();
}

CAMBIUM_COLD std::vector<NetworkFinding> check_lane_network(Map const& map, NetworkTolerances const& tolerances) {
  return check_lane_network(map.lanes(), tolerances);
}

}  // namespace cambium::inline v0_1::map
