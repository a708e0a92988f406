#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "cambium/core/error.hpp"
#include "cambium/core/text.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/map/building/lane_adjacency.hpp"
#include "cambium/map/building/make_roads.hpp"
#include "cambium/map/lanes/road_lanes.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/road/road_surface.hpp"

#include "../common/csv.hpp"

namespace map_example {

namespace cb = cambium;
using examples::csv_cell;
using examples::digits;

/// The road that a row names in its first column.
inline cb::map::Road const& road_of(cb::Map const& map, examples::CsvTable const& rows, std::size_t row) {
  try {
    return map.find_road(rows.word(row, 0));
  } catch (cb::MapError const&) {
    rows.fail_at(row, "the map has no road " + rows.word(row, 0), "look at the --picture for its roads");
  }
}

/// Poses of lanes: for each row road,s,lane of `file`, the lane's centre, width and lateral offset, and the pose of the
/// reference line. With `in_space`, also the centre on the road's surface, with elevation and superelevation.
inline std::string poses(cb::Map const& map, std::string const& file, bool in_space) {
  examples::CsvTable const rows(file, {"road", "s", "lane"});
  std::string text = "road,s,lane,x,y,hdg,width,t,rx,ry,rhdg,rk" + std::string(in_space ? ",sx,sy,sz\n" : "\n");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    auto const s = rows.number<double>(i, 1);
    auto const lane = rows.number<int>(i, 2);
    auto const& road = road_of(map, rows, i);
    auto const p = lane_point(road, s, lane);
    if (!p)
      rows.fail_at(i, "road " + road.name + " has no lane " + std::to_string(lane) + " at s " + rows.word(i, 1),
                   "name a lane that exists there, other than lane 0");
    text += csv_cell(road.name) + ',' + digits(s) + ',' + std::to_string(lane);
    for (double const value :
         {p->center.x, p->center.y, cb::geometry::normalize_angle(p->center.heading), p->width, p->t, p->reference.x,
          p->reference.y, cb::geometry::normalize_angle(p->reference.heading), p->reference.curvature})
      text += ',' + digits(value);
    if (in_space)
      for (double const value : surface_at(road, s, p->t).position) text += ',' + digits(value);
    text += '\n';
  }
  return text;
}

/// The lanes that contain the points x,y of `file`, for each point sorted by the distance to the lane's centre. `query`
/// is the number of the point, from 0.
inline std::string nearest(cb::Map const& map, std::string const& file) {
  examples::CsvTable const rows(file, {"x", "y"});
  std::string text = "road,lane,s,t,distance,query\n";
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (auto const& place : road_places(map, {rows.number<double>(i, 0), rows.number<double>(i, 1)}))
      text += csv_cell(map.road(place.road).name) + ',' + std::to_string(place.number) + ',' + digits(place.s) + ',' +
              digits(place.t) + ',' + digits(place.distance) + ',' + std::to_string(i) + '\n';
  return text;
}

/// The links between lanes at the ends of roads.
inline std::string links(cb::map::OpenDriveDocument const& document) {
  auto const word = [](cb::map::opendrive::ContactPoint end) {
    return end == cb::map::opendrive::ContactPoint::end ? "end" : "start";
  };
  std::string text = "road,end,lane,next_road,next_contact,next_lane,via\n";
  for (auto const& link : lane_adjacency(document, cb::map::make_roads(document)))
    text += csv_cell(link.road) + ',' + word(link.end) + ',' + std::to_string(link.lane) + ',' +
            csv_cell(link.next_road) + ',' + word(link.next_end) + ',' + std::to_string(link.next_lane) + ',' +
            csv_cell(link.junction.empty() ? "road" : "junction:" + link.junction) + '\n';
  return text;
}

}  // namespace map_example
