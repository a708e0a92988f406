#pragma once

#include <utility>

#include "cambium/core/macros.hpp"
#include "cambium/geometry/polygon.hpp"
#include "cambium/map/corridor/lane_area.hpp"
#include "cambium/map/corridor/road_area.hpp"

namespace cambium::inline v0_1::map {

CAMBIUM_COLD std::vector<geometry::Area> area_of(RoadCorridor const& road, double growth) {
  std::vector<geometry::Polygon> polygons;
  for (auto const& corridor : road.corridors)
    for (auto& polygon : area_of(corridor, detail::whole_path, growth)) polygons.push_back(std::move(polygon));
  return geometry::union_of(polygons);
}

}  // namespace cambium::inline v0_1::map
