#pragma once

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "cambium/core/macros.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/map/road/road_surface.hpp"

namespace cambium::inline v0_1::map {

namespace detail {

/// A height over the road's plane and its slope by t.
struct Height {
  double value{}, slope{};
};

[[nodiscard]] inline Height crossfall_height(Road const& road, double s, double t) {
  double const fall = portable::tan((t > 0.0 ? road.crossfall_left : road.crossfall_right).value(s));
  return {-std::abs(t) * fall, t > 0.0 ? -fall : fall};
}

/// Between two profiles the height runs linearly with s.
[[nodiscard]] inline Height shape_height(Road const& road, double s, double t) {
  auto const& shape = road.shape;
  if (shape.empty()) return {};
  auto const at = [t](ShapeProfile const& p) { return Height{p.height.value(t), p.height.derivative(t)}; };
  auto const next =
      std::find_if(shape.begin(), shape.end(), [s](ShapeProfile const& profile) { return profile.s > s; });
  if (next == shape.begin()) return {};
  Height const before = at(*std::prev(next));
  if (next == shape.end()) return before;
  double const u = (s - std::prev(next)->s) / (next->s - std::prev(next)->s);
  Height const behind = at(*next);
  return {before.value + u * (behind.value - before.value), before.slope + u * (behind.slope - before.slope)};
}

/// Height of the lane that holds t above the road's surface; of two at a border the one nearer to lane 0 counts.
[[nodiscard]] inline Height lane_height(Road const& road, double s, double t) {
  auto const* section = road.section_at(s);
  if (section == nullptr) return {};
  double const ds = s - section->begin;
  Height height;
  double nearest = std::numeric_limits<double>::infinity();
  for (auto const& lane : section->lanes) {
    if (lane.heights.empty() || lane.heights.front().s > ds) continue;
    auto const p = lane_point(road, s, lane.number);
    auto const [low, high] = std::minmax(p->inner_t, p->outer_t);
    if (t < low || t > high || std::abs(lane.number) > nearest) continue;
    nearest = std::abs(lane.number);
    auto const next =
        std::find_if(lane.heights.begin(), lane.heights.end(), [ds](LaneHeight const& h) { return h.s > ds; });
    auto const& record = *std::prev(next);
    double const width = p->outer_t - p->inner_t, slope = width != 0.0 ? (record.outer - record.inner) / width : 0.0;
    height = {record.inner + slope * (t - p->inner_t), slope};
  }
  return height;
}

}  // namespace detail

CAMBIUM_COLD SurfacePoint surface_at(Road const& road, double s, double t) {
  auto const reference = road.reference_line.at(s);
  auto const [sin, cos] = portable::sin_cos(reference.heading);
  auto const pitch = portable::sin_cos(portable::atan(road.elevation.derivative(s)));
  auto const roll = portable::sin_cos(road.superelevation.value(s));
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

}  // namespace cambium::inline v0_1::map
