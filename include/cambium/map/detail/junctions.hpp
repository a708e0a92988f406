#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "cambium/map/lane.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/opendrive_document.hpp"

namespace cambium::map::detail {

/// The document's junctions, in its order, with the roads and lanes that belong to them.
[[nodiscard]] inline std::vector<Junction> make_junctions(OpenDriveDocument const& document,
                                                          std::span<Road const> roads, std::span<Lane const> lanes) {
  std::vector<Junction> junctions;
  for (auto const& written : document.junctions) {
    Junction junction;
    junction.id = static_cast<JunctionId>(junctions.size());
    junction.name = written.id;
    for (auto const& road : roads)
      if (road.junction == junction.id) junction.roads.push_back(road.id);
    for (auto const& lane : lanes)
      if (roads[index_of(lane.road)].junction == junction.id) junction.lanes.push_back(lane.id);
    junctions.push_back(std::move(junction));
  }
  return junctions;
}

}  // namespace cambium::map::detail
