#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "cambium/core/macros.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/corridor/stop_lines.hpp"
#include "cambium/map/map.hpp"
#include "cambium/viewer/record_world.hpp"
#include "cambium/viewer/recording.hpp"
#include "cambium/world/static_object.hpp"

namespace cambium::inline v0_1 {

CAMBIUM_COLD std::vector<RecordedLane> recorded_lanes(Map const& map) {
  std::vector<RecordedLane> lanes;
  for (bool const drivable : {false, true})  // drivable lanes last, so that they are drawn on top
    for (auto const& lane : map.lanes()) {
      if (lane.drivable() != drivable || lane.left.empty() || lane.right.empty()) continue;
      auto const& road = map.road(lane.road);
      auto const kind = !drivable                 ? RecordedLaneKind::other
                        : is_valid(road.junction) ? RecordedLaneKind::junction
                                                  : RecordedLaneKind::driving;
      lanes.push_back(
          {lane.left.points(), lane.right.points(), road.name + ":" + std::to_string(lane.number), kind, true});
    }
  return lanes;
}

CAMBIUM_COLD std::vector<RecordedStopLine> recorded_stop_lines(Map const& map) {
  std::vector<RecordedStopLine> lines;
  for (auto const& line : map::stop_lines(map)) lines.push_back({line.left, line.right, line.light});
  return lines;
}

CAMBIUM_COLD RecordedLane recorded_way(map::LaneCorridor const& way) {
  RecordedLane lane{.kind = RecordedLaneKind::way};
  auto const samples = way.center.samples();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    geometry::Point const at = samples[i].position();
    geometry::Point const aside(-std::sin(samples[i].heading), std::cos(samples[i].heading));
    lane.left.push_back(at + way.widths[i].left * aside);
    lane.right.push_back(at - way.widths[i].right * aside);
  }
  return lane;
}

CAMBIUM_COLD std::pair<RecordedAgent, RecordedPose> recorded_object(StaticObject const& object) {
  geometry::Point longest(0.0, 0.0);
  for (std::size_t i = 0; i < object.outline.size(); ++i) {
    geometry::Point const side = object.outline.edge(i).second - object.outline.edge(i).first;
    if (side.squaredNorm() > longest.squaredNorm()) longest = side;
  }
  geometry::Point const along = longest.normalized(), across(-along.y(), along.x());
  geometry::Point const center = object.outline.bounding_box().center();
  geometry::Shape shape{0, 0, 0, 0};
  for (auto const& p : object.outline.points()) {
    shape.front = std::max(shape.front, along.dot(p - center));
    shape.rear = std::max(shape.rear, -along.dot(p - center));
    shape.left = std::max(shape.left, across.dot(p - center));
    shape.right = std::max(shape.right, -across.dot(p - center));
  }
  return {{none<AgentId>, shape, "object " + to_string(object.id), RecordedAgentKind::static_object},
          {center.x(), center.y(), std::atan2(along.y(), along.x()), 0.0, 0.0, true}};
}

}  // namespace cambium::inline v0_1
