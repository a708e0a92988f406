#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/core/stable_sort.hpp"
#include "cambium/geometry/line.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/corridor/detail/bends.hpp"
#include "cambium/map/corridor/detail/conflict_ways.hpp"
#include "cambium/map/corridor/free_corridor.hpp"
#include "cambium/map/map.hpp"

namespace cambium::inline v0_1::map::detail {

/// The way through `points` with arcs of `radius` [m] at its corners, or smaller ones where there is less room: at a
/// sharp corner, the border of one leg would block the other.
[[nodiscard]] inline std::vector<geometry::Point> rounded_corners(geometry::Line const& way, double radius) {
  constexpr double slight = 0.2, step = 0.2;  // [rad]
  auto const segments = way.segments();
  std::vector<geometry::Point> points{{segments.front().x, segments.front().y}};
  for (std::size_t i = 1; i < segments.size(); ++i) {
    auto const &in = segments[i - 1], &out = segments[i];
    geometry::Point const corner{out.x, out.y}, u{in.ux, in.uy}, v{out.ux, out.uy};
    double const turn = out.heading - in.heading, size = std::abs(turn);
    if (size < slight) {
      points.push_back(corner);
      continue;
    }
    double const cut = std::min(radius * portable::tan(0.5 * size), 0.45 * std::min(in.length, out.length));
    int const parts = static_cast<int>(std::ceil(size / step));
    for (int k = 0; k <= parts; ++k) {
      double const angle = size * k / parts;                                       // that has been turned by
      double const done = portable::sin(0.5 * angle) / portable::sin(0.5 * size);  // chord over the whole chord
      geometry::Point const begin = corner - cut * u, chord = cut * (u + v);
      double const aside = std::copysign(0.5 * (size - angle), turn);
      double const c = portable::cos(aside), s = -portable::sin(aside);
      points.push_back(begin + done * geometry::Point(c * chord.x() - s * chord.y(), s * chord.x() + c * chord.y()));
    }
  }
  points.push_back(way.points().back());
  return points;
}

/// Where the way crosses drivable lanes: from border to border.
class CrossingFinder {
 public:
  CrossingFinder(Map const& map, FreeCorridorOptions const& options) : map_(map), options_(options) {}

  [[nodiscard]] std::vector<LaneCrossing> find(geometry::Line const& way) {
    constexpr double step = 0.05;  // [m]
    auto const steps = static_cast<std::size_t>(std::ceil(way.length() / step));
    std::uint32_t cursor = 0;
    for (std::size_t i = 0; i <= steps; ++i) {
      double const s = std::min(way.length(), static_cast<double>(i) * step);
      map_.for_each_drivable_near(way.pose(s, cursor).position(), 0.0, [&](LaneHit const& hit) { pass(hit, s, step); });
    }
    for (auto& crossing : crossings_) finish(crossing, step, way.length());
    cambium::detail::stable_sort(crossings_, [](LaneCrossing const& crossing) {
      return std::tuple(crossing.begin, crossing.lane, crossing.lane_begin);
    });
    return std::move(crossings_);
  }

 private:
  /// Extends the crossing of the lane that holds the way at `s`, or begins one.
  void pass(LaneHit const& hit, double s, double step) {
    for (auto& crossing : crossings_) {
      if (crossing.lane != hit.lane || s - crossing.end > 2.0 * step) continue;
      crossing.end = s;
      crossing.lane_begin = std::min(crossing.lane_begin, hit.s);
      crossing.lane_end = std::max(crossing.lane_end, hit.s);
      return;
    }
    crossings_.push_back({hit.lane, s, s, hit.s, hit.s, {}});
  }

  void finish(LaneCrossing& crossing, double step, double length) const {
    auto const& lane = map_.lane(crossing.lane);
    double const half = 0.5 * options_.width;
    crossing.begin = std::max(0.0, crossing.begin - step);
    crossing.end = std::min(length, crossing.end + step);
    crossing.lane_begin = std::max(0.0, crossing.lane_begin - half);
    crossing.lane_end = std::min(lane.length(), crossing.lane_end + half);
    crossing.ways = ways_through(map_, lane, crossing.lane_begin - options_.view, crossing.lane_begin,
                                 crossing.lane_end + farthest_rear);
  }

  static constexpr double farthest_rear = 15.0;  // behind the reference point of a long vehicle [m]

  Map const& map_;
  FreeCorridorOptions const& options_;
  std::vector<LaneCrossing> crossings_;
};

/// See `build_free_corridor`.
[[nodiscard]] inline std::shared_ptr<RoadCorridor const> make_free_corridor(Map const& map,
                                                                            std::span<geometry::Point const> points,
                                                                            FreeCorridorOptions const& options) {
  if (!(options.width > 0.0 && options.width <= 1000.0 && options.view > 0.0 && options.view <= 1e4))
    throw MapError("free corridor", "its width or view is no positive number of metres", "leave them out");
  if (is_drivable(options.type))
    throw MapError("free corridor",
                   "its type, " + std::string(to_string(options.type)) + ", is one of lanes to drive on",
                   "take walking or biking, or build a road corridor");
  LaneCorridor corridor;
  auto const sharp = geometry::Line::from_points(points);
  if (!(sharp.length() <= 10'000.0))
    throw MapError("free corridor", "it is longer than 10 km", "give coordinates in metres");
  corridor.center = geometry::Line::from_points(rounded_corners(sharp, 0.5 * options.width + 0.5));
  auto const count = corridor.center.segments().size();
  corridor.widths.assign(count + 1, {0.5 * options.width, 0.5 * options.width});
  corridor.pieces.push_back(
      {.end = corridor.length(), .type = options.type, .segments = static_cast<std::uint32_t>(count)});
  find_bends(corridor);
  corridor.crossings = CrossingFinder(map, options).find(corridor.center);
  corridor.continues = corridor.reaches_destination = true;  // who comes to its end has arrived
  auto road = std::make_shared<RoadCorridor>();
  road->corridors.push_back(std::move(corridor));
  road->way.assign(points.begin(), points.end());
  road->view = options.view;
  return road;
}

}  // namespace cambium::inline v0_1::map::detail
