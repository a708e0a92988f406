#pragma once

#include <vector>

#include "cambium/map/opendrive/document.hpp"
#include "cambium/map/road/road.hpp"

namespace cambium::inline v0_1::map {

/// The roads that a document describes, in its order, header offset applied: all that exact queries (`lane_point`,
/// `surface_at`, `project`) need, without the sampled lanes of a `Map`. `RoadLane::id` names none yet. Linear in the
/// document.
[[nodiscard]] std::vector<Road> make_roads(OpenDriveDocument const& document);

}  // namespace cambium::inline v0_1::map

#ifndef CAMBIUM_COMPILED
#include "cambium/map/building/make_roads_impl.hpp"
#endif
