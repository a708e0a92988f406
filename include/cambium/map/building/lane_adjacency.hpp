#pragma once

#include <string>
#include <vector>

#include "cambium/map/opendrive/document.hpp"
#include "cambium/map/road/road.hpp"

namespace cambium::inline v0_1::map {

/// That one meets lane `next_lane` of `next_road` at its end `next_end` when leaving `road` at its end `end` in lane
/// `lane`: as the file says, whatever way lanes are driven.
struct LaneAdjacency {
  std::string road;
  opendrive::ContactPoint end = opendrive::ContactPoint::none;
  int lane = 0;
  std::string next_road;
  opendrive::ContactPoint next_end = opendrive::ContactPoint::none;
  int next_lane = 0;
  std::string junction;  ///< whose connection says so; empty: the road's own link

  friend bool operator==(LaneAdjacency const&, LaneAdjacency const&) = default;
};

/// Which lanes meet at the ends of roads, as written: by the roads' own links, in the order of the roads, then by the
/// junctions' connections, from the incoming road into the road that is entered. Where they lead is found as for a
/// `Map`. Links to roads or lanes that are not there are left out, and so are those to the middle of a road. `roads` is
/// what `make_roads` makes of the document. O(document) but for the lanes of a section.
[[nodiscard]] std::vector<LaneAdjacency> lane_adjacency(OpenDriveDocument const& document,
                                                        std::vector<Road> const& roads);

}  // namespace cambium::inline v0_1::map

#ifndef CAMBIUM_COMPILED
#include "cambium/map/building/lane_adjacency_impl.hpp"
#endif
