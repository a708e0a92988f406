#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/geometry/collision.hpp"
#include "cambium/geometry/line.hpp"
#include "cambium/geometry/oriented_box.hpp"
#include "cambium/geometry/shape.hpp"
#include "cambium/map/corridor.hpp"
#include "cambium/map/map.hpp"

namespace cambium::map::detail {

/// The place at `s` [m] of a lane's path, along the lanes before and behind it where it lies beyond the ends, and
/// straight on where no lane goes on there.
[[nodiscard]] inline geometry::Pose pose_on_way(Map const& map, LaneId id, double s) {
  auto const* lane = &map.lane(id);
  for (int lanes = 0; lanes < 16 && s < 0.0 && !lane->predecessors.empty(); ++lanes) {
    lane = &map.lane(lane->predecessors.front());
    s += lane->length();
  }
  for (int lanes = 0; lanes < 16 && s > lane->length() && !lane->successors.empty(); ++lanes) {
    s -= lane->length();
    lane = &map.lane(lane->successors.front());
  }
  double const on_path = std::clamp(s, 0.0, lane->length());
  auto const pose = lane->path.pose(on_path);
  return {pose.x + (s - on_path) * std::cos(pose.heading), pose.y + (s - on_path) * std::sin(pose.heading),
          pose.heading};
}

/// The smallest zone that holds both.
[[nodiscard]] inline ConflictZone joined(ConflictZone zone, ConflictZone const& with) {
  if (with.empty()) return zone;
  if (zone.empty()) return with;
  zone.begin = std::min(zone.begin, with.begin);
  zone.end = std::max(zone.end, with.end);
  zone.other_begin = std::min(zone.other_begin, with.other_begin);
  zone.other_end = std::max(zone.other_end, with.other_end);
  return zone;
}

/// Adds a zone to a list of zones that lie apart on both ways, so that one can wait between any two of them. Those
/// that do not become one: else two vehicles may each stand in a zone that the other waits for.
inline void add_zone(std::vector<ConflictZone>& zones, ConflictZone zone) {
  constexpr double room = 5.0;  // [m] for one who waits
  auto const is_one_with = [&zone](ConflictZone const& other) {
    return std::max(other.begin - zone.end, zone.begin - other.end) < room ||
           std::max(other.other_begin - zone.other_end, zone.other_begin - other.other_end) < room;
  };
  for (auto at = zones.begin(); (at = std::find_if(zones.begin(), zones.end(), is_one_with)) != zones.end();) {
    zone = joined(zone, *at);
    zones.erase(at);
  }
  zones.push_back(zone);
}

/// Two bodies, one on a line and one on a lane and its way, of which is asked where they touch.
struct TouchingBodies {
  Map const& map;
  geometry::Line const& line;
  LaneId other;
  geometry::Shape shape, other_shape;

  /// The parts of `range` where they touch, apart as in `add_zone`. O(places on one times places on the other).
  [[nodiscard]] std::vector<ConflictZone> zones(ConflictZone const& range) const {
    std::vector<geometry::OrientedBox> others;
    for (double s = range.other_begin; s <= range.other_end; s += step)
      others.push_back(geometry::box_of(other_shape, pose_on_way(map, other, s)));
    std::vector<ConflictZone> zones;
    for (double s = range.begin; s <= range.end; s += step) {
      auto const body = geometry::box_of(shape, line.pose(s));
      ConflictZone touched;
      for (std::size_t k = 0; k < others.size();) {
        if (std::size_t const far = places_apart(body, others[k])) {
          k += far;
          continue;
        }
        if (geometry::intersects(body, others[k])) {
          double const at = range.other_begin + static_cast<double>(k) * step;
          touched = joined(touched, {s - step, s + step, at - step, at + step});
        }
        ++k;
      }
      if (!touched.empty()) add_zone(zones, touched);
    }
    return zones;
  }

 private:
  static constexpr double step = 0.5;  // [m] between two places of a body

  /// How many of the next places are too far to touch: bodies go no more than 2 m along 1 m of path.
  [[nodiscard]] std::size_t places_apart(geometry::OrientedBox const& a, geometry::OrientedBox const& b) const {
    double const dx = b.x - a.x, dy = b.y - a.y;
    double const apart = std::sqrt(dx * dx + dy * dy) - shape.radius() - other_shape.radius();
    return apart > 2.0 * step ? static_cast<std::size_t>(apart / (2.0 * step)) : 0;
  }
};

}  // namespace cambium::map::detail
