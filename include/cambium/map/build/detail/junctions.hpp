#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "cambium/map/detail/id_places.hpp"
#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/opendrive/document.hpp"

namespace cambium::map::detail {

/// The document's junctions, in its order (the roads' junction ids count so), with the roads and lanes that belong to
/// them. Priorities between roads that are not in the map are left out.
[[nodiscard]] inline std::vector<Junction> make_junctions(OpenDriveDocument const& document,
                                                          std::span<Road const> roads, std::span<Lane const> lanes) {
  IdPlaces ids;
  for (auto const& road : roads) ids.emplace(road.name, index_of(road.id));
  std::vector<Junction> junctions;
  for (auto const& written : document.junctions) {
    Junction junction;
    junction.id = static_cast<JunctionId>(junctions.size());
    junction.name = written.id;
    for (auto const& priority : written.priorities)
      if (ids.contains(priority.high) && ids.contains(priority.low))
        junction.priorities.push_back(
            {static_cast<RoadId>(ids.at(priority.high)), static_cast<RoadId>(ids.at(priority.low))});
    junctions.push_back(std::move(junction));
  }
  for (auto const& road : roads)
    if (is_valid(road.junction)) junctions[index_of(road.junction)].roads.push_back(road.id);
  for (auto const& lane : lanes)
    if (auto const id = roads[index_of(lane.road)].junction; is_valid(id))
      junctions[index_of(id)].lanes.push_back(lane.id);
  return junctions;
}

}  // namespace cambium::map::detail
