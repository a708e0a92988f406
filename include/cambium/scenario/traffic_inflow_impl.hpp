#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "cambium/core/macros.hpp"
#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/scenario/traffic_inflow.hpp"

namespace cambium::inline v0_1 {

namespace detail {

CAMBIUM_COLD double entering_speed(Map const& map, map::LaneCorridor const& corridor, double s,
                                   geometry::Shape const& shape, InflowRules const& rules) {
  double speed = corridor.speed_limit_at(s);
  auto const slow_down = [&](double room, double to) {
    speed = std::min(speed, room < 0.0 ? to - 1e-9 : std::sqrt(to * to + 2.0 * rules.deceleration * room));
  };
  for (auto const& step : corridor.speed_limits)
    if (step.begin > s) slow_down(step.begin - s, step.limit);
  for (auto const& bend : corridor.bends)
    if (bend.end > s) slow_down(std::max(0.0, bend.begin - s), std::sqrt(rules.lateral_acceleration / bend.curvature));
  for (auto const& signal : corridor.signals)
    if (signal.line > s + shape.front) slow_down(signal.line - s - shape.front, 0.0);
  bool const large = !map.options().conflict_shape.holds(shape);
  for (auto const& conflict : corridor.conflicts)
    if (conflict.hull().end > s) slow_down(conflict.section[large][1].place_to_wait(shape.front, false) - s - 1.0, 0.0);
  return speed;
}

CAMBIUM_COLD void check_sources(Map const& map, std::vector<TrafficSource> const& sources) {
  for (std::size_t i = 0; i < sources.size(); ++i) {
    auto const& source = sources[i];
    auto const where = "traffic source " + std::to_string(i);
    if (!source.way && index_of(source.lane) >= map.lanes().size())
      throw WorldError(where, "it has no lane of this map, and no way", "take it as find_sources returns it");
    constexpr double most = 1e9;  // [1/h]
    if (!(source.per_hour > 0.0) || (source.per_hour > most && source.per_hour != TrafficSource::saturated))
      throw WorldError(where, "its demand is " + detail::rounded_text(source.per_hour) + " agents per hour",
                       "give one above 0 and up to 1e9, or TrafficSource::saturated, or leave the source out");
  }
}

}  // namespace detail

CAMBIUM_COLD std::vector<TrafficSource> find_sources(Map const& map) {
  std::vector<TrafficSource> sources;
  for (auto const& lane : map.lanes()) {
    auto const& width = lane.widths.front();
    if (!lane.drivable() || !lane.predecessors.empty() || is_valid(lane.opposite)) continue;
    if (map.in_junction(lane.id) || width.left + width.right < 2.5) continue;
    if (map::straight_route(map, lane.id, 100.0).length >= 30.0) sources.push_back({.lane = lane.id});
  }
  return sources;
}

CAMBIUM_COLD bool fits_route(Map const& map, map::Route const& route, geometry::Shape const& shape) {
  double const sharpest = 0.9 / (0.5 * shape.front * shape.front);  // [1/m]: it swings out by 0.9 m
  return std::all_of(route.lanes.begin(), route.lanes.end(), [&](LaneId id) {
    auto const segments = map.lane(id).path.segments();
    return map.in_junction(id) || std::all_of(segments.begin(), segments.end(), [&](auto const& segment) {
             return std::abs(segment.curvature) < sharpest;
           });
  });
}

CAMBIUM_COLD map::Route random_route(Map const& map, LaneId from, RandomStream& random, double longest) {
  if (index_of(from) >= map.lanes().size())
    throw WorldError("random_route", "the map has no such lane", "take one of find_sources, or of Map::lanes");
  auto const is_drivable = [&](LaneId lane) { return map.lane(lane).drivable(); };
  cambium::map::Route route;
  // Draws the route anew; false where it would come round.
  auto const draw_route = [&] {
    route = {{from}, map.lane(from).length()};
    while (route.length < longest || map.in_junction(route.lanes.back())) {
      std::vector<LaneId> next;
      auto const& successors = map.lane(route.lanes.back()).successors;
      for (auto const lane : successors)
        if (is_drivable(lane) && std::find(route.lanes.begin(), route.lanes.end(), lane) == route.lanes.end())
          next.push_back(lane);
      if (next.empty()) return std::ranges::none_of(successors, is_drivable);
      route.lanes.push_back(next[uniform_index(random, static_cast<std::uint32_t>(next.size()))]);
      route.length += map.lane(route.lanes.back()).length();
    }
    return true;
  };
  for (int draws = 0; draws < 20; ++draws)
    if (draw_route()) return route;
  // It ends before lanes that others cross or merge into.
  auto const goes_on = [&](map::Lane const& last) {
    return std::ranges::any_of(last.successors, is_drivable) && (map.in_junction(last.id) || !last.overlaps.empty());
  };
  while (route.lanes.size() > 1 && goes_on(map.lane(route.lanes.back()))) {
    route.length -= map.lane(route.lanes.back()).length();
    route.lanes.pop_back();
  }
  return route;
}

}  // namespace cambium::inline v0_1
