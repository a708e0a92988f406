#pragma once

#include <cstddef>
#include <span>

#include "cambium/core/ids.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/map/build/detail/lane_geometry.hpp"
#include "cambium/map/build/detail/section_sampler.hpp"
#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/map.hpp"
#include "cambium/map/road/road.hpp"

namespace cambium::map::detail {

/// The curves that lanes' paths are samples of. Looks at the roads, lanes and options that it is made with.
class ExactPaths {
 public:
  ExactPaths(std::span<Road const> roads, std::span<Lane const> lanes, MapOptions const& options)
      : roads_(roads), lanes_(lanes), options_(options) {}

  /// The place on the exact path, with the direction of travel, at the station of path position `s` [m]. O(lanes of the
  /// section), each a binary search.
  [[nodiscard]] geometry::Pose at(Lane const& lane, double s) const {
    auto const& road = roads_[index_of(lane.road)];
    auto const& section = road.sections[lane.section];
    auto const column = column_of(section, lane.number);
    auto const cross = SectionSampler(road, section, options_).at(lane.station_at(s));
    auto course = cross.center(column);
    if (is_valid(lane.merges_into)) {
      auto const target = column_of(section, lanes_[index_of(lane.merges_into)].number);
      double const from = lane.station_at(lane.merge_begin), to = lane.along_road ? section.end : section.begin;
      course = merging_path(cross, column, target, from, to);
    }
    auto pose = cross.at(course);
    if (!lane.along_road) pose.heading += geometry::pi;
    return pose;
  }

 private:
  std::span<Road const> roads_;
  std::span<Lane const> lanes_;
  MapOptions const& options_;
};

}  // namespace cambium::map::detail
