#pragma once

#include "cambium/core/ids.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/map/building/detail/make_road.hpp"
#include "cambium/map/building/make_roads.hpp"
#include "cambium/map/detail/id_places.hpp"

namespace cambium::inline v0_1::map {

CAMBIUM_COLD std::vector<Road> make_roads(OpenDriveDocument const& document) {
  auto const junctions = detail::places_of(document.junctions);
  std::vector<Road> roads;
  roads.reserve(document.roads.size());
  for (auto const& source : document.roads) {
    roads.push_back(detail::make_road(source, static_cast<RoadId>(roads.size()), document.header.offset));
    if (auto const at = junctions.find(source.junction); at != junctions.end())
      roads.back().junction = static_cast<JunctionId>(at->second);
  }
  return roads;
}

}  // namespace cambium::inline v0_1::map
