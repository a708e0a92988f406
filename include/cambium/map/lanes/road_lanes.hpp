#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/core/stable_sort.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/road/road.hpp"
#include "cambium/map/road/station_offset.hpp"

namespace cambium::inline v0_1::map {

/// A place on a road, and the lane that it is in.
struct RoadPlace {
  RoadId road = none<RoadId>;
  int number{};                ///< the file's lane id
  LaneId lane = none<LaneId>;  ///< none where the section is too short to be sampled
  double s{};                  ///< station [m]
  double t{};                  ///< lateral offset from the reference line, left positive [m]
  double distance{};           ///< from the lane's centre, across the road [m]
};

namespace detail {

/// Appends the lanes of `road` at (`foot.s`, `foot.t`).
inline void add_lanes_at(Road const& road, StationOffset const& foot, std::vector<RoadPlace>& places) {
  constexpr double tolerance = 1e-6;  // [m]
  bool const is_beside = foot.distance <= std::abs(foot.t) + tolerance;
  bool const at_end = foot.s <= tolerance || foot.s >= road.length - tolerance;
  if (at_end && !is_beside) return;                                            // beyond an end of the road
  double const t = is_beside ? foot.t : std::copysign(foot.distance, foot.t);  // on the outer side of a kink
  auto const* section = road.section_at(foot.s);
  if (section == nullptr) return;
  for (auto const& lane : section->lanes) {
    auto const p = lane_point(road, foot.s, lane.number);
    auto const [low, high] = std::minmax(p->inner_t, p->outer_t);
    if (p->width > 0.0 && t >= low - tolerance && t <= high + tolerance)
      places.push_back({road.id, lane.number, lane.id, foot.s, t, std::abs(t - p->t)});
  }
}

}  // namespace detail

/// As `lane_point` of its road: the lane `id` at road station `s` [m]; nothing outside of its section.
[[nodiscard]] inline std::optional<LanePoint> lane_point(Map const& map, LaneId id, double s) {
  auto const& lane = map.lane(id);
  if (!(s >= lane.road_begin && s <= lane.road_end)) return std::nullopt;
  auto const& road = map.road(lane.road);
  // At its end the next section begins: there the lane is what it is just before.
  return lane_point(road, s == lane.road_end && s < road.length ? std::nextafter(s, lane.road_begin) : s, lane.number);
}

/// The exact place of `p` on the road of `hit`, which `Map::lanes_near` or `Map::nearest_lane` has found for it. Some
/// evaluations of the reference line.
[[nodiscard]] inline StationOffset exact_place(Map const& map, geometry::Point const& p, LaneHit const& hit) {
  auto const& lane = map.lane(hit.lane);
  return project(map.road(lane.road).reference_line, p, lane.station_at(hit.s, hit.segment));
}

/// All lanes (of any type) that hold `p`, exactly, borders included to a micrometre; that whose centre is nearest
/// first. Planar: where roads pass over each other, lanes of both. O(log n) and some evaluations of reference lines.
[[nodiscard]] inline std::vector<RoadPlace> road_places(Map const& map, geometry::Point const& p) {
  double const reach = 2.0 * map.options().position_tolerance + 0.01;  // sampled lanes are so near to the exact ones
  std::vector<RoadPlace> places;
  for (auto const& hit : map.lanes_near(p, reach))
    detail::add_lanes_at(map.road(map.lane(hit.lane).road), exact_place(map, p, hit), places);
  // The lanes of a road lead to the same places.
  cambium::detail::stable_sort(places, [](RoadPlace const& at) { return std::tuple(at.road, at.number, at.s); });
  auto const is_same = [](RoadPlace const& a, RoadPlace const& b) {
    return a.road == b.road && a.number == b.number && std::abs(a.s - b.s) < 1e-6;
  };
  places.erase(std::unique(places.begin(), places.end(), is_same), places.end());
  cambium::detail::stable_sort(places,
                               [](RoadPlace const& at) { return std::tuple(at.distance, at.road, at.number, at.s); });
  return places;
}

}  // namespace cambium::inline v0_1::map
