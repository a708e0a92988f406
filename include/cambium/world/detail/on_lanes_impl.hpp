#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "cambium/core/ids.hpp"
#include "cambium/core/macros.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/geometry/angle.hpp"
#include "cambium/geometry/pose.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/corridor/lane_place.hpp"
#include "cambium/map/lanes/lane.hpp"
#include "cambium/map/map.hpp"
#include "cambium/world/detail/on_lanes.hpp"
#include "cambium/world/traffic_index.hpp"

namespace cambium::inline v0_1::detail {

/// Sine and cosine of the body's heading relative to `lane` at `s` [m].
[[nodiscard]] inline portable::SinCos turn_in(map::Lane const& lane, double s, BodyOnRoad const& body) {
  return portable::sin_cos(body.pose.heading - lane.path.pose(s).heading);
}

/// The agent's entry in `lane`, at its foot point `s` [m]: its speed along that lane and its extent ahead and behind.
[[nodiscard]] inline TrafficEntry entry_in(map::Lane const& lane, double s, BodyOnRoad const& body,
                                           portable::SinCos const& turn, TrafficEntry entry) {
  auto const [sin, cos] = turn;
  auto const reach = geometry::extent_along(body.shape, cos, sin);
  entry.position = lane.index_begin + std::clamp(s, 0.0, lane.length());
  entry.front = reach.positive;
  entry.rear = reach.negative;
  entry.speed = body.speed * cos;
  return entry;
}
[[nodiscard]] inline TrafficEntry entry_in(map::Lane const& lane, double s, BodyOnRoad const& body,
                                           TrafficEntry const& entry) {
  return entry_in(lane, s, body, turn_in(lane, s, body), entry);
}

inline void add_in(map::Lane const& lane, TrafficEntry const& entry, ReachingEntries& list) {
  list.add(entry, {lane.index_begin, lane.index_begin + lane.length()});
}

/// Adds an entry for each drivable lane that the agent's body reaches into. For agents on paths that are no drivable
/// lanes, such as free corridors.
inline void enter_touched(Map const& map, BodyOnRoad const& body, TrafficEntry const& entry, ReachingEntries& list) {
  auto const& shape = body.shape;
  geometry::Point const at = body.pose.position();
  double const radius = std::max(shape.front, shape.rear) + std::max(shape.left, shape.right);
  auto const first = static_cast<std::ptrdiff_t>(list.entries.size());
  map.for_each_drivable_near(at, radius, [&](map::LaneHit const& hit) {
    auto const& lane = map.lane(hit.lane);
    auto const turn = turn_in(lane, hit.s, body);
    auto const aside = geometry::extent_along(shape, turn.sin, -turn.cos);
    auto const widths = lane.widths_at(std::clamp(hit.s, 0.0, lane.length()), hit.segment);
    if (hit.lateral - aside.negative > widths.left || hit.lateral + aside.positive < -widths.right) return;
    auto const found = entry_in(lane, hit.s, body, turn, entry);
    if (hit.s + found.front < 0.0 || hit.s - found.rear > lane.length()) return;
    auto const is_there = [&](TrafficEntry const& other) {  // added for another foot point on the same lane
      return other.position >= lane.index_begin && other.position <= lane.index_begin + lane.length();
    };
    if (std::none_of(list.entries.begin() + first, list.entries.end(), is_there)) add_in(lane, found, list);
  });
}

CAMBIUM_COLD bool straddle(Map const& map, BodyOnRoad const& body, TrafficEntry const& entry, ReachingEntries& list) {
  auto const& at = body.at;
  auto const& corridor = body.road.corridors[at.corridor];
  if (!is_drivable(corridor.pieces[at.piece].type)) {
    list.off_lanes.push_back(entry.slot);
    enter_touched(map, body, entry, list);
    return true;
  }
  auto const& lane = map.lane(corridor.pieces[at.piece].lane);
  auto const [sin, cos] = portable::sin_cos(at.heading_error);
  auto const reach = geometry::extent_along(body.shape, sin, -cos);
  double const left = at.lateral + reach.positive, right = reach.negative - at.lateral;
  auto const widths = corridor.widths_at(at.s, at.segment);
  auto const& pose = body.pose;
  if (-left >= widths.right || -right >= widths.left) {
    if (auto const hit = map.nearest_lane(pose, 0.0))
      add_in(map.lane(hit->lane), entry_in(map.lane(hit->lane), hit->s, body, entry), list);
    return false;
  }
  if (std::abs(at.lateral) > on_path && left <= widths.left && right <= widths.right &&
      std::max(widths.left - left, widths.right - right) >= TrafficIndex::room_to_pass)
    list.aside.push_back(entry.slot);
  double const share = (at.index - lane.index_begin) / lane.length();
  auto const enter = [&](LaneId beside, double to_the_side) {
    if (is_valid(beside)) {
      auto const& other = map.lane(beside);
      auto const foot = other.path.project(pose.position(), other.path.find(share * other.length()));
      add_in(other, entry_in(other, foot.s, body, entry), list);
      return;
    }
    double const along = pose.heading - at.heading_error;
    geometry::Point const side{pose.x - portable::sin(along) * to_the_side,
                               pose.y + portable::cos(along) * to_the_side};
    auto const hit = map.nearest_lane({side.x(), side.y(), along + geometry::pi}, 0.0);
    if (!hit || hit->distance > 0.0) return;
    auto const& oncoming = map.lane(hit->lane);
    if (portable::cos(oncoming.path.pose(hit->s).heading - along) < 0.0)
      add_in(oncoming, entry_in(oncoming, hit->s, body, entry), list);
  };
  if (left > widths.left) enter(lane.left_neighbor, reach.positive);
  if (right > widths.right) enter(lane.right_neighbor, -reach.negative);
  return true;
}

}  // namespace cambium::inline v0_1::detail
