#pragma once

#include <utility>
#include <vector>

#include "cambium/geometry/polygon.hpp"
#include "cambium/geometry/polygon_union.hpp"
#include "cambium/map/corridor.hpp"
#include "cambium/map/lane_area.hpp"

namespace cambium::map {

/// The ground of all lanes of `road`. Each is widened by `growth` [m] to either side, so that no slits are left between
/// lanes side by side, whose common border is sampled twice.
[[nodiscard]] inline std::vector<geometry::Area> area_of(RoadCorridor const& road, double growth = 0.05) {
  std::vector<geometry::Polygon> polygons;
  for (auto const& corridor : road.corridors)
    for (auto& polygon : area_of(corridor, detail::whole_path, growth)) polygons.push_back(std::move(polygon));
  return geometry::union_of(polygons);
}

}  // namespace cambium::map
