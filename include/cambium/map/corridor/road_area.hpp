#pragma once

#include <vector>

#include "cambium/geometry/polygon_union.hpp"
#include "cambium/map/corridor/corridor.hpp"

namespace cambium::inline v0_1::map {

/// The ground of all lanes of `road`. Each is widened by `growth` [m] to either side, so that no slits are left between
/// lanes side by side, whose common border is sampled twice.
[[nodiscard]] std::vector<geometry::Area> area_of(RoadCorridor const& road, double growth = 0.05);

}  // namespace cambium::inline v0_1::map

#ifndef CAMBIUM_COMPILED
#include "cambium/map/corridor/road_area_impl.hpp"
#endif
