#pragma once

#include <cmath>
#include <Eigen/Core>

#include "cambium/core/macros.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/map/road/detail/surface_height.hpp"
#include "cambium/map/road/road.hpp"
#include "cambium/map/road/road_surface.hpp"

namespace cambium::map {

CAMBIUM_COLD SurfacePoint surface_at(Road const& road, double s, double t) {
  auto const reference = road.reference_line.at(s);
  auto const [sin, cos] = geometry::sin_cos(reference.heading);
  auto const pitch = geometry::sin_cos(std::atan(road.elevation.derivative(s)));
  auto const roll = geometry::sin_cos(road.superelevation.value(s));
  Eigen::Vector3d const forward(cos * pitch.cos, sin * pitch.cos, pitch.sin);
  Eigen::Vector3d const level(-sin, cos, 0.0), upright(-cos * pitch.sin, -sin * pitch.sin, pitch.cos);
  Eigen::Vector3d const left = roll.cos * level + roll.sin * upright, up = roll.cos * upright - roll.sin * level;
  detail::Height height;
  for (auto const& part :
       {detail::crossfall_height(road, s, t), detail::shape_height(road, s, t), detail::lane_height(road, s, t)}) {
    height.value += part.value;
    height.slope += part.slope;
  }
  double const z = road.elevation.value(s) + road.elevation_offset;
  SurfacePoint point;
  point.position = Eigen::Vector3d(reference.x, reference.y, z) + t * left + height.value * up;
  double const length = std::sqrt(1.0 + height.slope * height.slope);
  point.axes.col(0) = forward;
  point.axes.col(1) = (left + height.slope * up) / length;
  point.axes.col(2) = (up - height.slope * left) / length;
  return point;
}

}  // namespace cambium::map
