#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "cambium/core/error.hpp"
#include "cambium/map/corridor/build_corridor.hpp"
#include "cambium/map/corridor/lane_area.hpp"
#include "cambium/map/corridor/lane_place.hpp"
#include "cambium/map/corridor/road_area.hpp"
#include "cambium/map/lanes/junction.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/road/road_surface.hpp"
#include "cambium/map/road/station_offset.hpp"
#include "cambium/viewer/map_picture.hpp"

/// What users do with a map, with a bounded amount of work: whatever file it was made of, all of it must work.
namespace map_use {

using namespace cambium;
using namespace cambium::map;

/// At most `count` of the numbers below `size`, evenly spread.
inline std::vector<std::size_t> some_of(std::size_t size, std::size_t count) {
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < std::min(size, count); ++i) numbers.push_back(i * size / std::min(size, count));
  return numbers;
}

inline bool is_finite(std::vector<geometry::Polygon> const& polygons) {
  return std::all_of(polygons.begin(), polygons.end(),
                     [](auto const& polygon) { return std::isfinite(polygon.area()) && polygon.area() >= 0.0; });
}

inline std::string fault_of(Map const& map, LaneCorridor const& corridor) {
  if (!(std::isfinite(corridor.length()) && corridor.length() > 0.0)) return "a corridor has no length";
  if (corridor.widths.size() != corridor.center.segments().size() + 1) return "a corridor's widths are missing";
  for (auto const& w : corridor.widths)
    if (!std::isfinite(w.left + w.right)) return "a corridor's width is not finite";
  double end = 0.0;
  for (auto const& piece : corridor.pieces) {
    if (std::abs(piece.begin - end) > 1e-9 || !(piece.end >= piece.begin)) return "a corridor's pieces leave a gap";
    end = piece.end;
    double const middle = 0.5 * (piece.begin + piece.end);
    auto const at = corridor.lane_at(middle);
    if (!(at.s >= 0.0 && at.s <= map.lane(piece.lane).length() + 1.0)) return "a corridor's place is off its lane";
    if (corridor.piece_at(middle).begin > middle) return "a corridor's piece is not found";
  }
  if (std::abs(end - corridor.length()) > 1e-6) return "a corridor's pieces end before it";
  for (auto const& feeder : corridor.feeders)
    if (!std::isfinite(feeder.begin + feeder.end + feeder.index_begin + feeder.index_end) ||
        !(feeder.index_end > feeder.index_begin))
      return "a feeder is none";
  return "";
}

inline std::string fault_of(Map const& map, RoadCorridor const& road) {
  std::size_t vertices = 0;
  for (std::size_t i = 0; i < road.corridors.size(); ++i) {
    auto const& corridor = road.corridors[i];
    if (auto const fault = fault_of(map, corridor); !fault.empty()) return fault;
    vertices += corridor.widths.size();
    auto const at = locate(road, static_cast<cambium::CorridorId>(i), corridor.center.pose(0.5 * corridor.length()));
    if (!(std::abs(at.lateral) < 1e-3) || !std::isfinite(at.s + at.index)) return "a corridor's middle is beside it";
    if (corridor.widths.size() < 500 && !is_finite(area_of(corridor))) return "a corridor's area is not finite";
  }
  if (index_of(road.main) >= road.corridors.size()) return "the main corridor is missing";
  if (nearest_corridor(road, road.corridors[0].center.pose(0.0)).corridor == cambium::none<cambium::CorridorId>)
    return "no corridor is near";
  if (vertices < 200)
    for (auto const& area : area_of(road))
      if (!std::isfinite(area.outer.area())) return "a road corridor's area is not finite";
  return "";
}

/// Routes between some lanes, what they reach, the corridors along them.
inline std::string fault_of_ways(Map const& map) {
  auto const some = some_of(map.lanes().size(), 3);
  for (auto const i : some) {
    auto const from = static_cast<LaneId>(i);
    auto const straight = straight_route(map, from, 500.0);
    if (auto const fault = fault_of(map, *build_road_corridor(map, straight)); !fault.empty()) return fault;
    auto const reached = map.reachable(from, 500.0);
    if (reached.empty() || reached.front().lane != from) return "a lane does not reach itself";
    for (auto const to : {reached.back().lane, static_cast<LaneId>(some.back())})
      for (auto const& route : map.routes(from, to, {.max_routes = 2})) {
        if (!std::isfinite(route.length + route.cost) || route.lanes.empty()) return "a route is none";
        if (auto const fault = fault_of(map, *build_road_corridor(map, route)); !fault.empty()) return fault;
      }
    if (!map.shortest_route(from, reached.back().lane)) return "a lane that can be reached has no route";
  }
  return "";
}

inline std::string fault_of_junctions(Map const& map) {
  for (auto const& junction : map.junctions()) {
    if (junction.lanes.size() > 30) continue;
    if (auto const area = junction_area(map, junction.id); area && !std::isfinite(area->area()))
      return "a junction's area is not finite";
    for (auto const& conflict : conflict_areas(map, junction.id))
      if (conflict.area && !(conflict.area->area() > 0.0)) return "a conflict's area is none";
  }
  return "";
}

/// Look-ups on some lanes and roads, and away from them.
inline std::string fault_of_places(Map const& map) {
  for (auto const i : some_of(map.lanes().size(), 4)) {
    auto const& lane = map.lanes()[i];
    auto const pose = lane.path.pose(0.3 * lane.length());
    auto const beside = geometry::to_map(pose, {0.0, 4.0});
    geometry::Box box;
    box.add(pose.x, pose.y);
    auto const in = map.lanes_in(box.grown(0.01));
    bool const leaves = is_valid(lane.merges_into);  // its path does
    if (!leaves && std::find(in.begin(), in.end(), lane.id) == in.end()) return "a lane is not where its path is";
    bool const on = map.on_drivable_lane(beside);
    auto const near = map.lanes_near(beside, LaneTree::slack);
    if (on != std::any_of(near.begin(), near.end(), [&](auto const& h) { return map.lane(h.lane).drivable(); }))
      return "a point is on a lane and is not";
    if (lane.widths.size() < 500 && !is_finite(area_of(lane))) return "a lane's area is not finite";
    auto const& road = map.road(lane.road);
    auto const foot = project(road.reference_line, beside);
    if (!std::isfinite(foot.s + foot.t + foot.distance)) return "a foot point is not finite";
    auto const surface = surface_at(road, lane.road_begin, foot.t);
    if (!surface.position.allFinite() || !surface.axes.allFinite()) return "a road's surface is not finite";
  }
  return "";
}

inline std::string fault_of_picture(Map const& map) {
  auto const picture = svg_map_picture(map);
  for (char const* numbers : {" d=\"", "translate(", "viewBox=\""})  // elsewhere there are the file's words
    for (auto at = picture.find(numbers); at != picture.npos; at = picture.find(numbers, at + 1)) {
      auto const begin = at + std::strlen(numbers);
      auto const drawn = picture.substr(begin, picture.find_first_of("\")", begin) - begin);
      if (drawn.find_first_of("ni") != drawn.npos) return "the picture has a number that is none: " + drawn;
    }
  return "";
}

/// What fails first, what is thrown included; empty where all of it works.
inline std::string first_failure(Map const& map) {
  try {
    for (auto const& use : {fault_of_ways, fault_of_junctions, fault_of_places, fault_of_picture})
      if (auto fault = use(map); !fault.empty()) return fault;
  } catch (Error const& error) {
    return std::string("thrown: ") + error.what();
  }
  return "";
}

}  // namespace map_use
