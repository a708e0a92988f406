#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "cambium/core/ids.hpp"
#include "cambium/map/corridor/corridor.hpp"
#include "cambium/map/map.hpp"

namespace cambium::inline v0_1::map::detail {

/// The fastest that comes to a conflict, followed upstream from there: it brakes for bends, late and hard.
struct FastestArrival {
  double speed = 50.0;  ///< [m/s]
  double time = 0.0;    ///< until it is there [s]

  /// Goes back from position `to` to `from` [m] of a lane's path. O(length).
  void go_back(geometry::Line const& path, double from, double to) {
    constexpr double step = 4.0, lateral = 4.0, braking = 4.0;  // [m], [m/s^2]
    if (!(to > from)) return;
    std::uint32_t hint = 0;
    double heading = path.pose(to, hint).heading;
    for (double end = to; end > from;) {
      double const begin = std::max(from, end - step), length = end - begin;
      double const before = std::exchange(heading, path.pose(begin, hint).heading), turn = std::abs(before - heading);
      double const curvature = turn / std::max(length, 0.5 * step);
      speed = std::min(50.0, std::sqrt(speed * speed + 2.0 * braking * length));
      if (speed * speed * curvature > lateral) speed = std::sqrt(lateral / curvature);
      time += length / speed;
      end = begin;
    }
  }
};

/// Sets the times of a stretch of a lane's path, from `begin` to `end` [m], to a conflict at `meets` [m], at most
/// `end`. `arrival` is that from the end, then that from the begin. O(length).
inline void set_times(ConflictWay& stretch, geometry::Line const& path, double begin, double end, double meets,
                      FastestArrival& arrival) {
  stretch.time_from_end = arrival.time;
  arrival.go_back(path, begin, meets);
  stretch.time_from_begin = arrival.time;
  if (begin < meets && meets < end) stretch.time_from_end = arrival.time * (meets - end) / (meets - begin);
}

/// Adds the lanes downstream (`ahead`) or upstream of `lane`, as far as way position `until` [m], each once, by the
/// shortest way. `conflict` is where the conflict begins [m], `arrival` the one from the begin of `lane`.
inline void add_ways_beyond(Map const& map, Lane const& lane, bool ahead, double until, double conflict,
                            FastestArrival const& arrival, std::vector<ConflictWay>& ways) {
  struct Way {
    LaneId lane;
    double far_end;  // [m]
    FastestArrival arrival;
  };
  std::vector<bool> seen(map.lanes().size());
  std::vector<Way> open{{lane.id, ahead ? lane.length() : 0.0, arrival}};
  for (std::size_t i = 0; i < open.size(); ++i) {
    auto const way = open[i];
    if (ahead ? way.far_end >= until : way.far_end <= until) continue;
    for (auto const id : ahead ? map.lane(way.lane).successors : map.lane(way.lane).predecessors) {
      auto const& next = map.lane(id);
      if (!next.drivable() || id == lane.id || seen[index_of(id)]) continue;
      seen[index_of(id)] = true;
      double const far_end = ahead ? way.far_end + next.length() : way.far_end - next.length();
      double const from = ahead ? 0.0 : std::max(0.0, until - far_end);  // on the lane
      double const to = ahead ? std::min(next.length(), until - way.far_end) : next.length();
      ConflictWay stretch{next.index_begin + from, next.index_begin + to, ahead ? way.far_end : far_end + from};
      Way reached{id, far_end, way.arrival};
      if (!ahead) set_times(stretch, next.path, from, to, std::clamp(conflict - far_end, from, to), reached.arrival);
      ways.push_back(stretch);
      open.push_back(reached);
    }
  }
}

/// The ways by which traffic comes from position `from` [m] of `lane` to a conflict that begins at position `conflict`,
/// and leaves it up to position `to`, see `Conflict::ways`.
[[nodiscard]] inline std::vector<ConflictWay> ways_through(Map const& map, Lane const& lane, double from,
                                                           double conflict, double to) {
  double const begin = std::max(0.0, from);
  FastestArrival arrival;
  std::vector<ConflictWay> ways{{lane.index_begin + begin, lane.index_begin + lane.length(), begin}};
  set_times(ways.front(), lane.path, begin, lane.length(), std::clamp(conflict, begin, lane.length()), arrival);
  add_ways_beyond(map, lane, true, to, conflict, arrival, ways);
  add_ways_beyond(map, lane, false, from, conflict, arrival, ways);
  return ways;
}

}  // namespace cambium::inline v0_1::map::detail
