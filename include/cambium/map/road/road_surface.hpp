#pragma once

#include <Eigen/Core>

#include "cambium/map/road/road.hpp"

namespace cambium::inline v0_1::map {

/// A point of the road's surface in space, and how the surface lies there.
struct SurfacePoint {
  Eigen::Vector3d position;  ///< [m], z up
  Eigen::Matrix3d axes;      ///< orthonormal; columns: forward (increasing s), left, up from the surface
};

/// The point of the road's surface at station `s` and lateral offset `t` [m]: elevation along the road, and across it
/// superelevation, crossfall, shape and lane heights. The t axis lies in the plane that superelevation turns about the
/// reference line, so that its plan view is shorter than in the planar queries (`point_at`, `lane_point`), which lay t
/// out horizontally. Heights stand upright on that plane. O(lanes) more than `lane_point`.
[[nodiscard]] SurfacePoint surface_at(Road const& road, double s, double t);

}  // namespace cambium::inline v0_1::map

#ifndef CAMBIUM_COMPILED
#include "cambium/map/road/road_surface_impl.hpp"
#endif
