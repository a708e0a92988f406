#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cambium/map/lanes/overlaps.hpp"
#include "cambium/map/map.hpp"

/// Lanes made in code for the tests: one road a lane, so that nothing is beside each other unless it is said.
namespace by_hand {

using namespace cambium;
using namespace cambium::map;
using geometry::LineSample;
using geometry::Point;
using geometry::Pose;

/// Small own generator: the same numbers on every platform.
struct Numbers {
  std::uint64_t state;

  double operator()(double from, double to) {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return from + (to - from) * static_cast<double>(state >> 11) * 0x1p-53;
  }
};

/// Samples of an arc (a straight one where `curvature` is 0), a sample every `step` metres, ends included.
inline std::vector<LineSample> arc(Pose const& start, double curvature, double length, double step = 1.0) {
  std::vector<LineSample> samples;
  int const pieces = std::max(1, static_cast<int>(std::ceil(length / step)));
  for (int i = 0; i <= pieces; ++i) {
    double const s = length * i / pieces, half = 0.5 * curvature * s;
    double const chord = half == 0.0 ? s : s * std::sin(half) / half;
    samples.push_back({start.x + chord * std::cos(start.heading + half),
                       start.y + chord * std::sin(start.heading + half), start.heading + curvature * s});
  }
  return samples;
}

/// Appends a lane along `samples`, `half_width` to either side; gives its id.
inline LaneId add_lane(std::vector<Lane>& lanes, std::vector<LineSample> const& samples, double half_width = 1.75) {
  Lane lane;
  lane.id = static_cast<LaneId>(lanes.size());
  lane.road = static_cast<RoadId>(lanes.size());
  lane.number = -1;
  lane.type = LaneType::driving;
  lane.path = geometry::Line::from_samples(samples);
  lane.widths.assign(lane.path.segments().size() + 1, {half_width, half_width});
  lane.road_end = lane.length();
  auto left = samples, right = samples;
  for (auto* border : {&left, &right})
    for (auto& p : *border) {
      double const across = border == &left ? half_width : -half_width;
      p.x -= across * std::sin(p.heading);
      p.y += across * std::cos(p.heading);
    }
  lane.left = geometry::Line::from_samples(left);
  lane.right = geometry::Line::from_samples(right);
  lane.index_begin = lanes.empty() ? 0.0 : std::ceil(lanes.back().index_begin + lanes.back().length() + 10.0);
  lanes.push_back(std::move(lane));
  return lanes.back().id;
}

inline LaneId add_straight(std::vector<Lane>& lanes, Pose const& start, double length, double half_width = 1.75) {
  return add_lane(lanes, arc(start, 0.0, length, length), half_width);
}

/// A lane from (0, -3.5) along +x that swings onto the x axis between x = 40 and its end at x = 100.
inline LaneId add_swinging(std::vector<Lane>& lanes) {
  std::vector<LineSample> samples;
  for (int i = 0; i <= 200; ++i) {
    double const x = 0.5 * i, u = std::clamp((x - 40) / 60, 0.0, 1.0);
    samples.push_back({x, -3.5 + 3.5 * u * u * (3 - 2 * u), std::atan(3.5 / 60 * 6 * u * (1 - u))});
  }
  return add_lane(lanes, samples);
}

inline void link(std::vector<Lane>& lanes, LaneId from, LaneId to) {
  lanes[index_of(from)].successors.push_back(to);
  lanes[index_of(to)].predecessors.push_back(from);
}

inline void put_beside(std::vector<Lane>& lanes, LaneId left, LaneId right) {
  lanes[index_of(left)].right_neighbor = right;
  lanes[index_of(right)].left_neighbor = left;
  lanes[index_of(left)].right_changes = {{0.0, lanes[index_of(left)].length()}};
  lanes[index_of(right)].left_changes = {{0.0, lanes[index_of(right)].length()}};
  lanes[index_of(right)].road = lanes[index_of(left)].road;
  lanes[index_of(right)].number = lanes[index_of(left)].number - 1;
}

/// Distance of `p` from a line, its ends included.
inline double distance(geometry::Line const& line, Point const& p) {
  if (line.empty()) return INFINITY;
  auto const foot = line.project(p);
  return std::hypot(foot.lateral, std::max({-foot.s, foot.s - line.length(), 0.0}));
}

/// A map of the lanes, with their overlaps.
inline std::shared_ptr<Map const> make_map(std::vector<Lane> lanes) {
  Map::Parts parts;
  find_overlaps(lanes, {}, parts.options.overlap_clearance);
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    Road road;
    road.id = static_cast<RoadId>(i);
    road.name = std::to_string(i);
    parts.roads.push_back(std::move(road));
  }
  parts.lanes = std::move(lanes);
  return std::make_shared<Map const>(std::move(parts));
}

}  // namespace by_hand
